#include "path/techniques/RefractedPath.h"

namespace tungsten::path {

namespace {

/// t > 0 with a t + b t / sqrt(m² + (m² - 1) t²) = sum, for m of at least 1: the tangent of the angle where the index
/// is lower. The left side is concave, so that Newton's steps from below never pass the solution.
double tangentOf(double a, double b, double m, double sum) {
    constexpr int MostSteps = 64;
    const double slope = m * m;
    double t = sum / (a + b / m);
    for (int i = 0; i < MostSteps; ++i) {
        const double squared = slope + (slope - 1.0) * t * t, root = std::sqrt(squared);
        const double step = (sum - t * (a + b / root)) / (a + b * slope / (squared * root));
        t += step;
        if (!(step > 1e-5 * t)) break; // what is left is about the square of it
    }
    return t;
}

} // namespace

float RefractedPath::areaPerSolidAngle(float index) const {
    // lateral = depth tan + height tan', sin' = index sin; area = lateral d lateral, solid angle = sin d angle
    const float out = height * index / cosOutside;
    return (depth / cosInside + out) * (depth / sqr(cosInside) + out * cosInside / sqr(cosOutside));
}

std::optional<RefractedPath> refractedPath(float depth, float height, float lateral, float index) {
    if (!(depth > 0.0f) || !(height > 0.0f)) return std::nullopt;
    const auto cosine = [](double tangent) { return 1.0 / std::sqrt(1.0 + tangent * tangent); };
    const bool denser = index >= 1.0f;
    const double m = denser ? double(index) : 1.0 / double(index);
    const double wide = denser ? tangentOf(double(height), double(depth), m, double(lateral))
                               : tangentOf(double(depth), double(height), m, double(lateral));
    const double narrow = wide / std::sqrt(m * m + (m * m - 1.0) * wide * wide);
    const RefractedPath way{depth, height, float(cosine(denser ? narrow : wide)),
                            float(cosine(denser ? wide : narrow))};
    if (!(way.cosInside > 0.0f) || !(way.cosOutside > 0.0f)) return std::nullopt;
    return way;
}

std::optional<Vec3f> refractedOut(const Vec3f& direction, const Vec3f& normal, float index) {
    const float cosine = direction.dot(normal);
    const float squared = 1.0f - sqr(index) * (1.0f - sqr(cosine));
    if (!(cosine > 0.0f) || !(squared > 0.0f)) return std::nullopt;
    return (direction * index + normal * (std::sqrt(squared) - index * cosine)).normalized();
}

} // namespace tungsten::path
