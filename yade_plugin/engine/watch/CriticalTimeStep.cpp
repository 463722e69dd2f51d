// SPDX-License-Identifier: GPL-2.0-or-later
#include "CriticalTimeStep.hpp"
#include "Dynamics.hpp"
#include "engine/bodies/Integrator.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include <algorithm>

namespace masonry {

namespace {

// The largest eigenvalue without contacts of a scene that is kept, and what it was found for.
struct KnownEigenvalue {
    long revision = -1;
    double damping = 0, zoneDamping = 0, massScaling = 0;
    double inertia = 0;    // sum of its factors [-]
    double connectors = 0; // sum of their stiffness, with that of testing machines
    double value = 0;      // [1/s²]
    bool isForSame(const KnownEigenvalue& o) const {
        return revision == o.revision && damping == o.damping && zoneDamping == o.zoneDamping &&
               massScaling == o.massScaling && inertia == o.inertia && connectors == o.connectors;
    }
};

// The time step that follows the state changes if it can grow by so much or exceeds its share so far: smaller changes
// are not worth the energy that they cost in a contact. With the usual share of 0.8 it stays below 0.82 of its limit.
constexpr double growth = 1.1, excess = 1.02;

// The time step at which a motion of this eigenvalue is on the verge of being unstable [s].
double stepOf(double eigenvalue, double stiffnessDamping) {
    if (!(eigenvalue > 0)) return HUGE_VAL;
    const double dt = 2 / std::sqrt(eigenvalue);
    const double ratio = stiffnessDamping / dt; // of the damping of the highest mode to the critical one
    return dt * (std::sqrt(1 + ratio * ratio) - ratio);
}

} // namespace

double timeStepLimit(SceneStore& store, bool anew) {
    double stiffnessOfConnectors = 0;
    for (const auto* connectors : store.connectors)
        for (int c = 0; c < connectors->count(); ++c)
            stiffnessOfConnectors += connectors->stiffnessOf(c).sum() + connectors->rotationalStiffnessOf(c).sum();
    for (const auto* load : store.loads)
        stiffnessOfConnectors += load->machineStiffness().sum();
    double inertia = 0;
    for (int b = 0; store.integrator && b < int(store.integrator->inertiaFactors.size()); ++b)
        inertia += store.integrator->inertiaFactors[b];
    auto& known = store.kept<KnownEigenvalue>();
    KnownEigenvalue now{store.stiffnessRevision(),
                        store.damping(),
                        store.zones ? store.zones->damping : 0,
                        store.zones ? store.zones->massScaling : 0,
                        inertia,
                        stiffnessOfConnectors};
    const auto limit = [&] {
        double all = now.value;
        for (auto* one : store.contacts)
            all = one->largestEigenvalue(store, all, now.damping, anew);
        return stepOf(all, store.stiffnessDamping());
    };
    if (!anew && now.isForSame(known)) {
        now = known;
        return limit();
    }
    // A bound that does not depend on which of the bodies are damped is enough if it is kept to.
    if (!anew) now.value = Dynamics(store, Dynamics::AsIfAllWereDamped).highest();
    if (anew || !(store.scene().dt <= limit())) now.value = Dynamics(store, Dynamics::Each).highest();
    known = now;
    return limit();
}

static void changeTimeStep(SceneStore& store, double dt) {
    if (!(dt < HUGE_VAL)) return; // no joint and no pair has stiffness yet
    if (store.integrator) store.integrator->stepChange = dt - store.scene().dt;
    store.scene().dt = dt;
}

void beginFollowing(SceneStore& store) {
    for (int b = 0; b < store.bodies.size(); ++b)
        if (store.bodies.has(b)) store.bodies.detectAnyChange(b);
    for (auto* one : store.contacts)
        one->boundPairs(store, store.damping(), true);
    const double limit = timeStepLimit(store, true);
    for (auto* one : store.contacts) {
        one->jointEigenvalue = store.kept<KnownEigenvalue>().value;
        if (one->stepShare > 0) changeTimeStep(store, one->stepShare * limit);
    }
}

// The step that found new pairs was not too long: they press as their joint did, or not yet.
void followTimeStep(SceneStore& store) {
    for (auto* one : store.contacts) {
        if (!(one->stepShare > 0)) continue;
        one->boundPairs(store, store.damping());
        const double all = one->largestEigenvalue(store, one->jointEigenvalue, store.damping(), false);
        const double wanted = one->stepShare * stepOf(all, store.stiffnessDamping());
        const double dt = store.scene().dt;
        if (dt > excess * wanted || growth * dt < wanted) changeTimeStep(store, wanted);
    }
}

std::map<int, double> eigenvaluesOfBodies(SceneStore& store) { return Dynamics(store, Dynamics::Each).highestAlone(); }

std::pair<int, int> limitingBodies(SceneStore& store) { return Dynamics(store, Dynamics::Each).stiffest(); }

std::string describedLimit(SceneStore& store) {
    std::string what = "the time step is " + text(store.scene().dt) + " s";
    double limit = HUGE_VAL;
    int id1 = -1, id2 = -1;
    try {
        limit = timeStepLimit(store, true);
        std::tie(id1, id2) = limitingBodies(store);
    } catch (const std::invalid_argument&) { // of bodies whose numbers are not finite nothing is known any more
        limit = timeStepLimit(store, false);
    }
    if (!std::isfinite(limit)) return what;
    what += ", its limit " + text(limit) + " s";
    if (id1 < 0) return what;
    what += ", which ";
    if (id1 == id2) return what + "unit " + std::to_string(id1) + " sets";
    std::string name;
    for (const auto& joint : store.joints)
        if (joint.interaction->id1 == id1 && joint.interaction->id2 == id2) name = joint.phys->propertySet()->name;
    const auto isMachine = [&](const Load* load) { return load->body == id1 && !load->machineStiffness().isZero(0); };
    if (id2 == Connectors::ground)
        return what + "the " +
               (std::any_of(store.loads.begin(), store.loads.end(), isMachine) ? "testing machine at body "
                                                                               : "connector to the ground of body ") +
               std::to_string(id1) + " sets";
    if (name.empty())
        return what + "the connector of bodies " + std::to_string(id1) + " and " + std::to_string(id2) + " sets";
    return what + "joint \"" + name + "\" between bodies " + std::to_string(id1) + " and " + std::to_string(id2) +
           " sets";
}

} // namespace masonry
