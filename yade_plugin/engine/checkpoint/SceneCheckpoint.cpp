// SPDX-License-Identifier: GPL-2.0-or-later
#include "SceneCheckpoint.hpp"
#include "Transfer.hpp"
#include "common/Text.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/Changes.hpp"
#include "engine/bodies/ClassRole.hpp"
#include "engine/bodies/StepLock.hpp"
#include "engine/joints/Refinement.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include <map>

namespace masonry {

namespace py = boost::python;

// State of a body in a checkpoint.
struct BodyRecord {
    Vector3r position, velocity, spin, momentum;
    Vector3r force, torque;          // of the last step, so that scripts can read them after loading
    Vector3r lasting, lastingTorque; // the host's permanent force and torque
    Quaternionr orientation;
    unsigned blocked;
    bool damped;

    template <class Visit> void visitState(Visit&& visit) {
        visit(position, velocity, spin, momentum, force, torque, lasting, lastingTorque, orientation, blocked, damped);
    }
};

namespace {

std::vector<yade::Body*> bodiesOf(const yade::Scene& scene) {
    std::vector<yade::Body*> all;
    for (const auto& body : scene.bodies->body)
        if (body && body->state) all.push_back(body.get());
    return all;
}

void transferBodies(yade::Scene& scene, Transfer& to) {
    const auto bodies = bodiesOf(scene);
    auto& forces = scene.forces();
    forces.sync();
    const Vector3r none = Vector3r::Zero();
    std::vector<BodyRecord> records;
    for (const auto* body : bodies) {
        const auto& s = *body->state;
        const int id = body->id;
        records.push_back({s.pos, s.vel, s.angVel, s.angMom, forces.getForce(id), forces.getTorque(id), none, none,
                           s.ori, s.blockedDOFs, s.isDamped});
        if (forces.getPermForceUsed()) {
            records.back().lasting = forces.getPermForce(id);
            records.back().lastingTorque = forces.getPermTorque(id);
        }
    }
    to.numbers("bodies", [&](StateNumbers& n) {
        for (auto& record : records) {
            n(record);
            if (record.blocked > 63) n.refuse();
        }
    });
    if (!to.back) return;
    forces.reset(scene.iter, forces.getPermForceUsed());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        auto& s = *bodies[i]->state;
        const int id = bodies[i]->id;
        const auto& r = records[i];
        s.pos = r.position;
        s.vel = r.velocity;
        s.angVel = r.spin;
        s.angMom = r.momentum;
        s.ori = r.orientation;
        s.blockedDOFs = r.blocked;
        s.isDamped = r.damped;
        forces.addForce(id, r.force - r.lasting);
        forces.addTorque(id, r.torque - r.lastingTorque);
        if (!r.lasting.isZero(0)) forces.setPermForce(id, r.lasting);
        if (!r.lastingTorque.isZero(0)) forces.setPermTorque(id, r.lastingTorque);
    }
    forces.sync();
}

// The numbers of points come first, because all other numbers of joints follow them.
void transferJoints(SceneStore& store, Transfer& to) {
    to.numbers("points", [&](StateNumbers& n) {
        std::vector<PointCounts> points;
        for (const auto& joint : store.joints) {
            points.push_back(joint.geom->refined().points);
            n(points.back());
        }
        if (n.back && !Refinement::setPoints(store, points)) n.refuse();
    });
    if (to.back) store.pointsChanged();
    to.numbers("joints", [&](StateNumbers& n) {
        for (const auto& joint : store.joints) {
            joint.geom->group->visitState(joint.geom->index, n);
            joint.phys->group->visitState(joint.phys->index, n);
        }
    });
}

void transfer(yade::Scene& scene, Checkpoint& file, bool back) {
    Transfer to(file, back);
    to.owner = "scene.";
    to.numbers("step", [&](StateNumbers& n) {
        n(scene.iter);
        if (scene.iter < 0) n.refuse(); // an assertion of the host would end the program
    });
    to("time", scene.time);
    to("dt", scene.dt);
    transferBodies(scene, to);
    auto& store = SceneStore::of(scene);
    store.update();
    transferJoints(store, to);
    int number = 0;
    for (const auto& engine : scene.engines)
        if (auto* own = dynamic_cast<Stateful*>(engine.get())) {
            to.owner = "engine " + std::to_string(++number) + " " + engine->getClassName() + ".";
            to("dead", engine->dead);
            own->transfer(to);
        } else if (roleOf(*engine) == ClassRole::Integrator) {
            auto& host = static_cast<yade::NewtonIntegrator&>(*engine); // stages change it, too
            to.owner = "engine " + engine->getClassName() + ".";
            to("damping", host.damping);
            to("gravity", host.gravity);
        }
    for (const auto& engine : scene.engines)
        if (auto* zones = dynamic_cast<Zones*>(engine.get()))
            zones->units(); // refuses the state of another number of nodes
    if (back) ++changes;    // all engines read the scene anew
}

// A checksum of numbers and texts that do not change in a run, by which a checkpoint knows its scene.
class Fingerprint {
public:
    template <class... T> void operator()(const T&... values) { (add(values), ...); }
    std::string text() const { return std::to_string(sumOf(bytes_)); }

private:
    template <class T> void add(T value) {
        std::vector<double> numbers;
        StateNumbers to(numbers);
        to(value);
        bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
    }
    void add(Stateful* own) {
        Checkpoint all;
        Transfer to(all, false);
        if (own) own->transfer(to);
        bytes_ += all.bytes();
    }
    std::string bytes_;
};

Checkpoint captured(yade::Scene& scene) {
    Checkpoint made;
    transfer(scene, made, false);
    Fingerprint blocks, joints;
    for (const auto* body : bodiesOf(scene)) {
        const auto& s = *body->state;
        blocks(double(body->id), s.refPos, s.refOri, s.mass, s.inertia);
        if (const auto* corners = cornersOf(body->shape.get()))
            for (const auto& corner : *corners)
                blocks(corner);
        blocks(dynamic_cast<Stateful*>(body->material.get()));
    }
    std::map<const PropertySet*, double> kinds;
    auto& store = SceneStore::of(scene);
    store.update();
    for (const auto& joint : store.joints) {
        const auto& r = joint.geom->reference();
        auto* properties = joint.phys->propertySet().get();
        const auto [kind, fresh] = kinds.emplace(properties, double(kinds.size()));
        if (fresh) joints(dynamic_cast<Stateful*>(properties));
        joints(kind->second, double(joint.interaction->id1), double(joint.interaction->id2), r.normal, r.tangent,
               joint.phys->stiffness().normal, joint.phys->stiffness().shear);
        // A joint that was refined is still the one that it was made as.
        if (const auto& coarse = joint.geom->refined().coarse)
            for (const auto& point : *coarse)
                joints(point.offset, point.area);
        else
            for (int p = 0; p < joint.geom->points(); ++p)
                joints(joint.geom->offset(p), joint.geom->area(p));
        for (int side = 0; side < 2 && r.attached; ++side)
            joints(r.attached->sides[side]);
    }
    made.texts["blocks"] = blocks.text();
    made.texts["joints"] = joints.text();
    std::vector<std::string> engines;
    for (const auto& engine : scene.engines)
        if (dynamic_cast<Stateful*>(engine.get())) engines.push_back(engine->getClassName());
    made.texts["engines"] = joined(engines, ", ");
    made.texts["extra"];
    return made;
}

void compare(Checkpoint& saved, Checkpoint& here) {
    const auto refuse = [](const std::string& what) { throw std::invalid_argument("is of another scene: " + what); };
    if (saved.texts["engines"] != here.texts["engines"])
        refuse("its engines are " + saved.texts["engines"] + ", here " + here.texts["engines"]);
    if (saved.texts["blocks"] != here.texts["blocks"]) refuse("its blocks are others");
    if (saved.texts["joints"] != here.texts["joints"]) refuse("its joints are others, or have other properties");
    const auto namesOf = [](const auto& map) {
        std::string all;
        for (const auto& entry : map)
            all += entry.first + "\n";
        return all;
    };
    if (namesOf(saved.texts) != namesOf(here.texts) || namesOf(saved.numbers) != namesOf(here.numbers))
        throw std::invalid_argument("is of another version of the plugin: it holds other attributes");
}

Checkpoint read(const py::object& bytes) {
    char* data;
    Py_ssize_t size;
    if (PyBytes_AsStringAndSize(bytes.ptr(), &data, &size)) py::throw_error_already_set();
    return Checkpoint::read({data, std::size_t(size)});
}

// A state that is taken or given in the middle of a step would be that of no instant.
void refuseBeside(const std::string& what) {
    if (Singleton<yade::Omega>::instance().isRunning())
        throw std::invalid_argument("a checkpoint is " + what +
                                    " between runs: O.run() works in the background, "
                                    "call O.pause() first");
}

// Throws std::invalid_argument that begins with `what` if a number is not finite.
void refuseInfinite(const Checkpoint& state, const std::string& what) {
    for (const auto& [name, values] : state.numbers)
        for (double value : values)
            if (!std::isfinite(value)) throw std::invalid_argument(what + " at '" + name + "'");
}

yade::Scene& present() { return *Singleton<yade::Omega>::instance().getScene(); }

} // namespace

py::object saveScene(const std::string& extra) {
    refuseBeside("saved");
    const BetweenSteps still;
    auto made = captured(present());
    refuseInfinite(made, "the run has left finite numbers,");
    made.texts["extra"] = extra;
    const auto bytes = made.bytes();
    return py::object(py::handle<>(PyBytes_FromStringAndSize(bytes.data(), Py_ssize_t(bytes.size()))));
}

std::string loadScene(const py::object& bytes) {
    refuseBeside("loaded");
    const BetweenSteps still;
    auto saved = read(bytes), here = captured(present());
    refuseInfinite(saved, "is damaged: no finite number");
    compare(saved, here);
    try {
        transfer(present(), saved, true);
    } catch (...) {
        transfer(present(), here, true);
        throw;
    }
    auto& store = SceneStore::present(); // takes the velocities of the last step before a script prescribes others
    store.update();
    for (int b = 0; b < store.bodies.size(); ++b) {
        if (store.bodies.has(b)) store.bodies.take(b);
        store.bodies.forgetEarlier(b);
    }
    return saved.texts["extra"];
}

std::string savedText(const py::object& bytes) { return read(bytes).texts["extra"]; }

} // namespace masonry
