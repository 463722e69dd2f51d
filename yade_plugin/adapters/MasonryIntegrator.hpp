#pragma once
#include "motion/RigidMotion.hpp"
#include "scene/GravityWork.hpp"
#include "scene/Ledger.hpp"
#include "scene/SceneCheck.hpp"

namespace masonry {

class BodyColumns;
class SceneStore;

class MasonryIntegrator : public Adapter<MasonryIntegrator, yade::GlobalEngine>,
                          public EnergyLedger,
                          public GravityWork {
public:
    static constexpr const char* className = "MasonryIntegrator";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Moves the rigid bodies by the equations of NewtonIntegrator (paper eqs. (1)-(3)) and counts their energies. "
        "Leaves out what masonry does not need: periodic cells, clumps and bounds for a collider. NewtonIntegrator "
        "with "
        "MasonryEnergy remains as the reference.";

    double damping = 0.8;
    std::string dampingKind = "combined";
    double massDamping = 0;
    Vector3r gravity = Vector3r(0, 0, -9.81);

    template <class Visit> static void attributes(Visit&& visit) {
        using I = MasonryIntegrator;
        visit("damping", &I::damping,
              number("-", "Damping constant alpha").atLeast(0).atMost(0.99).source("paper eq. (3): 0.8"));
        visit("dampingKind", &I::dampingKind,
              described("'local': -alpha |F| sgn(v), paper eq. (3); 'combined': alpha |F| (sgn(dF/dt) - sgn(v)) / 2, "
                        "which also calms vibration about a steady motion"));
        visit("massDamping", &I::massDamping,
              number("1/s", "Mass-proportional viscous damping: every free axis of a damped body, and the nodes of "
                            "MasonryZones, get the force -massDamping times momentum. A mode of angular frequency w "
                            "then has the damping ratio massDamping/(2w); the limit of the time step stays. Blocks "
                            "under a MasonryLoad and axes whose motion is prescribed are left out")
                  .atLeast(0));
        visit("gravity", &I::gravity,
              number("m/s²",
                     "Gravity. It may change during a run: MasonryZones follows it, and the energy balance counts "
                     "its work"));
        ledgerOfBodies<I>(visit);
        GravityWork::describe<I>(visit);
        visit("last", computed(&I::lastForces, &I::setLastForces),
              described("Force per mass and torque per inertia of every body in the last step"), Hidden);
    }

    std::vector<std::string> problems() const;
    bool isActivated() override { return standsAlone(*this); }
    void action() override;

private:
    bool combined() const { return dampingKind == "combined"; }
    struct Sums {                           // of some bodies
        EnergyLedger energies;              // `fallen` is the sum of m g·u
        Vector3r moment = Vector3r::Zero(); // sum of m u [kg m]; see GravityWork
    };
    // Makes a step of bodies `first` up to, but without, `beyond`.
    Sums advance(SceneStore&, const Vector3r* forces, const Vector3r* torques, int first, int beyond);
    void findWeights(const BodyColumns&, int first, int count, Sums&) const;
    // Makes a step of a body none of whose rotations is blocked.
    EnergyLedger turnFreely(SceneStore&, const Vector3r& force, const Vector3r& torque, int body);
    std::vector<Vector3r> lastForces();
    void setLastForces(const std::vector<Vector3r>&);

    std::vector<double> last_[6]; // for combined damping: force per mass [m/s²] and torque per inertia [1/s²] of all
                                  // bodies in the last step; empty until then
};

} // namespace masonry

extern template class masonry::Adapter<masonry::MasonryIntegrator, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_KEY(masonry::MasonryIntegrator)
