#pragma once
// What the module is put together from.

#include <pybind11/numpy.h>

namespace darts::python {

/// The part about whole steps of a walk.
void declareGuides(pybind11::module_& sampling);

} // namespace darts::python
