// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts of blocks pair by pair in the host's InteractionLoop, in place of the engine of scene/Contacts. The loop is
// parallel, where an exception would end the program: what is wrong is written to the error stream at once and thrown
// at the beginning of the next step.
#pragma once
#include "contact/ContactParameters.hpp"
#include "host/Yade.hpp"
#include <atomic>
#include <map>
#include <memory>
#include <mutex>

namespace masonry {

using boost::shared_ptr;
using yade::Matrix3r;
using yade::Vector3r;

// The geometry of a pair whose boxes overlap. The host's IGeom of a contact derives from it.
class ContactGeometry {
public:
    int id1 = -1, id2 = -1; // of the one and of the other body
    int axis = 0;           // of OverlapFinder
    bool touches = false;
    Matrix3r turns[2] = {Matrix3r::Identity(), Matrix3r::Identity()}; // from the axes of each body to the global ones
    Vector3r place = Vector3r::Zero();                                // of the one body [m]
    RelativePose pose{Matrix3r::Identity(), Vector3r::Zero()};
    Overlap overlap{};                             // counts while they touch
    std::shared_ptr<const ContactBlock> blocks[2]; // null until the first step
    boost::weak_ptr<yade::Shape> shapes[2];        // that the blocks were made of

    Vector3r contactPoint() { return place + turns[0] * overlap.centre; }
    Vector3r normal() { return turns[0] * overlap.normal; } // from the one to the other body
    double area() { return overlap.area; }
    double depth() { return overlap.area > 0 ? overlap.force.norm() / overlap.area : 0; }
    // Of the pose in the last step, for a stiffness of 1 Pa/m [m⁴]. It reads both blocks anew.
    double potential();

    // The numbers of the last step, for saved files.
    std::vector<double> record();
    void setRecord(const std::vector<double>&);
};

// The law of a pair that touches, and its memory. The host's IPhys of a contact derives from it.
class ContactPhysics : public ContactProperties {
public:
    PairMemory memory{};
    ContactEffect effect = ContactEffect::none(); // of the last step

    Vector3r force() { return effect.wrench.force; }
    double stored() { return energyBesidePotential(memory); }
    std::vector<double> record();
    void setRecord(const std::vector<double>&);
};

// Finds the overlap of pairs. A geometry functor derives from it.
class ContactSearch {
public:
    // The overlap of a pair of blocks. False if something is wrong with the scene, which is then refused.
    bool find(yade::Scene&, const yade::Interaction&, const shared_ptr<yade::Shape>&, const shared_ptr<yade::Shape>&,
              const yade::State&, const yade::State&, ContactGeometry&);

private:
    std::shared_ptr<const ContactBlock> blockOf(const yade::Scene&, int id, const shared_ptr<yade::Shape>&);
    void beginStep(yade::Scene&);

    struct Known {
        boost::weak_ptr<yade::Shape> shape;
        std::shared_ptr<const ContactBlock> block;
    };
    std::mutex mutex_; // guards what follows; a pair needs it when its boxes begin to overlap
    std::map<const yade::Shape*, Known> known_;
    std::atomic<long> begunStep_{-1};
    std::size_t checkedBodies_ = 0;
};

// Refuses a scene from within the loop.
void refuseScene(yade::Scene&, const std::string& sentence);

// The step of pairs. A law functor derives from it.
class ContactStepper {
public:
    ContactStepper();
    virtual ~ContactStepper();
    ContactStepper(const ContactStepper&) = delete;
    ContactStepper& operator=(const ContactStepper&) = delete;
    virtual const yade::Scene* givenScene() const = 0; // the scene that the loop has set

    // Adds the forces of a pair to those of the present step. False if it no longer touches, and is to be erased.
    bool act(yade::Scene&, const yade::Interaction&, ContactGeometry&, ContactPhysics&);

    double lostInFriction() { return sumOf(&Sums::friction); } // so far [J]
    double lostInDamping() { return sumOf(&Sums::damping); }
    void setLostInFriction(const double& value) { setSum(&Sums::friction, value); }
    void setLostInDamping(const double& value) { setSum(&Sums::damping, value); }
    // Elastic energy of all contacts of a scene in the last step [J].
    static double stored(yade::Scene&);

private:
    struct alignas(64) Sums { // of a thread
        double friction = 0, damping = 0;
    };
    static constexpr int mostThreads = 256;
    double sumOf(double Sums::*) const;
    void setSum(double Sums::*, double value);
    std::vector<Sums> sums_ = std::vector<Sums>(mostThreads);
};

// Whether a law functor of contacts stands in an InteractionLoop that has run in this scene.
bool hasContactFunctor(const yade::Scene&);

// The stable time step of the rigid blocks of the present scene with these contacts and no joints [s].
double timeStepOf(const ContactParameters&);

} // namespace masonry
