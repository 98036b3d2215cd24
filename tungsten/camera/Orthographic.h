#pragma once
// Parallel rays along the axis.

#include "tungsten/camera/CameraModel.h"

namespace tungsten {

struct Orthographic : CameraBase {
    static constexpr const char* Type = "orthographic";
    float size = 1.0f; ///< half the image height

    static void read(const CameraReader& fields, Camera& camera);
    [[nodiscard]] Ray generateRay(const CameraPlacement& at, const RasterSample& sample) const;
    [[nodiscard]] MaybeSensor sampleSensor(const CameraPlacement& at, const Vec3f& point, const Vec2f& uLens) const;
    [[nodiscard]] std::optional<Vec2f> project(const CameraPlacement& at, const Vec3f& local) const;
};

} // namespace tungsten
