// Many subcontacts of one kind, a column for each quantity, so that the vector units take several at a time. The law is
// that of JointLaw; a subcontact that neither yields nor opens further nor hardens in a step takes a short way through
// the same equations, without branches, one that only slips another, and the rest go through JointLaw::advance.
#pragma once
#include "JointLaw.hpp"
#include <cstdint>

namespace masonry {

class JointColumns {
public:
    JointColumns() = default;
    JointColumns(const JointLaw& law, const ElasticStiffness& k, std::size_t size);

    std::size_t size() const { return opening_.size(); }
    JointState get(std::size_t i) const;
    void set(const JointLaw& law, std::size_t i, const JointState& state);

    // One step of the subcontacts from `first` on, under `count` jumps given in columns; without `slideB`, all slides
    // and shear stresses are along a. Gives their normal stresses; the shear stresses stand below. `law` is the one
    // that the columns were made with. Different ranges may be advanced at the same time.
    void advance(const JointLaw& law, std::size_t first, std::size_t count, const double* opening, const double* slideA,
                 const double* slideB, double* normalStress);

    const double* shearStressA() const { return shearStressA_.data(); }
    const double* shearStressB() const { return shearStressB_.data(); }

    // Energy dissipated so far [J/m²]: kept beside the state.
    Energies dissipated(std::size_t i) const { return {lostTension_[i], lostShear_[i], lostCompression_[i]}; }
    void setDissipated(std::size_t i, const Energies& e) {
        lostTension_[i] = e.tension, lostShear_[i] = e.shear, lostCompression_[i] = e.compression;
    }

private:
    struct Limits { // what the short way must know of the kind
        double normalStiffness, shearStiffness, tensileStrength, onset, residualCohesion, cohesionLoss,
            residualFriction, frictionLoss, capNormal, capShear, capLinear, limitClosure, ownShearStiffness;
        bool cap;
    };
    static std::int64_t advanceIntact(const Limits&, std::size_t count, const double* jumpN, const double* jumpA,
                                      const double* jumpB, const double* flow, const double* intact,
                                      const double* secant, const double* reach, const double* capStrength2,
                                      double* opening, double* largestOpening, double* largestClosure,
                                      double* shearStressA, double* shearStressB, double* normalStress,
                                      std::int64_t* now);

    struct Slide; // scratch
    static void trySlide(const Limits&, std::size_t count, const double* jumpN, const double* jumpA,
                         const double* jumpB, const double* flow, const double* intact, const double* secant,
                         const double* reach, const double* slip, const double* opening, const double* largestOpening,
                         const double* shearStressA, const double* shearStressB, const std::int64_t* now, Slide&);
    static void finishSlide(const Limits&, std::size_t count, const double* flow, const double* capStrength2,
                            const double* tensionDamage, double* shearDamage, double* intact, double* secant,
                            double* reach, double* slip, double* opening, double* largestOpening,
                            double* largestClosure, double* shearStressA, double* shearStressB, double* lostTension,
                            double* lostShear, double* normalStress, std::int64_t* now, const Slide&);
    void slide(const JointLaw&, std::size_t first, std::size_t count, const double* jumpN, const double* jumpA,
               const double* jumpB, double* shearStressB, double* normalStress, std::int64_t* now);

    ElasticStiffness k_{};
    Limits limits_{};
    bool slides_ = false; // whether the kind can take the way of those that only slip
    std::vector<double> opening_, crushing_, dilation_, slip_, largestOpening_, largestClosure_, tensionDamage_,
        shearDamage_, normalStress_, shearStressA_, shearStressB_;      // as in JointState
    std::vector<double> flow_, intact_, secant_, reach_, capStrength2_; // follow from the above: crushing less
    // dilation, 1 - d_ts, stiffness of the open joint, elastic opening before more damage, square of the cap's strength
    std::vector<double> lostTension_, lostShear_, lostCompression_;
    std::vector<std::int32_t> row_; // of the shear table, where it was read last
    std::vector<Regime> regime_;
};

} // namespace masonry
