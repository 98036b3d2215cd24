#pragma once
// How a camera's model reads itself.

#include "tungsten/camera/Camera.h"
#include "tungsten/reader/ObjectReader.h"

namespace tungsten {

class CameraReader : public ObjectReader {
  public:
    static constexpr double LargestSide = 65536; ///< pixels
    static constexpr Range LensRange{1e-9, 1e9};

    CameraReader(const ObjectReader& object, const ObjectReader& scene) : ObjectReader(object), scene_(scene) {}

    [[nodiscard]] float fov() const {
        return float(number("fov", 60.0, {"degrees", "horizontal field of view"}, {1e-3, 179.0}));
    }
    /// `focus_pivot` names a primitive: the distance of its origin, else `distance`.
    [[nodiscard]] float pivotDistance(const Vec3f& cameraPosition, float distance) const;

  private:
    ObjectReader scene_;
};

} // namespace tungsten
