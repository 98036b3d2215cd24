#include "tungsten/camera/Detectors.h"

#include "tungsten/core/Warp.h"

#include <cmath>

namespace tungsten {

double Detector::etendue() const {
    return double(Pi) * double(Pi) * double(radius) * double(radius) * double(aperture) * double(aperture);
}

Ray Detector::sampleRay(const Vec2f& uPlace, const Vec2f& uDirection) const {
    // A direction's projected solid angle is the area of its foot on the unit disc.
    const Vec2f foot = warp::squareToDisk(uDirection) * aperture;
    const Vec3f local(foot.x, foot.y, std::sqrt(std::max(1.0f - sqr(foot.x) - sqr(foot.y), 0.0f)));
    return {samplePoint(uPlace), frame.toWorld(local).normalized()};
}

Vec3f Detector::samplePoint(const Vec2f& u) const {
    const Vec2f disk = warp::squareToDisk(u) * radius;
    return position + frame.s * disk.x + frame.t * disk.y;
}

bool Detector::accepts(const Vec3f& towards) const {
    const Vec3f local = frame.toLocal(towards);
    return local.z > 0.0f && sqr(local.x) + sqr(local.y) <= sqr(aperture);
}

} // namespace tungsten
