#include "tungsten/bsdf/ShadingFrame.h"

namespace tungsten {

Frame bumpedFrame(const Bsdf& bsdf, const Vec3f& ns, const Tangents& tangents, const Vec2f& uv) {
    const Vec2f slope = bsdf.bump->derivatives(uv);
    const Vec3f t = tangents.u + ns * (slope.x - ns.dot(tangents.u)),
                b = tangents.v + ns * (slope.y - ns.dot(tangents.v));
    const Vec3f bumped = t.cross(b);
    const float length = bumped.length();
    if (!(length > 0.0f) || !std::isfinite(length)) return Frame(ns);
    return Frame(bumped.dot(ns) < 0.0f ? -bumped / length : bumped / length, t);
}

} // namespace tungsten
