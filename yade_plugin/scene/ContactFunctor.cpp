// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactFunctor.hpp"
#include "Blocks.hpp"
#include "BodyCheck.hpp"
#include "Contacts.hpp"
#include "SceneStore.hpp"
#include "common/Text.hpp"
#include <algorithm>
#include <cmath>
#include <iostream>
#include <omp.h>
#include <set>

namespace masonry {

namespace {

std::mutex steppersMutex;
std::set<const ContactStepper*> steppers; // all that there are: the host does not say which functors stand in a loop

ContactBlock readBlock(const yade::Body& body) {
    const auto surface = blockOf(*body.shape);
    try {
        return contactBlock(surface.vertices, surface.triangles);
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("contacts: body " + std::to_string(body.id) + ": " + error.what());
    }
}

ContactBody bodyOf(const yade::State& s, const Matrix3r& turn) {
    return {turn, s.pos, s.vel, s.angVel, s.mass, s.inertia, s.blockedDOFs};
}

double potentialOf(const ContactGeometry& geom, const ContactBlock& one, const ContactBlock& other) {
    OverlapFinder finder;
    finder.provideFor(one);
    finder.provideFor(other);
    return finder.potential(one, other, geom.pose);
}

} // namespace

// ---- geometry -----------------------------------------------------------------------------------------------------

double ContactGeometry::potential() {
    if (!touches) return 0;
    if (blocks[0] && blocks[1]) return potentialOf(*this, *blocks[0], *blocks[1]);
    const auto& scene = *Singleton<yade::Omega>::instance().getScene();
    return potentialOf(*this, readBlock(bodyAt(scene, id1, "contact: body")),
                       readBlock(bodyAt(scene, id2, "contact: body")));
}

namespace {

// Calls visit(number) for every number of a record.
template <class Visit> void eachNumber(ContactGeometry& g, Visit&& visit) {
    const auto all = [&](auto& matrix) {
        for (int i = 0; i < matrix.size(); ++i)
            visit(matrix.data()[i]);
    };
    all(g.turns[0]);
    all(g.turns[1]);
    all(g.place);
    all(g.pose.turn);
    all(g.pose.place);
    all(g.overlap.force);
    all(g.overlap.normal);
    all(g.overlap.centre);
    visit(g.overlap.area);
}

constexpr std::size_t wholeNumbers = 4, numbersOfGeometry = 9 + 9 + 3 + 9 + 3 + 3 + 3 + 3 + 1;

} // namespace

std::vector<double> ContactGeometry::record() {
    std::vector<double> all{double(id1), double(id2), double(axis), double(touches)};
    eachNumber(*this, [&](double number) { all.push_back(number); });
    return all;
}

void ContactGeometry::setRecord(const std::vector<double>& all) {
    if (all.size() != wholeNumbers + numbersOfGeometry)
        throw std::runtime_error("saved file is damaged at the geometry of a contact");
    id1 = int(all[0]);
    id2 = int(all[1]);
    axis = int(all[2]);
    touches = all[3] != 0;
    auto next = all.begin() + wholeNumbers;
    eachNumber(*this, [&](double& number) { number = *next++; });
}

// ---- physics ------------------------------------------------------------------------------------------------------

std::vector<double> ContactPhysics::record() {
    std::vector<double> all(memory.begin(), memory.end());
    all.insert(all.end(), effect.wrench.force.data(), effect.wrench.force.data() + 3);
    return all;
}

void ContactPhysics::setRecord(const std::vector<double>& all) {
    if (all.size() != PairMemory::numbers + 3)
        throw std::runtime_error("saved file is damaged at the state of a contact");
    std::copy_n(all.begin(), PairMemory::numbers, memory.begin());
    std::copy_n(all.begin() + PairMemory::numbers, 3, effect.wrench.force.data());
}

// ---- what is refused ----------------------------------------------------------------------------------------------

namespace {

// An engine that stands first in the step after a refusal, throws its sentence and takes itself out again. It is in no
// scene between two runs, so neither files nor Python know it.
class Refusal : public yade::GlobalEngine {
public:
    Refusal(const std::string& sentence, const std::vector<shared_ptr<yade::Engine>>& engines)
        : sentence_(sentence), engines_(engines) {}
    bool isActivated() override { return true; }
    void action() override {
        scene->nextEngines = engines_;
        throw std::invalid_argument(sentence_);
    }

private:
    const std::string sentence_;
    const std::vector<shared_ptr<yade::Engine>> engines_;
};

std::mutex refusing;

} // namespace

void refuseScene(yade::Scene& scene, const std::string& sentence) {
    const std::lock_guard<std::mutex> held(refusing);
    if (!scene.nextEngines.empty()) return; // there is one already, or the engines are about to be others
    std::cerr << "error: " + sentence + "\n" << std::flush;
    scene.nextEngines = scene.engines;
    scene.nextEngines.insert(scene.nextEngines.begin(), shared_ptr<yade::Engine>(new Refusal(sentence, scene.engines)));
}

// The first pair of a step looks whether anything is wrong with the scene.
void ContactSearch::beginStep(yade::Scene& scene) {
    const std::lock_guard<std::mutex> held(mutex_);
    if (begunStep_ == scene.iter) return;
    begunStep_ = scene.iter;
    SceneStore::of(scene).contactStep = scene.iter;
    if (scene.isPeriodic)
        refuseScene(scene, "O.periodic: contacts of blocks do not reach across a periodic cell; set it to False");
    const auto& bodies = scene.bodies->body;
    if (checkedBodies_ == bodies.size()) return;
    checkedBodies_ = bodies.size();
    std::string collider;
    for (const auto& engine : scene.engines)
        if (!engine->dead && engine->getClassName().find("Collider") != std::string::npos)
            collider = engine->getClassName();
    for (const auto& body : bodies) {
        if (!body || !body->shape) continue;
        const auto name = "contacts: body " + std::to_string(body->id);
        if (!isBlock(body->shape.get())) {
            if (body->bound)
                refuseScene(scene, name + " has the shape " + body->shape->getClassName() +
                                       ", which blocks would go through: make it a block, or take the Bo1 functor of "
                                       "its shape out");
            continue;
        }
        if (const auto wrong = problemsOf(*body); !wrong.empty()) refuseScene(scene, "contacts: " + wrong.front());
        if (!body->bound && !collider.empty())
            refuseScene(scene, name + " has no bound, so " + collider + " does not see it: set O.bodies[" +
                                   std::to_string(body->id) +
                                   "].bounded = True, and give the collider the Bo1 functor of its shape");
    }
}

// ---- search -------------------------------------------------------------------------------------------------------

namespace {

// Whether both stand for one object. A shape may belong to Python, which must not be the one to end it within a step or
// while a scene ends, so nothing here owns one.
bool isSame(const boost::weak_ptr<yade::Shape>& known, const shared_ptr<yade::Shape>& shape) {
    return !known.owner_before(shape) && !shape.owner_before(known);
}

// The finder of this thread, with memory for these blocks.
OverlapFinder& finderFor(const ContactBlock& one, const ContactBlock& other) {
    struct Finder {
        OverlapFinder finder;
        int corners = 0, faces = 0;
    };
    static thread_local Finder own;
    for (const auto* block : {&one, &other})
        if (block->cornerCount() > own.corners || block->faceCount() > own.faces) {
            own.finder.provideFor(*block);
            own.corners = std::max(own.corners, block->cornerCount());
            own.faces = std::max(own.faces, block->faceCount());
        }
    return own.finder;
}

} // namespace

std::shared_ptr<const ContactBlock> ContactSearch::blockOf(const yade::Scene& scene, int id,
                                                           const shared_ptr<yade::Shape>& shape) {
    const std::lock_guard<std::mutex> held(mutex_);
    auto& known = known_[shape.get()];
    if (!known.block || !isSame(known.shape, shape))
        known = {shape, std::make_shared<const ContactBlock>(readBlock(bodyAt(scene, id, "contacts: body")))};
    return known.block;
}

bool ContactSearch::find(yade::Scene& scene, const yade::Interaction& interaction,
                         const shared_ptr<yade::Shape>& shape1, const shared_ptr<yade::Shape>& shape2,
                         const yade::State& state1, const yade::State& state2, ContactGeometry& g) {
    if (begunStep_ != scene.iter) beginStep(scene);
    if (!isSame(g.shapes[0], shape1) || !isSame(g.shapes[1], shape2)) {
        try {
            g.blocks[0] = blockOf(scene, interaction.id1, shape1);
            g.blocks[1] = blockOf(scene, interaction.id2, shape2);
        } catch (const std::invalid_argument& error) {
            refuseScene(scene, error.what());
            return false;
        }
        g.shapes[0] = shape1;
        g.shapes[1] = shape2;
    }
    g.id1 = interaction.id1;
    g.id2 = interaction.id2;
    g.turns[0] = state1.ori.toRotationMatrix();
    g.turns[1] = state2.ori.toRotationMatrix();
    g.place = state1.pos;
    g.pose = relativePose(g.turns[0], state1.pos, g.turns[1], state2.pos);
    g.touches = finderFor(*g.blocks[0], *g.blocks[1]).find(*g.blocks[0], *g.blocks[1], g.pose, g.axis, g.overlap);
    if (!g.touches) g.overlap.area = 0;
    return true;
}

// ---- law ----------------------------------------------------------------------------------------------------------

ContactStepper::ContactStepper() {
    const std::lock_guard<std::mutex> held(steppersMutex);
    steppers.insert(this);
}

ContactStepper::~ContactStepper() {
    const std::lock_guard<std::mutex> held(steppersMutex);
    steppers.erase(this);
}

bool hasContactFunctor(const yade::Scene& scene) {
    const std::lock_guard<std::mutex> held(steppersMutex);
    return std::any_of(steppers.begin(), steppers.end(), [&](const auto* one) { return one->givenScene() == &scene; });
}

bool ContactStepper::act(yade::Scene& scene, const yade::Interaction& interaction, ContactGeometry& geom,
                         ContactPhysics& phys) {
    const auto& bodies = scene.bodies->body;
    const auto &state1 = *bodies[std::size_t(interaction.id1)]->state,
               &state2 = *bodies[std::size_t(interaction.id2)]->state;
    if (!(phys.normalStiffness > 0)) return true; // the scene has been refused
    auto& effect = phys.effect;
    effect.touches = geom.touches;
    const auto one = bodyOf(state1, geom.turns[0]), other = bodyOf(state2, geom.turns[1]);
    actOnPair(phys, {*geom.blocks[0], *geom.blocks[1], one, other, geom.pose, Vector3r::Zero()}, scene.dt, geom.overlap,
              finderFor(*geom.blocks[0], *geom.blocks[1]), phys.memory, effect);
    auto& sums = sums_[std::size_t(omp_get_thread_num() % mostThreads)];
    sums.friction += effect.lost;
    sums.damping += effect.damped;
    if (effect.acts) {
        const auto& [force, torques] = effect.wrench;
        auto& forces = scene.forces();
        forces.addForce(interaction.id1, -force);
        forces.addForce(interaction.id2, force);
        forces.addTorque(interaction.id1, torques[0]);
        forces.addTorque(interaction.id2, torques[1]);
    }
    return effect.touches;
}

double ContactStepper::sumOf(double Sums::*which) const {
    double sum = 0;
    for (const auto& one : sums_)
        sum += one.*which;
    return sum;
}

void ContactStepper::setSum(double Sums::*which, double value) {
    for (auto& one : sums_)
        one.*which = 0;
    sums_.front().*which = value;
}

double ContactStepper::stored(yade::Scene& scene) {
    double sum = 0;
    for (std::size_t n = 0; n < scene.interactions->currSize; ++n) {
        const auto& i = *scene.interactions->linIntrs[n];
        auto* geom = dynamic_cast<ContactGeometry*>(i.geom.get());
        const auto* phys = dynamic_cast<const ContactPhysics*>(i.phys.get());
        if (!geom || !phys || !geom->touches) continue;
        sum += phys->normalStiffness * geom->potential() + energyBesidePotential(phys->memory);
    }
    return sum;
}

double timeStepOf(const ContactParameters& given) {
    auto& store = SceneStore::present();
    store.update();
    Contacts contacts; // as the engine would find it
    static_cast<ContactParameters&>(contacts) = given;
    const double eigenvalue = contacts.largestEigenvalue(store, true) * (1 + store.damping());
    const double damping = contacts.largestDampingRatio();
    return eigenvalue > 0 ? (std::sqrt(1 + damping * damping) - damping) * 2 / std::sqrt(eigenvalue) : HUGE_VAL;
}

} // namespace masonry
