// SPDX-License-Identifier: GPL-2.0-or-later
// What the classes of this plugin that YADE sees have in common. Each lists its attributes once, for Python, dict(),
// saving, checkpoints, the check of values and the documentation.
//
// A class `T : Adapter<T, HostBase>` begins with MASONRY_CLASS or MASONRY_DISPATCHED, and defines `doc` and
//     template <class Visit> static void attributes(Visit&& visit) {
//         visit("young", &T::young, number("Pa", "Young's modulus").above(0));
//     }
// An attribute whose value lives elsewhere, as the state of a joint does, is given by two functions in place of a
// member: `visit("zones", computed(&T::zones, &T::setZones), ...)`; one that all objects share by a static member;
// state that Python does not see by a function that visits its numbers: `visit("record", &T::visitRecord, ...)`, see
// common/StateNumbers.hpp. A class may also define
//     void postLoad()                               checks and prepares the object after attributes were changed
//     std::vector<std::string> problems()           says what is wrong beyond the bounds of single attributes
//     static constexpr ClassRole declares           is its role, which an engine must have
//     std::string title()                           gives the name of the object in messages
//     template <class PyClass> static void extras(PyClass&)    adds more properties and functions for Python
#pragma once
#include "Assumptions.hpp"
#include "engine/bodies/Changes.hpp"
#include "engine/bodies/ClassRole.hpp"
#include "engine/bodies/StepLock.hpp"
#include "host/Yade.hpp"
#include <boost/mpl/vector.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/serialization/export.hpp>

namespace masonry {

struct Nothing {};
template <class Derived> struct NoRole {};

// The role of an engine, which its class declares.
template <class Derived> class DeclaredRole : public EngineWithRole {
public:
    ClassRole role() const final { return Derived::declares; }
};
template <class Derived, class Base>
using RoleOf = std::conditional_t<std::is_base_of<yade::Engine, Base>::value, DeclaredRole<Derived>, NoRole<Derived>>;

// A class whose base is a class of ours has its state from there.
template <class Base> using StateOf = std::conditional_t<std::is_base_of<Stateful, Base>::value, Nothing, Stateful>;

template <class Derived, class Base> class Adapter : public Base, public StateOf<Base>, public RoleOf<Derived, Base> {
public:
    using HostBase = Base;
    static constexpr ClassRole declares = ClassRole::None;

    std::string getClassName() const override { return Derived::className; }
    std::string getBaseClassName(unsigned i = 0) const override { return i == 0 ? Derived::baseName : ""; }
    int getBaseClassNumber() const override { return 1; }

    void postLoad() { check(); }
    std::vector<std::string> problems() const { return {}; }
    std::string title() const { return Derived::className; }
    template <class PyClass> static void extras(PyClass&) {}

    void callPostLoad() override {
        Base::callPostLoad();
        self().postLoad();
    }

    void pySetAttr(const std::string& key, const py::object& value) override {
        if (all().set(Derived::className, &self(), key, value)) return;
        const py::object mine = py::object(py::handle<>(py::borrowed(reinterpret_cast<PyObject*>(pythonClass()))));
        if (!PyObject_HasAttrString(mine.ptr(), key.c_str())) refuseAttribute(Derived::className, mine, key);
        Base::pySetAttr(key, value);
    }

    py::dict pyDict() const override {
        const BetweenSteps still;
        py::dict values;
        all().addTo(values, &const_cast<Derived&>(static_cast<const Derived&>(*this)));
        values.update(Base::pyDict());
        return values;
    }

    void pyRegisterClass(py::object scope) override {
        const py::scope here(scope);
        const py::docstring_options options(true, false, false);
        using PyClass = py::class_<Derived, shared_ptr<Derived>, py::bases<Base>, boost::noncopyable>;
        PyClass cls(Derived::className, Derived::doc);
        cls.def("__init__", initialiser(py::make_constructor(&Adapter::construct)));
        Derived standard;
        for (const auto& attribute : all())
            if (!(attribute->flags & Hidden)) addProperty(cls, *attribute, documentation(*attribute, &standard));
        cls.def("__setattr__", &Adapter::setAttribute);
        cls.def("updateAttrs", &Adapter::updateAll, py::args("values"),
                "Set several attributes from a dict, all or, with an error that tells all problems, none.");
        cls.def("properties", &Adapter::properties,
                "The description of every attribute: a list of dicts with name, unit, meaning, source, low, high, "
                "usual_low, usual_high and other_unit (the unit that an unusual value is probably given in).")
            .staticmethod("properties");
        if constexpr (notes()) {
            cls.def("assumed", &Derived::sources, "What nobody has given: a dict of attribute -> source of its value.")
                .def("assume", &Derived::assume, py::args("sources"),
                     "Note that these attributes are assumed, with the source of each, and that all others are given.");
            py::objects::add_to_namespace(
                cls, "set", py::raw_function(&Adapter::setTogether, 1),
                "Set properties together: set(friction=0.6, residualFriction=0.6). They are checked together, as "
                "values that depend on each other must be. If something is wrong, the error has all problems, and the "
                "object stays as it was. Returns the object.");
        }
        Derived::extras(cls);
    }

    template <class Archive> void serialize(Archive& ar, unsigned) {
        const BetweenSteps still;
        ar& boost::serialization::make_nvp(Derived::baseName, boost::serialization::base_object<Base>(self()));
        all().archive(&self(), ar);
        if (Archive::is_loading::value) self().postLoad();
    }

    void transfer(Transfer& to) override {
        if constexpr (std::is_base_of<Stateful, Base>::value) Base::transfer(to);
        all().transfer(&self(), to);
        if (to.back) self().postLoad();
    }

protected:
    void set(const char* name, const py::object& value) {
        py::dict one;
        one[name] = value;
        set(one);
    }

    // Throws std::invalid_argument that names all attributes out of their bounds, and all of problems().
    void check() {
        auto wrong = all().problems(&self());
        const auto more = self().problems();
        wrong.insert(wrong.end(), more.begin(), more.end());
        if (!wrong.empty()) throw std::invalid_argument(self().title() + ": " + joined(wrong, "; "));
    }

private:
    Derived& self() { return static_cast<Derived&>(*this); }

    // Whether the class notes what nobody has given.
    static constexpr bool notes() { return std::is_base_of<Assumptions, Derived>::value; }

    static const Attributes& all() {
        static const auto attributes = Attributes::of<Derived>();
        return attributes;
    }

    static PyTypeObject* pythonClass() { return py::converter::registered<Derived>::converters.get_class_object(); }

    template <class PyClass>
    static void addProperty(PyClass& cls, const Attribute& attribute, const std::string& about) {
        const auto get = py::make_function(
            [&attribute](Derived& object) {
                const BetweenSteps still;
                return attribute.value(&object);
            },
            py::default_call_policies(), boost::mpl::vector<py::object, Derived&>());
        if (attribute.flags & (ReadOnly | Shown)) {
            cls.add_property(attribute.name, get, about.c_str());
            return;
        }
        const auto set = [&attribute](Derived& object, const py::object& value) {
            try {
                object.set(attribute.name, value);
            } catch (const WrongProperties& error) {
                // a number within its own bounds, and a switch, are wrong because of other properties
                const auto& own = attribute.property;
                const bool fine =
                    own.isNumber() ? own.problem("", py::extract<double>(value)).empty() : PyBool_Check(value.ptr());
                if (!fine) throw;
                throw WrongProperties(std::string(error.what()) +
                                          "; properties that depend on each other are set together, as in joint.set(" +
                                          attribute.name + "=..., ...)",
                                      error.problems);
            }
        };
        cls.add_property(attribute.name, get,
                         py::make_function(set, py::default_call_policies(),
                                           boost::mpl::vector<void, Derived&, const py::object&>()),
                         about.c_str());
    }

    static void setAttribute(const py::object& object, const std::string& name, const py::object& value) {
        setOrRefuse(Derived::className, object, name, value);
    }

    static py::list properties() { return all().descriptions(); }

    static void updateAll(Derived& object, const py::dict& values) { object.set(values); }

    void set(const py::dict& values) {
        const BetweenSteps still;
        all().setAll(Derived::className, &self(), *this, Base::pyDict(), values);
        if constexpr (notes()) self().noteGiven(values);
    }

    static py::object setTogether(const py::tuple& args, const py::dict& values) {
        if (py::len(args) > 1)
            throw std::invalid_argument(std::string(Derived::className) + ".set takes keyword arguments only");
        static_cast<Derived&>(py::extract<Derived&>(args[0])).set(values);
        return args[0];
    }

    static shared_ptr<Derived> construct(py::tuple args, py::dict keywords) {
        shared_ptr<Derived> made(new Derived);
        made->pyHandleCustomCtorArgs(args, keywords);
        if (py::len(args) > 0)
            throw std::invalid_argument(std::string(Derived::className) + " takes keyword arguments only");
        if constexpr (notes()) made->assumed = all().defaults(Derived::className);
        if (py::len(keywords) > 0) made->set(keywords);
        return made;
    }
};

// Makes classes known to YADE, which then creates objects by their names, and adds the names to a list.
template <class... T> void enroll(std::vector<std::string>& names) {
    const auto one = [&](const char* name, ClassRole role, auto... makers) {
        Singleton<yade::ClassFactory>::instance().registerFactorable(name, makers...);
        names.push_back(name);
        if (role != ClassRole::None) declareRole(role, name);
    };
    (one(
         T::className, T::declares, [] { return static_cast<yade::Factorable*>(new T); },
         [] { return shared_ptr<yade::Factorable>(new T); }, [] { return static_cast<void*>(new T); }),
     ...);
}

// The names of a class and of its base in YADE. This macro or the next stands first in a class.
#define MASONRY_CLASS(Class, Base)                                                                                     \
public:                                                                                                                \
    static constexpr const char* className = #Class;                                                                   \
    static constexpr const char* baseName = #Base;

// These, and the number by which YADE's dispatchers know a class of materials, shapes, geometries or physics.
#define MASONRY_DISPATCHED(Class, Base)                                                                                \
    MASONRY_CLASS(Class, Base)                                                                                         \
    int& modifyClassIndex() override { return dispatchIndex(); }                                                       \
    const int& getClassIndex() const override { return dispatchIndex(); }                                              \
    const int& getBaseClassIndex(int depth) const override {                                                           \
        static yade::Base base;                                                                                        \
        return depth == 1 ? base.getClassIndex() : base.getBaseClassIndex(depth - 1);                                  \
    }                                                                                                                  \
                                                                                                                       \
private:                                                                                                               \
    static int& dispatchIndex() {                                                                                      \
        static int index = -1;                                                                                         \
        return index;                                                                                                  \
    }                                                                                                                  \
                                                                                                                       \
public:

// The two classes that a functor of YADE is for.
#define MASONRY_FOR_PAIRS(First, Second)                                                                               \
    std::string get2DFunctorType1() const override { return #First; }                                                  \
    std::string get2DFunctorType2() const override { return #Second; }                                                 \
    std::vector<std::string> getFunctorTypes() const override { return {#First, #Second}; }                            \
    std::string checkOrder() const override { return #First " " #Second; }

// The class that a functor of YADE's 3-D view draws.
#define MASONRY_DRAWS(Class)                                                                                           \
    std::string get1DFunctorType1() const override { return #Class; }                                                  \
    std::vector<std::string> getFunctorTypes() const override { return {#Class}; }                                     \
    std::string renders() const override { return #Class; }                                                            \
    void initgl() override {}

} // namespace masonry

// Makes a class known to YADE's archives, after the namespace in its header and in its source file. Its Adapter is
// compiled there alone.
#define MASONRY_DECLARE(Class)                                                                                         \
    extern template class masonry::Adapter<masonry::Class, masonry::Class::HostBase>;                                  \
    BOOST_CLASS_EXPORT_KEY(masonry::Class)
#define MASONRY_DEFINE(Class)                                                                                          \
    template class masonry::Adapter<masonry::Class, masonry::Class::HostBase>;                                         \
    BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Class)
