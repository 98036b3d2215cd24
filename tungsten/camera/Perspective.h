#pragma once
// Pinhole and thin lens.

#include "tungsten/camera/CameraModel.h"

namespace tungsten {

/// What both answer alike.
struct Perspective : FieldOfView {
    using FieldOfView::FieldOfView;

    [[nodiscard]] std::optional<Vec2f> project(const CameraPlacement& at, const Vec3f& local) const;
    [[nodiscard]] std::optional<FieldOfView> fieldOfView() const { return *this; }
    [[nodiscard]] bool hasParallelRays() const { return false; }
};

struct Pinhole : Perspective {
    static constexpr const char* Type = "pinhole";

    static void read(const CameraReader& fields, Camera& camera);
    [[nodiscard]] Ray generateRay(const CameraPlacement& at, const RasterSample& sample) const;
    [[nodiscard]] MaybeSensor sampleSensor(const CameraPlacement& at, const Vec3f& point, const Vec2f& uLens) const;
    [[nodiscard]] float aperture(const CameraPlacement&) const { return 0.0f; }
    [[nodiscard]] float focusDistance(const CameraPlacement&) const { return Infinity; }
    [[nodiscard]] bool hasSinglePosition() const { return true; }
};

struct ThinLens : Perspective {
    static constexpr const char* Type = "thinlens";
    float distanceOfFocus = 1.0f; ///< along the axis
    float apertureRadius = 0.001f;

    static void read(const CameraReader& fields, Camera& camera);
    [[nodiscard]] Ray generateRay(const CameraPlacement& at, const RasterSample& sample) const;
    [[nodiscard]] MaybeSensor sampleSensor(const CameraPlacement& at, const Vec3f& point, const Vec2f& uLens) const;
    [[nodiscard]] float aperture(const CameraPlacement& at) const {
        return apertureRadius * std::max(at.toWorld.x.length(), at.toWorld.y.length());
    }
    [[nodiscard]] float focusDistance(const CameraPlacement& at) const {
        return distanceOfFocus * at.toWorld.z.length();
    }
    [[nodiscard]] bool hasSinglePosition() const { return false; }
};

} // namespace tungsten
