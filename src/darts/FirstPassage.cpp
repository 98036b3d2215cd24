#include "darts/FirstPassage.h"

namespace darts {

FirstPassage::Slopes FirstPassage::slopes(const EscapePoint<float>& at, const Vec3& towardsTarget) const {
    const float step = meanFreePath_;
    Slopes slopes;
    float highest = -EscapeGeometry::Infinite, total = 0;
    for (size_t i = 0; i < exit_.faces.size(); ++i) {
        const EscapeGeometry::Face& face = exit_.faces[i];
        const EscapePoint<float>::RemainingLength here = at.to(face);
        EscapePoint<float>::RemainingLength deeper = here, later = here;
        deeper.depth += step;
        later.longest += step;
        const float log = logThrough(face, here);
        const float change = log - logThrough(face, deeper), inTime = (logThrough(face, later) - log) / step;
        // Towards the boundary it may grow exponentially, away from it hardly faster than the distance.
        const float outward = (change > 0.0f ? change : std::expm1(change)) / step;
        // A step along the boundary towards the target saves as much length outside.
        const Vec3 along = towardsTarget - face.normal * dot(towardsTarget, face.normal);
        const float top = std::max(highest, log), before = std::exp(highest - top), share = std::exp(log - top);
        slopes.pull = slopes.pull * before + (face.normal * outward + along * inTime) * share;
        slopes.later = slopes.later * before + inTime * share;
        total = total * before + share;
        highest = top;
    }
    slopes.pull = slopes.pull * (1.0f / total);
    slopes.later /= total;
    for (size_t i = 0; i < exit_.sides.size(); i += 2) {
        const EscapeGeometry::Side &a = exit_.sides[i], &b = exit_.sides[i + 1], &side = a.outside > b.outside ? a : b;
        if (side.outside > 0.0f)
            slopes.pull = slopes.pull - side.normal * (2.0f * side.outside * fourthInverseD_ /
                                                       (std::max(at.excess, 0.0f) + meanFreePath_));
    }
    return slopes;
}

} // namespace darts
