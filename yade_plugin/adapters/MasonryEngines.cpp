#include "MasonryEngines.hpp"
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include "SceneCheck.hpp"
#include "law/Text.hpp"
#include <Eigen/Eigenvalues>
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
};

Environment environmentOf(const yade::Scene& scene) {
    for (const auto& engine : scene.engines)
        if (const auto* own = dynamic_cast<const MasonryIntegrator*>(engine.get()))
            return {own->damping, own->gravity};
        else if (engine->getClassName() == "NewtonIntegrator") {
            const auto& host = static_cast<const yade::NewtonIntegrator&>(*engine);
            return {host.damping, host.gravity};
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
    // What damping takes of an acceleration, paper eq. (3) with the velocity in the middle of the step, or combined.
    const auto drag = [&](double free, double middle, double* before) {
        const double local = alpha * std::abs(free) * sign(middle);
        if (!before) return local;
        const double change = free - *before;
        *before = free;
        return 0.5 * (local - alpha * std::abs(free) * sign(change));
    };
    for (int i = 0; i < 3; ++i) {
        const double all = force[i] + s.mass * around.gravity[i];
        if (blocked(s, i)) {
            step.work[0] -= 0.5 * dt * s.vel[i] * all;
            continue;
        }
        const double free = force[i] / s.mass + around.gravity[i];
        const double taken = drag(free, s.vel[i] + 0.5 * dt * free, last ? &last[0][i] : nullptr);
        step.vel[i] += dt * (free - taken);
        step.damped[0] += 0.5 * dt * s.mass * taken * s.vel[i];
        step.damped[1] += 0.5 * dt * s.mass * taken * step.vel[i];
        step.kinetic += 0.5 * s.mass * s.vel[i] * step.vel[i];
    }
    // With a blocked rotation the integrator damps accelerations about the global axes, without it the torque.
    const bool restrained = rotationRestrained(s);
    Vector3r taken = Vector3r::Zero();
    for (int i = 0; i < 3; ++i) {
        if (blocked(s, 3 + i)) {
            step.work[0] -= 0.5 * dt * s.angVel[i] * torque[i];
            continue;
        }
        const double free = torque[i] / s.inertia[i];
        taken[i] =
            s.inertia[i] * drag(free, s.angVel[i] + (restrained ? 0.5 * dt * free : 0), last ? &last[1][i] : nullptr);
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
    forces.sync();
    if (driven) {
        // The force R that gives the point its velocity after this step: d·(v + w x arm) = V with
        // v' = v + dt (F + R d)/m + dt g, w' = w + dt I^-1 (T + arm x R d).
        const Vector3r d = direction.normalized(), lever = arm.cross(d), perMass = inverseMass(state);
        const Matrix3r perInertia = inverseInertia(state);
        const Vector3r push = forces.getForce(body) + total + state.mass * environmentOf(*scene).gravity;
        const Vector3r v = state.vel + scene->dt * perMass.cwiseProduct(push);
        const Vector3r w = state.angVel + scene->dt * (perInertia * (forces.getTorque(body) + arm.cross(total)));
        const double mobility = d.dot(perMass.cwiseProduct(d)) + lever.dot(perInertia * lever);
        if (!(mobility > 0))
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

void BodyEnergies::add(const BodyEnergies& other) {
    external += other.external, pendingExternal += other.pendingExternal;
    damped += other.damped, pendingDamped += other.pendingDamped;
    kinetic += other.kinetic, fallen += other.fallen;
}

namespace {

BodyEnergies energiesOf(const BodyStep& step) {
    return {step.work[0], step.damped[0], step.work[1], step.damped[1], step.kinetic, 0};
}

} // namespace

void MasonryEnergy::action() {
    checkScene(*scene);
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

// Rotation of a body by the end of a step.
void turn(State& s, const BodyStep& step, double dt) {
    if (rotationRestrained(s)) { // by the rotation vector angVel dt
        s.angVel = step.angVel;
        const Vector3r half = 0.5 * dt * s.angVel;
        const double h2 = half.squaredNorm();
        if (h2 == 0) return;
        double cosine, sinc; // series are exact to the last digit up to a thousandth
        if (h2 < 1e-6)
            cosine = 1 - h2 * (0.5 - h2 / 24), sinc = 1 - h2 * (1 / 6.0 - h2 / 120);
        else {
            const double h = std::sqrt(h2);
            cosine = std::cos(h), sinc = std::sin(h) / h;
        }
        const Vector3r axis = sinc * half;
        s.ori = Quaternionr(cosine, axis[0], axis[1], axis[2]) * s.ori;
        s.ori.normalize();
        return;
    }
    // A free body: leapfrog of the angular momentum, its spin taken in the body's axes, with the orientation at half
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

} // namespace

void MasonryIntegrator::action() {
    checkScene(*scene);
    auto& forces = scene->forces();
    forces.sync();
    const auto& all = scene->bodies->body;
    auto* zones = zonesOf(*scene);
    const auto loads = loadsOf(*scene);
    const Environment around{damping, gravity};
    const double dt = scene->dt;
    const bool combined = dampingKind == "combined";
    if (combined) last.resize(2 * all.size(), Vector3r::Zero());
    for (auto* load : loads)
        load->workBefore(dt);
    constexpr int piece = 64; // bodies that are summed up together, whatever the number of threads
    const int count = int(all.size()), pieces = (count + piece - 1) / piece;
    std::vector<BodyEnergies> sums(pieces);
#pragma omp parallel for schedule(static)
    for (int n = 0; n < pieces; ++n)
        for (int id = n * piece; id < std::min(count, (n + 1) * piece); ++id) {
            // bodies and states lie all over the memory: ask for them ahead of time
            if (id + 16 < count && all[id + 16]) __builtin_prefetch(&all[id + 16]->state);
            if (id + 8 < count && all[id + 8]) {
                const State& later = *all[id + 8]->state;
                for (const void* line : {(const void*)&later.pos, (const void*)&later.vel, (const void*)&later.angMom,
                                         (const void*)&later.refOri})
                    __builtin_prefetch(line);
            }
            if (!all[id] || (zones && zones->unitOf(id))) continue; // zones move their own
            State& s = *all[id]->state;
            sums[n].fallen += s.mass * gravity.dot(s.pos - s.refPos);
            if (!moves(s)) continue;
            const auto step =
                stepOf(s, forces.getForce(id), forces.getTorque(id), around, dt, combined ? &last[2 * id] : nullptr);
            sums[n].add(energiesOf(step));
            s.vel = step.vel;
            s.pos += dt * s.vel;
            turn(s, step, dt);
        }
    beginStep();
    for (const auto& sum : sums)
        add(sum);
    for (auto* load : loads) {
        const State& s = *all[load->body]->state;
        load->workAfter(dt, s.vel, s.angVel);
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
    double work = external, falls = fallen, moving = kinetic, drag = damped, inUnits = 0;
    for (const auto& engine : running.engines)
        if (const auto* load = dynamic_cast<MasonryLoad*>(engine.get()))
            work += load->work;
        else if (const auto* own = dynamic_cast<MasonryIntegrator*>(engine.get())) {
            work += own->external, falls += own->fallen, moving += own->kinetic, drag += own->damped;
        } else if (const auto* zones = dynamic_cast<MasonryZones*>(engine.get())) {
            falls += zones->gravityWork, moving += zones->kinetic, drag += zones->dampingWork;
            inUnits += zones->elastic;
        }
    const double in = work + falls;
    const double out = moving + drag + inUnits + stored.tension + stored.shear + stored.compression + lost.sum();
    const double size = std::max(std::abs(work) + std::abs(falls), std::abs(out));
    const double error = size > 0 ? (in - out) / size : 0;
    largestError = std::max(largestError, std::abs(error));
    py::dict all;
    all["external"] = work, all["gravity"] = falls, all["kinetic"] = moving, all["damping"] = drag;
    all["elastic_units"] = inUnits;
    all["elastic_tension"] = stored.tension, all["elastic_shear"] = stored.shear;
    all["elastic_compression"] = stored.compression;
    all["dissipated_tension"] = lost[0], all["dissipated_shear"] = lost[1], all["dissipated_compression"] = lost[2];
    all["error"] = error;
    return all;
}

// Bound of Irons and Treharne: the highest frequency of the whole is at most the highest of any element that carries
// its share of the masses. Elements are the joints between rigid units, the single points of joints at deformable
// units, and zones. A mass is shared out degree by degree in proportion to the elements' stiffnesses, which makes the
// bound exact for a regular chain.
py::tuple criticalTimeStep() {
    const auto& scene = *Singleton<yade::Omega>::instance().getScene();
    struct Element {
        std::vector<int> degrees;
        Eigen::MatrixXd stiffness;
        int ids[2];
    };
    std::vector<Element> elements;
    std::vector<double> masses, share; // per degree: mass (infinite where blocked), sum of the elements' diagonals
    std::map<int, int> firstOfBody;
    std::map<const MasonryZones*, int> firstOfZones;
    const auto freedom = [&](double mass) {
        masses.push_back(mass);
        share.push_back(0);
    };
    const auto degreesOfBody = [&](int id) {
        const auto [at, fresh] = firstOfBody.emplace(id, int(masses.size()));
        const State& s = *scene.bodies->body[id]->state;
        if (const auto wrong = problemsOf(*scene.bodies->body[id]); fresh && !wrong.empty())
            throw std::invalid_argument(joined(wrong));
        for (int i = 0; fresh && i < 6; ++i)
            freedom(blocked(s, i) ? HUGE_VAL : i < 3 ? s.mass : s.inertia[i - 3]);
        return at->second;
    };
    const auto degreesOfZones = [&](MasonryZones& zones) {
        const auto [at, fresh] = firstOfZones.emplace(&zones, int(masses.size()));
        if (fresh)
            for (const auto& unit : zones.units())
                for (double mass : unit.elasticity->masses())
                    for (int d = 0; d < 3; ++d)
                        freedom(zones.holds(d) ? HUGE_VAL : mass);
        return at->second;
    };
    const auto add = [&](Element e) {
        for (std::size_t i = 0; i < e.degrees.size(); ++i)
            share[e.degrees[i]] += e.stiffness(i, i);
        elements.push_back(std::move(e));
    };

    eachJoint(scene, [&](const yade::Interaction& interaction, const MasonryJointGeom& geom,
                         const MasonryJointPhys& phys) {
        const int ids[2] = {interaction.id1, interaction.id2};
        const std::vector<Attachment>* attachments[2] = {&geom.attachments1, &geom.attachments2};
        const Vector3r centres[2] = {geom.position1, geom.position2};
        const Matrix3r axes = geom.referenceAxes();
        Element whole; // of a joint between rigid units
        for (std::size_t p = 0; p < geom.points.size(); ++p) {
            Element e;
            std::vector<Vector3r> rows; // of the jump: its derivative by each degree
            for (int side = 0; side < 2; ++side) {
                const double sign = side ? 1 : -1;
                if (!attachments[side]->empty()) {
                    const auto& a = (*attachments[side])[p];
                    const int first = degreesOfZones(*geom.zones);
                    for (int n = 0; n < 3; ++n)
                        for (int d = 0; a.weights[n] > 0 && d < 3; ++d) {
                            e.degrees.push_back(first + 3 * a.nodes[n] + d);
                            rows.push_back(sign * a.weights[n] * axes.row(d).transpose());
                        }
                    continue;
                }
                const int first = degreesOfBody(ids[side]);
                const State& s = *scene.bodies->body[ids[side]]->state;
                const Matrix3r own = rotationRestrained(s) ? Matrix3r(Matrix3r::Identity()) : s.ori.toRotationMatrix();
                for (int d = 0; d < 6; ++d) {
                    e.degrees.push_back(first + d);
                    const Vector3r arm = geom.centre(geom.points[p]) - centres[side];
                    const Vector3r move = d < 3 ? Vector3r(Vector3r::Unit(d)) : Vector3r(own.col(d - 3).cross(arm));
                    rows.push_back(sign * (axes.transpose() * move));
                }
            }
            e.ids[0] = ids[0], e.ids[1] = ids[1];
            e.stiffness.resize(rows.size(), rows.size());
            const Vector3r k =
                geom.points[p].area * Vector3r(phys.normalStiffness, phys.shearStiffness, phys.shearStiffness);
            for (std::size_t i = 0; i < rows.size(); ++i)
                for (std::size_t j = 0; j < rows.size(); ++j)
                    e.stiffness(i, j) = rows[i].dot(k.cwiseProduct(rows[j]));
            if (geom.zones)
                add(std::move(e));
            else if (whole.degrees.empty())
                whole = std::move(e);
            else
                whole.stiffness += e.stiffness;
        }
        if (!whole.degrees.empty()) add(std::move(whole));
    });
    // Where damping brakes, it adds that share to a force, as stiffer joints and zones would.
    double damping = environmentOf(scene).damping;
    for (const auto& engine : scene.engines)
        if (auto* zones = dynamic_cast<MasonryZones*>(engine.get())) {
            damping = std::max(damping, zones->damping);
            for (const auto& unit : zones->units()) {
                const int first = degreesOfZones(*zones) + 3 * unit.firstNode;
                const auto& mesh = unit.elasticity->mesh();
                for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
                    Element e;
                    for (int node : mesh.zones[z])
                        for (int d = 0; d < 3; ++d)
                            e.degrees.push_back(first + 3 * node + d);
                    e.stiffness = unit.elasticity->stiffness(int(z));
                    e.ids[0] = e.ids[1] = unit.body;
                    add(std::move(e));
                }
            }
        }

    double highest = 0;
    int worst[2] = {-1, -1};
    for (const auto& e : elements) {
        Eigen::VectorXd scale(e.degrees.size()); // 1/sqrt of the element's share of the mass; zero where nothing moves
        for (std::size_t i = 0; i < e.degrees.size(); ++i) {
            const double part = e.stiffness(i, i) / share[e.degrees[i]];
            scale[i] = part > 0 ? 1 / std::sqrt(part * masses[e.degrees[i]]) : 0;
        }
        const Eigen::MatrixXd dynamic = scale.asDiagonal() * e.stiffness * scale.asDiagonal();
        const double value =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dynamic, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
        if (value > highest) highest = value, worst[0] = e.ids[0], worst[1] = e.ids[1];
    }
    return py::make_tuple(2 / std::sqrt((1 + damping) * highest), worst[0], worst[1]);
}

} // namespace masonry
