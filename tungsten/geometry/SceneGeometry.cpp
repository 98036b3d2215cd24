#include "tungsten/geometry/SceneGeometry.h"

#include <atomic>
#include <bit>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace tungsten {

namespace {

void requireNoError(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw std::runtime_error("Embree: " + std::string(error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "error ") +
                             (error == RTC_ERROR_OUT_OF_MEMORY ? "" : std::to_string(int(error))));
}

// --- triangles

void setPositions(RTCGeometry geometry, const TriangleMesh& mesh) {
    const std::vector<Vec3f>& positions = mesh.positions;
    // Embree reads 16 bytes at the last vertex: share the buffer only where that stays inside the allocation.
    if (positions.capacity() > positions.size()) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                   sizeof(Vec3f), positions.size());
        return;
    }
    void* copy = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                         positions.size());
    if (copy) std::uninitialized_copy(positions.begin(), positions.end(), static_cast<Vec3f*>(copy));
}

RTCGeometry makeTriangles(RTCDevice device, const TriangleMesh& mesh) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    setPositions(geometry, mesh);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(Triangle), mesh.triangles.size());
    return geometry;
}

/// The open interval (tMin, tMax) of a ray that canBeTraced() as the closest closed one, of neighbouring floats; Embree
/// needs tnear >= 0, and denormals may be flushed.
RTCRay embreeRay(const Ray& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x;
    out.org_y = ray.origin.y;
    out.org_z = ray.origin.z;
    out.dir_x = ray.direction.x;
    out.dir_y = ray.direction.y;
    out.dir_z = ray.direction.z;
    constexpr float Least = std::numeric_limits<float>::min();
    out.tnear = ray.tMin < Least ? Least : std::bit_cast<float>(std::bit_cast<uint32_t>(ray.tMin) + 1);
    out.tfar = std::bit_cast<float>(std::bit_cast<uint32_t>(ray.tMax) - 1);
    out.mask = ~0u;
    return out;
}

// --- faces at one place

/// Looks along a normal through a point of a face for the face there that a ray meets next.
struct CoincidentQuery {
    static constexpr unsigned Id = 1; ///< of its rays; those of other queries have 0

    embree::Context context; // first: Embree's address of it is the query's
    const std::vector<const Shape*>* shapes;
    const CoincidentFaces* faces;
    Vec3f position, normal;
    float reach;   ///< along the normal
    int64_t side;  ///< 1 for a ray along `normal`, -1 for one against it
    int64_t after; ///< only faces with a later order
    FaceIndex best{};
    int64_t bestOrder = std::numeric_limits<int64_t>::max();
    Vec2f barycentric{0.0f};

    static CoincidentQuery& of(const void* context) {
        return *const_cast<CoincidentQuery*>(static_cast<const CoincidentQuery*>(context));
    }
    [[nodiscard]] bool isHere(const FacePlane& plane) const {
        return std::abs(plane.height) <= reach && plane.normal.cross(normal).length2() <= CoincidentFaces::Parallel;
    }
    void consider(const FaceIndex& at, const Vec2f& uv) {
        const FacePlane plane = facePlane(*(*shapes)[at.shape], at.face, position);
        if (!isHere(plane)) return;
        const int64_t order = side * faces->order(at.shape, plane.normal.dot(normal) > 0.0f);
        if (order <= after || order >= bestOrder) return;
        best = at;
        bestOrder = order;
        barycentric = uv;
    }
    /// `error`: how far off ray tests may put faces.
    void ask(RTCScene scene, float error) {
        const float length = reach + 2.0f * error;
        RTCRayHit query{};
        query.ray = embreeRay({position - normal * length, normal, 0.0f, 2.0f * length});
        query.ray.id = Id;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::queryAll(scene, query, context, [](const RTCFilterFunctionNArguments* arguments) {
            RTCHitN* hit = arguments->hit;
            of(arguments->context)
                .consider({RTCHitN_geomID(hit, 1, 0), RTCHitN_primID(hit, 1, 0)},
                          {RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0)});
            arguments->valid[0] = 0; // traversal goes on
        });
    }
};

// --- spheres and disks: Embree calls back for each candidate

RTCBounds boundsAround(const Vec3f& centre, const Vec3f& extent) {
    Vec3f lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = std::nextafter(centre[axis] - extent[axis], -Infinity);
        upper[axis] = std::nextafter(centre[axis] + extent[axis], Infinity);
    }
    return {lower.x, lower.y, lower.z, 0.0f, upper.x, upper.y, upper.z, 0.0f};
}

RTCBounds boundsOf(const Sphere& sphere) {
    return boundsAround(sphere.centre, Vec3f(sphere.radius));
}

RTCBounds boundsOf(const Disk& disk) {
    const Vec3f& n = disk.frame.n;
    // Half extents R sqrt(1 - n_k^2), a little larger for rounding.
    const auto half = [&](float c) { return disk.radius * (std::sqrt(std::max(1.0f - c * c, 0.0f)) + 1e-5f); };
    return boundsAround(disk.centre, {half(n.x), half(n.y), half(n.z)});
}

template <typename Analytic>
void boundsCallback(const RTCBoundsFunctionArguments* args) {
    *args->bounds_o = boundsOf(*static_cast<const Analytic*>(args->geometryUserPtr));
}

float intersectRay(const auto& shape, const RTCRay& ray) {
    return intersectShape(shape, {ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tnear,
                          ray.tfar);
}

// Only single rays are traced (N = 1), so the packets are plain structs.
template <typename Analytic>
void intersectCallback(const RTCIntersectFunctionNArguments* args) {
    if (args->N != 1 || !args->valid[0]) return;
    auto& query = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    const float t = intersectRay(*static_cast<const Analytic*>(args->geometryUserPtr), query.ray);
    if (t < 0.0f) return;
    if (query.ray.id == CoincidentQuery::Id) {
        CoincidentQuery::of(args->context).consider({args->geomID, 0}, Vec2f(0.0f));
        return;
    }
    query.ray.tfar = t;
    query.hit.geomID = args->geomID;
    query.hit.primID = args->primID;
    query.hit.instID[0] = args->context->instID[0];
}

template <typename Analytic>
void occludedCallback(const RTCOccludedFunctionNArguments* args) {
    if (args->N != 1 || !args->valid[0]) return;
    auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
    if (intersectRay(*static_cast<const Analytic*>(args->geometryUserPtr), ray) >= 0.0f) ray.tfar = -Infinity;
}

template <typename Analytic>
RTCGeometry makeAnalytic(RTCDevice device, const Analytic& shape) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<Analytic*>(&shape));
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* args) { boundsCallback<Analytic>(args); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersectCallback<Analytic>);
    rtcSetGeometryOccludedFunction(geometry, occludedCallback<Analytic>);
    return geometry;
}

// Null for a shape that no ray meets.

RTCGeometry makeGeometry(RTCDevice device, const TriangleMesh& mesh) {
    return mesh.triangles.empty() || mesh.positions.empty() ? nullptr : makeTriangles(device, mesh);
}
template <typename Analytic>
RTCGeometry makeGeometry(RTCDevice device, const Analytic& shape) {
    return shape.boundingSphere().radius > 0.0f ? makeAnalytic(device, shape) : nullptr;
}

/// Asked by Embree's builders, in threads of their own. That the last of them has answered before a build ends is
/// known from Embree alone, which sanitizers do not see into: they see it by the count.
struct BuildMonitor {
    const LoadWatch& watch;
    std::atomic<int> answers{0};

    static bool goesOn(void* asked, double) {
        auto& monitor = *static_cast<BuildMonitor*>(asked);
        const bool on = monitor.watch.goesOn();
        monitor.answers.fetch_add(1, std::memory_order_release);
        return on;
    }
};

/// Embree ends the process at rays that are no numbers or start beyond its largest coordinate.
bool canBeTraced(const Ray& ray) {
    constexpr float Largest = 1.8e18f;
    const auto inReach = [](const Vec3f& v) {
        return std::abs(v.x) < Largest && std::abs(v.y) < Largest && std::abs(v.z) < Largest;
    };
    // Without room between its ends, or a number at one of them, nothing is on it.
    return inReach(ray.origin) && inReach(ray.direction) && ray.tMin < ray.tMax && ray.tMax > 0.0f;
}

} // namespace

SceneGeometry::SceneGeometry(const std::vector<const Shape*>& shapes, const std::vector<bool>& opaque,
                             const LoadWatch& watch)
    : shapes_(shapes), coincident_(shapes, opaque, watch), device_(rtcNewDevice(nullptr)) {
    if (!device_) throw std::runtime_error("Embree: no device");
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(),
                     coincident_.any() ? RTC_SCENE_FLAG_ROBUST | embree::QueryFilterFlag : RTC_SCENE_FLAG_ROBUST);
    attachShapes(watch);
    // Embree's builders end where the monitor says false.
    BuildMonitor monitor{watch};
    rtcSetSceneProgressMonitorFunction(scene_.get(), BuildMonitor::goesOn, &monitor);
    rtcCommitScene(scene_.get());
    (void)monitor.answers.load(std::memory_order_acquire);
    watch.poll();
    rtcSetSceneProgressMonitorFunction(scene_.get(), nullptr, nullptr);
    requireNoError(device_.get());
    RTCBounds bounds{};
    rtcGetSceneBounds(scene_.get(), &bounds);
    if (bounds.lower_x > bounds.upper_x) return; // nothing in it
    boundsMin_ = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
    boundsMax_ = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
}

void SceneGeometry::attachShapes(const LoadWatch& watch) {
    for (size_t i = 0; i < shapes_.size(); ++i) {
        watch.poll();
        const RTCGeometry geometry =
            std::visit([&](const auto& m) { return makeGeometry(device_.get(), m); }, *shapes_[i]);
        if (!geometry) continue;
        triangleCount_ += std::visit([](const auto& m) { return m.triangleCount(); }, *shapes_[i]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_.get(), geometry, unsigned(i));
        rtcReleaseGeometry(geometry);
    }
}

void SceneGeometry::complete(const Ray& ray, const Vec2f& barycentric, SurfaceHit& hit) const {
    std::visit([&](const auto& m) { m.complete(ray, barycentric, hit); }, *shapes_[hit.shape]);
}

Tangents SceneGeometry::tangents(const SurfaceHit& hit) const {
    return std::visit([&](const auto& m) { return m.tangents(hit); }, *shapes_[hit.shape]);
}

std::optional<SurfaceHit> SceneGeometry::intersect(const Ray& ray) const {
    if (!canBeTraced(ray)) return std::nullopt;
    if (leavesCoincident(ray)) return intersectFromCoincident(ray);
    RTCRayHit query{};
    query.ray = embreeRay(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(scene_.get(), query);
    std::optional<SurfaceHit> hit;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.emplace();
    hit->t = query.ray.tfar;
    hit->shape = query.hit.geomID;
    hit->face = query.hit.primID;
    complete(ray, {query.hit.u, query.hit.v}, *hit);
    if (coincident_.any() && coincident_.reach(hit->index()) > 0.0f) takeFirst(ray, *hit);
    return hit;
}

void SceneGeometry::takeFirst(const Ray& ray, SurfaceHit& hit) const {
    const int64_t side = ray.direction.dot(hit.ng) > 0.0f ? 1 : -1;
    CoincidentQuery query{{},           &shapes_,
                          &coincident_, hit.position,
                          hit.ng,       coincident_.reach(hit.index()),
                          side,         std::numeric_limits<int64_t>::min()};
    query.ask(scene_.get(), facePlane(*shapes_[hit.shape], hit.face, hit.position).error);
    if (!query.best.isSet() || query.bestOrder >= side * coincident_.order(hit.shape, true)) return;
    hit.shape = query.best.shape;
    hit.face = query.best.face;
    complete(ray, query.barycentric, hit);
}

std::optional<SurfaceHit> SceneGeometry::intersectFromCoincident(Ray ray) const {
    const FaceIndex left = std::exchange(ray.leaves, FaceIndex{});
    const FacePlane plane = facePlane(*shapes_[left.shape], left.face, ray.origin);
    const int64_t side = ray.direction.dot(plane.normal) > 0.0f ? 1 : -1;
    CoincidentQuery query{{},           &shapes_,
                          &coincident_, ray.origin - plane.normal * plane.height,
                          plane.normal, coincident_.reach(left),
                          side,         side * coincident_.order(left.shape, true)};
    query.ask(scene_.get(), plane.error);
    if (query.best.isSet()) {
        SurfaceHit next;
        next.t = 0.0f;
        next.shape = query.best.shape;
        next.face = query.best.face;
        complete(ray, query.barycentric, next);
        return next;
    }
    // What else lies at this place has been met before.
    const auto met = [&](const SurfaceHit& hit) {
        return coincident_.reach(hit.index()) > 0.0f &&
               query.isHere({hit.ng, (hit.position - query.position).dot(plane.normal), 0.0f});
    };
    auto hit = intersect(ray);
    while (hit && met(*hit)) {
        ray.tMin = hit->t;
        hit = intersect(ray);
    }
    return hit;
}

bool SceneGeometry::occluded(const Ray& ray) const {
    if (!canBeTraced(ray)) return false; // an end below 0 would pass for Embree's answer
    if (leavesCoincident(ray)) return intersectFromCoincident(ray).has_value();
    RTCRay query = embreeRay(ray);
    return embree::occluded(scene_.get(), query);
}

} // namespace tungsten
