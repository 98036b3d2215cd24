#pragma once
// Bodies that end: what lies between a vertex inside a body of a medium and a target outside.

#include "darts/Vec3.h"

#include <array>
#include <limits>

namespace darts {

/// How light gets from a vertex to its target, as far as anyone knows.
enum class Way {
    Through, ///< through the vertex's own medium, which may be taken for infinite
    Out,     ///< out of a body of the medium: Exit
    Unknown, ///< only bounds in time hold
};

/// How light leaves a body for a target outside, seen from a vertex. Beyond the boundary it flies free. Lengths in one
/// unit, normals unit and outward.
struct Exit {
    static constexpr float Infinite = std::numeric_limits<float>::infinity();

    /// A part of the boundary before the target, taken for an infinite plane.
    struct Face {
        Vec3 normal;
        float depth;     ///< of the vertex under it
        float height;    ///< of the target above it
        float thickness; ///< of the body along the normal, up to where light is lost on the other side, or Infinite
        float beyond;    ///< depth of this medium that takes as long as what light diffuses through farther out
    };
    /// A plane through the target; it sees, or lights, only what lies inside.
    struct Side {
        Vec3 normal;
        float outside; ///< of the vertex; negative inside
    };

    std::array<Face, 3> faces; ///< the first one is where the straight way to the target leaves
    int count = 0;
    float inside = 0;          ///< length of the straight way up to there
    float mismatch = 1;        ///< A = (1 + R) / (1 - R), R the mean internal reflectance; 1: index-matched
    float outerSpeed = 1;      ///< speed of light in the body over that beyond
    float gate = 0;            ///< length of the gate
    float surplus = 0;         ///< by so much the latest arrival is later than what the target itself allows
    bool connects = true;      ///< light goes on straight beyond the boundary
    bool sealed = false;       ///< and does so nowhere: no connection from inside is ever complete
    float leaveOdds = 1;       ///< factor on the odds of a flight's end at the surface ahead
    bool narrow = false;       ///< sides are set
    std::array<Side, 4> sides; ///< two pairs of opposite ones
};

/// A from the relative index n = inside over outside; R by Egan and Hilgeman (1973).
inline float boundaryMismatch(float n) {
    if (n == 1.0f) return 1.0f;
    const float inverse = 1.0f / n;
    const float reflectance =
        n > 1.0f ? -1.440f * inverse * inverse + 0.710f * inverse + 0.668f + 0.0636f * n
                 : -0.4399f + 0.7099f * inverse - 0.3319f * inverse * inverse + 0.0636f * inverse * inverse * inverse;
    return (1.0f + reflectance) / (1.0f - reflectance);
}

} // namespace darts
