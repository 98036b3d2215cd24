#pragma once
// The part of a beam's ribbon that lies before the surfaces near it.

#include "photon/primitives/KernelEdge.h"

#include <algorithm>
#include <cmath>

namespace tungsten::photon {

/// Across a beam, of the ribbon that a camera ray sees: half-width r, without what the beam's edges cut off.
struct RibbonRange {
    float low, high;

    /// `along`: from the beam's base to the ribbon's place; `across`: unit, the ribbon's direction there.
    static RibbonRange of(const KernelEdges& edges, float along, const Vec3f& direction, const Vec3f& across,
                          float radius) {
        RibbonRange range{-radius, radius};
        for (const KernelEdge& edge : {edges.nearest, edges.opposite})
            if (edge.exists()) range.cut(edge.reach - along * edge.normal.dot(direction), edge.normal.dot(across));
        return range;
    }
    [[nodiscard]] bool holds(float distance) const { return distance >= low && distance < high; }
    [[nodiscard]] float width() const { return high - low; }

  private:
    /// Cuts the range by a plane at `height` from the beam. A beam that leaves a plane behind before the curved surface
    /// itself counts as lying on it.
    void cut(float height, float slope) {
        const float end = std::max(height, 0.0f) / std::max(std::abs(slope), 1e-6f);
        if (slope > 0.0f)
            high = std::min(high, end);
        else
            low = std::max(low, -end);
    }
};

} // namespace tungsten::photon
