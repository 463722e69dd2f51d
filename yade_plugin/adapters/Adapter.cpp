// SPDX-License-Identifier: GPL-2.0-or-later
#include "Adapter.hpp"

namespace masonry {

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

py::dict documented(const std::string& name, const Property& p) {
    py::dict all;
    all["name"] = name;
    all["unit"] = p.isNumber() ? p.unit : "";
    all["meaning"] = p.meaning;
    all["source"] = p.from;
    all["low"] = p.low;
    all["high"] = p.high;
    all["usual_low"] = p.usualLow;
    all["usual_high"] = p.usualHigh;
    all["other_unit"] = p.otherUnit;
    return all;
}

} // namespace masonry
