#include "MasonryIntegrator.hpp"
#include "BodyStep.hpp"
#include "MasonryLoad.hpp"
#include "MasonryZones.hpp"
#include "SceneStore.hpp"

template class masonry::Adapter<masonry::MasonryIntegrator, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryIntegrator)

namespace masonry {

std::vector<std::string> MasonryIntegrator::problems() const {
    if (combined() || dampingKind == "local") return {};
    return {"dampingKind '" + dampingKind + "' must be 'combined' or 'local'"};
}

// In saved files and checkpoints: two vectors for each body, force per mass and torque per inertia.
std::vector<Vector3r> MasonryIntegrator::lastForces() {
    std::vector<Vector3r> all;
    for (std::size_t b = 0; b < last_[0].size(); ++b) {
        all.emplace_back(last_[0][b], last_[1][b], last_[2][b]);
        all.emplace_back(last_[3][b], last_[4][b], last_[5][b]);
    }
    return all;
}

void MasonryIntegrator::setLastForces(const std::vector<Vector3r>& all) {
    for (int d = 0; d < 6; ++d) {
        last_[d].assign(all.size() / 2, 0);
        for (std::size_t b = 0; b < all.size() / 2; ++b)
            last_[d][b] = all[2 * b + d / 3][d % 3];
    }
}

void MasonryIntegrator::action() {
    const EngineTurn turn(*scene, *this);
    auto& bodies = turn->bodies;
    const int count = bodies.size();
    const auto summed = scene->forces().summed(count);
    for (auto& column : last_)
        if (combined()) column.resize(count, 0);
    for (auto* load : turn->loads)
        load->workBefore(scene->dt, bodies.state(load->body));
    // The pieces over which energies are summed up do not depend on the number of threads, so neither do the sums.
    constexpr int piece = RigidMotion::most;
    const int pieces = (count + piece - 1) / piece;
    std::vector<EnergyLedger> sums(pieces);
#pragma omp parallel for schedule(static)
    for (int n = 0; n < pieces; ++n)
        sums[n] = advance(turn.store(), summed.forces, summed.torques, n * piece, std::min(count, (n + 1) * piece));
    beginStep();
    for (const auto& sum : sums)
        add(sum);
    for (auto* load : turn->loads) {
        const auto& s = bodies.state(load->body);
        load->workAfter(scene->dt, s.vel, s.angVel);
    }
}

EnergyLedger MasonryIntegrator::advance(SceneStore& store, const Vector3r* forces, const Vector3r* torques, int first,
                                        int beyond) {
    constexpr int ahead = 8;
    auto& bodies = store.bodies;
    const int count = beyond - first;
    const bool thoroughly = scene->iter % 10 == 0;
    EnergyLedger sum;
    RigidMotion motion;
    unsigned axes = 0, spinning = 0;
    unsigned char moved[RigidMotion::most]; // BodyColumns::axes() of a body that RigidMotion moves, else 0
    for (int i = 0; i < count; ++i) {
        const int b = first + i;
        moved[i] = 0;
        if (i + ahead < count && bodies.has(b + ahead)) bodies.prefetch(b + ahead);
        if (!bodies.has(b) || bodies.isUnit[b]) continue;
        thoroughly ? bodies.noticeAll(b) : bodies.notice(b);
        double fall = 0;
        for (int d = 0; d < 3; ++d)
            if (gravity[d] != 0) fall += gravity[d] * (bodies.position[d][b] - bodies.referencePosition[d][b]);
        sum.fallen += bodies.mass[b] * fall;
        if (bodies.spins(b)) {
            ++spinning;
            continue;
        }
        moved[i] = (unsigned char)(bodies.axes(b));
        axes |= moved[i];
    }
    if (axes != 0) {
        const RigidMotion::Around around{scene->dt, {gravity[0], gravity[1], gravity[2]}, combined()};
        double unused[RigidMotion::most] = {}; // local damping does not use earlier forces
        double* last[6];
        for (int i = 0; i < count; ++i)
            motion.alpha[i] = bodies.isDamped(first + i) ? damping : 0;
        for (int d = 0; d < 6; ++d) {
            last[d] = combined() ? &last_[d][first] : unused;
            if (!(axes >> d & 1)) continue;
            const Vector3r* on = d < 3 ? forces : torques;
            for (int i = 0; i < count; ++i) {
                motion.force[d][i] = on[first + i][d % 3];
                motion.free[d][i] = moved[i] != 0 && !bodies.isBlocked(first + i, d);
            }
        }
        motion.advance(bodies, last, first, count, around, axes);
        for (int i = 0; i < count; ++i) {
            if (moved[i] == 0) continue;
            bodies.give(first + i, axes);
            sum.external += motion.work[i];
            sum.damped += motion.damped[0][i];
            sum.pendingDamped += motion.damped[1][i];
            sum.kinetic += motion.kinetic[i];
        }
        sum.pendingExternal = sum.external;
    }
    // Last, because RigidMotion has also written to the rows of these bodies.
    for (int b = first; spinning > 0 && b < beyond; ++b)
        if (bodies.has(b) && !bodies.isUnit[b] && bodies.spins(b)) sum.add(turnFreely(store, forces[b], torques[b], b));
    return sum;
}

// The step is made in the host's State, because only that holds the angular momentum of the body.
EnergyLedger MasonryIntegrator::turnFreely(SceneStore& store, const Vector3r& force, const Vector3r& torque, int body) {
    auto& s = store.bodies.state(body);
    BodyForces before{Vector3r::Zero(), Vector3r::Zero()};
    for (int d = 0; combined() && d < 3; ++d) {
        before.force[d] = last_[d][body];
        before.torque[d] = last_[3 + d][body];
    }
    const auto step = stepOf(s, {force, torque}, gravity, scene->dt, {damping, false, combined() ? &before : nullptr});
    for (int d = 0; combined() && d < 3; ++d) {
        last_[d][body] = before.force[d];
        last_[3 + d][body] = before.torque[d];
    }
    s.vel = step.vel;
    s.pos += scene->dt * s.vel;
    turnInSpace(s, step, scene->dt);
    store.bodies.take(body);
    return step.energies;
}

} // namespace masonry
