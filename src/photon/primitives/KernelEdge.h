#pragma once
// Where a record's kernel ends because surfaces are near.

#include "tungsten/core/Types.h"

namespace tungsten::photon {

/// The side of a plane that a kernel keeps to: points x with normal . (x - y) < reach, y the record's position.
struct KernelEdge {
    Vec3f normal{0.0f};     ///< unit, away from the side that is kept
    float reach = Infinity; ///< of the plane along the normal, below 0 where the record lies beyond it

    /// False where no surface is near.
    [[nodiscard]] bool exists() const { return reach < Infinity; }
    /// Whether it holds y + offset.
    [[nodiscard]] bool holds(const Vec3f& offset) const { return normal.dot(offset) < reach; }
};

/// Edges at the nearest surface, and at one that is as near on the other side.
struct KernelEdges {
    KernelEdge nearest, opposite;
};

} // namespace tungsten::photon
