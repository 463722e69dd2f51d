// What every class that YADE sees has in common: one list of attributes serves Python, dict(), saving, checkpoints and
// the docs.
//
// A class `T : Adapter<T, HostBase>` gives `className`, `baseName`, `doc` and
//     template <class Visit> static void attributes(Visit&& visit) { visit("young", &T::young, "Young's modulus [Pa]");
//     }
// and may define `void postLoad()`, which checks and prepares after any change, `void refresh()`, which brings the
// attributes up to date before they are read, and `static void extras(PyClass&)`.
#pragma once
#include "files/Checkpoint.hpp"
#include "host/Yade.hpp"
#include "law/JointState.hpp"
#include "law/SofteningTable.hpp"
#include "common/Text.hpp"
#include <atomic>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <limits>
#include <type_traits>

namespace masonry {

namespace py = boost::python;
using boost::shared_ptr;
using yade::Quaternionr;
using yade::Vector3r;

// Counts every change of joints and units that arrays kept by engines must follow.
inline std::atomic<long> changes{0};

// An engine that keeps the state of joints in arrays of its own: it can bring the joints up to date, and let them go.
struct Keeper {
    virtual ~Keeper() = default;
    virtual void store() = 0;
    virtual void release() = 0;
};

// Hidden: saved, but not shown to Python. Given: by the scene that is built; no state, so checkpoints leave it alone.
enum Flags { Plain = 0, ReadOnly = 1, Hidden = 2, Given = 4 };

template <class T> struct IsNumbers : std::false_type {}; // types of fixed size that are saved as plain numbers
template <> struct IsNumbers<Vector3r> : std::true_type {};
template <> struct IsNumbers<Quaternionr> : std::true_type {};
template <> struct IsNumbers<TableRow> : std::true_type {};
template <> struct IsNumbers<JointState> : std::true_type {};

// Calls `each` with every number of a value, in a fixed order.
template <class F> void numbers(Vector3r& v, F&& each) { each(v[0]), each(v[1]), each(v[2]); }
template <class F> void numbers(Quaternionr& q, F&& each) { each(q.w()), each(q.x()), each(q.y()), each(q.z()); }
template <class F> void numbers(TableRow& r, F&& each) { each(r.ratio), each(r.damage); }
template <class F> void numbers(JointState& s, F&& each) {
    double regime = double(s.regime);
    each(s.opening), each(s.crushing), each(s.dilation), each(s.slip), each(s.largestOpening), each(s.largestClosure);
    each(s.tensionDamage), each(s.shearDamage), each(s.normalStress), each(s.shearStress.a), each(s.shearStress.b);
    each(regime);
    if (!(regime >= 0 && regime <= 3)) throw std::invalid_argument("saved file is damaged at the regime of a joint");
    s.regime = Regime(int(regime));
}

template <class Archive, class T> void archive(Archive& ar, const char* name, T& value) {
    ar& boost::serialization::make_nvp(name, value);
}

template <class Archive, class T> void archiveNumbers(Archive& ar, const char* name, std::vector<T>& values) {
    std::vector<double> flat;
    if (Archive::is_saving::value)
        for (auto& value : values)
            numbers(value, [&](double& number) { flat.push_back(number); });
    archive(ar, name, flat);
    if (Archive::is_saving::value) return;
    std::size_t width = 0, next = 0;
    T sample;
    numbers(sample, [&](double&) { ++width; });
    if (flat.size() % width != 0) throw std::runtime_error(std::string("saved file is damaged at ") + name);
    values.resize(flat.size() / width);
    for (auto& value : values)
        numbers(value, [&](double& number) { number = flat[next++]; });
}

template <class T> struct IsShared : std::false_type {};
template <class T> struct IsShared<shared_ptr<T>> : std::true_type {};
template <class T> struct IsList : std::false_type {};
template <class T> struct IsList<std::vector<T>> : std::true_type {};

// State on its way from a scene to a checkpoint or back, piece by piece in the same order. Objects that are shared stay
// the scene's own.
class Transfer {
public:
    const bool back;   // to the scene
    std::string owner; // whose state it is, before the names

    Transfer(Checkpoint& file, bool back) : back(back), file_(file) {}

    template <class T> void operator()(const std::string& name, T& value) {
        if constexpr (std::is_same<T, std::string>::value) {
            auto& text = file_.texts[owner + name];
            back ? value = text : text = value;
        } else if constexpr (plain<T>())
            several(name, &value, 1);
    }
    template <class T> void operator()(const std::string& name, std::vector<T>& values) {
        if constexpr (plain<T>()) {
            if (back) values.resize(file_.numbers[owner + name].size() / width<T>());
            several(name, values.data(), values.size());
        }
    }
    template <class T> void several(const std::string& name, T* values, std::size_t count) { // as many as the scene has
        auto& flat = file_.numbers[owner + name];
        flat.resize(back ? flat.size() : count * width<T>());
        if (flat.size() != count * width<T>()) damaged(name);
        std::size_t next = 0;
        for (std::size_t i = 0; i < count; ++i)
            each(values[i], [&](double& number) {
                auto& kept = flat[next++];
                back ? number = kept : kept = number;
            });
    }
    [[noreturn]] void damaged(const std::string& name) const {
        throw std::invalid_argument("does not fit this scene, at '" + owner + name + "'");
    }

private:
    template <class T> static constexpr bool plain() { return std::is_arithmetic<T>::value || IsNumbers<T>::value; }
    template <class T, class F> static void each(T& value, F&& visit) {
        if constexpr (std::is_arithmetic<T>::value) {
            double number = double(value);
            visit(number);
            if (std::is_integral<T>::value && !(std::abs(number) <= double(std::numeric_limits<T>::max())))
                throw std::invalid_argument("does not fit this scene: a whole number in it is too large");
            value = T(number);
        } else
            numbers(value, visit);
    }
    template <class T> static std::size_t width() {
        std::size_t count = 0;
        T sample{};
        each(sample, [&](double&) { ++count; });
        return count;
    }

    Checkpoint& file_;
};

// What has a state of its own for checkpoints.
struct Stateful {
    virtual ~Stateful() = default;
    virtual void transfer(Transfer&) = 0;
};

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

// What Python gives for an attribute, as the attribute's type; std::invalid_argument that names both if it is another.
template <class T> T given(const std::string& name, const py::object& value) {
    py::extract<T> extracted(value);
    const bool sort = !std::is_arithmetic<T>::value || PyBool_Check(value.ptr()) == std::is_same<T, bool>::value;
    try {
        if (sort && extracted.check()) return extracted();
    } catch (const py::error_already_set&) { // a list of other things
        PyErr_Clear();
    } catch (const std::bad_cast&) { // a whole number out of range
    }
    throw std::invalid_argument(name + ": expected " + expectedType<T>() + ", got " + shown(value));
}

template <class Derived, class Base> class Adapter : public Base, public Stateful {
public:
    std::string getClassName() const override { return Derived::className; }
    std::string getBaseClassName(unsigned i = 0) const override { return i == 0 ? Derived::baseName : ""; }
    int getBaseClassNumber() const override { return 1; }

    void postLoad() {}
    void refresh() {}
    template <class PyClass> static void extras(PyClass&) {}

    void callPostLoad() override {
        Base::callPostLoad();
        self().postLoad();
    }

    void pySetAttr(const std::string& key, const py::object& value) override {
        bool known = false;
        Derived::attributes([&](const char* name, auto member, const char*, int flags = Plain) {
            if (key != name || flags & Hidden) return;
            known = true;
            if (flags & ReadOnly)
                throw std::invalid_argument(std::string(Derived::className) + "." + key + " is read-only");
            using T = std::decay_t<decltype(self().*member)>;
            self().*member = given<T>(std::string(Derived::className) + "." + key, value);
        });
        if (!known) Base::pySetAttr(key, value);
    }

    py::dict pyDict() const override {
        py::dict all;
        const_cast<Derived&>(static_cast<const Derived&>(*this)).refresh();
        Derived::attributes([&](const char* name, auto member, const char*, int flags = Plain) {
            if (!(flags & Hidden)) all[name] = py::object(static_cast<const Derived&>(*this).*member);
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
        const Derived standard;
        Derived::attributes([&](const char* name, auto member, const char* text, int flags = Plain) {
            if (flags & Hidden) return;
            using T = std::decay_t<decltype(self().*member)>;
            T Derived::*const own = member;
            std::string about = text;
            if (std::is_arithmetic<T>::value || std::is_same<T, std::string>::value ||
                std::is_same<T, Vector3r>::value) {
                const std::string value = py::extract<std::string>(py::str(py::object(standard.*own)));
                about += flags & ReadOnly ? " Read-only." : " Default: " + value + ".";
            } else if (flags & ReadOnly)
                about += " Read-only.";
            const auto get = py::make_function(
                [own](Derived& object) {
                    object.refresh();
                    return object.*own;
                },
                py::default_call_policies(), boost::mpl::vector<T, Derived&>());
            if (flags & ReadOnly)
                cls.add_property(name, get, about.c_str());
            else {
                const auto set = [name](Derived& object, const py::object& value) { object.set(name, value); };
                cls.add_property(name, get,
                                 py::make_function(set, py::default_call_policies(),
                                                   boost::mpl::vector<void, Derived&, const py::object&>()),
                                 about.c_str());
            }
        });
        cls.def("updateAttrs", &Adapter::updateAll, py::args("values"),
                "Set several attributes from a dict, all or, with an error that tells all problems, none.");
        Derived::extras(cls);
    }

    template <class Archive> void serialize(Archive& ar, unsigned) {
        if (Archive::is_saving::value) self().refresh();
        ar& boost::serialization::make_nvp(Derived::baseName, boost::serialization::base_object<Base>(self()));
        Derived::attributes(
            [&](const char* name, auto member, const char*, int = Plain) { save(ar, name, self().*member); });
        if (Archive::is_loading::value) self().postLoad();
    }

    void transfer(Transfer& to) override {
        self().refresh();
        Derived::attributes([&](const char* name, auto member, const char*, int flags = Plain) {
            if (!(flags & Given)) to(name, self().*member);
        });
        if (to.back) self().postLoad();
    }

protected:
    void set(const char* name, const py::object& value) {
        py::dict one;
        one[name] = value;
        set(one);
    }

private:
    Derived& self() { return static_cast<Derived&>(*this); }

    static void updateAll(Derived& object, const py::dict& values) { object.set(values); }

    void set(const py::dict& values) { // all of them or, where one is refused, none
        py::dict before = Base::pyDict();
        Derived::attributes([&](const char* name, auto member, const char*, int flags = Plain) {
            if (!(flags & Hidden) && values.has_key(name)) before[name] = py::object(self().*member);
        });
        const py::list keys = values.keys();
        std::vector<std::string> wrong;
        const auto put = [&](const py::object& key, const py::object& value) {
            const std::string name = py::extract<std::string>(key);
            try {
                self().pySetAttr(name, value);
            } catch (const std::invalid_argument& error) {
                wrong.push_back(error.what());
            } catch (const py::error_already_set&) { // the host's, of its own attributes
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
            PyObject *type, *value, *trace; // an error of Python's own must not be met by what sets back
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

    template <class Archive, class T> static void save(Archive& ar, const char* name, T& value) {
        if constexpr (IsNumbers<T>::value) {
            std::vector<T> one{value};
            archiveNumbers(ar, name, one);
            if (one.size() != 1) throw std::runtime_error(std::string("saved file is damaged at ") + name);
            value = one[0];
        } else
            archive(ar, name, value);
    }
    template <class Archive, class T> static void save(Archive& ar, const char* name, std::vector<T>& values) {
        if constexpr (IsNumbers<T>::value)
            archiveNumbers(ar, name, values);
        else
            archive(ar, name, values);
    }
};

// The number by which dispatchers know a class of materials, geometries or physics.
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
