// SPDX-License-Identifier: GPL-2.0-or-later
// What the classes of this plugin that YADE sees have in common. Each class lists its attributes once, and this list
// serves Python, dict(), saving, checkpoints, the check of values and the documentation.
//
// A class `T : Adapter<T, HostBase>` defines `className`, `baseName`, `doc` and
//     template <class Visit> static void attributes(Visit&& visit) {
//         visit("young", &T::young, number("Pa", "Young's modulus").above(0));
//     }
// An attribute whose value lives elsewhere, as the state of a joint does, is given by two functions in place of a
// member: `visit("record", computed(&T::record, &T::setRecord), ...)`. A class may also define
//     void postLoad()                               checks and prepares the object after attributes were changed
//     std::vector<std::string> problems()           says what is wrong beyond the bounds of single attributes
//     std::string title()                           gives the name of the object in messages
//     template <class PyClass> static void extras(PyClass&)    adds more properties and functions for Python
#pragma once
#include "common/Property.hpp"
#include "host/Yade.hpp"
#include "scene/Changes.hpp"
#include "scene/StepGate.hpp"
#include "scene/Transfer.hpp"
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/mpl/vector.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

namespace masonry {

namespace py = boost::python;
using boost::shared_ptr;

// An attribute whose value lives elsewhere: a function that reads it, and one that sets it. Without `put` it cannot be
// set.
template <class Owner, class T> struct Computed {
    T (Owner::*get)();
    void (Owner::*put)(const T&);
};
template <class Owner, class T> Computed<Owner, T> computed(T (Owner::*get)(), void (Owner::*put)(const T&) = nullptr) {
    return {get, put};
}

template <class Object, class Owner, class T> T valueOf(Object& object, T Owner::*member) { return object.*member; }
template <class Object, class Owner, class T> T valueOf(Object& object, const Computed<Owner, T>& member) {
    return (object.*member.get)();
}
template <class Object, class Owner, class T> void give(Object& object, T Owner::*member, const T& value) {
    object.*member = value;
}
template <class Object, class Owner, class T>
void give(Object& object, const Computed<Owner, T>& member, const T& value) {
    if (member.put) (object.*member.put)(value);
}

template <class T> struct IsShared : std::false_type {};
template <class T> struct IsShared<shared_ptr<T>> : std::true_type {};
template <class T> struct IsList : std::false_type {};
template <class T> struct IsList<std::vector<T>> : std::true_type {};

template <class T> std::string expectedType() {
    if constexpr (IsList<T>::value) {
        if constexpr (IsShared<typename T::value_type>::value)
            return std::string("a list of ") + T::value_type::element_type::className;
        return std::is_same<T, std::vector<TableRow>>::value ? "a list of (ratio, damage) rows"
               : std::is_same<T, std::vector<double>>::value ? "a list of numbers"
                                                             : "a list of whole numbers";
    } else if constexpr (IsShared<T>::value)
        return T::element_type::className;
    else if (std::is_same<T, bool>::value)
        return "True or False";
    else if (std::is_integral<T>::value)
        return "a whole number";
    else if (std::is_arithmetic<T>::value)
        return "a number";
    else
        return std::is_same<T, std::string>::value ? "a text" : "a Vector3";
}

inline std::string shown(const py::object& value) {
    const std::string text = py::extract<std::string>(py::str(value));
    return text.size() > 80 ? text.substr(0, 80) + "..." : text;
}

// Converts what Python gives for an attribute to the attribute's type. Throws std::invalid_argument, which names the
// expected type and the value, where that cannot be done.
template <class T> T given(const std::string& name, const py::object& value) {
    py::extract<T> extracted(value);
    const bool fits = !std::is_arithmetic<T>::value || PyBool_Check(value.ptr()) == std::is_same<T, bool>::value;
    try {
        if (fits && extracted.check()) return extracted();
    } catch (const py::error_already_set&) { // an entry of a list has another type
        PyErr_Clear();
    } catch (const std::bad_cast&) { // a whole number is out of range
    }
    throw std::invalid_argument(name + ": expected " + expectedType<T>() + ", got " + shown(value));
}

// Raises AttributeError for an attribute that a class does not have. The message offers the nearest name that it has.
[[noreturn]] void refuseAttribute(const std::string& className, const py::object& ofClass, const std::string& name);

// The description of a property as a dict for Python.
py::dict documented(const std::string& name, const Property&);

struct Nothing {};

// A class whose base is a class of ours has its state from there.
template <class Base> using StateOf = std::conditional_t<std::is_base_of<Stateful, Base>::value, Nothing, Stateful>;

template <class Derived, class Base> class Adapter : public Base, public StateOf<Base> {
public:
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
        bool known = false;
        Derived::attributes([&](const char* name, const auto& member, const Property&, int flags = Plain) {
            if (key != name || flags & Hidden) return;
            known = true;
            const auto whole = std::string(Derived::className) + "." + key;
            if (flags & (ReadOnly | Shown)) throw std::invalid_argument(whole + " is read-only");
            using T = decltype(valueOf(self(), member));
            give(self(), member, given<T>(whole, value));
        });
        if (known) return;
        const py::object mine = py::object(py::handle<>(py::borrowed(reinterpret_cast<PyObject*>(pythonClass()))));
        if (!PyObject_HasAttrString(mine.ptr(), key.c_str())) refuseAttribute(Derived::className, mine, key);
        Base::pySetAttr(key, value);
    }

    py::dict pyDict() const override {
        const BetweenSteps still;
        py::dict all;
        auto& mine = const_cast<Derived&>(static_cast<const Derived&>(*this));
        Derived::attributes([&](const char* name, const auto& member, const Property&, int flags = Plain) {
            if (!(flags & Hidden)) all[name] = py::object(valueOf(mine, member));
        });
        all.update(Base::pyDict());
        return all;
    }

    void pyRegisterClass(py::object scope) override {
        const py::scope here(scope);
        const py::docstring_options options(true, false, false);
        using PyClass = py::class_<Derived, shared_ptr<Derived>, py::bases<Base>, boost::noncopyable>;
        PyClass cls(Derived::className, Derived::doc);
        cls.def("__init__",
                py::raw_function(
                    [construct = py::make_constructor(&Adapter::construct)](py::tuple args, py::dict keywords) {
                        return construct(py::object(args[0]), py::tuple(args.slice(1, py::_)), keywords);
                    },
                    1));
        Derived standard;
        Derived::attributes([&](const char* name, const auto& member, const Property& property, int flags = Plain) {
            if (!(flags & Hidden)) addProperty(cls, standard, name, member, property, flags);
        });
        cls.def("__setattr__", &Adapter::setAttribute);
        cls.def("updateAttrs", &Adapter::updateAll, py::args("values"),
                "Set several attributes from a dict, all or, with an error that tells all problems, none.");
        cls.def("properties", &Adapter::properties,
                "The description of every attribute: a list of dicts with name, unit, meaning, source, low, high, "
                "usual_low, usual_high and other_unit (the unit that an unusual value is probably given in).")
            .staticmethod("properties");
        Derived::extras(cls);
    }

    template <class Archive> void serialize(Archive& ar, unsigned) {
        const BetweenSteps still;
        ar& boost::serialization::make_nvp(Derived::baseName, boost::serialization::base_object<Base>(self()));
        Derived::attributes([&](const char* name, const auto& member, const Property&, int flags = Plain) {
            if (flags & Shown) return;
            auto value = valueOf(self(), member);
            archiveValue(ar, name, value);
            if (Archive::is_loading::value) give(self(), member, value);
        });
        if (Archive::is_loading::value) self().postLoad();
    }

    void transfer(Transfer& to) override {
        if constexpr (std::is_base_of<Stateful, Base>::value) Base::transfer(to);
        Derived::attributes([&](const char* name, const auto& member, const Property&, int flags = Plain) {
            if (flags & (Given | Shown)) return;
            auto value = valueOf(self(), member);
            to(name, value);
            if (to.back) give(self(), member, value);
        });
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
        std::vector<std::string> wrong;
        Derived::attributes([&](const char* name, const auto& member, const Property& property, int flags = Plain) {
            if (flags & (ReadOnly | Hidden | Shown)) return;
            using T = decltype(valueOf(self(), member));
            if constexpr (std::is_arithmetic<T>::value) {
                if (property.isNumber())
                    if (const auto what = property.problem(name, double(valueOf(self(), member))); !what.empty())
                        wrong.push_back(what);
            } else if constexpr (std::is_same<T, Vector3r>::value) {
                if (!valueOf(self(), member).allFinite()) {
                    const auto unit = property.isNumber() && property.unit != std::string("-")
                                          ? std::string(" [") + property.unit + "]"
                                          : "";
                    wrong.push_back(std::string(name) + " must be finite numbers" + unit);
                }
            }
        });
        const auto more = self().problems();
        wrong.insert(wrong.end(), more.begin(), more.end());
        if (!wrong.empty()) throw std::invalid_argument(self().title() + ": " + joined(wrong, "; "));
    }

private:
    Derived& self() { return static_cast<Derived&>(*this); }

    static PyTypeObject* pythonClass() { return py::converter::registered<Derived>::converters.get_class_object(); }

    template <class PyClass, class Member>
    static void addProperty(PyClass& cls, Derived& standard, const char* name, const Member& member,
                            const Property& property, int flags) {
        using T = decltype(valueOf(standard, member));
        std::string about = property.documentation();
        const bool fixed = flags & (ReadOnly | Shown);
        if (std::is_arithmetic<T>::value || std::is_same<T, std::string>::value || std::is_same<T, Vector3r>::value) {
            const std::string value = py::extract<std::string>(py::str(py::object(valueOf(standard, member))));
            about += fixed ? " Read-only." : " Default: " + value + ".";
        } else if (fixed)
            about += " Read-only.";
        const auto get = py::make_function(
            [member](Derived& object) {
                const BetweenSteps still;
                return py::object(valueOf(object, member));
            },
            py::default_call_policies(), boost::mpl::vector<py::object, Derived&>());
        if (fixed)
            cls.add_property(name, get, about.c_str());
        else {
            const auto set = [name](Derived& object, const py::object& value) { object.set(name, value); };
            cls.add_property(name, get,
                             py::make_function(set, py::default_call_policies(),
                                               boost::mpl::vector<void, Derived&, const py::object&>()),
                             about.c_str());
        }
    }

    static void setAttribute(const py::object& object, const std::string& name, const py::object& value) {
        const py::object cls = object.attr("__class__");
        if (!PyObject_HasAttrString(cls.ptr(), name.c_str())) refuseAttribute(Derived::className, cls, name);
        if (PyObject_GenericSetAttr(object.ptr(), py::str(name).ptr(), value.ptr())) py::throw_error_already_set();
    }

    static py::list properties() {
        py::list all;
        Derived::attributes([&](const char* name, const auto&, const Property& property, int flags = Plain) {
            if (!(flags & Hidden)) all.append(documented(name, property));
        });
        return all;
    }

    static void updateAll(Derived& object, const py::dict& values) { object.set(values); }

    // Sets all of the values or, where one is refused, none.
    void set(const py::dict& values) {
        const BetweenSteps still;
        py::dict before = Base::pyDict();
        Derived::attributes([&](const char* name, const auto& member, const Property&, int flags = Plain) {
            if (!(flags & Hidden) && values.has_key(name)) before[name] = py::object(valueOf(self(), member));
        });
        const py::list keys = values.keys();
        std::vector<std::string> wrong;
        const auto put = [&](const py::object& key, const py::object& value) {
            const std::string name = py::extract<std::string>(key);
            try {
                self().pySetAttr(name, value);
            } catch (const std::invalid_argument& error) {
                wrong.push_back(error.what());
            } catch (const py::error_already_set&) { // raised by the host for an attribute of its own
                if (!PyErr_ExceptionMatches(PyExc_TypeError)) throw;
                PyErr_Clear();
                wrong.push_back(std::string(Derived::className) + "." + name + ": cannot be " + shown(value));
            }
        };
        try {
            for (py::ssize_t i = 0; i < py::len(keys); ++i)
                put(keys[i], values[keys[i]]);
            if (!wrong.empty()) throw std::invalid_argument(joined(wrong));
            self().callPostLoad();
        } catch (...) {
            // An error of Python is put aside while the old values are set again, which calls Python, too.
            PyObject *type, *value, *trace;
            PyErr_Fetch(&type, &value, &trace);
            for (py::ssize_t i = 0; i < py::len(keys); ++i)
                if (before.has_key(keys[i])) put(keys[i], before[keys[i]]);
            PyErr_Restore(type, value, trace);
            throw;
        }
    }

    static shared_ptr<Derived> construct(py::tuple args, py::dict keywords) {
        shared_ptr<Derived> made(new Derived);
        made->pyHandleCustomCtorArgs(args, keywords);
        if (py::len(args) > 0)
            throw std::invalid_argument(std::string(Derived::className) + " takes keyword arguments only");
        if (py::len(keywords) > 0) made->set(keywords);
        return made;
    }

    template <class Archive, class T> static void archiveValue(Archive& ar, const char* name, T& value) {
        if constexpr (IsNumbers<T>::value) {
            std::vector<T> one{value};
            archiveNumbers(ar, name, one);
            if (one.size() != 1) throw std::runtime_error(std::string("saved file is damaged at ") + name);
            value = one[0];
        } else
            ar& boost::serialization::make_nvp(name, value);
    }
    template <class Archive, class T> static void archiveValue(Archive& ar, const char* name, std::vector<T>& values) {
        if constexpr (IsNumbers<T>::value)
            archiveNumbers(ar, name, values);
        else
            ar& boost::serialization::make_nvp(name, values);
    }
    template <class Archive, class T>
    static void archiveNumbers(Archive& ar, const char* name, std::vector<T>& values) {
        auto flat = Archive::is_saving::value ? flattened(values) : std::vector<double>();
        ar& boost::serialization::make_nvp(name, flat);
        if (Archive::is_loading::value && !unflatten(flat, values))
            throw std::runtime_error(std::string("saved file is damaged at ") + name);
    }
};

// Makes a class known to YADE, which then creates objects by its name, and adds the name to a list.
template <class T> void enroll(std::vector<std::string>& names) {
    Singleton<yade::ClassFactory>::instance().registerFactorable(
        T::className, [] { return static_cast<yade::Factorable*>(new T); },
        [] { return shared_ptr<yade::Factorable>(new T); }, [] { return static_cast<void*>(new T); });
    names.push_back(T::className);
}

// The number by which YADE's dispatchers know a class of materials, geometries or physics. Stands first in the class.
#define MASONRY_DISPATCHED(Class, HostBase)                                                                            \
public:                                                                                                                \
    int& modifyClassIndex() override { return dispatchIndex(); }                                                       \
    const int& getClassIndex() const override { return dispatchIndex(); }                                              \
    const int& getBaseClassIndex(int depth) const override {                                                           \
        static HostBase base;                                                                                          \
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

} // namespace masonry
