#pragma once
// Faces that lie on one another: bodies that touch, a body on a floor, a lamp on a ceiling, one body just inside
// another. A ray meets all of them at one place, and rounding must not decide which, nor in what order.

#include "tungsten/geometry/Shape.h"

#include <cstdint>
#include <vector>

namespace tungsten {

/// Which faces of a scene lie on others, to rounding, and in what order a ray meets those at one place. Found once,
/// from the shapes alone; costs nothing where there are none.
class CoincidentFaces {
  public:
    /// `opaque`, by shape, if not empty: neither passes light nor emits it. Two such faces that look at each other, or
    /// away from each other, hide each other and do not count.
    explicit CoincidentFaces(const std::vector<const Shape*>& shapes, const std::vector<bool>& opaque = {},
                             const LoadWatch& watch = {});

    [[nodiscard]] bool any() const { return any_; }
    /// How far from the face, along its normal, those lie that count as at the same place; 0 where there are none.
    [[nodiscard]] float reach(const FaceIndex& at) const {
        const std::vector<float>& reaches = reaches_[at.shape];
        return reaches.empty() ? 0.0f : reaches[at.face];
    }

    /// Where a face comes among those at one place: `along` is whether its normal points along the ray. Lower values
    /// are met first, and a ray the other way meets them in reverse. Bodies are left before others are entered, inner
    /// before outer ones; a sheet (what encloses no volume) lies between bodies, and a smaller one is in front, on the
    /// side of its normal, of a larger.
    [[nodiscard]] int64_t order(uint32_t shape, bool along) const;

    /// Normals of faces at one place are at most this far from parallel (squared sine).
    static constexpr float Parallel = 1e-6f;

  private:
    struct Rank {
        int64_t size = 0; ///< by size among all shapes, from 1
        bool sheet = false;
    };

    void rankShapes(const std::vector<const Shape*>& shapes);
    void mark(const FaceIndex& at, float reach);

    std::vector<std::vector<float>> reaches_; ///< per shape and face; empty for a shape without any
    std::vector<size_t> faces_;               ///< of each shape
    std::vector<Rank> ranks_;
    bool any_ = false;
};

} // namespace tungsten
