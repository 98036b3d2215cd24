#pragma once
// Which pixels of a pinhole camera's image have rays near something.

#include "photon/raster/Registers.h"

#include "tungsten/camera/Camera.h"

#include <optional>
#include <span>

namespace tungsten::photon {

/// Rows and columns, inclusive.
struct PixelArea {
    int left, right, top, bottom;
};

/// Which pixels have rays through a sphere. Where the whole sphere lies in front of the camera its image is an ellipse,
/// and rows have narrower columns than the area.
struct ImageDisc {
    PixelArea area;
    bool ellipse = false;
    float up, forward, squaredRadius;  ///< of the sphere, as the camera sees it
    float shift, slant, spread;        ///< chord at height Y: shift + slant Y +- spread root(Y), all as slopes
    float heightOfLeft, heightOfRight; ///< where the outline reaches its leftmost and rightmost points
};

/// Directions p with normal . p >= 0, by columns X and rows Y of the image plane: a X + b Y + c >= 0.
struct ImageHalfPlane {
    float a, b, c;
};

/// Projects onto the image of a pinhole camera. Its answers hold every ray that the pixel filter can draw.
class ImageFootprint {
  public:
    explicit ImageFootprint(const Camera& camera);

    /// Pixels whose rays can come within `radius` of the line from `start` to `end`; none if there are none.
    [[nodiscard]] std::optional<PixelArea> around(const Vec3f& start, const Vec3f& end, float radius) const;
    [[nodiscard]] std::optional<PixelArea> around(const Vec3f& point, float radius) const {
        return around(point, point, radius);
    }
    /// Pixels whose rays can meet the hull of these points; none if there are none.
    [[nodiscard]] std::optional<PixelArea> aroundHull(std::span<const Vec3f> points) const;
    /// Pixels whose rays can meet a sphere, with the image's outline.
    [[nodiscard]] std::optional<ImageDisc> disc(const Vec3f& point, float radius) const;
    /// Columns [left[i], right[i]] of row firstRow + i whose pixels can have rays through the sphere; none if right <
    /// left.
    struct Columns {
        alignas(64) int32_t left[Lanes], right[Lanes];
    };
    [[nodiscard]] Columns columns(const ImageDisc& disc, int firstRow) const;
    /// Where directions from the camera have a component along `normal`.
    [[nodiscard]] ImageHalfPlane halfPlane(const Vec3f& normal) const;
    /// Narrows columns [left, right] to those whose pixels in row y can lie in the half-plane.
    void narrow(const ImageHalfPlane& half, int y, int& left, int& right) const;

  private:
    struct Slopes {
        float low, high;
    };
    [[nodiscard]] std::optional<PixelArea> area(const std::optional<Slopes>& x, const std::optional<Slopes>& y) const;
    /// First and last row or column with rays beyond or before a coordinate of the image.
    [[nodiscard]] int firstPixel(float from, int size) const;
    [[nodiscard]] int lastPixel(float to, int size) const;
    /// Slopes of rays within `radius`, sideways against forward; none where they have no bounds.
    [[nodiscard]] static std::optional<Slopes> slopes(float sideways, float forward, float radius);

    Frame frame_;
    Vec3f origin_;
    int width_, height_;
    float margin_; ///< rays leave pixel centres by the filter, whose samples may reach a little beyond its half width
    float pixelsPerSlope_;
};

} // namespace tungsten::photon
