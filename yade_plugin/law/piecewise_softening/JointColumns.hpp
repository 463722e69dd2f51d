// The states of the subcontacts of joints of one kind, a column for each quantity, so that the vector units take
// several subcontacts at a time. The law is that of JointLaw, by the same equations and to the last bit.
#pragma once
#include "JointLaw.hpp"
#include "SideBySide.hpp"
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace masonry {

class JointColumns { // in columns [point][joint]
public:
    static constexpr int most = Columns::most; // joints that are advanced at a time

    JointColumns(std::shared_ptr<const JointLaw> law, const ElasticStiffness& k, int joints, int points);

    int joints() const { return joints_; }
    int points() const { return points_; }
    int stride() const { return stride_; } // joints padded to whole lanes; a lone joint is not padded
    const JointLaw& law() const { return *law_; }
    const ElasticStiffness& stiffness() const { return k_; }

    // Other properties: what follows from them is found anew, the state stays.
    void setLaw(std::shared_ptr<const JointLaw> law);

    JointState get(int point, int joint) const;
    void set(int point, int joint, const JointState& state);
    Energies dissipated(int point, int joint) const; // [J/m²] so far
    void setDissipated(int point, int joint, const Energies& energies);

    // One step of one subcontact with the law for one, losses included. Gives its normal stress.
    double advanceOne(int point, int joint, const Jump& jump);

    // One step of joints from..from+count (count <= most, from a multiple of 8) at a point, under jumps in columns that
    // begin at `from`. Without slideB all is in the plane: the shear stresses along b are zero and stay so. Gives
    // normal stresses. Different ranges may be advanced at the same time by threads.
    void advance(int point, int from, int count, const double* opening, const double* slideA, const double* slideB,
                 double* normalStress);

    const double* shearStressA(int point, int from) const { return columns_[Columns::ShearStressA] + at(point, from); }
    const double* shearStressB(int point, int from) const { return columns_[Columns::ShearStressB] + at(point, from); }

    // Area-weighted sums over all joints [J], in an order that does not depend on threads. `area` holds [point][stride]
    // numbers, or [point][most] numbers repeated for all blocks of `most` joints if `alike`.
    struct Sums {
        Energies stored, dissipated;
    };
    Sums energies(const double* area, bool alike) const;

private:
    struct Release {
        void operator()(void* memory) const { std::free(memory); }
    };

    std::size_t at(int point, int joint) const { return std::size_t(point) * stride_ + joint; }
    std::size_t group(int point, int joint) const { return std::size_t(point) * groups_ + joint / lanes; }
    void prepare(); // what follows from law and stiffness
    bool neverYielded(const JointState& s) const;
    void yieldFrom(int point, int joint); // from now on the eight joints of this one use all columns
    void derive(std::size_t i);           // finds what follows from a state

    std::shared_ptr<const JointLaw> law_;
    ElasticStiffness k_;
    Equations equations_;
    Consequences neverYielded_; // of subcontacts that never yielded
    int joints_, points_, stride_, groups_;
    // Zeroed memory that takes no room in the machine before it is written to: columns of what yielded subcontacts
    // have cost nothing where none has.
    std::unique_ptr<void, Release> memory_;
    Columns columns_;
    std::vector<TableRows> rows_;
    std::vector<Regime> regime_;
    std::vector<std::uint8_t> yielded_; // of groups of eight joints at a point, whether one has yielded
};

} // namespace masonry
