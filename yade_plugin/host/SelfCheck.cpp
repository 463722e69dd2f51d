// SPDX-License-Identifier: GPL-2.0-or-later
#include "SelfCheck.hpp"
#include "YadeGl.hpp"
#include "common/Text.hpp"
#include <algorithm>
#include <boost/core/demangle.hpp>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>

// Bytes added to the expected offset of State.mass. The tests build a second module with 8, which must refuse to
// import.
#ifndef MASONRY_FALSIFY
#define MASONRY_FALSIFY 0
#endif

namespace masonry::host {

namespace {

using namespace yade;

struct Member {
    const char *ofClass, *name;
    std::size_t offset;
};

// C++ leaves offsetof open for classes with virtual functions, and GCC warns of it but gives the right value.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
#define AT(Class, member)                                                                                              \
    { #Class, #member, offsetof(Class, member) }
const Member members[] = {
    {"State", "se3", offsetof(State, pos)},
    AT(State, vel),
    {"State", "mass", offsetof(State, mass) + MASONRY_FALSIFY},
    AT(State, angVel),
    AT(State, angMom),
    AT(State, inertia),
    AT(State, refPos),
    AT(State, refOri),
    AT(State, isDamped),
    AT(State, densityScaling),
    AT(Shape, color),
    AT(Shape, wire),
    AT(Polyhedra, v),
    AT(Material, id),
    AT(Material, label),
    AT(Material, density),
    {"CpmState", "epsVolumetric", sizeof(State)}, // the first member of a derived class gives the size of its base
    {"Sphere", "radius", sizeof(Shape)},
    {"LudingMat", "k1", sizeof(Material)},
    {"NormPhys", "kn", sizeof(IPhys)},
    {"PartialEngine", "ids", sizeof(Engine)},
    AT(Body, id),
    AT(Body, groupMask),
    AT(Body, flags),
    AT(Body, material),
    AT(Body, state),
    AT(Body, shape),
    AT(Body, bound),
    AT(Body, clumpId),
    AT(Interaction, isActive),
    AT(Interaction, id1),
    AT(Interaction, id2),
    AT(Interaction, iterMadeReal),
    AT(Interaction, geom),
    AT(Interaction, phys),
    AT(Scene, dt),
    AT(Scene, iter),
    AT(Scene, time),
    AT(Scene, isPeriodic),
    AT(Scene, tags),
    AT(Engine, dead),
    AT(Engine, ompThreads),
    AT(Engine, label),
    AT(NewtonIntegrator, damping),
    AT(NewtonIntegrator, gravity),
    AT(NewtonIntegrator, exactAsphericalRot),
    AT(Functor, label),
    AT(GlExtraDrawer, dead),
};
#undef AT
#pragma GCC diagnostic pop

struct Slot {
    const char* ofClass;
    int index;
    const char* function; // part of the demangled name of the function that the slot must point to
};

const Slot slots[] = {
#ifdef MASONRY_HOST_HAS_VOLUME
    {"Shape", 12, "getVolume"},
#else
    {"Shape", 12, "modifyClassIndex"},
#endif
    {"Serializable", 2, "getBaseClassName"},
    {"Serializable", 3, "getBaseClassNumber"},
    {"Serializable", 4, "getClassName"},
    {"Serializable", 5, "pySetAttr"},
    {"Serializable", 6, "pyDict()"},
    {"Serializable", 7, "pyDictCustom"},
    {"Serializable", 8, "callPostLoad"},
    {"Serializable", 9, "checkPyClassRegistersItself"},
    {"Serializable", 10, "pyRegisterClass"},
    {"Serializable", 11, "pyHandleCustomCtorArgs"},
    {"IGeom", 12, "modifyClassIndex"},
    {"IGeom", 13, "getClassIndex"},
    {"IGeom", 14, "getBaseClassIndex"},
    {"IGeom", 15, "getMaxCurrentlyUsedClassIndexOfKin"},
    {"IGeom", 16, "incrementMaxCurrentlyUsedClassIndexOfKin"},
    {"IGeom", 19, "incrementMaxCurrentlyUsedClassIndexOfKin"},
    {"IGeom", 20, "modifyClassIndex"},
    {"IGeom", 23, "getClassIndex"},
    {"IGeom", 24, "getBaseClassIndex"},
    {"IPhys", 12, "modifyClassIndex"},
    {"IPhys", 16, "incrementMaxCurrentlyUsedClassIndexOfKin"},
    {"IPhys", 19, "incrementMaxCurrentlyUsedClassIndexOfKin"},
    {"IPhys", 24, "getBaseClassIndex"},
    {"Material", 12, "newAssocState"},
    {"Material", 13, "stateTypeOk"},
    {"Material", 14, "modifyClassIndex"},
    {"Material", 18, "incrementMaxCurrentlyUsedClassIndexOfKin"},
    {"Material", 21, "incrementMaxCurrentlyUsedClassIndexOfKin"},
    {"Material", 26, "getBaseClassIndex"},
    {"Engine", 12, "isActivated"},
    {"Engine", 13, "action"},
    {"GlobalEngine", 13, "action"},
    {"LawFunctor", 12, "getFunctorTypes"},
    {"LawFunctor", 13, "get2DFunctorType1"},
    {"LawFunctor", 14, "get2DFunctorType2"},
    {"LawFunctor", 19, "checkOrder"},
    {"LawFunctor", 22, "::go(boost::shared_ptr<yade::IGeom>&, boost::shared_ptr<yade::IPhys>&, yade::Interaction*)"},
    {"IPhysFunctor", 19, "checkOrder"},
    {"IPhysFunctor", 22,
     "::go(boost::shared_ptr<yade::Material> const&, boost::shared_ptr<yade::Material> const&, "
     "boost::shared_ptr<yade::Interaction> const&)"},
    {"GlShapeFunctor", 12, "getFunctorTypes"},
    {"GlShapeFunctor", 13, "get1DFunctorType1"},
    {"GlShapeFunctor", 14, "renders"},
    {"GlShapeFunctor", 15, "initgl"},
    {"GlShapeFunctor", 20, "checkOrder"},
    {"GlShapeFunctor", 24,
     "::go(boost::shared_ptr<yade::Shape> const&, boost::shared_ptr<yade::State> const&, bool, "
     "yade::GLViewInfo const&)"},
    {"GlIPhysFunctor", 12, "getFunctorTypes"},
    {"GlIPhysFunctor", 13, "get1DFunctorType1"},
    {"GlIPhysFunctor", 14, "renders"},
    {"GlIPhysFunctor", 15, "initgl"},
    {"GlIPhysFunctor", 20, "checkOrder"},
    {"GlIPhysFunctor", 25,
     "::go(boost::shared_ptr<yade::IPhys> const&, boost::shared_ptr<yade::Interaction> const&, "
     "boost::shared_ptr<yade::Body> const&, boost::shared_ptr<yade::Body> const&, bool)"},
    {"GlExtraDrawer", 12, "render()"},
    {"IGeomFunctor", 15, "preStep"},
    {"IGeomFunctor", 20, "checkOrder"},
    {"IGeomFunctor", 27,
     "::go(boost::shared_ptr<yade::Shape> const&, boost::shared_ptr<yade::Shape> const&, "
     "yade::State const&, yade::State const&, Eigen::Matrix<double, 3, 1, 0, 3, 1> const&, "
     "bool const&, boost::shared_ptr<yade::Interaction> const&)"},
};

// What is particular to each version that this plugin knows. README.md says how to make the entry of another one.
struct Version {
    const char *name, *release;
    std::vector<std::string> maybeAbsent; // classes that this version may have been built without
};

const Version versions[] = {
    {"2023.02a", "Debian 12", {}},
    {"2025.2.0", "Debian 13", {"Polyhedra"}}, // built without CGAL
    {"2026.1.0", "Debian forky", {"Polyhedra"}},
};

const Version* known(const std::string& name) {
    for (const auto& v : versions)
        if (v.name == name) return &v;
    return nullptr;
}

// The variable by which a user takes the word for a version that is not in the list.
constexpr const char* onOwnRisk = "MASONRY_UNKNOWN_YADE";

// Slot 0 of the virtual function table of a YADE class; null if YADE exports no such table. The two words before it
// hold the distance to the beginning of the object and the type information.
void** tableOf(const std::string& name) {
    const auto symbol = "_ZTVN4yade" + std::to_string(name.size()) + name + "E";
    auto* table = static_cast<void**>(dlsym(RTLD_DEFAULT, symbol.c_str()));
    return table ? table + 2 : nullptr;
}

// The offset [bytes] that Python reads an attribute at, or -1 if its getter is no function of Boost.Python. The
// function object holds the address of its caller after its header of 16 bytes, and the caller holds the offset after
// the address of its virtual function table.
long offsetSeenByPython(const py::object& wrapper, const Member& m) {
    const py::object property = wrapper.attr(m.ofClass).attr("__dict__")[m.name];
    const py::object getter = property.attr("fget");
    if (std::strcmp(Py_TYPE(getter.ptr())->tp_name, "Boost.Python.function") != 0) return -1;
    const char* caller = *reinterpret_cast<char* const*>(reinterpret_cast<const char*>(getter.ptr()) + 16);
    return *reinterpret_cast<const long*>(caller + 8);
}

std::string found(long offset) { return offset < 0 ? "no such data member" : "offset " + std::to_string(offset); }

// Whether an object is exactly of the YADE class of that name, by the address of its virtual function table.
template <class T> bool isReally(const T* object, const char* name) {
    return object && *reinterpret_cast<void** const*>(object) == tableOf(name);
}

// Tries out members of Scene that Python cannot see: the containers of bodies, interactions, engines and forces. This
// happens in a scene of its own, so that the user's scene stays as it is.
void probe(std::vector<std::string>& wrong, const py::object& wrapper) {
    py::object omega = wrapper.attr("Omega")();
    const py::object usersScene = omega.attr("thisScene");
    omega.attr("switchToScene")(omega.attr("addScene")());
    omega.attr("bodies").attr("append")(wrapper.attr("Body")());
    py::list engines;
    engines.append(wrapper.attr("ForceResetter")());
    omega.attr("engines") = engines;

    Scene* scene = Singleton<Omega>::instance().getScene().get();
    const auto expect = [&](bool fits, const char* what) {
        if (!fits) wrong.push_back(std::string("Scene.") + what + ", found something else");
        return fits;
    };
    if (expect(isReally(scene->bodies.get(), "BodyContainer"), "bodies: expected at offset 600"))
        expect(scene->bodies->body.size() == 1, "bodies: expected the one body of the probe");
    if (expect(isReally(scene->interactions.get(), "InteractionContainer"), "interactions: expected at offset 616"))
        expect(scene->interactions->currSize == 0, "interactions: expected none in the probe");
    expect(scene->engines.size() == 1 && isReally(scene->engines[0].get(), "ForceResetter"),
           "engines: expected the one ForceResetter of the probe at offset 552");
    scene->forces().addForce(0, Vector3r(1, 2, 4));
    scene->forces().addTorque(0, Vector3r(3, 5, 7));
    omega.attr("bodies").attr("append")(wrapper.attr("Body")());
    const auto sums = scene->forces().sums(2);
    expect(sums.forces[0] == Vector3r(1, 2, 4) && sums.torques[0] == Vector3r(3, 5, 7) &&
               sums.forces + 1 == &scene->forces().getForce(1) && sums.torques + 1 == &scene->forces().getTorque(1),
           "forces: expected the sums of all bodies beside each other");
    sums.forces[1] += Vector3r(6, 8, 9);
    scene->forces().addForce(1, Vector3r(1, 1, 1));
    const Vector3r both = py::extract<Vector3r>(omega.attr("forces").attr("f")(1, true));
    expect(both == Vector3r(7, 9, 10), "forces: expected what is added to a sum to stay in it");
    const Vector3r seen = py::extract<Vector3r>(omega.attr("forces").attr("f")(0, true));
    expect(seen == Vector3r(1, 2, 4), "forces: expected a force added at offset 32 to be seen by O.forces");

    omega.attr("switchToScene")(usersScene);
}

} // namespace

bool has(const std::string& className) {
    return PyObject_HasAttrString(py::object(py::import("yade.wrapper")).ptr(), className.c_str());
}

std::string knownVersions() {
    std::vector<std::string> all;
    for (const auto& v : versions)
        all.push_back(std::string(v.name) + " (" + v.release + ")");
    return joined(all, " and ") + ", each with double precision";
}

std::vector<std::string> differences() {
    std::vector<std::string> wrong;
    const py::object config = py::import("yade.config"), wrapper = py::import("yade.wrapper");
    const std::string running = py::extract<std::string>(config.attr("version"));
    const int digits = py::extract<int>(py::import("yade.math").attr("getDigits10")(1));
    if (digits != 15) wrong.push_back("Real: expected 15 digits (double), found " + std::to_string(digits));
    if (!wrong.empty()) return wrong;

    const Version* version = known(running);
    std::vector<std::string> maybeAbsent;
    for (const auto& v : versions)
        if (!version || version == &v)
            maybeAbsent.insert(maybeAbsent.end(), v.maybeAbsent.begin(), v.maybeAbsent.end());
    for (const auto& m : members) {
        if (std::count(maybeAbsent.begin(), maybeAbsent.end(), m.ofClass) && !has(m.ofClass)) continue;
        long offset = -1;
        try {
            offset = offsetSeenByPython(wrapper, m);
        } catch (const py::error_already_set&) {
            PyErr_Clear();
        }
        if (offset != long(m.offset))
            wrong.push_back(std::string(m.ofClass) + "." + m.name + ": expected offset " + std::to_string(m.offset) +
                            ", found " + found(offset));
    }
    for (const auto& s : slots) {
        void** table = tableOf(s.ofClass);
        Dl_info info{};
        const bool known = table && dladdr(table[s.index], &info) && info.dli_sname;
        const auto name = known ? boost::core::demangle(info.dli_sname) : std::string("nothing");
        if (name.find(s.function) == std::string::npos)
            wrong.push_back(std::string(s.ofClass) + ", virtual function " + std::to_string(s.index) + ": expected " +
                            s.function + ", found " + name);
    }
    const char* word = std::getenv(onOwnRisk);
    const bool trusted = version || (word && std::string(word) == "1");
    if (!trusted && wrong.empty())
        wrong.push_back("its layout is that of the known versions, as far as the checks see; set the environment "
                        "variable " +
                        std::string(onOwnRisk) + "=1 to use it at your own risk");
    if (!version && !wrong.empty()) wrong.insert(wrong.begin(), "YADE version: " + running + " is not known");
    if (wrong.empty()) probe(wrong, wrapper);
    if (wrong.empty() && !version) {
        const auto warning = "YADE " + running + " is not known to the masonry plugin, which knows YADE " +
                             knownVersions() + "; its layout passes every check, and " + onOwnRisk +
                             "=1 says to use it: hold its results against those of a known version";
        if (PyErr_WarnEx(PyExc_RuntimeWarning, warning.c_str(), 1)) py::throw_error_already_set();
    }
    return wrong;
}

} // namespace masonry::host
