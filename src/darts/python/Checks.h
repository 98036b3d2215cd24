#pragma once
// What the module's functions are given: each check returns the value, or throws ValueError with the argument's name,
// what is accepted and what was found.

#include <pybind11/pybind11.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace darts::python {

/// Lengths, times and coefficients: products of two are floats.
inline constexpr double Largest = 1e15;

/// In [low, high].
template <typename Real>
Real within(Real value, const char* name, double low, double high) {
    if (double(value) >= low && double(value) <= high) return value;
    char text[160];
    std::snprintf(text, sizeof text, "%s: expected a number from %g to %g, found %g", name, low, high, double(value));
    throw pybind11::value_error(text);
}
template <typename Real>
Real notNegative(Real value, const char* name) {
    return within(value, name, 0.0, Largest);
}
template <typename Real>
Real finite(Real value, const char* name) {
    return within(value, name, -Largest, Largest);
}
/// A length that may be infinite.
template <typename Real>
Real length(Real value, const char* name) {
    return within(value, name, 0.0, std::numeric_limits<double>::infinity());
}
/// 1 - cos.
template <typename Real>
Real cosine(Real h, const char* name = "h") {
    return within(h, name, 0.0, 2.0);
}
/// A random number in [0, 1).
template <typename Real>
Real random(Real u, const char* name = "u") {
    if (u >= Real(0) && u < Real(1)) return u;
    char text[160];
    std::snprintf(text, sizeof text, "%s: expected random numbers from 0 to below 1, found %g", name, double(u));
    throw pybind11::value_error(text);
}

/// `Type.__new__(Type)` calls the constructor too: methods of an object that has none would read what is not there.
template <typename Class>
void makeWhole(Class& declared) {
    namespace py = pybind11;
    const py::handle own = declared;
    const py::object base = declared.attr("__base__");
    declared.attr("__new__") =
        py::cpp_function([own, base](const py::object& type, const py::args& args, const py::kwargs& named) {
            py::object made = base.attr("__new__")(type);
            if (type.is(own)) made.attr("__init__")(*args, **named);
            return made;
        });
}

} // namespace darts::python
