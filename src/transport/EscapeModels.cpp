#include "transport/EscapeModels.h"

#include "transport/Tuning.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::transport {

namespace {

/// Media that a way goes through before what is beyond counts as unknown.
constexpr int MostLayers = 8;
/// Between a way and the normal of the face it leaves through: a guard.
constexpr float LeastCosine = 0.05f;

Region regionBehind(const Scene& scene, const SurfaceHit& hit, const Vec3f& direction, const Region& region) {
    return regionBeyond(makeInteraction(scene, hit, direction), direction, region);
}

darts::EscapeGeometry::Face faceOf(const BoundedMedium& body, const BoundedMedium::Face& face, const Vec3f& position,
                                   const Vec3f& target) {
    darts::EscapeGeometry::Face result;
    result.normal = darts::vec3(face.normal);
    result.depth = std::max((face.point - position).dot(face.normal), 0.0f);
    result.height = std::max((target - face.point).dot(face.normal), 0.0f);
    Vec3f behind; // the box's corner farthest behind the boundary
    for (int axis = 0; axis < 3; ++axis)
        behind[axis] = face.normal[axis] > 0.0f ? body.box.min[axis] : body.box.max[axis];
    const float thickness = (face.point - behind).dot(face.normal);
    result.thickness = result.depth < thickness ? thickness : darts::EscapeGeometry::Infinite;
    result.outerDepth = 0.0f;
    return result;
}

} // namespace

EscapeModels::EscapeModels(const Scene& scene) : scene_(scene), bodies_(boundedMediaOf(scene)) {
    layered_ =
        std::count_if(bodies_.begin(), bodies_.end(), [](const BoundedMedium& body) { return body.scatters(); }) > 1;
}

std::unique_ptr<const EscapeModels> EscapeModels::make(const Scene& scene, const Policy& policy) {
    if (!policy.followsBodies()) return nullptr;
    auto escapeModels = std::make_unique<const EscapeModels>(scene);
    return escapeModels->any() ? std::move(escapeModels) : nullptr;
}

void EscapeModels::plan(const Scene& scene, const Policy& policy, Features& features) {
    const auto escapeModels = make(scene, policy);
    for (size_t i = 0; i < scene.media.size(); ++i) {
        const Medium& medium = scene.media[i];
        if (!medium.scatters()) continue;
        const std::string name =
            "model of " + (medium.name.empty() ? "#" + std::to_string(i) : "'" + medium.name + "'");
        features.describe(name, true,
                          escapeModels             ? escapeModels->describe(int(i))
                          : policy.followsBodies() ? "infinite medium: light passes no boundary of a scattering medium"
                                                   : "infinite medium: the preset or bodies leaves boundaries alone");
    }
}

bool EscapeModels::any() const {
    return std::any_of(bodies_.begin(), bodies_.end(),
                       [](const BoundedMedium& body) { return body.scatters() && body.ends(); });
}

bool EscapeModels::isThin(const BoundedMedium& body) {
    return body.box.size().length() * body.reducedSigmaT < tuning::ThinDepth;
}

bool EscapeModels::isBounded(int medium, int from) const {
    const BoundedMedium& body = bodies_[size_t(medium)];
    return body.ends() && !isThin(body) && (from != medium || body.insides > 1);
}

void EscapeModels::choose(const FlightStart& start, const Region& region, const EscapeTarget& aim,
                          darts::TimeBudget& budget, uint64_t& rays) const {
    if (region.medium < 0 || budget.C == 0.0f) return;
    if (!isBounded(region.medium, aim.medium)) return;
    const BoundedMedium& body = bodies_[size_t(region.medium)];
    if (body.primitive) {
        const BoundedMedium::BoundaryHit exit = body.intersectBoundary(start.position, darts::to<Vec3f>(budget.axis));
        const Bsdf& bsdf = *body.primitive->bsdfs[0];
        const SurfaceMargin margin{exit.face.normal, roundingError(exit.face.point, exit.face.normal)};
        return setGeometry({exit, bsdf.relativeIndex(), isIndexMatched(bsdf), body.primitive->outside, margin},
                           start.position, region, aim, budget, rays);
    }
    // From the boundary itself the way out of a body that the walk enters would miss it.
    const Vec3f position = start.position + start.ahead * start.clear;
    const Vec3f toAim = aim.position - position;
    const float distance = toAim.length();
    const Vec3f direction = toAim / distance;
    Ray way = start.margin.spawnRay(position, direction);
    way.tMax = aim.margin.before(direction, distance);
    const auto boundary = findBoundary(way, region, rays);
    if (boundary) setGeometry(*boundary, start.position, region, aim, budget, rays);
}

std::optional<EscapeModels::Boundary> EscapeModels::findBoundary(Ray way, const Region& region, uint64_t& rays) const {
    std::optional<Boundary> hole; // the last one entered
    Region at = region;
    float before = 0.0f; // length of the way up to the ray's origin
    for (int layer = 0; layer < MostLayers; ++layer) {
        ++rays;
        const auto hit = scene_.geometry->intersect(way);
        if (!hit) return at.medium != region.medium ? hole : std::nullopt;
        const Bsdf& bsdf = scene_.bsdfOf(*hit);
        if (!isIndexMatched(bsdf) && !refracts(bsdf)) return std::nullopt; // opaque
        const Region beyond = regionBehind(scene_, *hit, way.direction, at);
        const bool outward = way.direction.dot(hit->ng) >= 0.0f;
        const float index = outward ? bsdf.relativeIndex() : 1.0f / bsdf.relativeIndex();
        const Boundary boundary{{{hit->position, outward ? hit->ng : -hit->ng}, before + hit->t},
                                index,
                                isIndexMatched(bsdf),
                                beyond,
                                hit->margin()};
        // Light goes around what is in the body, unless the aim is in there.
        const bool inside = !outward || beyond.medium == region.medium;
        if (!inside || !boundary.straight) return boundary;
        if (beyond.medium != region.medium && at.medium == region.medium) hole = boundary;
        at = beyond;
        before += hit->t;
        way = hit->rest(way);
    }
    return std::nullopt;
}

void EscapeModels::setGeometry(const Boundary& boundary, const Vec3f& position, const Region& region,
                               const EscapeTarget& aim, darts::TimeBudget& budget, uint64_t& rays) const {
    const BoundedMedium& body = bodies_[size_t(region.medium)];
    budget.model = darts::EscapeModel::Bounded;
    darts::EscapeGeometry& exit = budget.escape;
    exit.straightExit = boundary.straight;
    exit.refractedOnly = body.isSealed();
    exit.inside = std::min(boundary.exit.distance, budget.C);
    const Vec3f direction = darts::to<Vec3f>(budget.axis);
    exit.lengthPerDepth = 1.0f / std::max(direction.dot(boundary.exit.face.normal), LeastCosine);
    exit.faces.add(faceOf(body, boundary.exit.face, position, aim.position));
    for (const BoundedMedium::Face& face : body.faces) {
        if (exit.faces.full()) break;
        const bool same = face.normal.dot(boundary.exit.face.normal) > 0.99f;
        if (same || !((aim.position - face.point).dot(face.normal) > 0.0f)) continue;
        const darts::EscapeGeometry::Face other = faceOf(body, face, position, aim.position);
        if (other.depth < exit.faces[0].depth + tuning::ThinDepth / body.reducedSigmaT) exit.faces.add(other);
    }
    exit.reflectionA = darts::boundaryReflectionA(boundary.index);
    exit.outerSpeed = region.speed / boundary.beyond.speed;
    if (aim.sides) {
        for (const Vec3f& normal : *aim.sides)
            exit.sides.add({darts::vec3(normal), normal.dot(position - aim.position)});
    }
    if (layered_ && exit.straightExit)
        addOuterDepth(boundary, {position, direction, exit.inside, aim.margin.before(direction, budget.C)}, region,
                      budget, rays);
}

void EscapeModels::addOuterDepth(const Boundary& boundary, const Ray& way, const Region& region,
                                 darts::TimeBudget& budget, uint64_t& rays) const {
    const BoundedMedium& own = bodies_[size_t(region.medium)];
    const float cosine = std::abs(way.direction.dot(boundary.exit.face.normal));
    Region beyond = boundary.beyond;
    Ray ahead = boundary.margin.spawnRay(way.at(way.tMin), way.direction);
    ahead.tMax = way.tMax - way.tMin;
    float from = way.tMin, slow = 0.0f; // length, and the time it takes as a length at the body's speed
    for (int layer = 0; layer < MostLayers && from < way.tMax; ++layer) {
        ++rays;
        const auto hit = scene_.geometry->intersect(ahead);
        const float to = hit ? from + hit->t : budget.C, length = to - from;
        const BoundedMedium* body = beyond.medium < 0 ? nullptr : &bodies_[size_t(beyond.medium)];
        if (body && body->reducedSigmaT * length > tuning::ThinDepth)
            budget.escape.faces[0].outerDepth += length * cosine * std::sqrt(own.diffusion() / body->diffusion());
        else
            slow += length * region.speed / beyond.speed;
        from = to;
        if (!hit || !isIndexMatched(scene_.bsdfOf(*hit))) break;
        beyond = regionBehind(scene_, *hit, way.direction, beyond);
        ahead = hit->rest(ahead);
    }
    slow += std::max(budget.C - from, 0.0f) * region.speed / beyond.speed;
    budget.escape.outerSpeed = slow / std::max(budget.C - way.tMin, 1e-20f);
}

std::string EscapeModels::describe(int medium) const {
    const BoundedMedium& body = bodies_[size_t(medium)];
    const auto nameOf = [&](int primitive) {
        const std::string& name = scene_.primitives[size_t(primitive)].name;
        return name.empty() ? "#" + std::to_string(primitive) : "'" + name + "'";
    };
    if (!body.ends()) return "infinite medium: no boundary that light passes";
    if (isThin(body)) return "infinite medium: its bodies are too thin for light to diffuse in";
    std::string text = "infinite medium inside";
    if (body.straight >= 0) text += ", half-space where light must get out through " + nameOf(body.straight);
    if (body.refracting >= 0) text += ", half-space with internal reflection behind " + nameOf(body.refracting);
    return text;
}

} // namespace tungsten::transport
