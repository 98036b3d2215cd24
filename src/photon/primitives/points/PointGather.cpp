#include "photon/primitives/points/PointGather.h"

#include "photon/primitives/CameraSegment.h"
#include "photon/store/NearestPhotons.h"
#include "transport/BounceLimits.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// What gatherPoint() sees (queryAbout).
struct PointQuery {
    embree::Context context;
    const Scene* scene;
    const transport::TimeSensor* sensor;
    const std::vector<Photon>* photons;
    const std::vector<float>* squaredRadii;
    const std::vector<KernelEdges>* edges;
    const CameraSegment* segment;
    FrameSums* sums;
    uint64_t gathered;
};

void gatherPoint(PointQuery& query, uint32_t index) {
    const Photon& photon = (*query.photons)[index];
    const CameraSegment& segment = *query.segment;
    if (photon.medium != segment.medium) return;
    const Vec3f offset = photon.position - segment.origin;
    const float along = offset.dot(segment.direction);
    if (!(along > 0.0f) || along > segment.length) return;
    const float squaredRadius =
        query.squaredRadii->size() == 1 ? query.squaredRadii->front() : (*query.squaredRadii)[index];
    const Vec3f toPhoton = offset - segment.direction * along;
    const float kernel = biweight(toPhoton.length2(), squaredRadius);
    if (kernel <= 0.0f) return;
    if (!query.edges->empty() && !(*query.edges)[index].nearest.holds(-toPhoton)) return;
    const TransportSettings& settings = query.scene->transport;
    const int interactions = segment.interactions + photon.bounce;
    if (!transport::BounceLimits(settings).renders(interactions)) return;
    int frame = 0;
    float weight = kernel;
    if (!query.sensor->gate.steadyState) {
        // The photon's own distance to the segment's origin: the exact time of the path through the photon.
        const double cameraTime =
            settings.cameraUnwarped ? 0.0 : segment.time + double(offset.length()) * segment.inverseSpeed;
        const double arrival = photon.time + cameraTime;
        frame = query.sensor->gate.frameOf(arrival);
        if (frame < 0) return;
        weight *= query.sensor->weight(arrival);
    }
    const Medium& medium = query.scene->media[size_t(segment.medium)];
    const Rgb value =
        photon.power * medium.transmittance(along) * (weight * medium.phase.eval(photon.direction, -segment.direction));
    (*query.sums)[size_t(frame)] += Vec3d(value);
    ++query.gathered;
}

constexpr float Everywhere = 1e18f;

/// From photons to their nearest, had they been spread evenly over a cube about them.
float usualDistance(const std::vector<Photon>& photons) {
    Vec3f low(Infinity), high(-Infinity);
    for (const Photon& photon : photons)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], photon.position[axis]);
            high[axis] = std::max(high[axis], photon.position[axis]);
        }
    return photons.empty() ? 0.0f : maxComponent(high - low) / std::cbrt(float(photons.size()));
}

} // namespace

PointGather::PointGather(const Scene& scene, const transport::TimeSensor& sensor, const std::vector<Photon>& photons,
                         const Radii& radii, bool)
    : scene_(scene), sensor_(sensor), photons_(photons), edges_(radii.edges()) {
    for (const float radius : radii.values()) squaredRadii_.push_back(radius * radius);
    if (photons.empty()) return;
    discs_.emplace(RTC_GEOMETRY_TYPE_DISC_POINT, embree::QueryFilterFlag, [&](RTCGeometry geometry) {
        auto* discs = EmbreeScene::newBuffer<PointWithRadius>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                                              photons.size());
        for (size_t i = 0; i < photons.size(); ++i) {
            discs[i] = {photons[i].position, radii[i]};
            largestRadius_ = std::max(largestRadius_, radii[i]);
        }
    });
}

uint64_t PointGather::gather(const CameraSegment& segment, FrameSums& sums) const {
    if (!discs_) return 0;
    PointQuery query{{}, &scene_, &sensor_, &photons_, &squaredRadii_, &edges_, &segment, &sums, 0};
    queryAbout<gatherPoint>(discs_->get(), segment, largestRadius_, query);
    return query.gathered;
}

std::vector<float> adaptiveRadii(const std::vector<Photon>& photons, const ProgressToken& watch) {
    constexpr size_t Neighbours = 30;
    const auto count = uint32_t(std::min(Neighbours, photons.size()));
    const NearestPhotons nearest(photons);
    std::vector<float> radii(photons.size());
    const float factor = 0.05f * std::sqrt(float(photons.size())) / float(std::max(count, 1u));
    const float guess = usualDistance(photons);
    watch.stage("radii", photons.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, photons.size(), 256), [&](const auto& range) {
        std::vector<NearestPhotons::Neighbour> found;
        float distance = guess;
        for (size_t i = range.begin(); i < range.end(); ++i) {
            watch.advanceEvery(256, i);
            // Wherever photons are dense, a wide search meets many that the nearest then replace.
            float search = std::max(1.5f * distance, 1e-12f), squared = 0.0f;
            do {
                search = std::min(search, Everywhere);
                squared = nearest.find(photons[i].position, search, count, found);
                search *= 2.0f;
            } while (found.size() < count && search < Everywhere);
            distance = std::sqrt(squared);
            radii[i] = std::max(std::sqrt(squared * factor), 1e-12f);
        }
    });
    return radii;
}

} // namespace tungsten::photon
