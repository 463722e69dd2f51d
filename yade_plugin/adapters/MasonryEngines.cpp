#include "MasonryEngines.hpp"
#include "MasonryJointGeom.hpp"
#include "MasonryJointPhys.hpp"
#include <Eigen/Eigenvalues>
#include <map>

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryLoad)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryEnergy)

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

yade::NewtonIntegrator* integratorOf(const yade::Scene& scene) {
    for (const auto& engine : scene.engines)
        if (engine->getClassName() == "NewtonIntegrator") return static_cast<yade::NewtonIntegrator*>(engine.get());
    return nullptr;
}

template <class F> void eachJoint(const yade::Scene& scene, F&& visit) {
    for (std::size_t i = 0; i < scene.interactions->currSize; ++i) {
        const auto& interaction = *scene.interactions->linIntrs[i];
        auto* geom = dynamic_cast<MasonryJointGeom*>(interaction.geom.get());
        auto* phys = dynamic_cast<MasonryJointPhys*>(interaction.phys.get());
        if (geom && phys) visit(interaction, *geom, *phys);
    }
}

} // namespace

void MasonryLoad::action() {
    if (body < 0 || std::size_t(body) >= scene->bodies->body.size() || !scene->bodies->body[body])
        throw std::invalid_argument("MasonryLoad.body " + std::to_string(body) + " does not exist");
    for (const auto& engine : scene->engines)
        if (auto* zones = dynamic_cast<MasonryZones*>(engine.get()); zones && zones->unitOf(body))
            throw std::invalid_argument("MasonryLoad.body " + std::to_string(body) +
                                        " is a deformable unit; load a rigid block joined to it");
    if (!(direction.norm() > 0)) throw std::invalid_argument("MasonryLoad.direction must not be zero");
    auto& state = *scene->bodies->body[body]->state;
    state.isDamped = false;
    arm = state.ori * state.refOri.conjugate() * (point - state.refPos);
    total = force;
    auto& forces = scene->forces();
    forces.sync();
    if (driven) {
        // The force R that gives the point its velocity after this step: d·(v + w x arm) = V with
        // v' = v + dt (F + R d)/m + dt g, w' = w + dt I^-1 (T + arm x R d).
        const auto* integrator = integratorOf(*scene);
        const Vector3r d = direction.normalized(), lever = arm.cross(d), perMass = inverseMass(state);
        const Matrix3r perInertia = inverseInertia(state);
        const Vector3r push =
            forces.getForce(body) + total + state.mass * (integrator ? integrator->gravity : Vector3r::Zero());
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
    const auto& state = *yade::Body::byId(body, Singleton<yade::Omega>::instance().getScene().get())->state;
    const Vector3r r = point - state.refPos;
    return state.pos + state.ori * state.refOri.conjugate() * r - point;
}

// The integrator's step n takes v- to v+ with the forces at x_n. Between x_n and x_n+1 a force does the work of its
// mean over both ends: half of it with v- at n, half with v+ (kept pending until n+1). With the kinetic energy m v-·v+
// / 2 the balance at x_n is then an identity, and the joints' trapezoidal work is its counterpart.
void MasonryEnergy::action() {
    const auto* integrator = integratorOf(*scene);
    const double alpha = integrator ? integrator->damping : 0, dt = scene->dt;
    const Vector3r g = integrator ? integrator->gravity : Vector3r::Zero();
    auto& forces = scene->forces();
    forces.sync();
    std::map<int, std::vector<MasonryLoad*>> loads;
    MasonryZones* zones = nullptr;
    for (const auto& engine : scene->engines)
        if (auto* load = dynamic_cast<MasonryLoad*>(engine.get()); load && !load->dead)
            loads[load->body].push_back(load);
        else if (auto* found = dynamic_cast<MasonryZones*>(engine.get()))
            zones = found;

    external += pendingExternal, damping += pendingDamping;
    pendingExternal = pendingDamping = kinetic = gravity = 0;
    for (const auto& body : scene->bodies->body) {
        if (!body || !body->state || (zones && zones->unitOf(body->id))) continue; // zones keep their own
        const State& s = *body->state;
        gravity += s.mass * g.dot(s.pos - s.refPos);
        const bool moves = (s.blockedDOFs & 63) != 63;
        if (!moves && s.vel.isZero() && s.angVel.isZero()) continue;
        const Vector3r force = forces.getForce(body->id), torque = forces.getTorque(body->id);
        const auto sign = [](double x) { return (x > 0) - (x < 0); };
        const double brake = s.isDamped ? alpha : 0;
        Vector3r vel = s.vel, angVel = s.angVel, dragTorque;
        for (int i = 0; i < 3; ++i) {
            if (blocked(s, i)) {
                external -= 0.5 * dt * s.vel[i] * (force[i] + s.mass * g[i]);
                pendingExternal -= 0.5 * dt * s.vel[i] * (force[i] + s.mass * g[i]);
                continue;
            }
            const double free = force[i] / s.mass + g[i];
            const double drag = brake * free * sign(free * (s.vel[i] + 0.5 * dt * free));
            vel[i] += dt * (free - drag);
            damping += 0.5 * dt * s.mass * drag * s.vel[i];
            pendingDamping += 0.5 * dt * s.mass * drag * vel[i];
            kinetic += 0.5 * s.mass * s.vel[i] * vel[i];
        }
        // With a blocked rotation the integrator damps accelerations about the global axes, without it the torque.
        const bool restrained = rotationRestrained(s);
        for (int i = 0; i < 3; ++i) {
            const double free = torque[i] / s.inertia[i];
            dragTorque[i] = brake * torque[i] * sign(torque[i] * (s.angVel[i] + (restrained ? 0.5 * dt * free : 0)));
            if (!blocked(s, 3 + i)) continue;
            external -= 0.5 * dt * s.angVel[i] * torque[i];
            pendingExternal -= 0.5 * dt * s.angVel[i] * torque[i];
            dragTorque[i] = 0;
        }
        if (restrained) {
            for (int i = 0; i < 3; ++i)
                if (!blocked(s, 3 + i)) {
                    angVel[i] += dt * (torque[i] - dragTorque[i]) / s.inertia[i];
                    kinetic += 0.5 * s.inertia[i] * s.angVel[i] * angVel[i];
                }
        } else {
            const Matrix3r axes = s.ori.toRotationMatrix();
            angVel += dt * (inverseInertia(s) * (torque - dragTorque));
            kinetic += 0.5 * (axes.transpose() * s.angVel).dot(s.inertia.cwiseProduct(axes.transpose() * angVel));
        }
        damping += 0.5 * dt * dragTorque.dot(s.angVel);
        pendingDamping += 0.5 * dt * dragTorque.dot(angVel);
        if (const auto mine = loads.find(body->id); mine != loads.end())
            for (auto* load : mine->second) {
                load->work += load->pendingWork + 0.5 * dt * load->total.dot(s.vel + s.angVel.cross(load->arm));
                load->pendingWork = 0.5 * dt * load->total.dot(vel + angVel.cross(load->arm));
            }
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
    double work = external, falls = gravity, moving = kinetic, drag = damping, inUnits = 0;
    for (const auto& engine : running.engines)
        if (const auto* load = dynamic_cast<MasonryLoad*>(engine.get()))
            work += load->work;
        else if (const auto* zones = dynamic_cast<MasonryZones*>(engine.get())) {
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
    const auto* integrator = integratorOf(scene);
    double damping = integrator ? integrator->damping : 0;
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
