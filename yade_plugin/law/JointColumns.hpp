// Many subcontacts of one kind, a column for each quantity, so that the vector units take several at a time. The law is
// that of JointLaw; a subcontact that neither yields nor opens further nor hardens in a step takes a short way through
// the same equations, without branches, and every other one goes through JointLaw::advance.
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

    // One step of the subcontacts from `first` on, under `count` jumps given in columns. `law` is the one that the
    // columns were made with. Different ranges may be advanced at the same time.
    void advance(const JointLaw& law, std::size_t first, std::size_t count, const double* opening, const double* slideA,
                 const double* slideB);

    const double* normalStress() const { return normalStress_.data(); }
    const double* shearStressA() const { return shearStressA_.data(); }
    const double* shearStressB() const { return shearStressB_.data(); }

    // Energy dissipated since this was last asked [J/m²].
    Energies takeDissipated(std::size_t i);

private:
    struct Limits { // what the short way must know of the kind
        double normalStiffness, shearStiffness, tensileStrength, onset, residualCohesion, cohesionLoss,
            residualFriction, frictionLoss, capNormal, capShear, capLinear, limitClosure;
        bool cap;
    };
    static void advanceIntact(const Limits&, std::size_t count, const double* jumpN, const double* jumpA,
                              const double* jumpB, const double* flow, const double* intact, const double* capStrength2,
                              double* opening, double* largestOpening, double* largestClosure, double* normalStress,
                              double* shearStressA, double* shearStressB, double* lostTension, std::uint8_t* regime);

    ElasticStiffness k_{};
    Limits limits_{};
    std::vector<double> opening_, crushing_, dilation_, slip_, largestOpening_, largestClosure_, tensionDamage_,
        shearDamage_, normalStress_, shearStressA_, shearStressB_; // as in JointState
    std::vector<double> flow_, intact_, capStrength2_;             // follow from the above: crushing less dilation,
                                                                   // 1 - d_ts, square of the cap's strength
    std::vector<double> lostTension_, lostShear_, lostCompression_;
    std::vector<std::uint8_t> regime_;
};

} // namespace masonry
