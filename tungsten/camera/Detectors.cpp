#include "tungsten/camera/Detectors.h"

#include "tungsten/camera/CameraReader.h"
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

float Detector::pdfPoint(const Vec3f& direction, float distance) const {
    return sqr(distance) / (Pi * sqr(radius) * std::max(-direction.dot(frame.n), 1e-20f));
}

bool Detector::accepts(const Vec3f& towards) const {
    const Vec3f local = frame.toLocal(towards);
    return local.z > 0.0f && sqr(local.x) + sqr(local.y) <= sqr(aperture);
}

std::optional<float> Detector::intersect(const Ray& ray) const {
    if (!accepts(-ray.direction)) return std::nullopt;
    const Vec3f offset = position - ray.origin;
    const float length = offset.dot(frame.n) / ray.direction.dot(frame.n);
    // The foot from the middle, not from the origin of a ray that comes from afar.
    const Vec3f foot = ray.direction * length - offset;
    if (!(length > ray.tMin && length < ray.tMax) || foot.length2() > sqr(radius)) return std::nullopt;
    return length;
}

MaybeSensor Detectors::sample(size_t index, const Vec3f& point, const Vec2f& u) const {
    const Detector& detector = row[index];
    const Vec3f offset = detector.samplePoint(u) - point;
    const float distance = offset.length();
    const Vec3f direction = offset / distance;
    if (!(distance > 0.0f) || !detector.accepts(-direction)) return std::nullopt;
    const float area = Pi * sqr(detector.radius), cosine = -direction.dot(detector.frame.n);
    const float weight = area * cosine / (sqr(distance) * float(detector.etendue()));
    return SensorSample{direction, distance, weight, {float(index), 0.0f}};
}

MaybeSensor Detectors::sampleSensor(const CameraPlacement&, const Vec3f& point, const Vec2f& u) const {
    const float count = float(row.size()), scaled = u.x * count;
    const auto index = std::min(size_t(scaled), row.size() - 1);
    auto drawn = sample(index, point, {std::min(scaled - float(index), 1.0f), u.y});
    if (drawn) drawn->weight *= count;
    return drawn;
}

namespace {

Detector readDetector(const ObjectReader& block, const Transform& placement) {
    Detector detector;
    detector.name = block.text("name", "", {"none", "what results call it"});
    detector.position =
        placement.point(block.vec3("position", Vec3f(0.0f), {"length", "middle of its disc"}, Range::coordinate()));
    const Vec3f direction = placement.vector(block.vec3(
        "direction", Vec3f(0, 0, 1), {"none", "where it looks: the normal of its disc"}, Range::coordinate()));
    const bool looks = direction.length() > LeastPositive;
    if (!looks) block.problem("direction", "expected a direction, found the length 0");
    detector.frame = Frame(looks ? direction.normalized() : Vec3f(0, 0, 1));
    detector.radius = float(block.number("radius", 0.001, {"length", "of its disc"}, CameraReader::LensRange));
    detector.aperture = float(block.number("numerical_aperture", 1.0,
                                           {"none", "sine of the half angle within which it accepts light; 1: a bucket "
                                                    "that accepts a hemisphere"},
                                           {1e-6, 1.0}));
    block.refuseUnknown({{"aperture", "numerical_aperture is the sine of the cone's half angle"},
                         {"angle", "numerical_aperture is the sine of the cone's half angle"},
                         {"na", "numerical_aperture is meant"},
                         {"diameter", "radius is half of it"},
                         {"look_at", "direction is look_at - position"}});
    return detector;
}

} // namespace

/// As many columns as there are detectors.
void Detectors::read(const CameraReader& fields, Camera& camera) {
    const Transform placement = fields.has("transform") ? fields.transform("transform", PlacementMeaning) : Transform();
    Detectors detectors;
    const Meaning meaning{"none", "detectors: discs that accept light within a cone, each a pixel of one row"};
    for (const ObjectReader& block : fields.blocks("detectors", meaning))
        detectors.row.push_back(readDetector(block, placement));
    fields.accept({"fov", "orthographic_size"});
    if (fields.describes()) return;
    if (detectors.row.empty() || detectors.row.size() > size_t(CameraReader::LargestSide))
        return fields.problem("detectors",
                              "expected an array of 1 to " + brief(CameraReader::LargestSide) + " detectors");
    if (fields.has("resolution"))
        fields.problem("resolution", "the image has a pixel for each detector, in one row; leave it out");
    camera.resolution = {int(detectors.row.size()), 1};
    camera.toWorld = Transform();
    camera.toWorld.translation = detectors.row.front().position;
    camera.filter = ReconstructionFilter(FilterType::Box);
    camera.model = std::move(detectors);
}

} // namespace tungsten
