// SPDX-License-Identifier: GPL-2.0-or-later
// The energy balance of a run, and the watch over it: a run that is unstable or has collapsed ends. An engine derives
// from this class.
#pragma once
#include "Collapse.hpp"
#include "common/StateNumbers.hpp"
#include "engine/bodies/GravityWork.hpp"
#include "engine/store/RunEnded.hpp"
#include "motion/EnergyLedger.hpp"
#include <optional>

namespace masonry {

// Energies that the engines of a scene keep, without those of the joints [J].
struct EngineEnergies {
    double work = 0;             // of loads and prescribed motions
    double falls = 0;            // work of gravity
    double moving = 0;           // kinetic energy
    double drag = 0;             // taken by damping and impacts
    double inUnits = 0;          // elastic energy of deformable units
    double changes = 0;          // elastic energy that joints got when they were refined or became contacts
    double inConnectors = 0;     // elastic energy of ties, springs and testing machines
    double lostInConnectors = 0; // dissipated by them
    // Elastic energy of contacts, and what their friction and damping took. Only a balance has them, because the
    // elastic energy takes longer to find than the forces.
    Vector3r contacts = Vector3r::Zero();
};

struct EnergyBalance {
    EngineEnergies engines;
    Vector3r stored, lost; // in the joints, by mode: tension, shear, compression [J]
    double error;          // [J]
    double size;           // of the work done [J]
};

class EnergyAudit : public EnergyLedger, public GravityWork, public CollapseLimits {
public:
    // The attributes of the class that the host sees say the meaning and unit of each.
    bool watch = true;
    int collapsedBlock = -1;
    std::string collapse;
    bool warned = false;
    double reportedError = 0;
    bool begun = false;
    double largestError = 0;
    double largestMade = 0;
    double largestInput = 0;
    double largestWork = 0;
    Vector3r mostLost = Vector3r::Zero();

    void visitSnapshot(StateNumbers& n) { n(snapshot_); }

protected:
    // To be called in every step, behind the engines that load bodies and ahead of those that move them.
    void audit(SceneStore&);
    // The present balance with a relative error [-], which the largest errors take into account.
    EnergyBalance relativeBalance(const SceneStore&);
    // Counts the kinetic energy of the present motion as work done from outside.
    void countPresentMotion(SceneStore&);

private:
    EngineEnergies energiesOfEngines(const SceneStore&) const;
    EnergyBalance presentBalance(const SceneStore&) const;
    double comparedWith(const SceneStore&, double size); // the work [J] to which an error of the balance is relative
    void lookAtBalance(const SceneStore&);
    void warnOfBalance(const SceneStore&, double error);
    void watchOver(SceneStore&);
    void countBodies(const SceneStore&);
    std::optional<RunEnded> lookForCollapse(SceneStore&);
    // Throws `other`, or the collapse of a block if that is the reason.
    [[noreturn]] void endRun(SceneStore&, const RunEnded& other);

    // Energies of joints, connectors and contacts at the last look at the balance [J].
    struct Snapshot {
        int step = -1; // of that look; -1: there was none
        Vector3r stored = Vector3r::Zero(), lost = Vector3r::Zero();
        double drag = 0, changes = 0;
        Vector3r connectors = Vector3r::Zero(), contacts = Vector3r::Zero();

        template <class Visit> void visitState(Visit&& visit) {
            visit(step, stored, lost, drag, changes, connectors, contacts);
        }
    };
    Snapshot snapshot_;
    double checkedStep_ = 0;    // time step at the last check [s]
    long checkedRevision_ = -1; // SceneStore::revision() at the last check
};

} // namespace masonry
