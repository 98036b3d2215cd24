#pragma once
// Fibres, buckets and single pixels: each is a column of an image one pixel high.

#include "tungsten/camera/CameraModel.h"

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
    /// Density per solid angle of such points, of one at a distance along the unit `direction`.
    [[nodiscard]] float pdfPoint(const Vec3f& direction, float distance) const;
    /// Whether it accepts what comes from the unit direction `towards`.
    [[nodiscard]] bool accepts(const Vec3f& towards) const;
    /// How far along the ray it meets the disc, if within the ray's limits and from where it is accepted.
    [[nodiscard]] std::optional<float> intersect(const Ray& ray) const;
};

/// A camera's model: a pixel is the mean radiance that its detector accepts.
struct Detectors : CameraBase {
    static constexpr const char* Type = "detectors";
    std::vector<Detector> row; ///< at least one

    static void read(const CameraReader& fields, Camera& camera);
    [[nodiscard]] Ray generateRay(const CameraPlacement&, const RasterSample& sample) const {
        return row[size_t(sample.pixel.x)].sampleRay(sample.uLens, sample.uFilter);
    }
    /// A connection to any place of any detector: one of them, all alike, then a point of its disc.
    [[nodiscard]] MaybeSensor sampleSensor(const CameraPlacement&, const Vec3f& point, const Vec2f& u) const;
    [[nodiscard]] std::optional<Vec2f> project(const CameraPlacement&, const Vec3f&) const { return std::nullopt; }

    /// A connection to one of them: its disc, at a place drawn evenly. None where it does not accept what comes from
    /// there.
    [[nodiscard]] MaybeSensor sample(size_t index, const Vec3f& point, const Vec2f& u) const;
    /// Density per solid angle of connections to a detector that is drawn evenly, to a point at a distance along the
    /// unit `direction`.
    [[nodiscard]] float pdf(size_t index, const Vec3f& direction, float distance) const {
        return row[index].pdfPoint(direction, distance) / float(row.size());
    }
};

} // namespace tungsten
