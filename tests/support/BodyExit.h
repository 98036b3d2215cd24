#pragma once
// Residuals of vertices in a body that light must leave.

#include "darts/ResidualRange.h"

namespace tungsten::test {

/// A vertex `depth` under the plane boundary of a half-space, its target straight above at `height`: connections are
/// `longest` long at most, the last `gate` of that inside the gate.
inline darts::Residual outOf(double depth, double height, double longest, double gate) {
    darts::Residual residual =
        darts::Residual::of(darts::Vec3{0, 0, 1} * float(depth + height), {longest - gate, longest});
    residual.way = darts::Way::Out;
    residual.exit.faces.add({{0, 0, 1}, float(depth), float(height), darts::Exit::Infinite, 0.0f});
    residual.exit.inside = float(depth);
    residual.exit.gate = residual.width;
    return residual;
}

/// Where light walks far: an albedo of 0.998.
inline darts::Medium thickMedium(float g) {
    return {{0.02f, 0.02f, 0.02f}, {10.0f, 10.0f, 10.0f}, g};
}

} // namespace tungsten::test
