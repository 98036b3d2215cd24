#include "path/techniques/ShellChord.h"

namespace tungsten::path {

ShellChord::ShellChord(const Vec3f& toCentre, const Vec3f& direction, double low, double high, double tMax)
    : centre_(double(toCentre.dot(direction))), tMax_(tMax) {
    const Vec3d off = Vec3d(toCentre) - Vec3d(direction) * centre_;
    squaredHeight_ = off.length2();
    // Any positive spread is a valid density; through the centre itself the angle would have none.
    spread_ = std::max(std::sqrt(squaredHeight_), 1e-4 * high);
    const double outside = high * high - squaredHeight_;
    if (!(high > 0.0) || !(outside > 0.0)) return;
    const double outer = std::sqrt(outside),
                 inner = low > 0.0 ? std::sqrt(std::max(low * low - squaredHeight_, 0.0)) : 0.0;
    bounds_ = {{{centre_ - outer, centre_ - inner}, {centre_ + inner, centre_ + outer}}};
    bool any = false;
    for (size_t i = 0; i < 2; ++i) {
        auto& [from, to] = bounds_[i];
        from = std::max(from, 0.0);
        to = std::min(to, tMax);
        if (!(to > from)) {
            from = to = 0.0;
            continue;
        }
        begin_ = any ? begin_ : from;
        end_ = to;
        any = true;
        angle_[i] = angleOf(from);
        range_[i] = angleOf(to) - angle_[i];
    }
}

double ShellChord::sample(double u) const {
    double angle = u * (range_[0] + range_[1]);
    const size_t i = angle < range_[0] || !(range_[1] > 0.0) ? 0 : 1;
    angle = i == 0 ? angle : angle - range_[0];
    const double t = centre_ + spread_ * std::tan(angle_[i] + angle);
    return std::clamp(t, bounds_[i][0], bounds_[i][1]);
}

double ShellChord::pdf(double t) const {
    const auto inside = [t](const std::array<double, 2>& bounds) {
        return t >= bounds[0] && t <= bounds[1] && bounds[1] > bounds[0];
    };
    if (empty() || !(inside(bounds_[0]) || inside(bounds_[1]))) return 0.0;
    const double offset = t - centre_;
    return spread_ / ((spread_ * spread_ + offset * offset) * (range_[0] + range_[1]));
}

int ShellChord::intersect(double radius, std::array<double, 2>& t, std::array<double, 2>& perRadius) const {
    const double squared = radius * radius - squaredHeight_;
    if (!(squared > 0.0)) return 0;
    const double half = std::sqrt(squared);
    int count = 0;
    for (const double root : {centre_ - half, centre_ + half})
        if (root > 0.0 && root < tMax_) {
            t[size_t(count)] = root;
            perRadius[size_t(count++)] = radius / half;
        }
    return count;
}

} // namespace tungsten::path
