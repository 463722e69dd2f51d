// SPDX-License-Identifier: GPL-2.0-or-later
#include "CriticalTimeStep.hpp"
#include "Dynamics.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include <algorithm>

namespace masonry {

namespace {

// The limit of a scene that is kept, and what it was found for.
struct KnownLimit {
    long revision = -1;
    double damping = 0, zoneDamping = 0, stiffnessDamping = 0, massScaling = 0;
    double connectors = 0; // sum of their stiffness, with that of testing machines
    double contacts = 0;   // bound of their eigenvalues [1/s²]
    double contactDamping = 0;
    double limit = 0; // [s]
    bool isForSame(const KnownLimit& o) const {
        return revision == o.revision && damping == o.damping && zoneDamping == o.zoneDamping &&
               stiffnessDamping == o.stiffnessDamping && massScaling == o.massScaling && connectors == o.connectors &&
               contacts == o.contacts && contactDamping == o.contactDamping;
    }
};

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
    double contacts = 0, contactDamping = 0;
    for (auto* one : store.contacts) {
        contacts += one->largestEigenvalue(store, anew);
        contactDamping = std::max(contactDamping, one->largestDampingRatio());
    }
    auto& known = store.kept<KnownLimit>();
    KnownLimit now{store.stiffnessRevision(),
                   store.damping(),
                   store.zones ? store.zones->damping : 0,
                   store.stiffnessDamping(),
                   store.zones ? store.zones->massScaling : 0,
                   stiffnessOfConnectors,
                   contacts,
                   contactDamping};
    if (!anew && now.isForSame(known)) return known.limit;
    const auto limit = [&](Dynamics::Damping damping) {
        // The sum of the largest eigenvalues of joints and of contacts is at least that of both.
        const double contacts = now.contacts * (1 + now.damping);
        return (std::sqrt(1 + now.contactDamping * now.contactDamping) - now.contactDamping) *
               stepOf(Dynamics(store, damping).highest() + contacts, now.stiffnessDamping);
    };
    // A bound that does not depend on which of the bodies are damped is enough if it is kept to.
    if (!anew) now.limit = limit(Dynamics::AsIfAllWereDamped);
    if (!(store.scene().dt <= now.limit)) now.limit = limit(Dynamics::Each);
    known = now;
    return known.limit;
}

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
    if (name.empty() && id2 == Connectors::ground)
        return what + "the connector of body " + std::to_string(id1) + " to the ground sets";
    if (name.empty())
        return what + "the connector of bodies " + std::to_string(id1) + " and " + std::to_string(id2) + " sets";
    return what + "joint \"" + name + "\" between bodies " + std::to_string(id1) + " and " + std::to_string(id2) +
           " sets";
}

} // namespace masonry
