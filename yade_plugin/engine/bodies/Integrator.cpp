// SPDX-License-Identifier: GPL-2.0-or-later
#include "Integrator.hpp"
#include "BodyCheck.hpp"
#include "BodyStep.hpp"
#include "Load.hpp"
#include "common/Parallel.hpp"
#include "common/Text.hpp"
#include <cmath>
#include <cstdint>

namespace masonry {

std::vector<std::string> Integrator::problems() const {
    std::vector<std::string> found;
    if (!combined() && dampingKind != "local")
        found.push_back("dampingKind '" + dampingKind + "' must be 'combined' or 'local'");
    for (double factor : inertiaFactors)
        if (!(factor >= 1 && factor < HUGE_VAL)) {
            found.push_back("inertiaFactors has " + text(factor) + ", must be a finite number of at least 1");
            break;
        }
    return found;
}

std::vector<Vector3r> Integrator::lastForces() {
    std::vector<Vector3r> all;
    for (std::size_t b = 0; b < last_[0].size(); ++b) {
        all.emplace_back(last_[0][b], last_[1][b], last_[2][b]);
        all.emplace_back(last_[3][b], last_[4][b], last_[5][b]);
    }
    return all;
}

void Integrator::setLastForces(const std::vector<Vector3r>& all) {
    for (int d = 0; d < 6; ++d) {
        last_[d].assign(all.size() / 2, 0);
        for (std::size_t b = 0; b < all.size() / 2; ++b)
            last_[d][b] = all[2 * b + d / 3][d % 3];
    }
}

void Integrator::advance(yade::Scene& scene, BodyColumns& bodies, const std::vector<Load*>& loads,
                         const std::vector<ForeignForce>& foreign) {
    const int count = bodies.size();
    if (std::size_t(count) < last_[0].size())
        throw std::invalid_argument(nameOf(ClassRole::Integrator) + " remembers forces of " +
                                    std::to_string(last_[0].size()) + " bodies, the scene has " +
                                    std::to_string(count));
    followInertia(bodies);
    const auto on = scene.forces().sums(count);
    combines_ = combined();
    for (auto& column : last_)
        if (combined()) column.resize(count, 0);
    const auto motionOf = [&](int body) -> const auto& { return bodies.state(body); };
    for (auto* load : loads) { // a script may have changed its body since the load acted
        load->eachBody([&](int body) { bodyAt(scene, body, ".body", ClassRole::Load); });
        load->workBefore(scene.dt, motionOf);
    }
    const double foreignWork = halfWork(foreign, scene.dt, motionOf);
    // The pieces over which energies are summed up do not depend on the number of threads, so neither do the sums.
    constexpr int piece = RigidMotion::most;
    const int pieces = (count + piece - 1) / piece;
    std::vector<Sums> found(pieces);
    Parallel::instance().overPieces(pieces, 1, [&](int first, int beyond) {
        for (int n = first; n < beyond; ++n)
            found[n] = advancePiece(scene, bodies, on.forces, on.torques, n * piece, std::min(count, (n + 1) * piece));
    });
    const double before = fallen;
    Vector3r moment = Vector3r::Zero();
    beginStep();
    for (const auto& sum : found) {
        add(sum.energies);
        moment += sum.moment;
    }
    fallen = workOfGravity(fallen, gravity, moment, before);
    external += foreignWork;
    pendingExternal += halfWork(foreign, scene.dt, motionOf);
    for (auto* load : loads)
        load->workAfter(scene.dt, motionOf);
    if (!shaking.samples.empty()) ++shaking.steps;
    stepChange = 0;
}

// Velocities stay, and the change of the kinetic energy counts as external work.
void Integrator::followInertia(BodyColumns& bodies) {
    bodies.scaleInertia(inertiaFactors);
    if (inertiaFactors == factorsBefore) return;
    for (int b = 0; b < bodies.size(); ++b) {
        const double before = factorOf(factorsBefore, b), change = inertiaFactor(b) - before;
        if (change == 0 || !bodies.has(b) || bodies.isUnit[b]) continue;
        auto& s = bodies.state(b);
        s.angMom *= 1 + change / before;
        const Vector3r spin = bodies.spins(b) ? Vector3r(s.ori.conjugate() * s.angVel) : s.angVel;
        for (int d = 0; falling && d < 3; ++d) {
            if (!bodies.isBlocked(b, d)) external += 0.5 * change * s.mass * s.vel[d] * s.vel[d];
            if (!bodies.isBlocked(b, 3 + d)) external += 0.5 * change * s.inertia[d] * spin[d] * spin[d];
        }
    }
    factorsBefore = inertiaFactors;
}

// The power of forces and weight on a body along its blocked axes with its present velocity, less that with the
// velocity of its last step [W]. The work of a step is done half with the forces before it and half with those after
// it, both times with its own velocity, which a script may have changed since.
double Integrator::gainedPower(const BodyColumns& bodies, int b, const Vector3r& force, const Vector3r& torque) const {
    const auto& before = *bodies.earlier(b);
    const Vector3r on[] = {force + bodies.weighed[b] * gravity, torque};
    double power = 0;
    for (int d = 0; d < 6; ++d) {
        const double now = bodies.isBlocked(b, d) ? bodies.velocity[d][b] : 0;
        power += on[d / 3][d % 3] * (now - (before.blocked >> d & 1 ? before.velocity[d] : 0));
    }
    return power;
}

Integrator::Sums Integrator::advancePiece(const yade::Scene& scene, BodyColumns& bodies, const Vector3r* forces,
                                          const Vector3r* torques, int first, int beyond) {
    constexpr int ahead = 8;
    const int count = beyond - first;
    const bool thoroughly = scene.iter % 10 == 0;
    Sums all;
    auto& sum = all.energies;
    RigidMotion motion;
    unsigned axes = 0;
    bool turning = false; // whether one of the bodies turns in space
    double earlier = 0;   // half of: the work of the last step less what it would be with present velocities [J]
    std::uint32_t blocked[RigidMotion::most]; // State.blockedDOFs of a body that RigidMotion moves, else all six
    for (int i = 0; i < count; ++i) {
        const int b = first + i;
        blocked[i] = 63;
        motion.alpha[i] = motion.viscous[i] = 0;
        if (i + ahead < count && bodies.has(b + ahead)) bodies.prefetch(b + ahead);
        if (!bodies.has(b) || bodies.isUnit[b]) continue;
        thoroughly ? bodies.detectAnyChange(b) : bodies.detectChange(b);
        if (bodies.earlier(b)) {
            earlier += 0.5 * scene.dt * gainedPower(bodies, b, forces[b], torques[b]);
            bodies.forgetEarlier(b);
        }
        axes |= bodies.spins(b) ? 7 : bodies.axes(b);
        blocked[i] = bodies.blockedAxes(b);
        motion.alpha[i] = bodies.isDamped(b) ? damping : 0;
        motion.viscous[i] = bodies.isDamped(b) ? massDamping : 0;
        motion.inSpace[i] = bodies.spins(b) ? 1 : 0;
        turning = turning || bodies.spins(b);
    }
    for (int i = 0; turning && i < count; ++i)
        for (int d = 0; d < 3; ++d) {
            const bool mine = motion.inSpace[i] != 0;
            motion.torque[d][i] = mine ? torques[first + i][d] : 0;
            motion.momentum[d][i] = mine ? bodies.state(first + i).angMom[d] : 0;
        }
    findWeights(bodies, first, count, all);
    if (axes != 0) {
        const RigidMotion::Around around{scene.dt, {gravity[0], gravity[1], gravity[2]}, combines_};
        double unused[RigidMotion::most]; // local damping does not use earlier forces
        if (!combines_) std::fill_n(unused, count, 0.0);
        double* last[6];
        for (int d = 0; d < 6; ++d) {
            last[d] = combines_ ? &last_[d][first] : unused;
            if (!(axes >> d & 1)) continue;
            const double* on = (d < 3 ? forces : torques)[first].data() + d % 3;
            for (int i = 0; i < count; ++i) {
                motion.force[d][i] = on[3 * i];
                motion.free[d][i] = blocked[i] >> d & 1 ? 0.0 : 1.0;
            }
            for (int i = 0; bodies.isScaled() && d < 3 && i < count; ++i) // added inertia has no weight
                motion.force[d][i] -= (bodies.mass[first + i] - bodies.weighed[first + i]) * gravity[d];
            // Velocities are those in the middle of a step: what flies falls for the mean of two unequal steps. The
            // product of both velocities, which is the kinetic energy in the middle of equal steps, is then too large.
            for (int i = 0; stepChange != 0 && d < 3 && i < count; ++i) {
                const double speed = bodies.velocity[d][first + i], weight = bodies.weighed[first + i] * gravity[d];
                if (!forces[first + i].isZero(0) || speed == 0 || motion.free[d][i] == 0) continue;
                motion.force[d][i] -= 0.5 * stepChange / scene.dt * weight;
                sum.kinetic -= 0.25 * stepChange * weight * speed;
            }
            for (int i = 0; turning && d >= 3 && i < count; ++i)
                if (motion.inSpace[i] != 0) motion.force[d][i] = motion.free[d][i] = 0;
        }
        motion.advance(bodies, last, first, count, around, axes);
        for (int i = 0; i < count; ++i) {
            const int b = first + i;
            const bool mine = bodies.has(b) && !bodies.isUnit[b] && (bodies.spins(b) || bodies.axes(b) != 0);
            if (!mine) continue;
            bodies.give(b, bodies.spins(b) ? 63 : axes);
            for (int d = 0; d < 3 && bodies.spins(b); ++d)
                bodies.state(b).angMom[d] = motion.momentum[d][i];
            sum.external += motion.work[i];
            sum.damped += motion.damped[0][i];
            sum.pendingDamped += motion.damped[1][i];
            sum.kinetic += motion.kinetic[i];
        }
        sum.pendingExternal = sum.external;
    }
    sum.external += earlier;
    return all;
}

// Sums m g·u and m u of rigid bodies, with their displacements u since the reference state.
void Integrator::findWeights(const BodyColumns& bodies, int first, int count, Sums& all) const {
    const double *now[3], *before[3];
    for (int d = 0; d < 3; ++d) {
        now[d] = &bodies.position[d][first];
        before[d] = &bodies.referencePosition[d][first];
    }
    // The three sums side by side: an addition then waits for none of another sum.
    double moment[3] = {};
    for (int i = 0; i < count; ++i) {
        const double mass = bodies.has(first + i) && !bodies.isUnit[first + i] ? bodies.weighed[first + i] : 0;
        double falls = 0; // gravity times displacement
        for (int d = 0; d < 3; ++d) {
            const double moved = now[d][i] - before[d][i];
            falls += gravity[d] * moved;
            moment[d] += mass * moved;
        }
        all.energies.fallen += mass * falls;
    }
    all.moment = {moment[0], moment[1], moment[2]};
}

} // namespace masonry
