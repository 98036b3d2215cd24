#pragma once
// A sight line and the directions of verified slices.

#include "photon/primitives/sliced/Ball.h"

#include <array>
#include <limits>

namespace tungsten::photon {

template <typename Real>
Vector<Real> unit(double x, double y, double z) {
    const Vec3d d = Vec3d(x, y, z).normalized();
    return {Real(d.x), Real(d.y), Real(d.z)};
}
template <typename Real>
CameraRay<Real> alongZ(bool warped) {
    return {Vector<Real>(0), Vector<Real>(0, 0, 1), 0, std::numeric_limits<Real>::infinity(), warped};
}
template <typename Real>
std::array<Vector<Real>, 3> volumeDirections() {
    return {unit<Real>(-2, 1, 1), unit<Real>(-1, -1, 0), unit<Real>(3, 2, -2)};
}
template <typename Real>
std::array<Vector<Real>, 4> hypervolumeDirections() {
    return {unit<Real>(0, 2, -2), unit<Real>(1, -1, 1), unit<Real>(-2, -1, 1), unit<Real>(2, 0, -2)};
}

} // namespace tungsten::photon
