#pragma once
// Fibres, buckets and single pixels: each is a column of an image one pixel high.

#include "tungsten/core/Types.h"

#include <string>
#include <vector>

namespace tungsten {

/// A disc that accepts light within a cone about its normal.
struct Detector {
    std::string name;
    Vec3f position;
    Frame frame; ///< n is where it looks
    float radius = 0.0f;
    float aperture = 1.0f; ///< numerical: sine of the cone's half angle; 1: the hemisphere

    /// Area times projected solid angle, pi^2 radius^2 aperture^2: times mean radiance it is power.
    [[nodiscard]] double etendue() const;
    /// Even over the disc (`uPlace`) and over the projected solid angle (`uDirection`), so that the mean of what rays
    /// bring is the mean radiance.
    [[nodiscard]] Ray sampleRay(const Vec2f& uPlace, const Vec2f& uDirection) const;
    /// A point of the disc, even over it.
    [[nodiscard]] Vec3f samplePoint(const Vec2f& u) const;
    /// Whether it accepts what comes from the unit direction `towards`.
    [[nodiscard]] bool accepts(const Vec3f& towards) const;
};

/// A camera's model: a pixel is the mean radiance that its detector accepts.
struct Detectors {
    std::vector<Detector> row; ///< at least one
};

} // namespace tungsten
