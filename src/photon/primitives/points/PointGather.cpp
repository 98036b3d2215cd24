#include "photon/primitives/points/PointGather.h"

#include "photon/store/NearestPhotons.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// What the filter sees of a query; the context is its first member, so that its address is the query's.
struct Query {
    embree::Context context;
    const Scene* scene;
    const Sensor* sensor;
    const std::vector<Photon>* photons;
    const std::vector<float>* squaredRadii;
    const CameraSegment* segment;
    FrameSums* sums;
    uint64_t gathered;
};

void evaluate(Query& query, uint32_t index) {
    const Photon& photon = (*query.photons)[index];
    const CameraSegment& segment = *query.segment;
    if (photon.medium != segment.medium) return;
    const Vec3f offset = photon.position - segment.origin;
    const float along = offset.dot(segment.direction);
    if (!(along > 0.0f) || along > segment.length) return;
    const float squaredRadius =
        query.squaredRadii->size() == 1 ? query.squaredRadii->front() : (*query.squaredRadii)[index];
    const float kernel = biweight((offset - segment.direction * along).length2(), squaredRadius);
    if (kernel <= 0.0f) return;
    const TransportSettings& transport = query.scene->transport;
    const int interactions = segment.interactions + photon.bounce;
    if (interactions < transport.minBounces || interactions >= transport.maxBounces) return;
    int frame = 0;
    float weight = kernel;
    if (!query.sensor->gate.steadyState) {
        // The photon's own distance to the segment's origin: the exact time of the path through the photon.
        const double cameraTime =
            transport.cameraUnwarped ? 0.0 : segment.time + double(offset.length()) * segment.inverseSpeed;
        const double arrival = photon.time + cameraTime;
        frame = query.sensor->gate.frameOf(arrival);
        if (frame < 0) return;
        weight *= query.sensor->weight(arrival);
    }
    const Medium& medium = query.scene->media[size_t(segment.medium)];
    const Rgb value =
        photon.power * medium.transmittance(along) * (weight * medium.phase.eval(photon.direction, -segment.direction));
    (*query.sums)[size_t(frame)] += Vec3d(double(value.x), double(value.y), double(value.z));
    ++query.gathered;
}

/// Evaluates every disc on the ray and rejects it, so that traversal goes on.
void filter(const RTCFilterFunctionNArguments* arguments) {
    auto& query = *reinterpret_cast<Query*>(arguments->context);
    evaluate(query, RTCHitN_primID(arguments->hit, 1, 0));
    arguments->valid[0] = 0;
}

} // namespace

PointGather::PointGather(const Scene& scene, const Sensor& sensor, const std::vector<Photon>& photons,
                         const Radii& radii, bool)
    : scene_(scene), sensor_(sensor), photons_(photons) {
    std::vector<PointWithRadius> points;
    points.reserve(photons.size());
    for (size_t i = 0; i < photons.size(); ++i) points.push_back({photons[i].position, radii[i]});
    for (const float radius : radii.values()) squaredRadii_.push_back(radius * radius);
    points_ = std::make_unique<EmbreePoints>(points);
}

uint64_t PointGather::gather(const CameraSegment& segment, FrameSums& sums) const {
    if (photons_.empty()) return 0;
    Query query{{}, &scene_, &sensor_, &photons_, &squaredRadii_, &segment, &sums, 0};
    // Embree skips discs that hold or nearly touch the ray's origin: start two radii behind it and test exactly in
    // evaluate().
    const float margin = 2.0001f * points_->largestRadius();
    RTCRayHit ray{};
    ray.ray.org_x = segment.origin.x - segment.direction.x * margin;
    ray.ray.org_y = segment.origin.y - segment.direction.y * margin;
    ray.ray.org_z = segment.origin.z - segment.direction.z * margin;
    ray.ray.dir_x = segment.direction.x;
    ray.ray.dir_y = segment.direction.y;
    ray.ray.dir_z = segment.direction.z;
    ray.ray.tnear = 0.0f;
    ray.ray.tfar = segment.length + 2.0f * margin;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::queryAll(points_->scene(), ray, query.context, filter);
    return query.gathered;
}

std::vector<float> adaptiveRadii(const std::vector<Photon>& photons) {
    constexpr size_t Neighbours = 30;
    const auto count = uint32_t(std::min(Neighbours, photons.size()));
    const NearestPhotons nearest(photons);
    std::vector<float> radii(photons.size());
    const float factor = 0.05f * std::sqrt(float(photons.size())) / float(std::max(count, 1u));
    tbb::parallel_for(size_t(0), photons.size(), [&](size_t i) {
        std::vector<NearestPhotons::Neighbour> found;
        radii[i] = std::max(std::sqrt(nearest.find(photons[i].position, 1e18f, count, found) * factor), 1e-12f);
    });
    return radii;
}

} // namespace tungsten::photon
