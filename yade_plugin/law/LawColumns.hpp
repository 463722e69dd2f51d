// The states of the subcontacts of joints of one kind, in columns [point][joint]. What a law does with them is in
// ColumnsWith.
#pragma once
#include "Columns.hpp"
#include "Law.hpp"
#include <cstdlib>
#include <vector>

namespace masonry {

class LawColumns {
public:
    static constexpr int most = Columns::most; // joints that are advanced at a time

    // The first `count` columns are kept.
    LawColumns(int count, const ElasticStiffness& k, int joints, int points);
    virtual ~LawColumns() = default;

    int joints() const { return joints_; }
    int points() const { return points_; }
    int stride() const { return stride_; } // joints padded to whole lanes; a lone joint is not padded
    const ElasticStiffness& stiffness() const { return k_; }
    const double* shearStressA(int point, int from) const { return columns_[Columns::ShearStressA] + at(point, from); }
    const double* shearStressB(int point, int from) const { return columns_[Columns::ShearStressB] + at(point, from); }

    const double* tensionDamage(int point, int from) const {
        return columns_[Columns::TensionDamage] + at(point, from);
    }
    const Regime* regime(int point, int from) const { return &regime_[at(point, from)]; }

    virtual const Law& law() const = 0;
    // Other properties for the same law: what follows from them is found anew, the state stays. False, and nothing
    // happens, if the properties ask for another law.
    virtual bool setLaw(const std::shared_ptr<const Law>&) = 0;

    virtual JointState get(int point, int joint) const = 0;
    virtual void set(int point, int joint, const JointState&) = 0;
    Energies dissipated(int point, int joint) const; // [J/m²] so far
    virtual void setDissipated(int point, int joint, const Energies&) = 0;

    // One step of one subcontact with the law for one, losses included. Gives its normal stress.
    virtual double advanceOne(int point, int joint, const Jump&) = 0;

    // One step of joints from..from+count (count <= most, from a multiple of 8) at a point, under jumps in columns that
    // begin at `from`. Without slideB all is in the plane: the shear stresses along b are zero and stay so. Gives
    // normal stresses. Different ranges may be advanced at the same time by threads.
    virtual void advance(int point, int from, int count, const double* opening, const double* slideA,
                         const double* slideB, double* normalStress) = 0;

    // Area-weighted sums over all joints [J], in an order that does not depend on threads. `area` holds [point][stride]
    // numbers, or [point][most] numbers repeated for all blocks of `most` joints if `alike`.
    struct Sums {
        Energies stored, dissipated;
    };
    virtual Sums energies(const double* area, bool alike) const = 0;

protected:
    std::size_t at(int point, int joint) const { return std::size_t(point) * stride_ + joint; }
    std::size_t group(int point, int joint) const { return std::size_t(point) * groups_ + joint / lanes; }
    bool hasYielded(int point, int joint) const { return yielded_[group(point, joint)] != 0; }

    ElasticStiffness k_;
    int joints_, points_, stride_, groups_;
    Columns columns_;
    std::vector<TableRows> rows_;
    std::vector<Regime> regime_;
    std::vector<std::uint8_t> yielded_; // of groups of eight joints at a point, whether one has yielded

private:
    struct Release {
        void operator()(void* memory) const { std::free(memory); }
    };
    // Zeroed memory that takes no room in the machine before it is written to: columns of what yielded subcontacts
    // have cost nothing where none has.
    std::unique_ptr<void, Release> memory_;
};

} // namespace masonry
