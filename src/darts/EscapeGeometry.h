#pragma once
// Bodies that end: what lies between a vertex inside a body of a medium and a target outside.

#include "darts/Vec3.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace darts {

/// How light gets from a vertex to its target, as far as anyone knows.
enum class EscapeModel {
    Infinite, ///< through the vertex's own medium, which may be taken for infinite
    Bounded,  ///< out of a body of the medium: EscapeGeometry
};

/// Up to N of a kind, of which only those that are there are copied: residuals are copied at every vertex.
template <typename T, size_t N>
class InlineVector {
  public:
    InlineVector() = default;
    InlineVector(const InlineVector& other) : size_(other.size_) { std::copy_n(other.items_, size_, items_); }
    InlineVector& operator=(const InlineVector& other) {
        if (this == &other) return *this;
        size_ = other.size_;
        std::copy_n(other.items_, size_, items_);
        return *this;
    }
    ~InlineVector() = default;

    /// Another one; there is room.
    void add(const T& item) { items_[size_++] = item; }
    [[nodiscard]] size_t size() const { return size_; }
    [[nodiscard]] bool full() const { return size_ == N; }
    [[nodiscard]] T& operator[](size_t i) { return items_[i]; }
    [[nodiscard]] const T& operator[](size_t i) const { return items_[i]; }

  private:
    T items_[N];
    size_t size_ = 0;
};

/// How light leaves a body for a target outside, seen from a vertex. Beyond the boundary it flies free. Lengths in one
/// unit, normals unit and outward.
struct EscapeGeometry {
    static constexpr float Infinite = std::numeric_limits<float>::infinity();

    /// A part of the boundary before the target, taken for an infinite plane.
    struct Face {
        Vec3 normal;
        float depth;      ///< of the vertex under it
        float height;     ///< of the target above it
        float thickness;  ///< of the body along the normal, up to where light is lost on the other side, or Infinite
        float outerDepth; ///< depth of this medium whose diffusion takes as long as that of the media outside the face
    };
    /// A plane through the target; it sees, or lights, only what lies inside.
    struct Side {
        Vec3 normal;
        float outside; ///< of the vertex; negative inside
    };

    InlineVector<Face, 3> faces; ///< the first one is where the straight way to the target leaves
    float inside = 0;            ///< length of the straight way up to there
    float lengthPerDepth = 1;    ///< length of straight ways in the body per depth under that face
    float reflectionA = 1;       ///< A = (1 + R) / (1 - R), R the mean internal reflectance; 1: index-matched
    float outerSpeed = 1;        ///< speed of light in the body over that beyond
    float gate = 0;              ///< what is still to come of the gate, a length
    float extraLength = 0;       ///< by which light from other points of the emitter may arrive later
    bool straightExit = true;    ///< light goes on straight beyond the boundary
    bool refractedOnly = false;  ///< every face refracts: no straight connection from inside reaches the target
    InlineVector<Side, 4> sides; ///< pairs of opposite ones; none if the target sees everything
};

/// What a medium n > 1 times as dense reflects of unpolarised light that comes evenly from all directions outside
/// (Walsh 1926); rounding takes over near 1.
inline double reflectanceFromOutside(double n) {
    const double n2 = n * n, n4 = n2 * n2, sum = n2 + 1.0, difference = n2 - 1.0;
    return 0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0)) +
           n2 * difference * difference / (sum * sum * sum) * std::log((n - 1.0) / (n + 1.0)) -
           2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / (sum * (n4 - 1.0)) +
           8.0 * n4 * (n4 + 1.0) / (sum * (n4 - 1.0) * (n4 - 1.0)) * std::log(n);
}

/// A from the relative index n = inside over outside; R by Egan and Hilgeman (1973), whose fit leaves [0, 1] above 3.8
/// and below 0.27: from 1 / 2 to 2 within 0.002, beyond exactly.
inline float boundaryReflectionA(float n) {
    if (n == 1.0f) return 1.0f;
    if (n > 2.0f || n < 0.5f) {
        const double dense = n > 1.0f ? double(n) : 1.0 / double(n), outside = reflectanceFromOutside(dense);
        const double passes = n > 1.0f ? (1.0 - outside) / (dense * dense) : 1.0 - outside;
        return float((2.0 - passes) / passes);
    }
    const float inverse = 1.0f / n;
    const float reflectance =
        n > 1.0f ? -1.440f * inverse * inverse + 0.710f * inverse + 0.668f + 0.0636f * n
                 : -0.4399f + 0.7099f * inverse - 0.3319f * inverse * inverse + 0.0636f * inverse * inverse * inverse;
    return (1.0f + reflectance) / (1.0f - reflectance);
}

} // namespace darts
