// SPDX-License-Identifier: GPL-2.0-or-later
#include "Attribute.hpp"
#include "engine/bodies/StepLock.hpp"
#include <boost/python/raw_function.hpp>

namespace masonry {

#define MASONRY_COMPILED_HERE(T) template class AttributeOf<T>;
MASONRY_ATTRIBUTES(MASONRY_COMPILED_HERE)

std::string shown(const py::object& value) {
    const py::str whole(value);
    py::object some = whole.slice(0, 80);
    if (!py::extract<bool>(some.attr("isprintable")())) some = py::object(py::handle<>(PyObject_ASCII(some.ptr())));
    const std::string text = py::extract<std::string>(some);
    return py::len(whole) > 80 ? text + "..." : text;
}

bool isText(const py::object& value) {
    return PyUnicode_Check(value.ptr()) && py::len(value) <= 4096 && py::extract<bool>(value.attr("isprintable")());
}

namespace {

// The message of the error of Python that has been raised, which is over then.
std::string takenError() {
    PyObject *type, *value, *trace;
    PyErr_Fetch(&type, &value, &trace);
    const py::handle<> kept(type), error(py::allow_null(value)), where(py::allow_null(trace));
    return error ? py::extract<std::string>(py::str(py::object(error)))() : "";
}

} // namespace

bool Attributes::set(const char* className, void* object, const std::string& name, const py::object& value) const {
    for (const auto& one : all_) {
        if (name != one->name || one->flags & Hidden) continue;
        const auto whole = std::string(className) + "." + name;
        if (one->flags & (ReadOnly | Shown)) throw std::invalid_argument(whole + " is read-only");
        one->set(object, whole, value);
        return true;
    }
    return false;
}

void Attributes::setAll(const char* className, void* object, yade::Serializable& same, py::dict before,
                        const py::dict& values) const {
    for (const auto& one : all_)
        if (!(one->flags & Hidden) && values.has_key(one->name)) before[one->name] = one->value(object);
    const py::list keys = values.keys();
    std::vector<std::string> wrong, unknown;
    const auto put = [&](const py::object& key, const py::object& value) {
        const std::string name = py::extract<std::string>(key);
        try {
            same.pySetAttr(name, value);
        } catch (const std::invalid_argument& error) {
            wrong.push_back(error.what());
        } catch (const py::error_already_set&) {
            if (PyErr_ExceptionMatches(PyExc_AttributeError))
                unknown.push_back(takenError());
            else if (PyErr_ExceptionMatches(PyExc_TypeError) || PyErr_ExceptionMatches(PyExc_UnicodeError)) {
                PyErr_Clear(); // raised by the host for an attribute of its own
                wrong.push_back(std::string(className) + "." + name + ": cannot be " + shown(value));
            } else
                throw;
        }
    };
    bool followed = false; // whether what follows from the values was made
    try {
        for (py::ssize_t i = 0; i < py::len(keys); ++i)
            put(keys[i], values[keys[i]]);
        const bool allSet = wrong.empty() && unknown.empty();
        try {
            same.callPostLoad();
            followed = true;
        } catch (const std::invalid_argument& error) {
            if (allSet) throw;
            wrong.push_back(error.what());
        }
        if (wrong.empty() && !unknown.empty()) {
            PyErr_SetString(PyExc_AttributeError, joined(unknown).c_str());
            py::throw_error_already_set();
        }
        unknown.insert(unknown.end(), wrong.begin(), wrong.end());
        if (!allSet) throw std::invalid_argument(joined(unknown));
    } catch (...) {
        // An error of Python is put aside while the old values are set again, which calls Python, too.
        PyObject *type, *value, *trace;
        PyErr_Fetch(&type, &value, &trace);
        for (py::ssize_t i = 0; i < py::len(keys); ++i)
            if (before.has_key(keys[i])) put(keys[i], before[keys[i]]);
        if (followed) same.callPostLoad();
        PyErr_Restore(type, value, trace);
        throw;
    }
}

void Attributes::addTo(py::dict& all, void* object) const {
    for (const auto& one : all_)
        if (!(one->flags & Hidden)) all[one->name] = one->value(object);
}

py::list Attributes::descriptions() const {
    py::list list;
    for (const auto& one : all_) {
        if (one->flags & Hidden) continue;
        const auto& p = one->property;
        py::dict all;
        all["name"] = one->name;
        all["unit"] = p.isNumber() ? p.unit : "";
        all["meaning"] = p.meaning;
        all["source"] = p.from;
        all["low"] = p.low;
        all["high"] = p.high;
        all["usual_low"] = p.usualLow;
        all["usual_high"] = p.usualHigh;
        all["other_unit"] = p.otherUnit;
        list.append(all);
    }
    return list;
}

std::vector<std::string> Attributes::problems(void* object) const {
    std::vector<std::string> wrong;
    for (const auto& one : all_) {
        if (one->flags & (ReadOnly | Hidden | Shown)) continue;
        if (const auto what = one->problem(object); !what.empty()) wrong.push_back(what);
    }
    return wrong;
}

void Attributes::transfer(void* object, Transfer& to) const {
    for (const auto& one : all_)
        if (!(one->flags & (Given | Shown | OfHost))) one->transfer(object, to);
}

std::map<std::string, std::string> Attributes::defaults(const std::string& className) const {
    std::map<std::string, std::string> sources;
    for (const auto& one : all_) {
        const std::string from = *one->property.from ? one->property.from : "none";
        sources[one->name] = "default of " + className + ", for calcium silicate: " + from;
    }
    return sources;
}

void refuseAttribute(const std::string& className, const py::object& ofClass, const std::string& name) {
    const py::list known(py::handle<>(PyObject_Dir(ofClass.ptr())));
    std::vector<std::string> names;
    for (py::ssize_t i = 0; i < py::len(known); ++i) {
        const std::string other = py::extract<std::string>(known[i]);
        if (other[0] != '_') names.push_back(other);
    }
    const auto nearest = nearestName(name, names);
    const auto message =
        className + " has no attribute '" + name + "'" + (nearest.empty() ? "" : ", did you mean '" + nearest + "'?");
    PyErr_SetString(PyExc_AttributeError, message.c_str());
    throw py::error_already_set();
}

void setOrRefuse(const char* className, const py::object& object, const std::string& name, const py::object& value) {
    const py::object cls = object.attr("__class__");
    if (!PyObject_HasAttrString(cls.ptr(), name.c_str())) refuseAttribute(className, cls, name);
    if (PyObject_GenericSetAttr(object.ptr(), py::str(name).ptr(), value.ptr())) py::throw_error_already_set();
}

std::string documentation(const Attribute& attribute, void* standard) {
    auto about = attribute.property.documentation();
    const bool fixed = attribute.flags & (ReadOnly | Shown);
    if (fixed)
        about += " Read-only.";
    else if (attribute.hasDefault())
        about += " :ydefault:`" + std::string(py::extract<std::string>(py::str(attribute.value(standard)))) + "`";
    return about;
}

py::object initialiser(const py::object& construct) {
    return py::raw_function(
        [construct](py::tuple args, py::dict keywords) {
            return construct(py::object(args[0]), py::tuple(args.slice(1, py::_)), keywords);
        },
        1);
}

} // namespace masonry
