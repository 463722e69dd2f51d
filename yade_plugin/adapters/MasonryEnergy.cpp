// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryEnergy.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include "engine/bodies/BodyStep.hpp"
#include "engine/bodies/Integrator.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/units/Zones.hpp"
#include "engine/watch/CriticalTimeStep.hpp"
#include "engine/watch/EngineScope.hpp"
#include <iostream>

template class masonry::Adapter<masonry::MasonryEnergy, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryEnergy)

namespace masonry {

using yade::State;

namespace {

// Elastic energy [J] that joints got so far when they were refined and when they were handed over.
double givenByChanges(const SceneStore& store) {
    double all = store.loop ? store.loop->refiningEnergy : 0;
    for (const auto* contacts : store.allContacts)
        all += contacts->conversionEnergy;
    return all;
}

// Work of tightening, energy stored and energy dissipated in the ties and springs [J].
Vector3r energiesOfConnectors(const SceneStore& store) {
    Vector3r sums = Vector3r::Zero();
    for (const auto* connectors : store.allConnectors)
        sums += Vector3r(connectors->given, connectors->stored, connectors->dissipated);
    return sums;
}

// Elastic energy of contacts, and energies lost in their friction and damping [J].
Vector3r energiesOfContacts(const SceneStore& store) {
    Vector3r sums = Vector3r::Zero();
    for (auto* contacts : store.allContacts)
        sums += Vector3r(contacts->elastic(store), contacts->lostInFriction, contacts->lostInDamping);
    return sums;
}

} // namespace

MasonryEnergy::Inventory MasonryEnergy::inventory(const SceneStore& store) const {
    const Vector3r connectors = energiesOfConnectors(store);
    Inventory all{external + connectors[0], fallen, kinetic, damped, 0, 0, connectors[1], connectors[2],
                  Vector3r::Zero()};
    all.given = givenByChanges(store);
    for (const auto* contacts : store.allContacts)
        all.work += contacts->given;
    for (const auto* load : store.allLoads)
        all.work += load->work;
    if (store.loop) all.drag += store.loop->dampingWork + store.loop->impactWork;
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
void MasonryEnergy::watchOver(SceneStore& store) {
    const bool tenth = scene->iter % 10 == 0;
    if (!tenth && scene->dt == checkedStep_ && store.revision() == checkedRevision_) return;
    checkedStep_ = scene->dt;
    checkedRevision_ = store.revision();
    for (bool anew : {false, true}) { // the limit is found anew before a run is stopped: masses may have changed
        if (scene->dt <= timeStepLimit(store, anew)) break;
        if (anew) throw std::runtime_error("unstable: " + masonry::describedLimit(store));
    }
    if (!tenth) return;
    // The step is finished first, so that the energies belong to one instant.
    if (scene->iter % collapseEvery == 0) store.endsWith = findCollapse(store);
    const auto all = inventory(store);
    const double motion = std::abs(all.moving);
    if (!std::isfinite(motion)) {
        stopIfCollapsed(store);
        throw std::runtime_error("numbers " + firstNotFinite(*scene) + " are not finite at step " +
                                 std::to_string(scene->iter) + "; " + masonry::describedLimit(store));
    }
    largestInput = std::max(largestInput, std::abs(all.work + all.falls));
    if (motion > 100 * largestInput + 1e-12 && store.uncounted.empty()) {
        const auto what = "unstable: motion out of nothing at step " + std::to_string(scene->iter) + ", " +
                          text(motion) + " J where " + text(largestInput) + " J of work were done; " +
                          masonry::describedLimit(store) +
                          ". Velocities set by hand must be reported at once by MasonryEnergy.given()";
        stopIfCollapsed(store, what);
        throw std::runtime_error(what);
    }
}

std::string MasonryEnergy::findCollapse(SceneStore& store) {
    const auto found = masonry::findCollapse(store, {turnLimit, slideLimit, closureLimit, openingLimit});
    collapsedBlock = found.block;
    collapse = found.what;
    return found.block < 0 ? "" : "collapsed: " + found.what;
}

void MasonryEnergy::stopIfCollapsed(SceneStore& store, const std::string& besides) {
    const auto found = findCollapse(store);
    if (!found.empty()) throw std::runtime_error(found + (besides.empty() ? "" : ". Besides, " + besides));
}

// In a step this engine finds the joints of the step, but the ledger of the step before. So it keeps the energies of
// the joints in every thousandth step, and compares them in the next one with the ledger, which then belongs to the
// same instant. This costs less than a step.
void MasonryEnergy::lookAtBalance(const SceneStore& store) {
    const double damping = store.loop ? store.loop->dampingWork + store.loop->impactWork : 0;
    if (stepThen >= 0 && scene->iter == stepThen + 1) {
        auto all = inventory(store);
        all.drag += dampingThen - damping;
        const Vector3r connectors = energiesOfConnectors(store);
        all.work += connectorsThen[0] - connectors[0];
        all.inConnectors = connectorsThen[1];
        all.lostInConnectors = connectorsThen[2];
        all.inContacts = contactsThen;
        all.given = givenThen; // joints are refined after they were looked at
        const auto then = balanceOf(all, storedThen, lostThen);
        warnOfBalance(store, std::abs(then.error) / comparedWith(then.size));
    }
    if (scene->iter % 1000 != 0 || scene->iter == 0) return;
    const auto now = presentBalance(store);
    storedThen = now.stored;
    lostThen = now.lost;
    dampingThen = damping;
    givenThen = givenByChanges(store);
    connectorsThen = energiesOfConnectors(store);
    contactsThen = energiesOfContacts(store);
    stepThen = int(scene->iter);
}

void MasonryEnergy::warnOfBalance(const SceneStore& store, double error) {
    if (!(error > 0.01 && error > 2 * reportedError)) return;
    reportedError = error;
    if (!store.uncounted.empty()) {
        if (!warned)
            std::cerr
                << "warning: the work of " + store.uncounted +
                       " is not counted, so the energy balance is off by it, and motion out of nothing ends no run; "
                       "ahead of MasonryJointLoop its work is counted\n"
                << std::flush;
        warned = true;
        return;
    }
    warned = true;
    std::cerr << "warning: at step " + std::to_string(stepThen) + " the energy balance is off by " +
                     text(std::round(1000 * error) / 10) +
                     " % of the work done: a smaller time step, slower loading or more damping helps; what a script "
                     "does between steps to places, velocities and forces is not counted (this is reported again if "
                     "it becomes twice as large, see MasonryEnergy.balance())\n"
              << std::flush;
}

namespace {

// Kinetic energy of all axes and nodes that are not blocked [J].
double motionOf(SceneStore& store) {
    double twice = 0;
    auto* zones = store.zones;
    for (const auto& body : store.scene().bodies->body) {
        if (!body || !body->state || (zones && zones->unitOf(body->id))) continue;
        const State& s = *body->state;
        const Vector3r spin = rotationRestrained(s) ? s.angVel : Vector3r(s.ori.conjugate() * s.angVel);
        for (int i = 0; i < 3; ++i) {
            if (!isBlocked(s, i)) twice += s.mass * s.vel[i] * s.vel[i];
            if (!isBlocked(s, 3 + i)) twice += s.inertia[i] * spin[i] * spin[i];
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

void MasonryEnergy::countPresentMotion(SceneStore& store) {
    external += motionOf(store) - inventory(store).moving;
    begun = true;
}

void MasonryEnergy::given() {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update();
    countPresentMotion(store);
}

void MasonryEnergy::action() {
    const EngineScope turn(*scene, *this);
    if (!begun) countPresentMotion(turn.store());
    if (watch) {
        lookAtBalance(turn.store());
        watchOver(turn.store());
    }
    if (!turn->integrator) countBodies(turn); // MasonryIntegrator counts the energies of rigid bodies itself
    turn.end();
}

void MasonryEnergy::countBodies(const EngineScope& turn) {
    const Vector3r gravity = turn->gravity();
    const double damping = turn->damping();
    auto& forces = scene->forces();
    forces.sync();
    const double before = fallen;
    Vector3r moment = Vector3r::Zero();
    beginStep();
    for (const auto& body : scene->bodies->body) {
        if (!body || !body->state || (turn->zones && turn->zones->unitOf(body->id))) continue; // MasonryZones does
        const State& s = *body->state;
        fallen += s.mass * gravity.dot(s.pos - s.refPos);
        moment += s.mass * (s.pos - s.refPos);
        if (!isFreeOrMoves(s)) continue;
        const BodyForces on{forces.getForce(body->id), forces.getTorque(body->id)};
        add(stepOf(s, on, gravity, scene->dt, damping).energies);
    }
    fallen = workOfGravity(fallen, gravity, moment, before);
    for (auto* load : turn->loads) {
        const auto before = [&](int body) -> const State& { return *bodyAt(*scene, body, "MasonryLoad.body").state; };
        const auto after = [&](int body) {
            const BodyForces on{forces.getForce(body), forces.getTorque(body)};
            return stepOf(before(body), on, gravity, scene->dt, damping);
        };
        load->workBefore(scene->dt, before);
        load->workAfter(scene->dt, after);
    }
}

MasonryEnergy::Balance MasonryEnergy::presentBalance(const SceneStore& store) const {
    Vector3r stored = Vector3r::Zero(), lost = Vector3r::Zero();
    for (const auto& kind : store.kinds) {
        const auto sums = kind.states->columns->energies(kind.shapes->area.data(), kind.shapes->alike);
        stored += Vector3r(sums.stored.tension, sums.stored.shear, sums.stored.compression);
        lost += Vector3r(sums.dissipated.tension, sums.dissipated.shear, sums.dissipated.compression);
    }
    auto all = inventory(store);
    all.inContacts = energiesOfContacts(store);
    return balanceOf(all, stored, lost);
}

MasonryEnergy::Balance MasonryEnergy::balanceOf(const Inventory& all, const Vector3r& stored, const Vector3r& lost) {
    const auto [work, falls, moving, drag, inUnits, given, inConnectors, lostInConnectors, inContacts] = all;
    const double in = work + falls + given;
    const double out = moving + drag + inUnits + stored[0] + stored[1] + stored[2] + lost.sum() + inConnectors +
                       lostInConnectors + inContacts.sum();
    const double size = std::max(std::abs(work) + std::abs(falls), std::abs(out));
    return {all, stored, lost, in - out, size};
}

// Where next to no work was done, the error is round-off, and its ratio to that work says nothing. So the work counts
// as no less than the largest until now, nor than that of the scene's weight over a nanometre.
double MasonryEnergy::comparedWith(double size) {
    double mass = 0;
    for (const auto& body : scene->bodies->body)
        if (body && body->state) mass += body->state->mass;
    largestWork = std::max({largestWork, size, 9.81e-9 * mass});
    return largestWork > 0 ? largestWork : 1;
}

py::dict MasonryEnergy::balance() {
    const BetweenSteps still;
    auto& store = SceneStore::present();
    store.update(SceneStore::ScanScope::Joints); // a full look would take too long: every row of curve.csv calls this
    const auto [inventory, stored, lost, error, size] = presentBalance(store);
    const auto [work, falls, moving, drag, inUnits, given, inConnectors, lostInConnectors, inContacts] = inventory;
    // Dissipated energies should never fall. They can: where a joint opens or closes within a step, the trapezoidal
    // rule takes the mean of the tractions before and after, and the error is counted as dissipated, also where it is
    // negative. A long undamped series of such steps makes energy. Damping or shorter steps prevent that.
    mostLost = mostLost.cwiseMax(lost);
    const double compared = comparedWith(size);
    largestError = std::max(largestError, std::abs(error) / compared);
    largestMade = std::max(largestMade, (mostLost - lost).sum() / compared);
    py::dict all;
    all["external"] = work;
    all["gravity"] = falls;
    all["refining"] = store.loop ? store.loop->refiningEnergy : 0;
    double handing = 0;
    for (const auto* contacts : store.allContacts)
        handing += contacts->conversionEnergy;
    all["kinetic"] = moving;
    const double impacts = store.loop ? store.loop->impactWork : 0;
    all["damping"] = drag - impacts;
    all["impacts"] = impacts;
    all["elastic_units"] = inUnits;
    all["elastic_tension"] = stored[0];
    all["elastic_shear"] = stored[1];
    all["elastic_compression"] = stored[2];
    all["dissipated_tension"] = lost[0];
    all["dissipated_shear"] = lost[1];
    all["dissipated_compression"] = lost[2];
    if (!store.allConnectors.empty()) {
        all["elastic_connectors"] = inConnectors;
        all["dissipated_connectors"] = lostInConnectors;
    }
    if (!store.allContacts.empty()) {
        all["handing"] = handing;
        all["elastic_contacts"] = inContacts[0];
        all["friction_contacts"] = inContacts[1];
        all["damping_contacts"] = inContacts[2];
    }
    all["error"] = error / compared;
    return all;
}

} // namespace masonry
