#pragma once
// Residuals of vertices in a body that light must leave.

#include "darts/TimeBudget.h"

namespace tungsten::test {

/// A vertex `depth` under the plane boundary of a half-space, its target straight above at `height`: connections are
/// `longest` long at most, the last `gate` of that inside the gate.
inline darts::TimeBudget outOf(double depth, double height, double longest, double gate) {
    darts::TimeBudget budget =
        darts::TimeBudget::of(darts::Vec3{0, 0, 1} * float(depth + height), {longest - gate, longest});
    budget.model = darts::EscapeModel::Bounded;
    budget.escape.faces.add({{0, 0, 1}, float(depth), float(height), darts::EscapeGeometry::Infinite, 0.0f});
    budget.escape.inside = float(depth);
    return budget;
}

/// Where light walks far: an albedo of 0.998.
inline darts::Medium thickMedium(float g) {
    return {{0.02f, 0.02f, 0.02f}, {10.0f, 10.0f, 10.0f}, g};
}

} // namespace tungsten::test
