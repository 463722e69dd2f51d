// SPDX-License-Identifier: GPL-2.0-or-later
// The Python module masonry._masonry. When it is imported it checks whether it fits the running YADE, and registers its
// classes there.
#include "adapters/Connecting.hpp"
#include "adapters/FunctorOfLaw.hpp"
#include "adapters/Gl1_MasonryBlock.hpp"
#include "adapters/Gl1_MasonryJointPhys.hpp"
#include "adapters/GlExtra_MasonryLegend.hpp"
#include "adapters/Ig2_MasonryBlock_Polyhedra_MasonryJointGeom.hpp"
#include "adapters/Ig2_Polyhedra_Polyhedra_MasonryJointGeom.hpp"
#include "adapters/MasonryBlock.hpp"
#include "adapters/MasonryContacts.hpp"
#include "adapters/MasonryEnergy.hpp"
#include "adapters/MasonryIntegrator.hpp"
#include "adapters/MasonryJointLoop.hpp"
#include "adapters/MasonryLoad.hpp"
#include "adapters/MasonrySprings.hpp"
#include "adapters/MasonryTies.hpp"
#include "adapters/MasonryVtkRecorder.hpp"
#include "adapters/MasonryZones.hpp"
#include "common/Memory.hpp"
#include "common/Parallel.hpp"
#include "common/Text.hpp"
#include "engine/bodies/StepLock.hpp"
#include "engine/checkpoint/SceneCheckpoint.hpp"
#include "engine/joints/Neighbours.hpp"
#include "engine/joints/Resultant.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/watch/CriticalTimeStep.hpp"
#include "engine/watch/ElasticSolution.hpp"
#include "host/SelfCheck.hpp"

namespace {

using namespace masonry;

// Converts lists between C++ and Python for a type for which the host has no such converter.
template <class Of> struct Sequence {
    using List = std::vector<typename Of::Type>;
    static PyObject* convert(const List& values) {
        py::list all;
        for (const auto& value : values)
            all.append(Of::toPython(value));
        return py::incref(all.ptr());
    }
    static void* convertible(PyObject* object) {
        if (!PySequence_Check(object) || PyUnicode_Check(object)) return nullptr;
        const py::object sequence{py::handle<>(py::borrowed(object))};
        for (py::ssize_t i = 0; i < py::len(sequence); ++i)
            if (!Of::fits(sequence[i])) return nullptr;
        return object;
    }
    static void construct(PyObject* object, py::converter::rvalue_from_python_stage1_data* data) {
        void* place = reinterpret_cast<py::converter::rvalue_from_python_storage<List>*>(data)->storage.bytes;
        auto* values = new (place) List;
        data->convertible = place;
        const py::object sequence{py::handle<>(py::borrowed(object))};
        for (py::ssize_t i = 0; i < py::len(sequence); ++i)
            values->push_back(Of::fromPython(sequence[i]));
    }
    static void enroll() {
        py::to_python_converter<List, Sequence>();
        py::converter::registry::push_back(&convertible, &construct, py::type_id<List>());
    }
};

struct Rows {
    using Type = TableRow;
    static py::object toPython(const Type& row) { return py::make_tuple(row.ratio, row.damage); }
    static bool fits(const py::object& row) {
        return PySequence_Check(row.ptr()) && py::len(row) == 2 && py::extract<double>(row[0]).check() &&
               py::extract<double>(row[1]).check();
    }
    static Type fromPython(const py::object& row) { return {py::extract<double>(row[0]), py::extract<double>(row[1])}; }
};
struct Joints {
    using Type = shared_ptr<MasonryJoint>;
    static py::object toPython(const Type& joint) { return py::object(joint); }
    static bool fits(const py::object& joint) { return !joint.is_none() && py::extract<Type>(joint).check(); }
    static Type fromPython(const py::object& joint) { return py::extract<Type>(joint); }
};

py::tuple criticalTimeStep() {
    const StillScene scene;
    const double limit = timeStepLimit(*scene, true);
    const auto [id1, id2] = limitingBodies(*scene);
    return py::make_tuple(limit, id1, id2);
}

double presentLimit() { return timeStepLimit(*StillScene(), true); }

py::dict bodyEigenvalues() {
    py::dict all;
    for (const auto& [body, value] : eigenvaluesOfBodies(*StillScene()))
        all[body] = value;
    return all;
}

// How many threads may be used, and what steps took on them.
py::list threads() {
    const BetweenSteps still;
    py::list all;
    for (const auto& record : Parallel::instance().choice().records()) {
        py::dict one;
        one["threads"] = record.threads;
        one["steps"] = record.steps;
        one["time"] = record.time;
        all.append(one);
    }
    return all;
}

void allowThreads(int most, bool always) {
    const BetweenSteps still;
    Parallel::instance().allow(most, always);
}

py::tuple presentNeighbours(double tolerance, bool keepFaces) {
    return neighbours(tolerance, keepFaces ? &SceneStore::present().kept<SharedFaces>() : nullptr);
}

void dropFaces() { SceneStore::present().kept<SharedFaces>() = {}; }

py::object touchingPairs(double tolerance) { return neighbours(tolerance, nullptr)[0]; }

void connected() {
    StillScene()->connected();
    giveMemoryBack();
}

} // namespace

// Raises an error of Python that has these attributes.
template <class... Named> void raise(PyObject* type, const char* message, const Named&... attributes) {
    py::object error(py::handle<>(PyObject_CallFunction(type, "s", message)));
    ((error.attr(attributes.first) = attributes.second), ...);
    PyErr_SetObject(type, error.ptr());
}

void raiseEnded(const RunEnded& ended) {
    raise(PyExc_RuntimeError, ended.what(), std::pair("code", ended.code), std::pair("block", ended.block));
}

void raiseWrong(const WrongProperties& wrong) {
    py::list problems;
    for (const auto& problem : wrong.problems) {
        py::dict one;
        one["property"] = problem.property;
        one["code"] = problem.code;
        one["text"] = problem.text;
        problems.append(one);
    }
    raise(PyExc_ValueError, wrong.what(), std::pair("problems", problems));
}

static void registerAll() {
    py::register_exception_translator<WrongProperties>(&raiseWrong);
    py::register_exception_translator<RunEnded>(&raiseEnded);
    Sequence<Rows>::enroll();
    Sequence<Joints>::enroll();

    std::vector<std::string> names;
    enroll<MasonryMat, MasonryBlock, MasonryJoint, MasonryJointGeom, MasonryJointPhys>(names);
    enroll<Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom, Ip2_MasonryMat_MasonryMat_MasonryJointPhys>(names);
    if (host::has("Polyhedra"))
        enroll<Ig2_MasonryBlock_Polyhedra_MasonryJointGeom, Ig2_Polyhedra_Polyhedra_MasonryJointGeom>(names);
    for (const auto enrolment : enrolmentsOfFunctors())
        enrolment(names);
    enroll<Gl1_MasonryBlock, Gl1_MasonryJointPhys, GlExtra_MasonryLegend>(names);
    enroll<MasonryZones, MasonryJointLoop, MasonryTies, MasonrySprings, MasonryContacts, MasonryLoad, MasonryEnergy,
           MasonryIntegrator, MasonryVtkRecorder>(names);
    Singleton<yade::Omega>::instance().buildDynlibDatabase(names);
    yade::OpenGLRenderer::initDone = false;

    py::list classes;
    for (const auto& name : names)
        classes.append(name);
    py::scope().attr("classes") = classes;
    py::scope().attr("commit") = MASONRY_COMMIT;
    py::scope().attr("version") = MASONRY_VERSION;
    py::def(
        "neighbours", &presentNeighbours, (py::arg("tolerance") = 1e-4, py::arg("keepFaces") = false),
        "Three lists for masonry.connect(): pairs (id1, id2) of bodies that share a face; pairs (id1, id2, gap, bound) "
        "that nearly share one or overlap, with the gap and the largest one accepted; (id, size) of the thinnest and "
        "of the largest block. Gaps and sizes in m. With keepFaces the joints that are made next take the faces that "
        "were found, until dropFaces() is called.");
    py::def("allowThreads", &allowThreads, (py::arg("most"), py::arg("always") = false),
            "Let steps use so many threads [-] where that is quicker, or always. For masonry.model.threads.");
    py::def(
        "threads", &threads,
        "For every number of threads that steps may use: threads [-], steps taken on them, time in their loops [s].");
    py::def("dropFaces", &dropFaces, "Free the memory of the faces that neighbours() has kept. For masonry.connect().");
    py::def("touchingPairs", &touchingPairs, (py::arg("tolerance") = 1e-4),
            "Pairs (id1, id2) of blocks that share a face; tolerance as in "
            "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.");
    py::def(
        "criticalTimeStep", &criticalTimeStep,
        "(dt, id1, id2): the stable time step [s] under the damping of O.engines, at most 1.1 % below the limit, and "
        "the pair of bodies whose joint sets it (twice the same for a deformable unit). Ask again after changing "
        "joints, masses, blocked motions or damping.");
    py::def("timeStepLimit", &presentLimit,
            "The first number of criticalTimeStep() [s], in half the time. For masonry.model.structure.");
    py::class_<ElasticSolution, boost::noncopyable>(
        "ElasticSolution", "Equilibrium of the scene while joints and units stay elastic. For masonry.stages.rest.")
        .def("move", &ElasticSolution::move,
             "Move all to where the forces of the last step, in which nothing has moved, would be in equilibrium. "
             "Returns the square root of the work of what was not in equilibrium [J^(1/2)].")
        .def("findMode", &ElasticSolution::findMode, py::args("direction"),
             "Find the first mode along a direction. Returns the square of its angular frequency [1/s²], 0 if there is "
             "none.")
        .def("participation", &ElasticSolution::participation,
             "Momentum of the mode along its direction per its velocity [kg^(1/2)].")
        .def("displace", &ElasticSolution::displace, py::args("amount"), "Move all along the mode [m kg^(1/2)].")
        .def("force", &ElasticSolution::force, "Force of the last step along the mode [N/kg^(1/2)].");
    py::def(
        "bodyEigenvalues", &bodyEigenvalues,
        "By the id of every rigid body with a joint the largest eigenvalue of its vibration while all others are held "
        "[1/s²]. For masonry.model.scheme.");
    py::def("connect", &connect, py::args("pairs", "geometry", "physics", "rule"),
            "Make the joints of pairs of bodies. Returns the interactions, the MasonryJoint objects that they have, "
            "and what is "
            "wrong; then no joint is left. For masonry.connect().");
    py::def(
        "connected", &connected,
        "Tell the plugin that all blocks have their joints. A block that is added later and has no joint is then an "
        "error. For masonry.connect().");
    py::def(
        "resultant", &resultant, py::args("interactions", "signs", "about"),
        "(force, moment) of joints together, global axes: the forces on their first bodies [N] and their moment about "
        "a point in space [N m], each joint times its sign; -1 gives those on its second body. Forces act at the "
        "present places.");
    py::def("saveScene", &saveScene, py::args("extra"),
            "The state of the scene as bytes, together with a text of the caller.");
    py::def("loadScene", &loadScene, py::args("bytes"), "Set the scene to a saved state; returns the caller's text.");
    py::def("savedText", &savedText, py::args("bytes"), "The caller's text in a saved state.");
}

// Written in place of BOOST_PYTHON_MODULE, which gives Python the module even when its body has failed. An import into
// a YADE that does not fit must raise an error and register nothing.
extern "C" PyObject* PyInit__masonry() {
    std::vector<std::string> differences;
    if (py::handle_exception([&] { differences = host::differences(); })) return nullptr;
    if (!differences.empty()) {
        const auto message = "this YADE does not fit the masonry plugin, which knows YADE " + host::knownVersions() +
                             "; nothing was registered:\n  " + joined(differences);
        PyErr_SetString(PyExc_ImportError, message.c_str());
        return nullptr;
    }
    static PyModuleDef definition = {PyModuleDef_HEAD_INIT,
                                     "_masonry",
                                     "The masonry classes of YADE.",
                                     -1,
                                     nullptr,
                                     nullptr,
                                     nullptr,
                                     nullptr,
                                     nullptr};
    auto* made = py::detail::init_module(definition, &registerAll);
    if (made) StepLock::watchForks();
    return made;
}
