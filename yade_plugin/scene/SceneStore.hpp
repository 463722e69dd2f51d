// The view of a scene that all engines of this plugin share: its engines, bodies and joints. It is read again when they
// have changed. It owns the columns in which the state of joints and rigid bodies lives.
#pragma once
#include "BodyColumns.hpp"
#include "Collapse.hpp"
#include "JointHome.hpp"

namespace masonry {

class MasonryEnergy;
class MasonryIntegrator;
class MasonryJointGeom;
class MasonryJointLoop;
class MasonryJointPhys;
class MasonryLoad;
class MasonryZones;

struct JointKind { // joints whose properties have equal values, and which share stiffness and number of subcontacts
    shared_ptr<JointShapes> shapes;
    shared_ptr<JointStates> states;
    bool hung; // whether a side of these joints is deformable
};

struct JointView { // a joint, with the objects by which the host holds it
    const yade::Interaction* interaction;
    shared_ptr<MasonryJointGeom> geom;
    shared_ptr<MasonryJointPhys> phys;
};

class SceneStore {
public:
    static SceneStore& of(yade::Scene&);
    static SceneStore& present(); // the store of the scene that Python works on

    // How thoroughly update() looks for changes.
    enum class Look {
        AtAll,    // at joints, bodies and their State objects
        InStep,   // at joints; at bodies once a step; at their State objects, which lie apart in memory and are hardly
                  // ever replaced, every tenth step
        AtJoints, // at joints only
    };
    // Reads again what has changed since the last time. Throws std::invalid_argument, and leaves the joints in their
    // homes, if the joints of the scene belong to more than one MasonryZones.
    void update(Look look = Look::AtAll);
    // Throws std::invalid_argument with all problems that prevent a run. Checks only when the scene has changed; the
    // time step is checked every time. In a scene without MasonryEnergy, which looks itself, it throws
    // std::runtime_error if a block has collapsed.
    void check();
    // masonry.connect() calls this when all blocks have their joints. Blocks that are added later are then reported by
    // strangers().
    void connected();

    yade::Scene& scene() const { return scene_; }
    bool gone() const { return life_.expired(); }
    // Expires when the scene ends.
    const boost::weak_ptr<yade::Factorable>& life() const { return life_; }
    // A number that changes whenever bodies or joints were read again. No two readings of any scenes have the same.
    long revision() const { return revision_; }

    // The engines of the scene that are not dead; null if there is none of a class.
    MasonryJointLoop* loop = nullptr;
    MasonryZones* zones = nullptr;
    MasonryEnergy* energy = nullptr;
    MasonryIntegrator* integrator = nullptr;
    const yade::NewtonIntegrator* hostIntegrator = nullptr;
    const yade::Engine* last = nullptr; // the last of this plugin's engines in a step; recorders do not count
    std::vector<MasonryLoad*> loads;
    std::vector<MasonryLoad*> allLoads; // also those that are dead, whose work so far counts

    BodyColumns bodies;
    CollapseWatch collapse;
    static constexpr int collapseEvery = 100; // steps between two looks at it
    std::vector<JointKind> kinds;
    std::vector<JointView> joints; // of all kinds, in the host's order

    // Ids of the blocks that were added after connect() and have no joint.
    std::vector<int> strangers() const;
    double damping() const;          // damping constant of the integrator of rigid bodies [-]
    yade::Vector3r gravity() const;  // of the integrator of rigid bodies [m/s²]
    double massDamping() const;      // of the integrator of rigid bodies [1/s]
    double stiffnessDamping() const; // of MasonryJointLoop [s]

private:
    explicit SceneStore(yade::Scene&);
    bool readEngines(); // whether the engines are others than before
    void readJoints();

    yade::Scene& scene_;
    boost::weak_ptr<yade::Factorable> life_;
    long revision_ = 0;
    long seenChanges_ = -1;                                     // value of `changes` when the joints were last read
    std::size_t seenInteractions_ = 0;                          // number of interactions when the joints were last read
    long seenStep_ = -1;                                        // step in which the bodies were last looked at
    std::vector<std::pair<const yade::Engine*, bool>> engines_; // all engines, and whether each is dead
    long seenCollapse_ = -1;                                    // step in which check() last looked for a collapse
    bool checked_ = false;                                      // whether the scene was checked since it changed
    std::vector<const yade::Body*> connected_;                  // the bodies at connected()
};

// Stands at the beginning of an engine's action. While it exists, Python's readers wait. It brings the store up to date
// and checks the scene.
class EngineTurn {
public:
    EngineTurn(yade::Scene&, const yade::Engine&);
    explicit EngineTurn(yade::Scene&); // for the functors of the host's interaction loop; does not check the scene
    ~EngineTurn();
    EngineTurn(const EngineTurn&) = delete;
    EngineTurn& operator=(const EngineTurn&) = delete;

    SceneStore* operator->() const { return store_; }
    SceneStore& store() const { return *store_; }

private:
    SceneStore* store_ = nullptr;
    const yade::Engine* engine_ = nullptr;
    int errors_; // exceptions under way when it was made, so that its end knows whether the action failed
};

} // namespace masonry
