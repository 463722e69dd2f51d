// SPDX-License-Identifier: GPL-2.0-or-later
// The view of a scene that all engines of this plugin share: its engines, bodies and joints, read again when they have
// changed. It owns the columns in which the state of joints and rigid bodies lives.
#pragma once
#include "RunEnded.hpp"
#include "engine/bodies/Load.hpp"
#include "engine/bodies/StepLock.hpp"
#include "engine/joints/SceneContents.hpp"
#include <map>
#include <memory>
#include <optional>
#include <typeindex>

namespace masonry {

class Integrator;
class Zones;

class SceneStore : public SceneContents {
public:
    static SceneStore& of(yade::Scene&);
    static SceneStore& present(); // the store of the scene that Python works on

    // How thoroughly update() looks for changes.
    enum class ScanScope {
        Everything, // It looks at joints, bodies and their State objects.
        Step,   // It looks at joints every time, at bodies once a step, and at their State objects every tenth step,
                // because these are hardly ever replaced and take long to reach in memory.
        Joints, // It looks at joints only.
    };
    // Reads again what has changed since the last time. Throws std::invalid_argument, and leaves the joints in their
    // groups, if they belong to more than one Zones.
    void update(ScanScope scope = ScanScope::Everything);
    // Reads the joints again of which some were given other points: their stiffness stays in the time step.
    void pointsChanged();
    // Moves the joints that are there into common groups, while masonry.connect() makes others.
    void gather();
    // masonry.connect() calls this when all blocks have their joints; unjoinedBlocks() then reports blocks that are
    // added later.
    void connected();
    bool isConnected() const { return !connected_.empty(); }

    bool gone() const { return life_.expired(); }

    // The engines of the scene that are not dead; null if there is none of a class.
    Zones* zones = nullptr;
    Integrator* integrator = nullptr;
    const yade::NewtonIntegrator* hostIntegrator = nullptr;
    const yade::Engine* first = nullptr;     // the first of this plugin's engines in a step
    const yade::Engine* last = nullptr;      // the last of this plugin's engines in a step; recorders do not count
    bool foreign = false;                    // whether engines of others stand before the first, and may load bodies
    std::vector<ForeignForce> foreignForces; // theirs and permanent ones in the present step
    std::string uncounted;                   // an engine of others whose work is not counted; empty: there is none
    std::optional<RunEnded> endsWith;        // why the run ends after this step
    bool watched = false;                    // whether an engine watches over the run: it looks for a collapse itself
    std::vector<Load*> allLoads;             // also those that are dead, whose work so far counts
    std::vector<Connectors*> allConnectors;  // likewise
    std::vector<Contacts*> allContacts;      // likewise

    // What another part keeps for this scene: one object of every type, made when it is first asked for.
    template <class Kept> Kept& kept() {
        auto& place = kept_[typeid(Kept)];
        if (!place) place = std::make_shared<Kept>();
        return *static_cast<Kept*>(place.get());
    }

    // Whether another engine has opened the present step by update() and checkBeforeStep(), and neither engines nor
    // joints have changed since.
    bool isOpenFor(const yade::Engine&);
    void opened();

    bool checked = false; // whether checkBeforeStep() has seen the scene since it changed

    // Ids of the blocks that were added after connect() and have no joint.
    std::vector<int> unjoinedBlocks() const;
    double damping() const;               // damping constant of the integrator of rigid bodies [-]
    yade::Vector3r gravity() const;       // of the integrator of rigid bodies [m/s²]
    double inertiaFactor(int body) const; // on the inertia of a body, by the integrator [-]
    double massDamping() const;           // of the integrator of rigid bodies [1/s]
    double stiffnessDamping() const;      // of the joints [s]

private:
    explicit SceneStore(yade::Scene&);
    bool sameEngines() const; // whether the engines are those that were read
    bool sameJoints() const;  // whether the joints are those that were read
    void readEngines();
    void readForeignForces();
    void readJoints();
    void groupJoints(std::vector<JointView>, bool sameProperties);

    boost::weak_ptr<yade::Factorable> life_;
    long seenChanges_ = -1;                                     // value of `changes` when the joints were last read
    std::size_t seenInteractions_ = 0;                          // number of interactions when the joints were last read
    long seenStep_ = -1;                                        // step in which the bodies were last looked at
    std::vector<std::pair<const yade::Engine*, bool>> engines_; // all engines, and whether each is dead
    std::map<std::type_index, std::shared_ptr<void>> kept_;
    long openedStep_ = -1;                     // step that was opened last
    std::size_t place_ = 0;                    // in the list of engines, of ours that found it open last
    std::vector<const yade::Body*> connected_; // the bodies at connected()
};

// The present scene, up to date and without a step, while this exists: for functions of Python.
class StillScene {
public:
    SceneStore* operator->() const { return &store_; }
    SceneStore& operator*() const { return store_; }
    explicit StillScene(SceneStore::ScanScope scope = SceneStore::ScanScope::Everything) { store_.update(scope); }

private:
    const BetweenSteps still_;
    SceneStore& store_ = SceneStore::present();
};

} // namespace masonry
