#pragma once
// What light paths leave for planes, volumes, balls and hypervolumes.

#include "photon/store/Store.h"

#include "tungsten/geometry/Shape.h"

#include <array>
#include <cmath>

namespace tungsten::photon {

enum class FlightShape : uint8_t { Ball = 0, Beam = 1, Plane = 2, Volume = 3, Hypervolume = 4 };

/// A base, and the directions of the flights from it whose lengths are integrated: one of a beam to four of a
/// hypervolume (long ones, docs/photon-primitives.md, section 2). A ball has a vertex, its centre, and integrates over
/// direction and length of the flight from there.
struct SliceRecord {
    double time; ///< at the base, since the clock's zero
    Vec3f base;
    /// Directions of the flights; a ball has those of the two flights that led to it. A ball on a light has its normal.
    /// A ball on a surface has the geometric normal on the side that light leaves to, and the shading normal (third).
    std::array<Vec3f, 4> directions;
    Rgb power;   ///< leaving the base, of one path; a ball: colliding there, before a direction is drawn
    float reach; ///< of the first flight: to the next surface; a ball: the least length of its flight
    std::array<uint16_t, 2> random; ///< places samples, at a different place on each ray
    /// A ball: of the two flights that led to it. A ball on a light: its uv. A beam: where it
    /// begins to count.
    std::array<float, 2> lengths;
    uint16_t bounce; ///< interactions from the light up to and including the base
    int16_t medium;  ///< index of the medium the flights cross
    int16_t emitter; ///< a ball on a light: its index; otherwise -1
    FlightShape shape;
    bool shared : 1;       ///< balls and volumes make the same paths: weighed by multiple importance sampling
    bool shortFlights : 1; ///< they end at random lengths (flightEnds)
    bool onSurface : 1;    ///< a ball on a surface that scatters evenly; power: before it is spread over directions

    [[nodiscard]] int flights() const { return std::max(int(shape), 1); }
    [[nodiscard]] double randomNumber(size_t which) const { return (double(random[which]) + 0.5) * 0x1p-16; }
    /// At a delta gate it is seen through the temporal kernel. Balls that nothing shares their paths with have infinite
    /// variance at one length, and hardly more than a finite one over a box (docs/photon-primitives.md, section 2.5);
    /// lights rarely lie on rays.
    [[nodiscard]] bool blurredInTime() const {
        return shape == FlightShape::Plane || shape == FlightShape::Beam ||
               (shape == FlightShape::Ball && !shared && emitter < 0);
    }
    /// A ball on a light, or on a surface.
    [[nodiscard]] SurfaceSample surfacePoint() const {
        return {base, directions[0], {lengths[0], lengths[1]}, directions[1].x};
    }
    /// A ball on a surface: per solid angle.
    [[nodiscard]] float leavingSurface(const Vec3f& direction) const {
        return direction.dot(directions[2]) > 0.0f ? std::max(direction.dot(directions[0]), 0.0f) * InvPi : 0.0f;
    }
};
/// Added to random numbers, so that frames differ.
inline double frameRotation(int frame) {
    constexpr double GoldenRatio = 0.6180339887498949;
    const double turned = double(frame) * GoldenRatio;
    return turned - std::floor(turned);
}
static_assert(sizeof(SliceRecord) == 104, "many are stored: no padding");

} // namespace tungsten::photon
