#include "path/techniques/RefractedView.h"

#include "path/Tuning.h"

namespace tungsten::path {

using transport::BoundedMedium;

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

// ---- Faces and emitters

namespace {

/// Most triangles of one light: each is asked whether a direction meets it.
constexpr size_t MostLampTriangles = 64;
/// Between a way to the boundary and its normal: a guard, which no way reaches at indices above 1.02.
constexpr float LeastRefractedCosine = 0.2f;

} // namespace

bool RefractedEmitter::isOne(const Emitter& emitter) {
    const AreaEmitter* area = emitter.surface();
    if (!area || !(area->areaSampler->area() > 0.0f)) return false;
    return std::visit([](const auto& m) { return m.faceCount() <= MostLampTriangles; }, *area->shape);
}

/// Moeller and Trumbore 1997.
float meetsFront(const TriangleMesh& mesh, const Triangle& triangle, const Vec3f& origin, const Vec3f& direction) {
    const Vec3f a = mesh.positions[triangle.v[0]];
    const Vec3f edge1 = mesh.positions[triangle.v[1]] - a, edge2 = mesh.positions[triangle.v[2]] - a;
    const Vec3f across = direction.cross(edge2), from = origin - a;
    const float determinant = edge1.dot(across); // positive: from the front
    if (!(determinant > 0.0f)) return -1.0f;
    const float b1 = from.dot(across);
    const Vec3f turned = from.cross(edge1);
    const float b2 = direction.dot(turned);
    if (b1 < 0.0f || b2 < 0.0f || b1 + b2 > determinant) return -1.0f;
    return edge2.dot(turned) / determinant;
}

RefractedView::RefractedView(const Vec3f& vertex, const BoundedMedium::Face& face, float relativeIndex, float speed,
                             const RefractedEmitter& emitter)
    : position(vertex), normal(face.normal), depth((face.point - vertex).dot(face.normal)), index(relativeIndex),
      speedInside(speed), lamp(emitter) {
    foot = vertex + normal * depth;
    leastCosine = std::max(std::sqrt(std::max(1.0f - 1.0f / sqr(index), 0.0f)), LeastRefractedCosine);
    widest = depth * std::sqrt(1.0f / sqr(leastCosine) - 1.0f);
}

auto RefractedView::aim(const RefractedPath& way, const Vec3f& direction, const Vec3f& outward,
                        const Vec3f& normalThere) const -> std::optional<RefractedTarget> {
    const float emission = -outward.dot(normalThere);
    if (!(way.cosInside >= leastCosine) || !lamp.area().shinesAt(emission)) return std::nullopt;
    const float area = way.areaPerSolidAngle(index) * way.cosOutside / emission;
    return RefractedTarget{way, direction, way.inside() / speedInside + way.outside() / lamp.speed,
                           area / lamp.area().areaSampler->area()};
}

auto RefractedView::courseTo(const Vec3f& point) const -> std::optional<Course> {
    const Vec3f offset = point - foot;
    const float height = offset.dot(normal);
    const Vec3f along = offset - normal * height;
    const float lateral = along.length();
    const auto way = refractedPath(depth, height, lateral, index);
    if (!way) return std::nullopt;
    const float sine = std::sqrt(std::max(1.0f - sqr(way->cosInside), 0.0f));
    const Vec3f tangent = lateral > 0.0f ? along / lateral : Vec3f(0.0f);
    return Course{*way, (tangent * sine + normal * way->cosInside).normalized(),
                  tangent * (index * sine) + normal * way->cosOutside};
}

std::optional<Vec3f> RefractedView::directionTo(const Vec3f& point) const {
    const auto course = courseTo(point);
    return course ? std::optional(course->direction) : std::nullopt;
}

auto RefractedView::towards(const Vec3f& point, const Vec3f& normalThere) const -> std::optional<RefractedTarget> {
    const auto course = courseTo(point);
    return course ? aim(course->way, course->direction, course->outward, normalThere) : std::nullopt;
}

} // namespace tungsten::path
