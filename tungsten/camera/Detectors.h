#pragma once
// Fibres, buckets and single pixels: each is a column of an image one pixel high.

#include "tungsten/core/Types.h"

#include <optional>
#include <string>
#include <vector>

namespace tungsten {

/// A connection from a point to the sensor.
struct SensorSample {
    Vec3f direction; ///< from the point, unit
    float distance;
    /// Power scattered per steradian towards the sensor, times this, is what the point adds to the image per pixel of
    /// area about `raster`: the density of raster positions per solid angle over distance^2 (orthographic: per area
    /// across the rays), divided by the density of the place on the lens. Of detectors: cosine over distance^2, by
    /// the etendue and the density of the place on which one. Visibility not included.
    float weight;
    Vec2f raster; ///< position in the image, in pixels; whole numbers are the centres of filters
};

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
    /// Density per solid angle of such points, of one at a distance along the unit `direction`.
    [[nodiscard]] float pdfPoint(const Vec3f& direction, float distance) const;
    /// Whether it accepts what comes from the unit direction `towards`.
    [[nodiscard]] bool accepts(const Vec3f& towards) const;
    /// How far along the ray it meets the disc, if within the ray's limits and from where it is accepted.
    [[nodiscard]] std::optional<float> intersect(const Ray& ray) const;
};

/// A camera's model: a pixel is the mean radiance that its detector accepts.
struct Detectors {
    std::vector<Detector> row; ///< at least one

    /// A connection to one of them: its disc, at a place drawn evenly. None where it does not accept what comes from
    /// there.
    [[nodiscard]] std::optional<SensorSample> sample(size_t index, const Vec3f& point, const Vec2f& u) const;
    /// Density per solid angle of connections to a detector that is drawn evenly, to a point at a distance along the
    /// unit `direction`.
    [[nodiscard]] float pdf(size_t index, const Vec3f& direction, float distance) const {
        return row[index].pdfPoint(direction, distance) / float(row.size());
    }
};

} // namespace tungsten
