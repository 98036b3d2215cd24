#include "tungsten/bsdf/ShadingFrame.h"

namespace tungsten {

Frame shadingFrame(const Bsdf& bsdf, const Vec3f& ns, const Vec3f& dpdu, const Vec3f& dpdv, const Vec2f& uv) {
    if (!bsdf.bump) return Frame(ns);
    const Vec2f slope = bsdf.bump->derivatives(uv);
    const Vec3f t = dpdu + ns * (slope.x - ns.dot(dpdu)), b = dpdv + ns * (slope.y - ns.dot(dpdv));
    const Vec3f bumped = t.cross(b);
    const float length = bumped.length();
    if (!(length > 0.0f) || !std::isfinite(length)) return Frame(ns);
    return Frame(bumped.dot(ns) < 0.0f ? -bumped / length : bumped / length, t);
}

} // namespace tungsten
