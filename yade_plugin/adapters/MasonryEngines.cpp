#include "MasonryEngines.hpp"
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include "SceneCheck.hpp"
#include "motion/LargestEigenvalue.hpp"
#include "motion/RigidMotion.hpp"
#include "common/Text.hpp"
#include <map>

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryLoad)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryEnergy)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryIntegrator)

namespace masonry {

using yade::Matrix3r;
using yade::State;

namespace {

bool blocked(const State& s, int axis) { return s.blockedDOFs >> axis & 1; } // 0-2 translations, 3-5 rotations

bool rotationRestrained(const State& s) { return s.blockedDOFs >> 3 != 0; }

// Inverse inertia in global axes as the integrator uses it: with a blocked rotation the three values stand for the
// global axes, without for the body's own.
Matrix3r inverseInertia(const State& s) {
    Vector3r inverse = s.inertia.cwiseInverse();
    if (!rotationRestrained(s)) {
        const Matrix3r axes = s.ori.toRotationMatrix();
        return axes * inverse.asDiagonal() * axes.transpose();
    }
    for (int i = 0; i < 3; ++i)
        if (blocked(s, 3 + i)) inverse[i] = 0;
    return inverse.asDiagonal();
}

Vector3r inverseMass(const State& s) {
    Vector3r inverse;
    for (int i = 0; i < 3; ++i)
        inverse[i] = blocked(s, i) ? 0 : 1 / s.mass;
    return inverse;
}

struct Environment { // of the integrator that runs
    double damping = 0;
    Vector3r gravity = Vector3r::Zero();
    bool host = false;
};

Environment environmentOf(const yade::Scene& scene) {
    for (const auto& engine : scene.engines)
        if (const auto* own = dynamic_cast<const MasonryIntegrator*>(engine.get()))
            return {own->damping, own->gravity};
        else if (engine->getClassName() == "NewtonIntegrator") {
            const auto& host = static_cast<const yade::NewtonIntegrator&>(*engine);
            return {host.damping, host.gravity, true};
        }
    return {};
}

std::vector<MasonryLoad*> loadsOf(const yade::Scene& scene) {
    std::vector<MasonryLoad*> all;
    for (const auto& engine : scene.engines)
        if (auto* load = dynamic_cast<MasonryLoad*>(engine.get()); load && !load->dead) all.push_back(load);
    return all;
}

MasonryZones* zonesOf(const yade::Scene& scene) {
    for (const auto& engine : scene.engines)
        if (auto* zones = dynamic_cast<MasonryZones*>(engine.get())) return zones;
    return nullptr;
}

int sign(double x) { return (x > 0) - (x < 0); }

// A step of a body, in the host's equations. It takes v- to v+ with the forces at x_n. Between x_n and x_n+1 a force
// does the work of its mean over both ends: half of it with v- at n, half with v+ (pending until n+1). With the kinetic
// energy m v-·v+ / 2 the balance at x_n is then an identity, and the joints' trapezoidal work is its counterpart.
struct BodyStep {
    Vector3r vel, angVel;      // after
    Vector3r torque;           // less what damping takes
    double kinetic = 0;        // [J]
    double work[2] = {0, 0};   // of prescribed motions, at n and pending [J]
    double damped[2] = {0, 0}; // taken by damping, at n and pending [J]
};

// `last` are force and torque per mass and inertia of the step before, for combined damping, and are brought up to
// date; null: local damping.
[[gnu::always_inline]] inline BodyStep stepOf(const State& s, const Vector3r& force, const Vector3r& torque,
                                              const Environment& around, double dt, Vector3r* last) {
    BodyStep step{s.vel, s.angVel, torque};
    const double alpha = s.isDamped ? around.damping : 0;
    const double rate = 1 / dt;
    // What damping takes of an acceleration, paper eq. (3), or combined: at most `stop`, what stops the motion in the
    // middle of the step. So it turns no motion round and never adds energy; the host's takes all and may.
    const auto drag = [&](double free, double stop, double* before) {
        const double reach = alpha * std::abs(free);
        if (around.host) return reach * sign(stop);
        if (!before) return std::clamp(stop, -reach, reach);
        const int change = sign(free - *before);
        *before = free;
        return std::clamp(stop, -0.5 * reach * (1 + change), 0.5 * reach * (1 - change));
    };
    for (int i = 0; i < 3; ++i) {
        const double all = force[i] + s.mass * around.gravity[i];
        if (blocked(s, i)) {
            step.work[0] -= 0.5 * dt * s.vel[i] * all;
            continue;
        }
        const double free = force[i] / s.mass + around.gravity[i];
        const double taken = drag(free, rate * s.vel[i] + 0.5 * free, last ? &last[0][i] : nullptr);
        step.vel[i] += dt * (free - taken);
        step.damped[0] += 0.5 * dt * s.mass * taken * s.vel[i];
        step.damped[1] += 0.5 * dt * s.mass * taken * step.vel[i];
        step.kinetic += 0.5 * s.mass * s.vel[i] * step.vel[i];
    }
    // With a blocked rotation the integrator damps accelerations about the global axes, without it the torque, and what
    // stops the spin about one of them cannot be more than its share of the smallest inertia.
    const bool restrained = rotationRestrained(s);
    const Vector3r gained = restrained || around.host ? Vector3r::Zero() : Vector3r(inverseInertia(s) * torque);
    const double least = s.inertia.minCoeff();
    Vector3r taken = Vector3r::Zero();
    for (int i = 0; i < 3; ++i) {
        if (blocked(s, 3 + i)) {
            step.work[0] -= 0.5 * dt * s.angVel[i] * torque[i];
            continue;
        }
        const double free = torque[i] / s.inertia[i];
        const double stop = restrained ? rate * s.angVel[i] + 0.5 * free
                                       : least / s.inertia[i] * (rate * s.angVel[i] + 0.5 * gained[i]);
        taken[i] = s.inertia[i] * drag(free, stop, last ? &last[1][i] : nullptr);
    }
    step.torque -= taken;
    step.work[1] = step.work[0];
    if (restrained) {
        for (int i = 0; i < 3; ++i)
            if (!blocked(s, 3 + i)) {
                step.angVel[i] += dt * step.torque[i] / s.inertia[i];
                step.kinetic += 0.5 * s.inertia[i] * s.angVel[i] * step.angVel[i];
            }
    } else {
        const Matrix3r axes = s.ori.toRotationMatrix();
        step.angVel += dt * (inverseInertia(s) * step.torque);
        step.kinetic += 0.5 * (axes.transpose() * s.angVel).dot(s.inertia.cwiseProduct(axes.transpose() * step.angVel));
    }
    step.damped[0] += 0.5 * dt * taken.dot(s.angVel);
    step.damped[1] += 0.5 * dt * taken.dot(step.angVel);
    return step;
}

bool moves(const State& s) { return (s.blockedDOFs & 63) != 63 || !s.vel.isZero(0) || !s.angVel.isZero(0); }

template <class F> void eachJoint(const yade::Scene& scene, F&& visit) {
    for (std::size_t i = 0; i < scene.interactions->currSize; ++i) {
        const auto& interaction = *scene.interactions->linIntrs[i];
        auto* geom = dynamic_cast<MasonryJointGeom*>(interaction.geom.get());
        auto* phys = dynamic_cast<MasonryJointPhys*>(interaction.phys.get());
        if (geom && phys && geom->points.size() == phys->states.size()) visit(interaction, *geom, *phys);
    }
}

} // namespace

void MasonryLoad::postLoad() {
    std::vector<std::string> wrong;
    if (body < 0) wrong.push_back("body " + std::to_string(body) + " must be at least 0");
    if (!point.allFinite()) wrong.push_back("point must be finite numbers [m]");
    if (!force.allFinite()) wrong.push_back("force must be finite numbers [N]");
    if (!(direction.norm() > 0 && std::isfinite(direction.norm())))
        wrong.push_back("direction must be finite numbers, not all zero");
    if (!std::isfinite(velocity)) wrong.push_back("velocity " + text(velocity) + " m/s must be a finite number");
    if (!wrong.empty()) throw std::invalid_argument("MasonryLoad: " + joined(wrong, "; "));
}

void MasonryLoad::action() {
    checkScene(*scene);
    if (auto* zones = zonesOf(*scene); zones && zones->unitOf(body))
        throw std::invalid_argument("MasonryLoad.body " + std::to_string(body) +
                                    " is a deformable unit; load a rigid block joined to it");
    auto& state = *bodyAt(*scene, body, "MasonryLoad.body").state;
    state.isDamped = false;
    arm = state.ori * state.refOri.conjugate() * (point - state.refPos);
    total = force;
    auto& forces = scene->forces();
    if (driven) {
        // The force R that gives the point its velocity after this step: d·(v + w x arm) = V with
        // v' = v + dt (F + R d)/m + dt g, w' = w + dt I^-1 (T + arm x R d).
        const Vector3r d = direction.normalized(), lever = arm.cross(d), perMass = inverseMass(state);
        const Matrix3r perInertia = inverseInertia(state);
        const Vector3r push = forces.getForceSingle(body) + total + state.mass * environmentOf(*scene).gravity;
        const Vector3r v = state.vel + scene->dt * perMass.cwiseProduct(push);
        const Vector3r w = state.angVel + scene->dt * (perInertia * (forces.getTorqueSingle(body) + arm.cross(total)));
        const double mobility = d.dot(perMass.cwiseProduct(d)) + lever.dot(perInertia * lever);
        if (mobility <= 0)
            throw std::invalid_argument("MasonryLoad: body " + std::to_string(body) +
                                        " is blocked in the driven direction");
        reaction = (velocity - d.dot(v) - lever.dot(w)) / (mobility * scene->dt);
        total += reaction * d;
    } else
        reaction = 0;
    forces.addForce(body, total);
    forces.addTorque(body, arm.cross(total));
}

Vector3r MasonryLoad::displacement() const {
    const auto& state = *bodyAt(*Singleton<yade::Omega>::instance().getScene(), body, "MasonryLoad.body").state;
    const Vector3r r = point - state.refPos;
    return state.pos + state.ori * state.refOri.conjugate() * r - point;
}

// Half of a load's work is done with the velocity before the step and half with the one after, as in BodyStep.
void MasonryLoad::workBefore(double dt) {
    const auto& s = *scene->bodies->body[body]->state;
    work += pendingWork + 0.5 * dt * total.dot(s.vel + s.angVel.cross(arm));
}

void MasonryLoad::workAfter(double dt, const Vector3r& vel, const Vector3r& angVel) {
    pendingWork = 0.5 * dt * total.dot(vel + angVel.cross(arm));
}

void BodyEnergies::beginStep() {
    external += pendingExternal, damped += pendingDamped;
    pendingExternal = pendingDamped = kinetic = fallen = 0;
}

namespace {

BodyEnergies energiesOf(const BodyStep& step) {
    return {step.work[0], step.damped[0], step.work[1], step.damped[1], step.kinetic, 0};
}

} // namespace

namespace {

struct Inventory { // what the engines of a scene keep, without the joints
    double work = 0, falls = 0, moving = 0, drag = 0, inUnits = 0; // [J]
};

Inventory inventoryOf(const yade::Scene& scene, const BodyEnergies& energies) {
    Inventory all{energies.external, energies.fallen, energies.kinetic, energies.damped};
    for (const auto& engine : scene.engines)
        if (const auto* load = dynamic_cast<MasonryLoad*>(engine.get()))
            all.work += load->work;
        else if (const auto* own = dynamic_cast<MasonryIntegrator*>(engine.get()))
            all.work += own->external, all.falls += own->fallen, all.moving += own->kinetic, all.drag += own->damped;
        else if (const auto* zones = dynamic_cast<MasonryZones*>(engine.get())) {
            all.falls += zones->gravityWork, all.moving += zones->kinetic, all.drag += zones->dampingWork;
            all.inUnits += zones->elastic;
        }
    return all;
}

struct Limit { // of the time step, and when it was found
    double dt = 0;
    int id1 = -1, id2 = -1;
    const yade::Scene* scene = nullptr;
    long changes = -1;
    double damping = 0, zoneDamping = 0;
};

Limit limitOf(const yade::Scene&, bool anew);
std::string describe(const yade::Scene&, const Limit&); // its time step, its limit, and what sets that

std::string firstNotFinite(const yade::Scene& scene) {
    for (const auto& body : scene.bodies->body)
        if (body && body->state && !(body->state->pos + body->state->vel + body->state->angVel).allFinite())
            return "of body " + std::to_string(body->id);
    return "of the joints";
}

} // namespace

// Looks every tenth step, and when time step or joints are others. The energy of motion m v-·v+ / 2 of a stable motion
// lies between that of all work done and minus 1/(1 - r²) of it, at a share r of the limit; r is 0.995 for a hundred.
void MasonryEnergy::check() {
    const bool tenth = scene->iter % 10 == 0;
    if (!tenth && scene->dt == lastStep_ && changes == lastChanges_) return;
    lastStep_ = scene->dt, lastChanges_ = changes;
    for (bool anew : {false, true}) { // masses may have changed
        const auto limit = limitOf(*scene, anew);
        if (scene->dt <= limit.dt) break;
        if (anew) throw std::runtime_error("unstable: " + describe(*scene, limit));
    }
    if (!tenth) return;
    const auto all = inventoryOf(*scene, *this);
    const double motion = std::abs(all.moving);
    if (!std::isfinite(motion))
        throw std::runtime_error("numbers " + firstNotFinite(*scene) + " are not finite at step " +
                                 std::to_string(scene->iter) + "; " + describe(*scene, limitOf(*scene, false)));
    largestInput = std::max(largestInput, std::abs(all.work + all.falls));
    if (motion > 100 * largestInput + 1e-12)
        throw std::runtime_error("unstable: motion out of nothing at step " + std::to_string(scene->iter) + ", " +
                                 text(motion) + " J where " + text(largestInput) + " J of work were done; " +
                                 describe(*scene, limitOf(*scene, true)) +
                                 ". Velocities set by hand must be told at once by MasonryEnergy.given()");
}

namespace {

double motionOf(const yade::Scene& scene) { // energy of what is free to move [J]
    double twice = 0;
    auto* zones = zonesOf(scene);
    for (const auto& body : scene.bodies->body) {
        if (!body || !body->state || (zones && zones->unitOf(body->id))) continue;
        const State& s = *body->state;
        const Vector3r spin = rotationRestrained(s) ? s.angVel : Vector3r(s.ori.conjugate() * s.angVel);
        for (int i = 0; i < 3; ++i) {
            if (!blocked(s, i)) twice += s.mass * s.vel[i] * s.vel[i];
            if (!blocked(s, 3 + i)) twice += s.inertia[i] * spin[i] * spin[i];
        }
    }
    if (zones) {
        zones->refresh();
        for (const auto& unit : zones->units())
            for (std::size_t n = 0; n < unit.elasticity->masses().size(); ++n)
                for (int d = 0; d < 3; ++d)
                    if (!zones->holds(d))
                        twice += unit.elasticity->masses()[n] * std::pow(zones->velocities[unit.firstNode + n][d], 2);
    }
    return 0.5 * twice;
}

} // namespace

void MasonryEnergy::given() {
    const auto& running = *Singleton<yade::Omega>::instance().getScene();
    external += motionOf(running) - inventoryOf(running, *this).moving;
    begun = true;
}

void MasonryEnergy::action() {
    checkScene(*scene);
    if (!begun) given();
    if (watch) check();
    for (const auto& engine : scene->engines)
        if (dynamic_cast<MasonryIntegrator*>(engine.get())) return; // keeps them itself
    const auto around = environmentOf(*scene);
    auto& forces = scene->forces();
    forces.sync();
    auto* zones = zonesOf(*scene);
    beginStep();
    for (const auto& body : scene->bodies->body) {
        if (!body || !body->state || (zones && zones->unitOf(body->id))) continue; // zones keep their own
        const State& s = *body->state;
        fallen += s.mass * around.gravity.dot(s.pos - s.refPos);
        if (!moves(s)) continue;
        const auto step = stepOf(s, forces.getForce(body->id), forces.getTorque(body->id), around, scene->dt, nullptr);
        add(energiesOf(step));
    }
    for (auto* load : loadsOf(*scene)) {
        const State& s = *scene->bodies->body[load->body]->state;
        const auto step =
            stepOf(s, forces.getForce(load->body), forces.getTorque(load->body), around, scene->dt, nullptr);
        load->workBefore(scene->dt);
        load->workAfter(scene->dt, step.vel, step.angVel);
    }
}

void MasonryIntegrator::postLoad() {
    std::vector<std::string> wrong;
    if (!(damping >= 0 && damping <= 0.99)) wrong.push_back("damping " + text(damping) + " must be 0 to 0.99");
    if (dampingKind != "combined" && dampingKind != "local")
        wrong.push_back("dampingKind '" + dampingKind + "' must be 'combined' or 'local'");
    if (!gravity.allFinite()) wrong.push_back("gravity must be finite numbers");
    if (!wrong.empty()) throw std::invalid_argument("MasonryIntegrator: " + joined(wrong, "; "));
}

namespace {

// Rotation by the end of a step of a body that is free to turn.
void turn(State& s, const BodyStep& step, double dt) {
    // Leapfrog of the angular momentum, its spin taken in the body's axes, with the orientation at half
    // step from the momentum at the step; the host's scheme for aspherical bodies.
    const auto spinOf = [&](const Vector3r& momentum) {
        return Vector3r((s.ori.conjugate() * momentum).cwiseQuotient(s.inertia));
    };
    const auto moved = [](const Quaternionr& from, const Quaternionr& by, const Vector3r& spin, double time) {
        const Quaternionr change = by * Quaternionr(0, spin[0], spin[1], spin[2]);
        return Quaternionr((from.coeffs() + 0.5 * time * change.coeffs()).eval());
    };
    const Quaternionr middle = moved(s.ori, s.ori, spinOf(s.angMom + 0.5 * dt * step.torque), 0.5 * dt);
    s.angMom += dt * step.torque;
    const Vector3r spin = spinOf(s.angMom);
    s.ori = moved(s.ori, middle, spin, dt);
    s.angVel = s.ori * spin;
    s.ori.normalize();
}

// A body's place in the columns, and the axes in which it is free or moves.
[[gnu::always_inline]] inline unsigned gather(const State& s, const Vector3r& force, const Vector3r& torque,
                                              double damping, const Vector3r* last, RigidMotion& m, int i) {
    unsigned axes = ~s.blockedDOFs & 63;
    m.mass[i] = s.mass, m.alpha[i] = s.isDamped ? damping : 0;
    for (int d = 0; d < 3; ++d) {
        m.inertia[d][i] = s.inertia[d];
        m.force[d][i] = force[d], m.force[3 + d][i] = torque[d];
        m.velocity[d][i] = s.vel[d], m.velocity[3 + d][i] = s.angVel[d];
        m.last[d][i] = last ? last[0][d] : 0, m.last[3 + d][i] = last ? last[1][d] : 0;
        m.free[d][i] = !blocked(s, d), m.free[3 + d][i] = !blocked(s, 3 + d);
        axes |= (s.vel[d] != 0) << d | (s.angVel[d] != 0) << (3 + d);
        m.orientation[1 + d][i] = s.ori.coeffs()[d];
    }
    m.orientation[0][i] = s.ori.w();
    return axes;
}

[[gnu::always_inline]] inline void scatter(const RigidMotion& m, int i, double dt, State& s, Vector3r* last) {
    for (int d = 0; d < 3; ++d) {
        s.vel[d] = m.velocity[d][i], s.angVel[d] = m.velocity[3 + d][i];
        s.pos[d] += dt * s.vel[d];
        s.ori.coeffs()[d] = m.orientation[1 + d][i];
        if (last) last[0][d] = m.last[d][i], last[1][d] = m.last[3 + d][i];
    }
    s.ori.w() = m.orientation[0][i];
}

} // namespace

// Whether the places are no longer those of the bodies. States change hands so rarely that a look now and then will do.
bool MasonryIntegrator::stale() const {
    const auto& all = scene->bodies->body;
    bool fits = places_.size() == all.size();
    for (std::size_t id = 0; fits && id < all.size(); ++id)
        fits = places_[id].body == all[id].get();
    return !fits || scene->iter % 100 == 0;
}

void MasonryIntegrator::action() {
    checkScene(*scene);
    auto& forces = scene->forces();
    forces.sync();
    const auto& all = scene->bodies->body;
    if (stale()) {
        auto* zones = zonesOf(*scene);
        places_.clear();
        for (const auto& body : all)
            places_.push_back({body.get(), body ? body->state.get() : nullptr,
                               body && body->state && !(zones && zones->unitOf(body->id))});
    }
    const auto loads = loadsOf(*scene);
    const Environment around{damping, gravity};
    const RigidMotion::Around rigid{scene->dt, {gravity[0], gravity[1], gravity[2]}, dampingKind == "combined"};
    if (rigid.combined) last.resize(2 * all.size(), Vector3r::Zero());
    for (auto* load : loads)
        load->workBefore(scene->dt);
    constexpr int piece = RigidMotion::most,
                  ahead = 8; // bodies that are summed up together, whatever the number of threads
    const int count = int(all.size()), pieces = (count + piece - 1) / piece;
    std::vector<BodyEnergies> sums(pieces);
#pragma omp parallel for schedule(static)
    for (int n = 0; n < pieces; ++n) {
        RigidMotion motion;
        State* states[piece];
        int ids[piece], restrained = 0;
        unsigned axes = 0;
        for (int id = n * piece; id < std::min(count, (n + 1) * piece); ++id) {
            if (id + ahead < count)
                for (int line = 1; line < 5; ++line) // states lie all over the memory
                    __builtin_prefetch(reinterpret_cast<const char*>(places_[id + ahead].state) + 64 * line);
            if (!places_[id].rigid) continue;
            State& s = *places_[id].state;
            sums[n].fallen += s.mass * gravity.dot(s.pos - s.refPos);
            if (!moves(s)) continue;
            const Vector3r &force = forces.getForce(id), &torque = forces.getTorque(id);
            if (rotationRestrained(s)) {
                axes |= gather(s, force, torque, damping, rigid.combined ? &last[2 * id] : nullptr, motion, restrained);
                states[restrained] = &s, ids[restrained++] = id;
                continue;
            }
            const auto step = stepOf(s, force, torque, around, scene->dt, rigid.combined ? &last[2 * id] : nullptr);
            sums[n].add(energiesOf(step));
            s.vel = step.vel;
            s.pos += scene->dt * s.vel;
            turn(s, step, scene->dt);
        }
        motion.advance(restrained, rigid, axes);
        for (int i = 0; i < restrained; ++i) {
            scatter(motion, i, scene->dt, *states[i], rigid.combined ? &last[2 * ids[i]] : nullptr);
            sums[n].add(
                {motion.work[i], motion.damped[0][i], motion.work[i], motion.damped[1][i], motion.kinetic[i], 0});
        }
    }
    beginStep();
    for (const auto& sum : sums)
        add(sum);
    for (auto* load : loads) {
        const State& s = *all[load->body]->state;
        load->workAfter(scene->dt, s.vel, s.angVel);
    }
}

py::dict MasonryEnergy::balance() {
    const auto& running = *Singleton<yade::Omega>::instance().getScene();
    Energies stored;
    Vector3r lost = Vector3r::Zero();
    eachJoint(running, [&](const auto&, const MasonryJointGeom& geom, MasonryJointPhys& phys) {
        phys.refresh();
        lost += phys.dissipated;
        for (std::size_t i = 0; i < phys.states.size(); ++i) {
            const auto e = JointLaw::stored(phys.stiffness(), phys.states[i]);
            stored.tension += geom.points[i].area * e.tension;
            stored.shear += geom.points[i].area * e.shear;
            stored.compression += geom.points[i].area * e.compression;
        }
    });
    const auto [work, falls, moving, drag, inUnits] = inventoryOf(running, *this);
    const double in = work + falls;
    const double out = moving + drag + inUnits + stored.tension + stored.shear + stored.compression + lost.sum();
    const double size = std::max(std::abs(work) + std::abs(falls), std::abs(out));
    // What is dissipated cannot come back: a joint that opens or closes within a step takes the trapezoidal work of
    // both stiffnesses, and a long undamped series of such steps makes energy, which damping or shorter steps prevent.
    mostLost = mostLost.cwiseMax(lost);
    const double error = size > 0 ? (in - out) / size : 0;
    largestError = std::max(largestError, std::abs(error));
    if (size > 0) largestMade = std::max(largestMade, (mostLost - lost).sum() / size);
    py::dict all;
    all["external"] = work, all["gravity"] = falls, all["kinetic"] = moving, all["damping"] = drag;
    all["elastic_units"] = inUnits;
    all["elastic_tension"] = stored.tension, all["elastic_shear"] = stored.shear;
    all["elastic_compression"] = stored.compression;
    all["dissipated_tension"] = lost[0], all["dissipated_shear"] = lost[1], all["dissipated_compression"] = lost[2];
    all["error"] = error;
    return all;
}

namespace {

// Stiffness over masses of a scene, S K S with S = sqrt((1 + alpha) / M), as a sum over its joints and deformable
// units. The degrees of freedom are the six of every rigid body and the three of every node; those that are blocked
// have no part in it.
class Dynamics {
public:
    explicit Dynamics(const yade::Scene&);

    std::vector<bool> moves; // whether a degree of freedom can
    void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
    // The bodies of the joint, or twice the unit, that has most of a mode's energy.
    std::pair<int, int> stiffest(const Eigen::VectorXd& mode) const;

private:
    struct Joint { // between rigid bodies, or a point of one at nodes
        std::vector<int> degrees;
        Eigen::MatrixXd stiffness;
        int body1, body2;
    };
    struct Unit {
        BlockMatrix matrix;
        int first, body;
    };
    void addDegree(double mass, double damping, bool blocked) {
        moves.push_back(!blocked);
        scale_.push_back(blocked ? 0 : std::sqrt((1 + damping) / mass));
    }
    void addJoint(const yade::Scene&, const yade::Interaction&, const MasonryJointGeom&, const MasonryJointPhys&);
    // Calls `visit(body1, body2, degree, force)` with the force of every part on its degrees under a motion.
    template <class F> void eachForce(const Eigen::VectorXd& motion, F&& visit) const;

    std::vector<double> scale_; // sqrt((1 + alpha) / mass) of a degree of freedom; 0 where it is blocked
    std::map<int, int> firstOfBody_;
    std::vector<Joint> joints_;
    std::vector<Unit> units_;
};

Dynamics::Dynamics(const yade::Scene& scene) {
    if (auto* zones = zonesOf(scene))
        for (const auto& unit : zones->units()) {
            units_.push_back({unit.elasticity->matrix(), 3 * unit.firstNode, unit.body});
            for (double mass : unit.elasticity->masses())
                for (int d = 0; d < 3; ++d)
                    addDegree(mass, zones->damping, zones->holds(d));
        }
    eachJoint(scene, [&](const yade::Interaction& interaction, const MasonryJointGeom& geom,
                         const MasonryJointPhys& phys) { addJoint(scene, interaction, geom, phys); });
}

void Dynamics::addJoint(const yade::Scene& scene, const yade::Interaction& interaction, const MasonryJointGeom& geom,
                        const MasonryJointPhys& phys) {
    const int ids[2] = {interaction.id1, interaction.id2};
    const std::vector<Attachment>* attachments[2] = {&geom.attachments1, &geom.attachments2};
    const Vector3r centres[2] = {geom.position1, geom.position2};
    const Matrix3r axes = geom.referenceAxes();
    const double damping = environmentOf(scene).damping;
    for (std::size_t p = 0; p < geom.points.size(); ++p) {
        Joint part{{}, {}, ids[0], ids[1]};
        std::vector<Vector3r> rows; // of the jump: its derivative by each degree
        const auto add = [&](int degree, const Vector3r& moved) {
            if (moves[degree]) part.degrees.push_back(degree), rows.push_back(axes.transpose() * moved);
        };
        for (int side = 0; side < 2; ++side) {
            const double sign = side ? 1 : -1;
            if (!attachments[side]->empty()) {
                const auto& a = (*attachments[side])[p];
                for (int n = 0; n < 3 && a.weights[n] > 0; ++n)
                    for (int d = 0; d < 3; ++d)
                        add(3 * a.nodes[n] + d, sign * a.weights[n] * Vector3r::Unit(d));
                continue;
            }
            const State& s = *scene.bodies->body[ids[side]]->state;
            const auto [first, fresh] = firstOfBody_.emplace(ids[side], int(moves.size()));
            if (fresh)
                if (const auto wrong = problemsOf(*scene.bodies->body[ids[side]]); !wrong.empty())
                    throw std::invalid_argument(joined(wrong));
            for (int d = 0; fresh && d < 6; ++d)
                addDegree(d < 3 ? s.mass : s.inertia[d - 3], s.isDamped ? damping : 0, blocked(s, d));
            const Matrix3r own = rotationRestrained(s) ? Matrix3r(Matrix3r::Identity()) : s.ori.toRotationMatrix();
            const Vector3r arm = geom.centre(geom.points[p]) - centres[side];
            for (int d = 0; d < 6; ++d)
                add(first->second + d, sign * (d < 3 ? Vector3r(Vector3r::Unit(d)) : own.col(d - 3).cross(arm)));
        }
        const Vector3r k =
            geom.points[p].area * Vector3r(phys.normalStiffness, phys.shearStiffness, phys.shearStiffness);
        part.stiffness.resize(rows.size(), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < rows.size(); ++j)
                part.stiffness(i, j) = rows[i].dot(k.cwiseProduct(rows[j]));
        if (geom.zones || p == 0)
            joints_.push_back(std::move(part));
        else
            joints_.back().stiffness += part.stiffness;
    }
}

template <class F> void Dynamics::eachForce(const Eigen::VectorXd& motion, F&& visit) const {
    for (const auto& joint : joints_)
        for (std::size_t i = 0; i < joint.degrees.size(); ++i) {
            double force = 0;
            for (std::size_t j = 0; j < joint.degrees.size(); ++j)
                force += joint.stiffness(j, i) * motion[joint.degrees[j]];
            visit(joint.body1, joint.body2, joint.degrees[i], force);
        }
    for (const auto& unit : units_)
        for (int r = 0; r < unit.matrix.rowCount; ++r) {
            const auto& row = unit.matrix.rows[r];
            double force = 0;
            for (int e = row.first; e < row.beyond; ++e)
                force += unit.matrix.values[e] * motion[unit.first + unit.matrix.columns[e]];
            visit(unit.body, unit.body, unit.first + row.degree, force);
        }
}

void Dynamics::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    const Eigen::Map<const Eigen::VectorXd> scale(scale_.data(), Eigen::Index(scale_.size()));
    y.setZero();
    eachForce(scale.cwiseProduct(x), [&](int, int, int degree, double force) { y[degree] += force; });
    y.array() *= scale.array();
}

std::pair<int, int> Dynamics::stiffest(const Eigen::VectorXd& mode) const {
    const Eigen::VectorXd motion =
        Eigen::Map<const Eigen::VectorXd>(scale_.data(), Eigen::Index(scale_.size())).cwiseProduct(mode);
    std::map<std::pair<int, int>, double> energies;
    eachForce(motion, [&](int body1, int body2, int degree, double force) {
        energies[{body1, body2}] += motion[degree] * force;
    });
    const auto most = std::max_element(energies.begin(), energies.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == energies.end() ? std::pair(-1, -1) : most->first;
}

} // namespace

namespace {

Limit limitOf(const yade::Scene& scene, bool anew) {
    static Limit last;
    const auto* zones = zonesOf(scene);
    Limit limit{HUGE_VAL, -1, -1, &scene, changes, environmentOf(scene).damping, zones ? zones->damping : 0};
    const auto when = [](const Limit& l) { return std::tie(l.scene, l.changes, l.damping, l.zoneDamping); };
    if (!anew && when(limit) == when(last)) return last;
    const Dynamics dynamics(scene);
    const auto highest = largestEigenvalue(
        dynamics.moves, [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { dynamics.multiply(x, y); });
    if (highest.bound > 0) limit.dt = 2 / std::sqrt(highest.bound);
    std::tie(limit.id1, limit.id2) = dynamics.stiffest(highest.mode);
    limit.changes = changes; // units may have been meshed
    return last = limit;
}

std::string describe(const yade::Scene& scene, const Limit& limit) {
    std::string what = "the time step is " + text(scene.dt) + " s";
    if (limit.id1 < 0) return what;
    what += ", its limit " + text(limit.dt) + " s, which ";
    if (limit.id1 == limit.id2) return what + "unit " + std::to_string(limit.id1) + " sets";
    std::string name;
    eachJoint(scene, [&](const yade::Interaction& i, const MasonryJointGeom&, const MasonryJointPhys& phys) {
        if (i.id1 == limit.id1 && i.id2 == limit.id2) name = phys.joint->name;
    });
    return what + "joint \"" + name + "\" between bodies " + std::to_string(limit.id1) + " and " +
           std::to_string(limit.id2) + " sets";
}

} // namespace

py::tuple criticalTimeStep() {
    const auto limit = limitOf(*Singleton<yade::Omega>::instance().getScene(), true);
    return py::make_tuple(limit.dt, limit.id1, limit.id2);
}

} // namespace masonry
