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
#include <link.h>
#include <typeinfo>

namespace masonry::host {

// A class with nothing of its own: its virtual function table is the one that the compiler made of the declaration of
// T. It is exported, so that the loader gives the address and size of this table as it gives those of YADE's.
template <class T> struct __attribute__((visibility("default"))) Declared : T {};

// All classes of Yade.hpp and YadeGl.hpp that have virtual functions, but for Polyhedra, which not every YADE has, and
// InteractionContainer, of which only members are used.
#define MASONRY_HOST_TABLES(X)                                                                                         \
    X(Factorable)                                                                                                      \
    X(Serializable)                                                                                                    \
    X(State)                                                                                                           \
    X(Shape)                                                                                                           \
    X(Material)                                                                                                        \
    X(IGeom)                                                                                                           \
    X(IPhys)                                                                                                           \
    X(Interaction)                                                                                                     \
    X(Body)                                                                                                            \
    X(BodyContainer)                                                                                                   \
    X(Engine)                                                                                                          \
    X(GlobalEngine)                                                                                                    \
    X(NewtonIntegrator)                                                                                                \
    X(Scene)                                                                                                           \
    X(Functor)                                                                                                         \
    X(LawFunctor)                                                                                                      \
    X(IPhysFunctor)                                                                                                    \
    X(IGeomFunctor)                                                                                                    \
    X(GlShapeFunctor)                                                                                                  \
    X(GlIPhysFunctor)                                                                                                  \
    X(GlExtraDrawer)

#define MASONRY_MAKE_TABLE(Class) template struct Declared<yade::Class>;
MASONRY_HOST_TABLES(MASONRY_MAKE_TABLE)
#undef MASONRY_MAKE_TABLE

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
    AT(State, mass),
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

// The size of a base class is where the first member of a class of YADE that derives from it lies.
struct Size {
    const char* base;
    std::size_t size;
    const char *derived, *first;
};

const Size sizes[] = {
    {"State", sizeof(State), "CpmState", "epsVolumetric"},
    {"Shape", sizeof(Shape), "Sphere", "radius"},
    {"Material", sizeof(Material), "LudingMat", "k1"},
    {"IGeom", sizeof(IGeom), "GenericSpheresContact", "normal"},
    {"IPhys", sizeof(IPhys), "NormPhys", "kn"},
    {"Engine", sizeof(Engine), "PartialEngine", "ids"},
    {"GlobalEngine", sizeof(GlobalEngine), "PeriodicEngine", "virtPeriod"},
    {"LawFunctor", sizeof(LawFunctor), "Law2_ScGeom_CpmPhys_Cpm", "yieldSurfType"},
    {"IPhysFunctor", sizeof(IPhysFunctor), "Ip2_FrictMat_FrictMat_FrictPhys", "kn"},
    {"IGeomFunctor", sizeof(IGeomFunctor), "Ig2_Sphere_Sphere_ScGeom", "interactionDetectionFactor"},
    {"GlExtraDrawer", sizeof(GlExtraDrawer), "GlExtra_LawTester", "tester"},
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

// A virtual function table with its head: two words before the functions of each base.
struct Table {
    void* const* words = nullptr;
    std::size_t count = 0;
    void* at(std::size_t i) const { return i < count ? words[i] : nullptr; }
};
constexpr int head = 2; // words [-]: the distance to the beginning of the object, the type information

Table tableOf(const std::type_info& type) {
    Table table;
    Dl_info info{};
    void* entry = nullptr;
    void* found = dlsym(RTLD_DEFAULT, (std::string("_ZTV") + type.name()).c_str());
    if (!found || !dladdr1(found, &info, &entry, RTLD_DL_SYMENT) || !entry) return table;
    table.words = static_cast<void* const*>(found);
    table.count = static_cast<const ElfW(Sym)*>(entry)->st_size / sizeof(void*);
    return table;
}

// One of the two destructors of a class, or what shifts an object to it from a base so many bytes further on.
void* destructor(const std::type_info& type, long base, const char* kind) {
    const std::string name = type.name(), shift = base ? "Thn" + std::to_string(base) + "_" : "";
    return dlsym(RTLD_DEFAULT, ("_Z" + shift + name.substr(0, name.size() - 1) + kind).c_str());
}

std::string functionName(void* address) {
    Dl_info info{};
    return address && dladdr(address, &info) && info.dli_sname ? boost::core::demangle(info.dli_sname) : "nothing";
}

// The function without its class: a class of YADE may override what we declare for its base alone.
std::string withoutClass(const std::string& function) {
    const auto name = function.rfind("::", function.find('('));
    return name == std::string::npos ? function : function.substr(name);
}

// Compares all words of YADE's table with those that the compiler made of our declaration. Both name the same
// functions, apart from what `Declared` has of its own: destructors and type information.
void compare(const char* name, const std::type_info& real, const std::type_info& ours,
             std::vector<std::string>& wrong) {
    const Table found = tableOf(real), expected = tableOf(ours);
    long base = 0;
    for (std::size_t i = 0; i < std::max(found.count, expected.count); ++i) {
        if (found.at(i) == &real && expected.at(i) == &ours) {
            base = -reinterpret_cast<long>(found.at(i - 1));
            continue;
        }
        if (found.at(i) == expected.at(i)) continue;
        const auto both = [&](const char* kind) {
            return found.at(i) && found.at(i) == destructor(real, base, kind) &&
                   expected.at(i) == destructor(ours, base, kind);
        };
        if (both("D1Ev") || both("D0Ev")) continue;
        const auto there = functionName(found.at(i)), here = functionName(expected.at(i));
        if (withoutClass(there) == withoutClass(here)) continue;
        wrong.push_back(std::string(name) + ", virtual function " + std::to_string(long(i) - head) + " of " +
                        std::to_string(long(found.count) - head) + ": expected " + here + ", found " + there);
        return;
    }
}

// The offset [bytes] that Python reads an attribute at, or -1 if its getter is no function of Boost.Python. The
// function object holds the address of its caller after its header of 16 bytes, and the caller holds the offset after
// the address of its virtual function table.
long offsetSeenByPython(const py::object& wrapper, const char* ofClass, const char* member) {
    try {
        const py::object property = wrapper.attr(ofClass).attr("__dict__")[member];
        const py::object getter = property.attr("fget");
        if (std::strcmp(Py_TYPE(getter.ptr())->tp_name, "Boost.Python.function") != 0) return -1;
        const char* caller = *reinterpret_cast<char* const*>(reinterpret_cast<const char*>(getter.ptr()) + 16);
        return *reinterpret_cast<const long*>(caller + 8);
    } catch (const py::error_already_set&) {
        PyErr_Clear();
        return -1;
    }
}

std::string found(long offset) { return offset < 0 ? "no such data member" : "offset " + std::to_string(offset); }

// Whether an object is of the YADE class of that name; what is no object may lie there.
template <class T> bool isReally(const T* object, const char* name) {
    const auto symbol = "_ZTVN4yade" + std::to_string(std::strlen(name)) + name + "E";
    auto* const* table = static_cast<void* const*>(dlsym(RTLD_DEFAULT, symbol.c_str()));
    return object && table && *reinterpret_cast<void* const* const*>(object) == table + head;
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

    const Version* version = known(running);
    std::vector<std::string> maybeAbsent;
    for (const auto& v : versions)
        if (!version || version == &v)
            maybeAbsent.insert(maybeAbsent.end(), v.maybeAbsent.begin(), v.maybeAbsent.end());
    for (const auto& m : members) {
        if (std::count(maybeAbsent.begin(), maybeAbsent.end(), m.ofClass) && !has(m.ofClass)) continue;
        const long offset = offsetSeenByPython(wrapper, m.ofClass, m.name);
        if (offset != long(m.offset))
            wrong.push_back(std::string(m.ofClass) + "." + m.name + ": expected offset " + std::to_string(m.offset) +
                            ", found " + found(offset));
    }
    for (const auto& s : sizes) {
        const long size = offsetSeenByPython(wrapper, s.derived, s.first);
        if (size != long(s.size))
            wrong.push_back(std::string(s.base) + ": expected a size of " + std::to_string(s.size) + ", found " +
                            s.derived + "." + s.first + " at " + found(size));
    }
#define MASONRY_COMPARE(Class) compare(#Class, typeid(Class), typeid(Declared<Class>), wrong);
    MASONRY_HOST_TABLES(MASONRY_COMPARE)
#undef MASONRY_COMPARE
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
