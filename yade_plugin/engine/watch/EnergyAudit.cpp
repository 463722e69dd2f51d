// SPDX-License-Identifier: GPL-2.0-or-later
#include "EnergyAudit.hpp"
#include "CriticalTimeStep.hpp"
#include "common/Text.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/bodies/BodyStep.hpp"
#include "engine/bodies/Integrator.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include <iostream>

namespace masonry {

using yade::State;

// ---- the balance ------------------------------------------------------------------------------------------------

namespace {

double dragOfJoints(const SceneStore& store) {
    return store.loop ? store.loop->dampingWork + store.loop->impactWork : 0;
}

double energyOfChanges(const SceneStore& store) {
    double all = store.loop ? store.loop->refiningEnergy : 0;
    for (const auto* contacts : store.allContacts)
        all += contacts->conversionEnergy;
    return all;
}

// Work from outside, energy stored and energy dissipated in ties, springs and testing machines [J]. The work of a load
// is without what its machine has taken up, which came from outside, too.
Vector3r energiesOfConnectors(const SceneStore& store) {
    Vector3r sums = Vector3r::Zero();
    for (const auto* connectors : store.allConnectors)
        sums += Vector3r(connectors->given, connectors->stored, connectors->dissipated);
    for (const auto* load : store.allLoads)
        sums += Vector3r(load->stored + load->dissipated, load->stored, load->dissipated);
    return sums;
}

// Elastic energy of contacts, and energies lost in their friction and damping [J].
Vector3r energiesOfContacts(const SceneStore& store) {
    Vector3r sums = Vector3r::Zero();
    for (auto* contacts : store.allContacts)
        sums += Vector3r(contacts->elastic(store), contacts->lostInFriction, contacts->lostInDamping);
    return sums;
}

EnergyBalance balanceOf(const EngineEnergies& e, const Vector3r& stored, const Vector3r& lost) {
    const double in = e.work + e.falls + e.changes;
    const double out = e.moving + e.drag + e.inUnits + stored[0] + stored[1] + stored[2] + lost.sum() + e.inConnectors +
                       e.lostInConnectors + e.contacts.sum();
    const double size = std::max(std::abs(e.work) + std::abs(e.falls), std::abs(out));
    return {e, stored, lost, in - out, size};
}

} // namespace

EngineEnergies EnergyAudit::energiesOfEngines(const SceneStore& store) const {
    const Vector3r connectors = energiesOfConnectors(store);
    EngineEnergies all{external + connectors[0], fallen,        kinetic,      damped, 0,
                       energyOfChanges(store),   connectors[1], connectors[2]};
    for (const auto* contacts : store.allContacts)
        all.work += contacts->given;
    for (const auto* load : store.allLoads)
        all.work += load->work;
    all.drag += dragOfJoints(store);
    for (const EnergyLedger* other :
         {static_cast<const EnergyLedger*>(store.integrator), static_cast<const EnergyLedger*>(store.zones)}) {
        if (!other) continue;
        all.work += other->external;
        all.falls += other->fallen;
        all.moving += other->kinetic;
        all.drag += other->damped;
        all.inUnits += other->elastic;
    }
    return all;
}

EnergyBalance EnergyAudit::presentBalance(const SceneStore& store) const {
    Vector3r stored = Vector3r::Zero(), lost = Vector3r::Zero();
    for (const auto& kind : store.kinds) {
        const auto sums = kind.states->columns->energies(kind.shapes->area.data(), kind.shapes->alike);
        stored += Vector3r(sums.stored.tension, sums.stored.shear, sums.stored.compression);
        lost += Vector3r(sums.dissipated.tension, sums.dissipated.shear, sums.dissipated.compression);
    }
    auto all = energiesOfEngines(store);
    all.contacts = energiesOfContacts(store);
    return balanceOf(all, stored, lost);
}

// Where next to no work was done, the error is round-off, and its ratio to that work says nothing. So the work counts
// as no less than the largest until now, nor than that of the scene's weight over a nanometre.
double EnergyAudit::comparedWith(const SceneStore& store, double size) {
    double mass = 0;
    for (const auto& body : store.scene().bodies->body)
        if (body && body->state) mass += body->state->mass;
    largestWork = std::max({largestWork, size, 9.81e-9 * mass});
    return largestWork > 0 ? largestWork : 1;
}

// Dissipated energies should never fall. They can: where a joint opens or closes within a step, the trapezoidal rule
// takes the mean of the tractions before and after, and the error is counted as dissipated, also where it is negative.
// A long undamped series of such steps makes energy. Damping or shorter steps prevent that.
EnergyBalance EnergyAudit::relativeBalance(const SceneStore& store) {
    auto balance = presentBalance(store);
    mostLost = mostLost.cwiseMax(balance.lost);
    const double compared = comparedWith(store, balance.size);
    largestError = std::max(largestError, std::abs(balance.error) / compared);
    largestMade = std::max(largestMade, (mostLost - balance.lost).sum() / compared);
    balance.error /= compared;
    return balance;
}

// In a step this engine finds the joints of the step, but the ledger of the step before. So it keeps the energies of
// the joints in every thousandth step, and compares them in the next one with the ledger, which then belongs to the
// same instant. This costs less than a step.
void EnergyAudit::lookAtBalance(const SceneStore& store) {
    const auto& scene = store.scene();
    auto& then = snapshot_;
    if (then.step >= 0 && scene.iter == then.step + 1) {
        auto all = energiesOfEngines(store);
        all.drag += then.drag - dragOfJoints(store);
        all.work += then.connectors[0] - energiesOfConnectors(store)[0];
        all.inConnectors = then.connectors[1];
        all.lostInConnectors = then.connectors[2];
        all.contacts = then.contacts;
        all.changes = then.changes; // joints are refined after the snapshot was taken
        const auto balance = balanceOf(all, then.stored, then.lost);
        warnOfBalance(store, std::abs(balance.error) / comparedWith(store, balance.size));
    }
    if (scene.iter % 1000 != 0 || scene.iter == 0) return;
    const auto now = presentBalance(store);
    then = {int(scene.iter),
            now.stored,
            now.lost,
            dragOfJoints(store),
            energyOfChanges(store),
            energiesOfConnectors(store),
            energiesOfContacts(store)};
}

void EnergyAudit::warnOfBalance(const SceneStore& store, double error) {
    if (!(error > 0.01 && error > 2 * reportedError)) return;
    reportedError = error;
    if (!store.uncounted.empty()) {
        if (!warned)
            std::cerr
                << "warning: the work of " + store.uncounted +
                       " is not counted, so the energy balance is off by it, and motion out of nothing ends no run; "
                       "ahead of " +
                       nameOf(ClassRole::Joints) + " its work is counted\n"
                << std::flush;
        warned = true;
        return;
    }
    warned = true;
    std::cerr << "warning: at step " + std::to_string(snapshot_.step) + " the energy balance is off by " +
                     text(std::round(1000 * error) / 10) +
                     " % of the work done: a smaller time step, slower loading or more damping helps; what a script "
                     "does between steps to places, velocities and forces is not counted (this is reported again if "
                     "it becomes twice as large, see " +
                     nameOf(ClassRole::Watch) + ".balance())\n"
              << std::flush;
}

// ---- the watch --------------------------------------------------------------------------------------------------

namespace {

std::string firstNotFinite(const yade::Scene& scene) {
    for (const auto& body : scene.bodies->body)
        if (body && body->state && !(body->state->pos + body->state->vel + body->state->angVel).allFinite())
            return "of body " + std::to_string(body->id);
    return "of the joints";
}

} // namespace

// Looks every tenth step, and when the time step or the joints have changed. Let r be the time step over its limit. The
// kinetic energy m v-·v+ / 2 of a stable elastic motion is at most the work done, and at least minus 1/(1 - r²) times
// it. Even for r = 0.995 that factor is 100, so a larger kinetic energy means that the run is unstable.
void EnergyAudit::watchOver(SceneStore& store) {
    const auto& scene = store.scene();
    const bool tenth = scene.iter % 10 == 0;
    if (!tenth && scene.dt == checkedStep_ && store.revision() == checkedRevision_) return;
    checkedStep_ = scene.dt;
    checkedRevision_ = store.revision();
    for (bool anew : {false, true}) { // the limit is found anew before a run is stopped: masses may have changed
        if (scene.dt <= timeStepLimit(store, anew)) break;
        if (anew) throw RunEnded("unstable", "unstable: " + describedLimit(store));
    }
    if (!tenth) return;
    // The step is finished first, so that the energies belong to one instant.
    if (scene.iter % collapseEvery == 0) store.endsWith = lookForCollapse(store);
    const auto all = energiesOfEngines(store);
    const double motion = std::abs(all.moving);
    if (!std::isfinite(motion))
        endRun(store, {"not finite", "numbers " + firstNotFinite(scene) + " are not finite at step " +
                                         std::to_string(scene.iter) + "; " + describedLimit(store)});
    largestInput = std::max(largestInput, std::abs(all.work + all.falls));
    if (motion > 100 * largestInput + 1e-12 && store.uncounted.empty())
        endRun(store, {"unstable", "unstable: motion out of nothing at step " + std::to_string(scene.iter) + ", " +
                                       text(motion) + " J where " + text(largestInput) + " J of work were done; " +
                                       describedLimit(store) + ". Velocities set by hand must be reported at once by " +
                                       nameOf(ClassRole::Watch) + ".given()"});
}

std::optional<RunEnded> EnergyAudit::lookForCollapse(SceneStore& store) {
    const auto found = findCollapse(store, *this);
    collapsedBlock = found.block;
    collapse = found.what;
    return found.ended();
}

void EnergyAudit::endRun(SceneStore& store, const RunEnded& other) {
    const auto collapsed = lookForCollapse(store);
    if (!collapsed) throw other;
    const bool tells = std::string(other.code) == "unstable";
    throw RunEnded(collapsed->code, collapsed->what() + (tells ? std::string(". Besides, ") + other.what() : ""),
                   collapsed->block);
}

// ---- a step -----------------------------------------------------------------------------------------------------

namespace {

// Kinetic energy of all axes and nodes that are not blocked [J].
double motionOf(SceneStore& store) {
    double twice = 0;
    auto* zones = store.zones;
    for (const auto& body : store.scene().bodies->body) {
        if (!body || !body->state || (zones && zones->unitOf(body->id))) continue;
        const State& s = *body->state;
        const Vector3r spin = rotationRestrained(s) ? s.angVel : Vector3r(s.ori.conjugate() * s.angVel);
        const double factor = store.inertiaFactor(int(body->id));
        for (int i = 0; i < 3; ++i) {
            if (!isBlocked(s, i)) twice += factor * s.mass * s.vel[i] * s.vel[i];
            if (!isBlocked(s, 3 + i)) twice += factor * s.inertia[i] * spin[i] * spin[i];
        }
    }
    if (!zones) return 0.5 * twice;
    if (zones->massScaling > 0) return 0.5 * twice + zones->kineticEnergy(zones->massScaling);
    for (const auto& unit : zones->units()) {
        const auto& masses = unit.elasticity->masses();
        for (std::size_t n = 0; n < masses.size(); ++n)
            for (int d = 0; d < 3; ++d)
                if (!zones->holds(d)) twice += masses[n] * std::pow(zones->velocityOf(unit.firstNode + int(n))[d], 2);
    }
    return 0.5 * twice;
}

} // namespace

void EnergyAudit::countPresentMotion(SceneStore& store) {
    external += motionOf(store) - energiesOfEngines(store).moving;
    begun = true;
}

void EnergyAudit::audit(SceneStore& store) {
    if (!begun) countPresentMotion(store);
    if (watch) {
        lookAtBalance(store);
        watchOver(store);
    }
    if (!store.integrator) countBodies(store); // our integrator counts the energies of rigid bodies itself
}

void EnergyAudit::countBodies(const SceneStore& store) {
    auto& scene = store.scene();
    const Vector3r gravity = store.gravity();
    const double damping = store.damping();
    auto& forces = scene.forces();
    forces.sync();
    const double before = fallen;
    Vector3r moment = Vector3r::Zero();
    beginStep();
    for (const auto& body : scene.bodies->body) {
        if (!body || !body->state || (store.zones && store.zones->unitOf(body->id))) continue; // counted by Zones
        const State& s = *body->state;
        fallen += s.mass * gravity.dot(s.pos - s.refPos);
        moment += s.mass * (s.pos - s.refPos);
        if (!isFreeOrMoves(s)) continue;
        const BodyForces on{forces.getForce(body->id), forces.getTorque(body->id)};
        add(stepOf(s, on, gravity, scene.dt, damping).energies);
    }
    fallen = workOfGravity(fallen, gravity, moment, before);
    const auto now = [&](int body) -> const State& { return *bodyAt(scene, body, ".body", ClassRole::Load).state; };
    const auto then = [&](int body) {
        const BodyForces on{forces.getForce(body), forces.getTorque(body)};
        return stepOf(now(body), on, gravity, scene.dt, damping);
    };
    external += halfWork(store.foreignForces, scene.dt, now);
    pendingExternal += halfWork(store.foreignForces, scene.dt, then);
    for (auto* load : store.loads) {
        load->workBefore(scene.dt, now);
        load->workAfter(scene.dt, then);
    }
}

} // namespace masonry
