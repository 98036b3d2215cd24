#pragma once
// A query of a slice record by a camera segment: the data that all kinds of slices need.

#include "photon/primitives/CameraSegment.h"
#include "photon/primitives/sliced/CameraRay.h"
#include "photon/primitives/sliced/SliceRecord.h"

#include "tungsten/medium/Medium.h"

#include <bit>

namespace tungsten::photon {

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
        for (size_t i = 0; i < K; ++i) w[i] = Vec3d(flights.directions[i]);
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

// Short primitives: collapsed flights that end at random lengths, in place of a transmittance
// (docs/photon-primitives.md, section 2).

/// Lengths at which a record's flights end, by the mean coefficient; infinite for long ones. They are drawn by the
/// record's own number: a flight's end need not be where the light path's was, as nothing else of the record depends on
/// it, and ghosts have none.
inline std::array<double, 4> flightEnds(const SliceRecord& flights, const Medium& medium) {
    std::array<double, 4> ends;
    ends.fill(std::numeric_limits<double>::infinity());
    if (!flights.shortFlights) return ends;
    uint64_t state = (uint64_t(flights.random[0]) << 16 | flights.random[1]) + 1;
    for (double& end : ends) {
        // Steele, Lea and Flood 2014, SplitMix64
        uint64_t bits = state += 0x9e3779b97f4a7c15u;
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        bits ^= bits >> 31;
        end = -std::log1p(-double(bits >> 11) * 0x1p-53) / double(meanComponent(medium.sigmaT()));
    }
    return ends;
}

/// What short flights of these lengths are weighed by besides their transmittance: 1 / P(none has ended), or 0 where
/// one has; 1 for long ones.
inline double unended(const SliceRecord& flights, const Medium& medium, const double* lengths, int count) {
    if (!flights.shortFlights) return 1.0;
    const std::array<double, 4> ends = flightEnds(flights, medium);
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        if (lengths[i] > ends[size_t(i)]) return 0.0;
        sum += lengths[i];
    }
    return std::exp(double(meanComponent(medium.sigmaT())) * sum);
}

} // namespace tungsten::photon
