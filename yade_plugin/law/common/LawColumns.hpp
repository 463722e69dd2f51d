// SPDX-License-Identifier: GPL-2.0-or-later
// The states of the subcontacts of joints of one kind, in columns [point][joint], for who does not know the law. What a
// law does with them is in ColumnsOf and ColumnsSideBySide.
#pragma once
#include "Columns.hpp"
#include "JointField.hpp"
#include "JointState.hpp"
#include "Law.hpp"
#include "common/StateNumbers.hpp"
#include <cstdlib>
#include <functional>
#include <vector>

namespace masonry {

constexpr double bondGone = 1 - 1e-9; // damage of a bond that is gone

class LawColumns {
public:
    static constexpr int most = Columns::most; // joints that are advanced at a time

    // `count` is the number of columns of the law, `of` gives its column of a role.
    LawColumns(int count, int (*of)(Role), const ElasticStiffness& k, int joints, int points);
    virtual ~LawColumns() = default;

    int joints() const { return joints_; }
    int points() const { return points_; }
    int stride() const { return stride_; } // joints padded to whole lanes; a lone joint is not padded
    const ElasticStiffness& stiffness() const { return k_; }
    virtual const Law& law() const = 0;

    // The numbers of joints side by side, which begin with joint `from`.
    const double* shearStressA(int point, int from) const {
        return columns_[SharedColumn::ShearStressA] + at(point, from);
    }
    const double* shearStressB(int point, int from) const {
        return columns_[SharedColumn::ShearStressB] + at(point, from);
    }
    const Regime* regime(int point, int from) const { return &regime_[at(point, from)]; }
    // The numbers of a role, null where the law has no such column.
    const double* column(Role role, int point, int from) const {
        const int of = of_(role);
        return of == SharedColumn::none ? nullptr : columns_[of] + at(point, from);
    }
    // Whether these joints were made with a bond whose damage the law knows.
    bool isBonded() const;

    // Normal stress [Pa] that a subcontact has if it is closed and its stiffness is that of an intact one.
    double stressIfClosed(int point, int joint) const {
        const std::size_t i = at(point, joint);
        return k_.normal * (columns_[SharedColumn::Opening][i] + columns_[SharedColumn::Irreversible][i]);
    }

    // Sets the shear stress out of the plane to zero, of which round-off has left something.
    void dropShearStressB(int point, int joint) { columns_[SharedColumn::ShearStressB][at(point, joint)] = 0; }

    // What every law knows of a subcontact.
    virtual JointState state(int point, int joint) const = 0;
    Energies dissipated(int point, int joint) const; // [J/m²] so far
    virtual void setDissipated(int point, int joint, const Energies&) = 0;

    // All numbers of the state of a subcontact, its regime among them, with their names: `read` shows them to a
    // function, `write` takes those that it leaves.
    virtual void read(int point, int joint, const std::function<void(const char* name, double number)>&) const = 0;
    virtual void write(int point, int joint, const std::function<void(const char* name, double& number)>&) = 0;
    void visitState(int point, int joint, StateNumbers&); // the same and what was dissipated, to save or to load
    // Takes the stresses from a subcontact: what is pressed or sheared is at rest from now on, what is open stays so.
    virtual void release(int point, int joint) = 0;
    // Takes the state of a subcontact from other columns, that is all numbers that both laws call the same.
    virtual void take(int point, int joint, const LawColumns& from, int otherPoint, int other);

    // What files show of a subcontact beside its stresses.
    virtual void show(int point, int joint, const ShowField&) const = 0;
    double shown(int point, int joint, const JointField&) const; // one of these; zero if the law does not show it
    virtual Yield yielding(int point, int joint) const = 0;
    // The yield functions of a subcontact that has never yielded, under these stresses [Pa].
    virtual Yield yieldingUnder(double normalStress, const Shear& shearStress) const = 0;

    // One step of one subcontact with the law for one, losses included. Gives its normal stress.
    virtual double advanceOne(int point, int joint, const Jump&) = 0;

    // One step of joints from..from+count (count <= most, from a multiple of 8) at a point, under jumps in columns that
    // begin at `from`. Without slideB all is in the plane: the shear stresses along b are zero and stay so. Gives
    // normal stresses. Different ranges may be advanced at the same time by threads.
    virtual void advance(int point, int from, int count, const double* opening, const double* slideA,
                         const double* slideB, double* normalStress) = 0;

    // Intact joints. As long as a joint is elastic and has never yielded, its stresses are the stiffness times its
    // jumps, which are linear over its face, and its points need not be advanced. A law for which that holds says so
    // here, and then answers the questions that follow; another is never asked them.
    virtual bool knowsIntact() const { return false; }
    // Whether nothing has yielded at a subcontact, so that its stress is the stiffness times its jump, or differs from
    // that by a stress that was given to it.
    virtual bool isIntact(int /*point*/, int /*joint*/) const { return false; }
    // Whether a joint whose outermost points are elastic is elastic at all of its points, because the law's elastic
    // domain is convex.
    virtual bool isConvex() const { return false; }
    // Adds 1 to `yielding` where a subcontact of an intact joint would not be well within the elastic domain under a
    // jump, or the jump is not finite. Without slideB all is in the plane.
    virtual void findYielding(int /*count*/, const double* /*opening*/, const double* /*slideA*/,
                              const double* /*slideB*/, Mask* /*yielding*/) const {}
    // Takes down what a subcontact that stays elastic remembers of an opening, such as the largest so far, for the
    // joints from..from+count.
    virtual void remember(int /*point*/, int /*from*/, int /*count*/, const double* /*opening*/) {}
    // Gives a subcontact of an intact joint its jump, and the stress that belongs to it.
    void setElastic(int point, int joint, double opening, double slideA, double slideB) {
        const std::size_t i = at(point, joint);
        columns_[SharedColumn::Opening][i] = opening;
        columns_[SharedColumn::ShearStressA][i] = k_.shear * slideA;
        columns_[SharedColumn::ShearStressB][i] = k_.shear * slideB;
    }

    // Area-weighted sums over all joints [J], in an order that does not depend on threads. `area` holds [point][stride]
    // numbers, or [point][most] numbers repeated for all blocks of `most` joints if `alike`.
    struct Sums {
        Energies stored, dissipated;
    };
    Sums energies(const double* area, bool alike) const;

protected:
    // Adds the energies of the subcontacts of up to eight joints at a point.
    virtual void sumEnergies(int point, int from, int count, const double* area, LaneSums& sums) const = 0;

    std::size_t at(int point, int joint) const { return std::size_t(point) * stride_ + joint; }

    int (*of_)(Role);
    ElasticStiffness k_;
    int joints_, points_, stride_;
    Columns columns_;
    std::vector<Regime> regime_;

private:
    struct Release {
        void operator()(void* memory) const { std::free(memory); }
    };
    // Zeroed memory that takes no room in the machine before it is written to, as columns that only subcontacts which
    // have yielded use.
    std::unique_ptr<void, Release> memory_;
};

} // namespace masonry
