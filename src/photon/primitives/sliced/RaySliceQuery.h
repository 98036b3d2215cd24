#pragma once
// A query of a slice record by a camera segment: the data that all kinds of slices need.

#include "photon/primitives/sliced/Chord.h"
#include "photon/primitives/sliced/SliceRecord.h"
#include "photon/view/CameraSegment.h"

#include "tungsten/medium/Medium.h"

#include <bit>

namespace tungsten::photon {

inline Vec3d inDouble(const Vec3f& v) {
    return {double(v.x), double(v.y), double(v.z)};
}
inline Vec3f inFloat(const Vec3d& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

/// In [0, 1), different for every ray.
inline double rayRotation(const Vec3f& d) {
    uint32_t hash = 0x9e3779b9u;
    for (const float f : {d.x, d.y, d.z}) {
        hash ^= std::bit_cast<uint32_t>(f);
        hash *= 0x85ebca6bu;
        hash ^= hash >> 15;
        hash *= 0xc2b2ae35u;
        hash ^= hash >> 13;
    }
    return double(hash) * 0x1p-32;
}

/// A record and a camera segment in double precision, with times as path lengths.
struct RaySliceQuery {
    const SliceRecord& flights;
    const CameraSegment& segment;
    const Medium& medium;
    CameraRay<double> sight;
    Vec3d base;
    double speed, start; ///< start: time of arrival of a path of length 0 from the base

    template <size_t K>
    [[nodiscard]] std::array<Vec3d, K> directions() const {
        std::array<Vec3d, K> w;
        for (size_t i = 0; i < K; ++i) w[i] = inDouble(flights.directions[i]);
        return w;
    }
    [[nodiscard]] double residual(double time) const { return (time - start) * speed; }
    [[nodiscard]] double arrival(double length) const { return start + length / speed; }
    /// In [0, 1), one of two numbers of the record, turned by ray and frame.
    [[nodiscard]] double random(size_t which, int frame) const {
        const double u = flights.randomNumber(which) + rayRotation(segment.direction) + frameRotation(frame);
        return u - std::floor(u);
    }
    [[nodiscard]] double phase(const Vec3f& last) const { return double(medium.phase.eval(last, -segment.direction)); }
    /// weight(coefficients) of every channel.
    template <typename Weight>
    [[nodiscard]] Vec3d perChannel(const Weight& weight) const {
        const Rgb sigmaT = medium.sigmaT();
        const auto channel = [&](int c) {
            return weight(Coefficients<double>{double(medium.sigmaS()[c]), double(sigmaT[c])});
        };
        const double first = channel(0);
        return medium.isGrey() ? Vec3d(first) : Vec3d(first, channel(1), channel(2));
    }
};

} // namespace tungsten::photon
