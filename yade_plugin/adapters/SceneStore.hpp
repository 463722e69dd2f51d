// One view of a scene for all engines of this plugin, read once a change: its engines, bodies and joints. It owns the
// columns in which the state of joints and bodies lives.
#pragma once
#include "BodyColumns.hpp"
#include "JointHome.hpp"

namespace masonry {

class MasonryEnergy;
class MasonryIntegrator;
class MasonryJointGeom;
class MasonryJointLoop;
class MasonryJointPhys;
class MasonryLoad;
class MasonryZones;

struct JointKind { // joints that share properties, stiffness and number of subcontacts
    shared_ptr<JointShapes> shapes;
    shared_ptr<JointStates> states;
    bool hung; // whether a side is deformable
};

struct JointView { // a joint as the host holds it
    const yade::Interaction* interaction;
    shared_ptr<MasonryJointGeom> geom;
    shared_ptr<MasonryJointPhys> phys;
};

class SceneStore {
public:
    static SceneStore& of(yade::Scene&);
    static SceneStore& present(); // of the scene that Python sees

    // Reads what has changed since the last time. Throws std::invalid_argument, and leaves the joints where they are,
    // for a scene whose joints cannot stand together.
    enum class Look {
        AtAll,    // joints, bodies and their States
        InStep,   // joints; bodies once a step, their States every hundredth, because they hardly ever change hands
        AtJoints, // joints only
    };
    void update(Look look = Look::AtAll);
    // Throws std::invalid_argument with all that keeps the scene from being run; looks at it once a change only.
    void check();
    // All blocks have their joints: what is added later is told. For masonry.connect().
    void connected();

    yade::Scene& scene() const { return scene_; }
    bool gone() const { return life_.expired(); }
    const boost::weak_ptr<yade::Factorable>& life() const { return life_; } // of the scene
    long revision() const { return revision_; } // another number after every reading of bodies and joints, of any scene

    // Engines that are not dead, in their order; null where there is none.
    MasonryJointLoop* loop = nullptr;
    MasonryZones* zones = nullptr;
    MasonryEnergy* energy = nullptr;
    MasonryIntegrator* integrator = nullptr;
    const yade::NewtonIntegrator* hostIntegrator = nullptr;
    const yade::Engine* last = nullptr; // the last that changes state of ours
    std::vector<MasonryLoad*> loads;
    std::vector<MasonryLoad*> allLoads; // with those that are dead

    BodyColumns bodies;
    std::vector<JointKind> kinds;
    std::vector<JointView> joints; // of all kinds, in the host's order

    // Blocks that came after connect(), and have no joint.
    std::vector<int> strangers() const;
    double damping() const;         // of the rigid bodies' integrator [-]
    yade::Vector3r gravity() const; // [m/s²]

private:
    explicit SceneStore(yade::Scene&);
    bool readEngines();
    void readJoints();

    yade::Scene& scene_;
    boost::weak_ptr<yade::Factorable> life_;
    long revision_ = 0;
    long seenChanges_ = -1;
    std::size_t seenInteractions_ = 0;
    long seenStep_ = -1;                                        // step in which the bodies were last looked at
    std::vector<std::pair<const yade::Engine*, bool>> engines_; // and whether they are dead
    bool checked_ = false;
    std::vector<const yade::Body*> connected_;
};

// An engine's turn in a step: readers wait, the scene is known and fit to run.
class EngineTurn {
public:
    EngineTurn(yade::Scene&, const yade::Engine&);
    explicit EngineTurn(yade::Scene&); // before the host's interaction loop: the scene is known, but not checked
    ~EngineTurn();
    EngineTurn(const EngineTurn&) = delete;
    EngineTurn& operator=(const EngineTurn&) = delete;

    SceneStore* operator->() const { return store_; }
    SceneStore& store() const { return *store_; }

private:
    SceneStore* store_ = nullptr;
    const yade::Engine* engine_ = nullptr;
    int errors_;
};

} // namespace masonry
