#pragma once
// Where a walk has got to.

#include "tungsten/scene/Interaction.h"

namespace tungsten::transport {

/// The last vertex that a walk has not passed straight: where its present direction was drawn.
struct LastVertex {
    enum class Kind { Specular, Surface, Medium }; ///< Specular: mirrors, refraction, and where the walk starts

    Kind kind = Kind::Specular;
    Vec3f position{0.0f};
    float pdf = 0.0f; ///< of the present direction, per solid angle (Way::pdf)
};

/// In double, of positions as they are stored.
inline double distanceBetween(const Vec3f& a, const Vec3f& b) {
    const Vec3d d(double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z));
    return d.length();
}

/// A value: copies of a walk that is split have one each.
struct PathState {
    Sampler random;       ///< the path's own numbers
    Ray ray{};            ///< ahead, from the last vertex, unit direction; at a vertex: the direction up to there
    Region region{};      ///< medium and speed along it
    Rgb throughput{1.0f}; ///< the path's contribution per channel over its density; walks from lights may hold power
    ChannelDensities channels{1.0f}; ///< of plain flights
    float logRatio = 0.0f;           ///< log of the density of guided paths up to here over that of plain ones
    double time = 0.0;               ///< of flight so far; stands still while `timed` is false
    int interactions = 0;            ///< surfaces met, index-matched ones included, and scatterings in media
    int flights = 0;                 ///< in scattering media since the last surface
    int mediumScatters = 0;
    int inARow = 0;         ///< the last of these, since the last surface
    bool timed = true;      ///< false: on camera segments that do not count, up to the first vertex that scatters
    bool scattered = false; ///< at a surface by a smooth lobe, or in a medium
    LastVertex last{};

    /// The time at the end of a straight way of this length.
    [[nodiscard]] double timeAfter(double length) const { return timed ? time + length / double(region.speed) : time; }
};
static_assert(sizeof(PathState) <= 256, "walks are copied where they are split");

} // namespace tungsten::transport
