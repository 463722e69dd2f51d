// SPDX-License-Identifier: GPL-2.0-or-later
// The attributes of a class that YADE sees, whatever their types: what Python, dict(), saving, checkpoints and the
// check of values do with them. What depends on the type of a value is compiled once for this type: for each class anew
// it would take most of the time of a build.
#pragma once
#include "common/Property.hpp"
#include "engine/checkpoint/Transfer.hpp"
#include "law/common/SofteningTable.hpp"
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <functional>
#include <map>
#include <memory>

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

template <class T> struct IsShared : std::false_type {};
template <class T> struct IsShared<shared_ptr<T>> : std::true_type {};
template <class T> struct IsList : std::false_type {};
template <class T> struct IsList<std::vector<T>> : std::true_type {};
template <class T> struct HoldsObjects : IsShared<T> {};
template <class T> struct HoldsObjects<std::vector<T>> : IsShared<T> {};
// Lists of names are found anew and never saved.
template <class T> using IsNames = std::is_same<T, std::vector<std::string>>;

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

// The first 80 characters of a value as text.
std::string shown(const py::object& value);

// Whether a value is a text of at most 4096 characters, all of which can be printed.
bool isText(const py::object& value);

// Converts what Python gives for an attribute to the attribute's type. Throws std::invalid_argument, which names the
// expected type and the value, where that cannot be done.
template <class T> T given(const std::string& name, const py::object& value) {
    py::extract<T> extracted(value);
    const bool fits = std::is_same<T, std::string>::value
                          ? isText(value)
                          : !std::is_arithmetic<T>::value || PyBool_Check(value.ptr()) == std::is_same<T, bool>::value;
    try {
        if (fits && extracted.check() && !PyErr_Occurred()) return extracted();
        PyErr_Clear();                       // of an array without dimensions
    } catch (const py::error_already_set&) { // an entry of a list has another type
        PyErr_Clear();
    } catch (const std::bad_cast&) { // a whole number is out of range
    }
    throw std::invalid_argument(name + ": expected " + expectedType<T>() + ", got " + shown(value));
}

// One attribute. `object` is a pointer to an object of the class whose attribute it is.
class Attribute {
public:
    const char* const name;
    const Property property;
    const int flags; // of Flags

    Attribute(const char* name, const Property& property, int flags) : name(name), property(property), flags(flags) {}
    virtual ~Attribute() = default;

    virtual py::object value(void* object) const = 0;
    // Sets the value to what Python gives; std::invalid_argument, which begins with `whole`, if it has another type.
    virtual void set(void* object, const std::string& whole, const py::object& value) const = 0;
    virtual std::string problem(void* object) const = 0; // what is wrong with the value; empty if nothing is
    virtual bool hasDefault() const = 0;                 // whether the documentation says the default
    virtual void transfer(void* object, Transfer& to) const = 0;
    virtual void archive(void* object, boost::archive::binary_iarchive&) const = 0;
    virtual void archive(void* object, boost::archive::binary_oarchive&) const = 0;
    virtual void archive(void* object, boost::archive::xml_iarchive&) const = 0;
    virtual void archive(void* object, boost::archive::xml_oarchive&) const = 0;
};

template <class T> class AttributeOf final : public Attribute {
    const std::function<T(void* object)> get;
    const std::function<void(void* object, const T& value)> put;

public:
    AttributeOf(const char* name, const Property& property, int flags, decltype(get) get, decltype(put) put)
        : Attribute(name, property, flags), get(std::move(get)), put(std::move(put)) {}

    py::object value(void* object) const override { return py::object(get(object)); }
    void set(void* object, const std::string& whole, const py::object& value) const override {
        put(object, given<T>(whole, value));
    }
    std::string problem(void* object) const override {
        if constexpr (std::is_arithmetic<T>::value) {
            if (property.isNumber()) return property.problem(name, double(get(object)));
        } else if constexpr (std::is_same<T, Vector3r>::value) {
            if (!get(object).allFinite()) {
                const bool hasUnit = property.isNumber() && property.unit != std::string("-");
                return std::string(name) + " must be finite numbers" +
                       (hasUnit ? std::string(" [") + property.unit + "]" : "");
            }
        }
        return {};
    }
    bool hasDefault() const override {
        return std::is_arithmetic<T>::value || std::is_same<T, std::string>::value || std::is_same<T, Vector3r>::value;
    }
    void transfer(void* object, Transfer& to) const override {
        if constexpr (!HoldsObjects<T>::value && !IsNames<T>::value) {
            auto value = get(object);
            to(name, value);
            if (to.back) put(object, value);
        }
    }
    void archive(void* object, boost::archive::binary_iarchive& from) const override { through(object, from); }
    void archive(void* object, boost::archive::binary_oarchive& to) const override { through(object, to); }
    void archive(void* object, boost::archive::xml_iarchive& from) const override { through(object, from); }
    void archive(void* object, boost::archive::xml_oarchive& to) const override { through(object, to); }

private:
    template <class Archive> void through(void* object, Archive& ar) const {
        auto value = get(object);
        if constexpr (std::is_arithmetic<T>::value || std::is_same<T, std::string>::value || HoldsObjects<T>::value)
            ar& boost::serialization::make_nvp(name, value);
        else if constexpr (!IsNames<T>::value) {
            std::vector<double> flat;
            StateNumbers to(flat);
            if (Archive::is_saving::value) to(value);
            ar& boost::serialization::make_nvp(name, flat);
            StateNumbers from(flat, std::string("saved file is damaged at ") + name);
            if (Archive::is_loading::value) from(value);
        }
        if (Archive::is_loading::value) put(object, value);
    }
};

// Types that several classes have attributes of are compiled in Attribute.cpp.
#define MASONRY_ATTRIBUTES(X)                                                                                          \
    X(bool)                                                                                                            \
    X(int)                                                                                                             \
    X(long)                                                                                                            \
    X(double)                                                                                                          \
    X(std::string)                                                                                                     \
    X(Vector3r) X(std::vector<int>) X(std::vector<double>) X(std::vector<Vector3r>) X(std::vector<TableRow>)
#define MASONRY_COMPILED_ELSEWHERE(T) extern template class AttributeOf<T>;
MASONRY_ATTRIBUTES(MASONRY_COMPILED_ELSEWHERE)

// All attributes of a class, in the order in which it lists them.
class Attributes {
public:
    // Made by `Class::attributes`, which calls this object with each of them.
    template <class Class> static Attributes of() {
        Attributes made;
        Class::attributes(Listing<Class>{made.all_});
        return made;
    }

    // Sets the attribute of this name. False if the class has no such attribute.
    bool set(const char* className, void* object, const std::string& name, const py::object& value) const;
    // Sets several values or, where one is refused, none. `before` has the attributes of the host's base class.
    void setAll(const char* className, void* object, yade::Serializable& same, py::dict before,
                const py::dict& values) const;
    void addTo(py::dict& all, void* object) const;
    py::list descriptions() const;
    // Notes of every attribute that it has the default of a class, with the source of that.
    std::map<std::string, std::string> defaults(const std::string& className) const;
    std::vector<std::string> problems(void* object) const;
    void transfer(void* object, Transfer& to) const;
    template <class Archive> void archive(void* object, Archive& ar) const {
        for (const auto& one : all_)
            if (!(one->flags & (Shown | OfHost))) one->archive(object, ar);
    }
    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }

private:
    using List = std::vector<std::unique_ptr<const Attribute>>;
    template <class Class> struct Listing {
        List& all;
        template <class T, class Get, class Put>
        void add(const char* name, const Property& property, int flags, Get&& get, Put&& put) const {
            all.push_back(std::make_unique<AttributeOf<T>>(
                name, property, flags, [get](void* object) -> T { return get(*static_cast<Class*>(object)); },
                [put](void* object, const T& value) { put(*static_cast<Class*>(object), value); }));
        }

        // A member of the class or of a base of it.
        template <class Owner, class T>
        void operator()(const char* name, T Owner::*member, const Property& property, int flags = Plain) const {
            add<T>(
                name, property, flags, [member](Class& object) { return object.*member; },
                [member](Class& object, const T& value) { object.*member = value; });
        }
        template <class Owner, class T>
        void operator()(const char* name, const Computed<Owner, T>& functions, const Property& property,
                        int flags = Plain) const {
            add<T>(
                name, property, flags, [functions](Class& object) { return (object.*functions.get)(); },
                [functions](Class& object, const T& value) {
                    if (functions.put) (object.*functions.put)(value);
                });
        }
        // A value that all objects of the class share.
        template <class T> void operator()(const char* name, T* shared, const Property& property) const {
            add<T>(
                name, property, Plain, [shared](Class&) { return *shared; },
                [shared](Class&, const T& value) { *shared = value; });
        }
        // State that Python does not see, and whose numbers a function of the class visits.
        template <class Owner>
        void operator()(const char* name, void (Owner::*visit)(StateNumbers&), const Property& property) const {
            add<std::vector<double>>(
                name, property, Hidden,
                [visit](Class& object) {
                    std::vector<double> flat;
                    StateNumbers to(flat);
                    (object.*visit)(to);
                    return flat;
                },
                [visit, name](Class& object, const std::vector<double>& flat) {
                    StateNumbers from(flat, std::string("the saved state is damaged at '") + name + "'");
                    (object.*visit)(from);
                    from.end();
                });
        }
    };

    List all_;
};

// Raises AttributeError for an attribute that a class does not have. The message offers the nearest name that it has.
[[noreturn]] void refuseAttribute(const std::string& className, const py::object& ofClass, const std::string& name);

// Sets an attribute of an object of Python, or raises as refuseAttribute() does.
void setOrRefuse(const char* className, const py::object& object, const std::string& name, const py::object& value);

// The sentence for Python about an attribute, with its default in the object `standard`.
std::string documentation(const Attribute&, void* standard);

// The `__init__` of a class, from a function that makes an object of positional and keyword arguments.
py::object initialiser(const py::object& construct);

} // namespace masonry
