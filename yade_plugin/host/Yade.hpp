// SPDX-License-Identifier: GPL-2.0-or-later
// The classes of YADE that this plugin touches, declared in our own words, because Debian's YADE comes without headers.
// SelfCheck.cpp names the versions whose layouts these are, with double precision, and compares them with the running
// YADE when the plugin is imported; README.md says why they are declared as they are.
//
// Each class declares its destructor before all other virtual functions and does not define it. The compiler then
// writes no virtual function table for the class and uses YADE's own, so that dispatch, dynamic_cast and saving see one
// type and not two.
#pragma once
#include <Eigen/Geometry>
#include <boost/enable_shared_from_this.hpp>
#include <boost/mpl/at.hpp>
#include <boost/mpl/vector.hpp>
#include <boost/python.hpp>
#include <boost/serialization/access.hpp>
#include <boost/shared_ptr.hpp>
#include <limits>
#include <map>
#include <omp.h>
#include <string>
#include <vector>

namespace yade {

using Real = double;
using Vector2r = Eigen::Matrix<Real, 2, 1>;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;
using boost::shared_ptr;
namespace py = boost::python;

class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
    virtual ~Factorable();
    virtual std::string getBaseClassName(unsigned = 0) const;
    virtual int getBaseClassNumber() const;
    virtual std::string getClassName() const;
};

// The functions that every serializable class of YADE overrides, in the order of its table. `serialize` is declared so
// that our classes can name their base; what runs is YADE's own function of that name, which the loader finds first.
#define MASONRY_HOST_CLASS(Class)                                                                                      \
public:                                                                                                                \
    virtual ~Class();                                                                                                  \
    std::string getBaseClassName(unsigned = 0) const override;                                                         \
    int getBaseClassNumber() const override;                                                                           \
    std::string getClassName() const override;                                                                         \
    void pySetAttr(const std::string& key, const py::object& value) override;                                          \
    py::dict pyDict() const override;                                                                                  \
    void callPostLoad() override;                                                                                      \
    void pyRegisterClass(py::object scope) override;                                                                   \
    template <class Archive> void serialize(Archive&, unsigned) {}

class Serializable : public Factorable {
public:
    virtual ~Serializable();
    std::string getBaseClassName(unsigned = 0) const override;
    int getBaseClassNumber() const override;
    std::string getClassName() const override;
    virtual void pySetAttr(const std::string& key, const py::object& value);
    virtual py::dict pyDict() const;
    virtual py::dict pyDictCustom() const;
    virtual void callPostLoad();
    virtual void checkPyClassRegistersItself(const std::string& name) const;
    virtual void pyRegisterClass(py::object scope);
    virtual void pyHandleCustomCtorArgs(py::tuple& args, py::dict& keywords);
    template <class Archive> void serialize(Archive&, unsigned) {}
};

// Numbers the classes of one kind (materials, shapes, geometries or physics); dispatchers choose a functor by these
// numbers. YADE exports no table of this class, so its functions are defined here.
class Indexable {
public:
    virtual void incrementMaxCurrentlyUsedClassIndexOfKin() { unexpected(); }
    virtual int& modifyClassIndex() { return unexpected(); }
    virtual ~Indexable() = default;
    virtual const int& getClassIndex() const { return unexpected(); }
    virtual const int& getBaseClassIndex(int) const { return unexpected(); }
    virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const { return unexpected(); }

protected:
    void createIndex() {
        int& index = modifyClassIndex();
        if (index != -1) return;
        index = getMaxCurrentlyUsedClassIndexOfKin() + 1;
        incrementMaxCurrentlyUsedClassIndexOfKin();
    }

private:
    [[noreturn]] static int& unexpected() { throw std::logic_error("class without a dispatch index"); }
};

#define MASONRY_HOST_INDEX                                                                                             \
    int& modifyClassIndex() override;                                                                                  \
    const int& getClassIndex() const override;                                                                         \
    const int& getBaseClassIndex(int depth) const override;                                                            \
    const int& getMaxCurrentlyUsedClassIndexOfKin() const override;                                                    \
    void incrementMaxCurrentlyUsedClassIndexOfKin() override;

class State : public Serializable, public Indexable {
    MASONRY_HOST_CLASS(State)
    MASONRY_HOST_INDEX
    enum : unsigned { blockX = 1, blockY = 2, blockZ = 4, blockRX = 8, blockRY = 16, blockRZ = 32 };

private:
    void *posReference_, *oriReference_;
    char updateMutex_[40];

public:
    State();
    Vector3r pos;
    Quaternionr ori;
    Vector3r vel;
    Real mass;
    Vector3r angVel, angMom, inertia, refPos;
    Quaternionr refOri;
    unsigned blockedDOFs;
    bool isDamped;
    Real densityScaling;
};

class Shape : public Serializable, public Indexable {
    MASONRY_HOST_CLASS(Shape)
#ifdef MASONRY_HOST_HAS_VOLUME // since YADE 2026.1.0; CMakeLists.txt looks for it in the YADE that is installed
    virtual Real getVolume();
#endif
    MASONRY_HOST_INDEX
private:
    shared_ptr<void> boundFunctor_, internalForceFunctor_;

public:
    Vector3r color;
    bool wire, highlight;
};

// Only a YADE that was built with CGAL has this class, so its function is a weak symbol: null where it is missing.
class Polyhedra : public Shape {
    MASONRY_HOST_CLASS(Polyhedra)
    int& modifyClassIndex() override;
    const int& getClassIndex() const override;
    const int& getBaseClassIndex(int depth) const override;
    __attribute__((weak)) std::vector<int> GetSurfaceTriangulation();

private:
    char hull_[328 - 96];

public:
    std::vector<Vector3r> v; // vertices [m], relative to the centroid, in the axes of the body
};

class Material : public Serializable, public Indexable {
    MASONRY_HOST_CLASS(Material)
    virtual shared_ptr<State> newAssocState() const;
    virtual bool stateTypeOk(State*) const;
    MASONRY_HOST_INDEX
    int id = -1;
    std::string label;
    Real density = 1000;
    Material() = default;
};

class IGeom : public Serializable, public Indexable {
    MASONRY_HOST_CLASS(IGeom)
    MASONRY_HOST_INDEX
    IGeom() = default;
};

class IPhys : public Serializable, public Indexable {
    MASONRY_HOST_CLASS(IPhys)
    MASONRY_HOST_INDEX
    IPhys() = default;
};

class Interaction : public Serializable {
    MASONRY_HOST_CLASS(Interaction)
    bool isActive;

private:
    char functorCache_[88 - 25];

public:
    int id1, id2;
    long iterMadeReal, iterLastSeen;
    shared_ptr<IGeom> geom;
    shared_ptr<IPhys> phys;
};

class Scene;

class Body : public Serializable {
    MASONRY_HOST_CLASS(Body)
    virtual void userForcedDisplacementRedrawHook();
    static const shared_ptr<Body>& byId(int id, Scene* scene);
    int id, groupMask, flags, subdomain;
    shared_ptr<Material> material;
    shared_ptr<State> state;
    shared_ptr<Shape> shape;
    shared_ptr<void> bound;
    std::map<int, shared_ptr<Interaction>> intrs;
    int clumpId;
};

class BodyContainer : public Serializable {
    MASONRY_HOST_CLASS(BodyContainer)
    std::vector<shared_ptr<Body>> body;
};

class InteractionContainer : public Serializable {
    MASONRY_HOST_CLASS(InteractionContainer)
    std::vector<shared_ptr<Interaction>> linIntrs, sortedIntrs;
    void* bodies;
    std::size_t currSize;
    bool insert(int id1, int id2); // the new interaction comes last
    bool erase(int id1, int id2, int place);
};

// No object of this class is made here: its size is not declared, and Scene::forces() gives a reference to YADE's own.
class ForceContainer {
public:
    // The sums of all forces [N] and torques [N m] so far, of bodies below `count`, each body's beside that of the
    // next. Who adds to them here need not let YADE add up what its threads have: that loop takes longer than the sums.
    struct Sums {
        Vector3r *forces, *torques;
    };
    Sums sums(int count) {
        const int threads = omp_get_max_threads();
        omp_set_num_threads(1); // YADE's threads would wait by spinning after its short loop
        sync();
        if (&getForce(count - 1) ==
            &getForce(std::numeric_limits<int>::max())) { // the zero for bodies beyond the arrays
            addForce(count - 1, Vector3r::Zero());
            addTorque(count - 1, Vector3r::Zero());
            sync();
        }
        omp_set_num_threads(threads);
        return {const_cast<Vector3r*>(&getForce(0)), const_cast<Vector3r*>(&getTorque(0))};
    }
    void addForce(int id, const Vector3r&);
    void addTorque(int id, const Vector3r&);
    void sync();
    const Vector3r& getForce(int id);
    const Vector3r& getTorque(int id);
    void setPermForce(int id, const Vector3r&);
    void setPermTorque(int id, const Vector3r&);
    bool getPermForceUsed() const;
    const Vector3r& getPermForce(int id); // only after getPermForceUsed(): before that there is no array
    const Vector3r& getPermTorque(int id);
    void reset(long iter, bool permanentToo); // needs sync() before: unsynchronised forces can survive it
};

class Engine : public Serializable {
    MASONRY_HOST_CLASS(Engine)
    virtual bool isActivated();
    virtual void action();
    Scene* scene;

private:
    long executions_;
    unsigned long long nanoseconds_;

public:
    shared_ptr<void> timingDeltas;
    bool dead;
    int ompThreads;
    std::string label;
    Engine();
};

class GlobalEngine : public Engine {
    MASONRY_HOST_CLASS(GlobalEngine)
    GlobalEngine() = default;
};

class NewtonIntegrator : public GlobalEngine {
    MASONRY_HOST_CLASS(NewtonIntegrator)
private:
    char inner_[256 - 104];

public:
    Real damping;
    Vector3r gravity;
    Real maxVelocitySq;
    bool exactAsphericalRot;
};

class Scene : public Serializable {
    MASONRY_HOST_CLASS(Scene)
private:
    char head_[32 - 24];
    char forces_[440 - 32];

public:
    Real dt;
    long iter;
    bool subStepping;
    int subStep;
    Real time, speed;
    long stopAtIter;
    Real stopAtTime;
    bool isPeriodic, trackEnergy, doSort, consistencyChecks;
    int selectedBody, subdomain;
    shared_ptr<Shape> subD;
    std::vector<std::string> tags;
    std::vector<shared_ptr<Engine>> engines, nextEngines;
    shared_ptr<BodyContainer> bodies;
    shared_ptr<InteractionContainer> interactions;
    ForceContainer& forces() { return *reinterpret_cast<ForceContainer*>(forces_); }
};

class Functor : public Serializable {
    MASONRY_HOST_CLASS(Functor)
    virtual std::vector<std::string> getFunctorTypes() const;
    shared_ptr<void> timingDeltas;
    Scene* scene = nullptr;
    std::string label;
    Functor() = default;
};

// The functions that a dispatcher calls on a functor, in the order of its table: checkOrder, then go and goReverse,
// each with one to seven arguments, of which those beyond the list of arguments are of MPL's void_. Laws and physics
// functors override the go with three arguments, geometry functors the one with seven.
template <class R, class Arguments> class FunctorWrapper {
    template <int i> using A = typename boost::mpl::at_c<Arguments, i>::type;

public:
    virtual ~FunctorWrapper() = default;
    virtual std::string checkOrder() const;
#define MASONRY_HOST_CALLS(name)                                                                                       \
    virtual R name(A<0>);                                                                                              \
    virtual R name(A<0>, A<1>);                                                                                        \
    virtual R name(A<0>, A<1>, A<2>);                                                                                  \
    virtual R name(A<0>, A<1>, A<2>, A<3>);                                                                            \
    virtual R name(A<0>, A<1>, A<2>, A<3>, A<4>);                                                                      \
    virtual R name(A<0>, A<1>, A<2>, A<3>, A<4>, A<5>);                                                                \
    virtual R name(A<0>, A<1>, A<2>, A<3>, A<4>, A<5>, A<6>);
    MASONRY_HOST_CALLS(go)
    MASONRY_HOST_CALLS(goReverse)
#undef MASONRY_HOST_CALLS
};

template <class Kind1, class Kind2, class R, class Arguments>
class Functor2D : public Functor, public FunctorWrapper<R, Arguments> {
public:
    std::vector<std::string> getFunctorTypes() const override;
    virtual std::string get2DFunctorType1() const;
    virtual std::string get2DFunctorType2() const;
};

class LawFunctor
    : public Functor2D<IGeom, IPhys, bool, boost::mpl::vector<shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*>> {
    MASONRY_HOST_CLASS(LawFunctor)
    LawFunctor() = default;
};

class IPhysFunctor : public Functor2D<Material, Material, void,
                                      boost::mpl::vector<const shared_ptr<Material>&, const shared_ptr<Material>&,
                                                         const shared_ptr<Interaction>&>> {
    MASONRY_HOST_CLASS(IPhysFunctor)
    IPhysFunctor() = default;
};

class IGeomFunctor
    : public Functor2D<Shape, Shape, bool,
                       boost::mpl::vector<const shared_ptr<Shape>&, const shared_ptr<Shape>&, const State&,
                                          const State&, const Vector3r&, const bool&, const shared_ptr<Interaction>&>> {
    MASONRY_HOST_CLASS(IGeomFunctor)
    virtual void preStep();
    IGeomFunctor() = default;
};

class ClassFactory {
public:
    bool registerFactorable(std::string name, Factorable* (*create)(), shared_ptr<Factorable> (*createShared)(),
                            void* (*createPureCustom)());
};

class Omega {
public:
    void buildDynlibDatabase(const std::vector<std::string>& names);
    const shared_ptr<Scene>& getScene() const;
    bool isRunning(); // whether O.run() works in the background
};

} // namespace yade

template <class T> class Singleton { // the object is YADE's; instance() is found in its library
public:
    static T& instance();
};

#undef MASONRY_HOST_INDEX
