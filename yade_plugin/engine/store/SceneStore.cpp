// SPDX-License-Identifier: GPL-2.0-or-later
#include "SceneStore.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/Changes.hpp"
#include "engine/bodies/ClassRole.hpp"
#include "engine/bodies/Integrator.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/contacts/Contacts.hpp"
#include "engine/units/Zones.hpp"
#include <algorithm>

namespace masonry {

namespace {

// Holds the interpreter while it exists, in whatever thread.
class WithInterpreter {
public:
    WithInterpreter() : state_(PyGILState_Ensure()) {}
    ~WithInterpreter() { PyGILState_Release(state_); }
    WithInterpreter(const WithInterpreter&) = delete;
    WithInterpreter& operator=(const WithInterpreter&) = delete;

private:
    PyGILState_STATE state_;
};

// All values of a property set as bytes, so that sets with equal values can be found.
std::string valuesOf(const JointProperties& properties) {
    std::string bytes;
    const auto add = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    JointProperties::describe([&](const char*, auto member, const Property&) {
        const auto& value = properties.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_arithmetic<Value>::value)
            add(value);
        else {
            add(value.size());
            for (const auto& part : value)
                if constexpr (std::is_same<Value, std::string>::value)
                    add(part);
                else {
                    add(part.ratio);
                    add(part.damage);
                }
        }
    });
    return bytes;
}

long newRevision() {
    static long readings = 0;
    return ++readings;
}

// Whether the bodies of a scene still have the State objects that were read.
bool sameStates(const yade::Scene& scene, const BodyColumns& bodies) {
    for (const auto& body : scene.bodies->body)
        if (body && body->state.get() != (bodies.has(body->id) ? &bodies.state(body->id) : nullptr)) return false;
    return true;
}

} // namespace

SceneStore::SceneStore(yade::Scene& scene) : SceneContents(scene), life_(scene.shared_from_this()) {}

SceneStore& SceneStore::of(yade::Scene& scene) {
    // Never destroyed: what it holds may belong to Python, which ends first.
    static auto& all = *new std::vector<std::unique_ptr<SceneStore>>;
    for (auto& store : all)
        if (&store->scene_ == &scene && !store->gone()) return *store;
    // What a store of a scene that has ended holds may belong to Python, which must not end it within a run.
    if (PyGILState_Check())
        all.erase(std::remove_if(all.begin(), all.end(), [](const auto& store) { return store->gone(); }), all.end());
    all.emplace_back(new SceneStore(scene));
    return *all.back();
}

SceneStore& SceneStore::present() { return of(*Singleton<yade::Omega>::instance().getScene()); }

double SceneStore::damping() const {
    return integrator ? integrator->damping : hostIntegrator ? hostIntegrator->damping : 0;
}

yade::Vector3r SceneStore::gravity() const {
    return integrator ? integrator->gravity : hostIntegrator ? hostIntegrator->gravity : yade::Vector3r(0, 0, 0);
}

double SceneStore::inertiaFactor(int body) const { return integrator ? integrator->inertiaFactor(body) : 1; }

double SceneStore::massDamping() const { return integrator ? integrator->massDamping : 0; }

double SceneStore::stiffnessDamping() const { return loop ? loop->stiffnessDamping : 0; }

bool SceneStore::sameEngines() const {
    const auto& present = scene_.engines;
    bool same = engines_.size() == present.size();
    for (std::size_t i = 0; same && i < present.size(); ++i)
        same = engines_[i].first == present[i].get() && engines_[i].second == present[i]->dead;
    return same;
}

bool SceneStore::sameJoints() const {
    return seenChanges_ == changes && seenInteractions_ == scene_.interactions->currSize;
}

bool SceneStore::isOpenFor(const yade::Engine& engine) {
    if (openedStep_ != scene_.iter || first == &engine) return false;
    // Behind another engine of ours nothing has run since that could have changed the list, which may be long.
    const auto& present = scene_.engines;
    ++place_;
    const bool follows = place_ < present.size() && present.size() == engines_.size() &&
                         present[place_].get() == &engine && engines_[place_].first == &engine;
    if (!follows) {
        if (!sameEngines()) return false;
        place_ = 0;
        while (engines_[place_].first != &engine)
            ++place_;
    }
    return sameJoints();
}

void SceneStore::opened() {
    openedStep_ = scene_.iter;
    place_ = engines_.size();
    endsWith.reset();
    readForeignForces();
    if (integrator && !integrator->shaking.samples.empty()) integrator->shaking.act(scene_.dt, integrator->gravity);
}

void SceneStore::readEngines() {
    engines_.clear();
    loads.clear();
    allLoads.clear();
    connectors.clear();
    allConnectors.clear();
    contacts.clear();
    allContacts.clear();
    loop = nullptr;
    zones = nullptr;
    watched = foreign = false;
    integrator = nullptr;
    hostIntegrator = nullptr;
    first = last = nullptr;
    uncounted.clear();
    std::string before; // an engine of YADE that loads or moves bodies, ahead of ours
    for (const auto& engine : scene_.engines) {
        engines_.emplace_back(engine.get(), engine->dead);
        auto* load = dynamic_cast<Load*>(engine.get());
        auto* connector = dynamic_cast<Connectors*>(engine.get());
        if (load) allLoads.push_back(load);
        auto* touching = dynamic_cast<Contacts*>(engine.get());
        if (connector) allConnectors.push_back(connector);
        if (touching) allContacts.push_back(touching);
        if (engine->dead) continue;
        const auto note = [](auto*& place, auto* found) {
            if (!place) place = found;
        };
        const auto role = roleOf(*engine);
        const bool ours = isOurs(*engine);
        if (load) loads.push_back(load);
        if (connector) connectors.push_back(connector);
        if (touching) contacts.push_back(touching);
        if (role == ClassRole::Integrator && !ours)
            hostIntegrator = static_cast<const yade::NewtonIntegrator*>(engine.get());
        watched = watched || role == ClassRole::Watch;
        note(loop, dynamic_cast<JointLoop*>(engine.get()));
        note(zones, dynamic_cast<Zones*>(engine.get()));
        note(integrator, dynamic_cast<Integrator*>(engine.get()));
        if (ours && role != ClassRole::Recorder) {
            if (!first) first = engine.get();
            last = engine.get();
        } else if (role != ClassRole::ForceResetter) {
            foreign = foreign || !first;
            const auto base = engine->getBaseClassName(), name = engine->getClassName();
            const bool moved = integrator || hostIntegrator; // forces that are added from here on do nothing
            if (base == "PartialEngine" || base == "KinematicEngine" || base == "TranslationEngine" ||
                base == "RotationEngine" || (name == "PyRunner" && !moved))
                (first ? uncounted : before) = name;
        }
    }
    if (!loop && uncounted.empty()) uncounted = before;
}

// YADE's sums begin with the permanent forces. If joints run as functors, their forces are already summed with others
// when our first engine runs, so the permanent ones alone are known.
void SceneStore::readForeignForces() {
    foreignForces.clear();
    auto& forces = scene_.forces();
    const bool permanent = forces.getPermForceUsed();
    if (!(permanent || (foreign && loop)) || bodies.size() == 0) return;
    const auto on = forces.sums(bodies.size());
    for (int b = 0; b < bodies.size(); ++b) {
        if (!bodies.has(b) || bodies.isUnit[b]) continue;
        const Vector3r& force = loop ? on.forces[b] : forces.getPermForce(b);
        const Vector3r& torque = loop ? on.torques[b] : forces.getPermTorque(b);
        if (!(force.isZero(0) && torque.isZero(0))) foreignForces.push_back({b, force, torque});
    }
}

namespace {

// The bricks in two units, which monolithic joints make (JointProperties::monolithic).
std::vector<Zones::Brick> bricksOf(const std::vector<JointView>& joints) {
    std::vector<Zones::Brick> bricks;
    std::map<int, std::string> crackOf; // of every unit, the name of its monolithic joint
    for (const auto& joint : joints) {
        const auto& set = *joint.phys->propertySet();
        if (!set.monolithic) continue;
        const auto& sides = joint.geom->reference().sides;
        for (const auto& side : sides) {
            const auto [other, fresh] = crackOf.emplace(side.body, set.name);
            if (!fresh)
                throw std::invalid_argument(
                    "body " + std::to_string(side.body) + " has two joints that are monolithic, \"" + other->second +
                    "\" and \"" + set.name +
                    "\": a brick that is one block until it cracks has two units and one crack surface; use "
                    "monolithic=False for bricks of more units");
        }
        bricks.push_back({sides[0].body, sides[1].body, false});
    }
    return bricks;
}

} // namespace

void SceneStore::update(ScanScope scope) {
    if (!sameEngines()) {
        readEngines();
        checked = false;
        seenChanges_ = -1; // read anew, because other engines may move the bodies
    }
    bool sameBodies = true;
    if (scope == ScanScope::Everything || (scope == ScanScope::Step && seenStep_ != scene_.iter)) {
        sameBodies = bodies.fits(scene_);
        if (sameBodies && (scope == ScanScope::Everything || scene_.iter % 10 == 0))
            sameBodies = sameStates(scene_, bodies);
        seenStep_ = scene_.iter;
    }
    if (sameBodies && sameJoints()) return;
    checked = false;
    const WithInterpreter python; // property sets that nothing refers to any more are given back to Python
    readJoints();
    bodies.read(scene_);
    if (zones)
        for (int id : zones->bodies)
            if (id >= 0 && id < bodies.size()) bodies.isUnit[id] = true;
    if (zones) zones->takeBricks(bricksOf(joints));
    revision_ = stiffnessRevision_ = newRevision();
    seenChanges_ = changes;
    seenInteractions_ = scene_.interactions->currSize;
}

void SceneStore::gather() {
    const WithInterpreter python;
    readJoints();
    checked = false;
    seenChanges_ = -1;
}

void SceneStore::pointsChanged() {
    if (!sameJoints()) return update(ScanScope::Joints);
    const WithInterpreter python;
    groupJoints(std::move(joints), true);
    revision_ = newRevision();
}

void SceneStore::readJoints() {
    std::vector<JointView> found;
    found.reserve(scene_.interactions->currSize);
    const Zones* zonesOfJoints = nullptr;
    bool broken = false;
    for (std::size_t n = 0; n < scene_.interactions->currSize; ++n) {
        const auto& interaction = *scene_.interactions->linIntrs[n];
        const auto geom = boost::dynamic_pointer_cast<JointGeometry>(interaction.geom);
        const auto phys = boost::dynamic_pointer_cast<JointPhysics>(interaction.phys);
        if (!geom || !phys || !geom->made() || !phys->made() || geom->points() != phys->points()) {
            broken = broken || geom || phys;
            continue;
        }
        const auto& attached = geom->reference().attached;
        if (attached && zonesOfJoints && zonesOfJoints != attached->zones.get())
            throw std::invalid_argument("the joints of a scene can belong to one " + nameOf(ClassRole::Units) +
                                        " only");
        if (attached) zonesOfJoints = attached->zones.get();
        found.push_back({&interaction, geom, phys});
    }
    // A view that still has one of the old groups belongs to a joint that was taken out of the scene, or of which only
    // one half is left. With one of the latter the old groups stay readable, and checkScene() reports it.
    for (auto& kind : kinds)
        kind.shapes->left = kind.states->left = !broken;
    groupJoints(std::move(found), false);
}

// Moves joints into common groups, one for each kind. Within a kind they keep the order of the host's container. If
// nothing but points has changed, a group that keeps its joints stays as it is.
void SceneStore::groupJoints(std::vector<JointView> found, bool sameProperties) {
    struct Group {
        ElasticStiffness k;
        std::vector<std::size_t> members;
    };
    std::map<std::string, int> sets; // number of every set of values
    std::map<const PropertySet*, int> setOf;
    const auto setNumber = [&](const PropertySet* joint) {
        const auto [at, fresh] = setOf.emplace(joint, 0);
        if (fresh) at->second = sets.emplace(valuesOf(*joint), int(sets.size())).first->second;
        return at->second;
    };
    using Key = std::tuple<int, int, bool>;
    std::map<Key, std::multimap<double, std::size_t>> byStiffness; // numbers of groups, sorted by normal stiffness
    std::vector<Group> groups;
    for (std::size_t n = 0; n < found.size(); ++n) {
        const auto& [interaction, geom, phys] = found[n];
        const auto& k = phys->stiffness();
        const bool attached = geom->reference().attached != nullptr;
        auto& alike = byStiffness[{setNumber(phys->propertySet().get()), geom->points(), attached}];
        auto at = alike.lower_bound(k.normal * (1 - 2e-12));
        const auto fits = [&](std::size_t group) {
            return sameButRoundOff(groups[group].k.normal, k.normal, k.normal) &&
                   sameButRoundOff(groups[group].k.shear, k.shear, k.shear);
        };
        while (at != alike.end() && at->first <= k.normal * (1 + 2e-12) && !fits(at->second))
            ++at;
        if (at == alike.end() || !fits(at->second)) {
            at = alike.emplace(k.normal, groups.size());
            groups.push_back({k, {}});
        }
        groups[at->second].members.push_back(n);
    }

    std::vector<JointKind> made;
    for (const auto& group : groups) {
        const auto& first = found[group.members[0]];
        const int count = int(group.members.size()), points = first.geom->points();
        const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const JointKind& kind) {
            return sameProperties && kind.shapes == first.geom->group && int(kind.shapes->joints.size()) == count;
        });
        if (known != kinds.end() && std::all_of(group.members.begin(), group.members.end(),
                                                [&](std::size_t n) { return found[n].geom->group == known->shapes; })) {
            made.push_back(*known);
            kinds.erase(known);
            continue;
        }
        JointKind kind{shared_ptr<JointShapes>(new JointShapes(count, points)),
                       shared_ptr<JointStates>(new JointStates(first.phys->propertySet(), group.k, count, points)),
                       first.geom->reference().attached != nullptr};
        kind.states->shapes = kind.shapes;
        kind.shapes->law = kind.states->columns.unsynchronised();
        for (JointGroup* group :
             {static_cast<JointGroup*>(kind.shapes.get()), static_cast<JointGroup*>(kind.states.get())}) {
            group->scene = life_;
            group->inScene = true;
        }
        for (int j = 0; j < count; ++j) {
            const auto& joint = found[group.members[j]];
            kind.shapes->take(j, *joint.geom->group, joint.geom->index);
            kind.states->take(j, *joint.phys->group, joint.phys->index);
            joint.geom->group = kind.shapes;
            joint.phys->group = kind.states;
            joint.geom->index = joint.phys->index = j;
        }
        kind.shapes->shareShapes();
        made.push_back(kind);
    }
    for (auto& kind : kinds)
        kind.shapes->left = kind.states->left = kind.shapes->left || sameProperties;
    kinds = std::move(made);
    joints = std::move(found);
}

void SceneStore::connected() {
    connected_.clear();
    for (const auto& body : scene_.bodies->body)
        connected_.push_back(body.get());
}

std::vector<int> SceneStore::unjoinedBlocks() const {
    std::vector<int> all;
    if (connected_.empty()) return all;
    std::vector<bool> joined(scene_.bodies->body.size(), false);
    for (const auto& joint : joints)
        for (int id : {joint.interaction->id1, joint.interaction->id2})
            if (std::size_t(id) < joined.size()) joined[id] = true;
    for (std::size_t id = 0; id < joined.size(); ++id) {
        const auto& body = scene_.bodies->body[id];
        const bool block = body && isBlock(body->shape.get());
        const bool known = id < connected_.size() && connected_[id] == body.get();
        if (block && !known && !joined[id]) all.push_back(int(id));
    }
    return all;
}

} // namespace masonry
