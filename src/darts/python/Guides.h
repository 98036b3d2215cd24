#pragma once
// What the module is put together from.

#include "darts/Settings.h"
#include "darts/TimeBudget.h"

#include <pybind11/numpy.h>

#include <string>

namespace darts::python {

// These read arguments that several classes have; each throws ValueError for what it does not take.
darts::Medium mediumOf(float sigmaA, float sigmaS, float g);
darts::Settings presetOf(const std::string& preset, const std::string& mode, float g);
/// Time budget towards a target on the axis z.
darts::TimeBudget residualOf(float C, double low, double high);

/// The part about whole steps of a walk.
void declareGuides(pybind11::module_& sampling);

} // namespace darts::python
