#include "photon/surface/SurfaceConnections.h"

#include "transport/BounceLimits.h"
#include "transport/GateBounds.h"

#include <algorithm>

namespace tungsten::photon {

namespace {

float meanIntensity(const LightVertex& vertex) {
    return meanComponent(vertex.power) * vertex.meanScattering;
}

} // namespace

SurfaceConnections::SurfaceConnections(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record,
                                       const PassInfo& pass, const Spread& spread)
    : scene_(scene), sensor_(sensor), points_(record.points), speed_(double(scene.cameraRegion.speed)) {
    if (points_.empty()) return;
    const double pixelArea =
        4.0 / (double(record.width) * double(record.width)); // at the distance where the image is 2 wide
    const double plane = scene.camera.fieldOfView()->planeDistance;
    std::vector<ClusterPoint> points;
    for (const SensorPoint& point : points_) {
        const double length = point.time * speed_;
        const double cosine = std::max(std::abs(double(point.direction.dot(point.hit.ng))), 0.05);
        const double area = length * length * pixelArea / (cosine * plane * plane);
        spread_.push_back(std::min(spread.pixels * float(std::sqrt(area)), spread.most));
        points.push_back(
            {point.hit.position, point.hit.ng, scene.transport.cameraUnwarped ? 0.0f : float(length), spread_.back()});
    }
    clusters_ = std::make_unique<SensorClusters>(points, Sampler(pass.seed, RandomStream::Resample, pass.index, 0));
    perKept_ = float(double(points_.size()) / double(clusters_->order().size()));
}

SurfaceConnections::Ranges SurfaceConnections::openRanges(const LightVertex& vertex,
                                                          const darts::TimeGate& gate) const {
    Ranges ranges;
    const double low = speed_ * (gate.begin - vertex.time), high = speed_ * (gate.end - vertex.time);
    if (!clusters_ || !(high > 0.0)) return ranges;
    // receive() tests exactly.
    constexpr auto Slack = float(transport::FlightSlack); // a few times: clusters add lengths in float
    const float slack = 4.0f * Slack * float(high) + 10.0f * Slack * float(high - low);
    const auto open = [&](const darts::TimeGate& times) {
        const LengthRange range{float(speed_ * (times.begin - vertex.time)) - slack,
                                float(speed_ * (times.end - vertex.time)) + slack};
        if (ranges.count == MostRanges)
            ranges.list[MostRanges - 1].most = range.most;
        else
            ranges.list[ranges.count++] = range;
    };
    if (!sensor_.response) open(gate);
    for (const darts::TimeGate& times : sensor_.openTimes)
        if (times.end > vertex.time) open(times);
    return ranges;
}

float SurfaceConnections::expectedLight(const LightVertex& vertex, const darts::TimeGate& gate) const {
    const Ranges ranges = openRanges(vertex, gate);
    if (ranges.count == 0) return 0.0f;
    return meanIntensity(vertex) * clusters_->weight({vertex.position, {ranges.list.data(), ranges.count}});
}

void SurfaceConnections::find(const LightVertex& vertex, const darts::TimeGate& gate, Sampler& sampler,
                              std::vector<PointDraw>& draws) const {
    draws.clear();
    const Ranges ranges = openRanges(vertex, gate);
    const float each = meanIntensity(vertex);
    if (ranges.count == 0 || !(each > 0.0f)) return;
    clusters_->draw({vertex.position, {ranges.list.data(), ranges.count}}, *lightPerConnection_ / each, sampler, draws);
}

void SurfaceConnections::receive(const LightVertex& vertex, const darts::TimeGate& gate, const PointDraw& draw,
                                 ReceivedLight light, std::vector<ReceivedLight>& received, uint64_t& rays) const {
    const SensorPoint& point = points_[draw.point];
    const SurfaceInteraction surface = makeInteraction(scene_, point.hit, point.direction);
    const Vec3f toVertex = -draw.direction;
    // The other side of a thin wall: rounding tells neither side from the other, and spreading would lift light
    // through.
    const float height = std::abs(toVertex.dot(point.hit.ng)) * draw.distance;
    if (vertex.margin.onSurface() && height < 4.0f * (vertex.margin.error + point.hit.error)) return;
    // Not by the value of the BSDF: neighbours whose texture is not black here may share what arrives.
    if (!surface.consistent(toVertex, scene_.transport.consistencyChecks) ||
        ((surface.bsdf->lobes() & lobe::Transmissive) == 0 && surface.frame.toLocal(toVertex).z * surface.wi.z <= 0.0f))
        return;
    const Ray ray{vertex.position, draw.direction, vertex.margin.beyond(draw.direction),
                  point.hit.margin().before(draw.direction, draw.distance)};
    const Visibility visibility = traceVisibility(scene_, ray, draw.distance, vertex.region, rays);
    if (isBlack(visibility.transmittance)) return;
    const int interactions = point.interactions + vertex.bounce + 1 + visibility.crossings;
    if (!transport::BounceLimits(scene_.transport).renders(interactions)) return;
    const double time = vertex.time + visibility.time + (scene_.transport.cameraUnwarped ? 0.0 : point.time);
    if (!(time >= gate.begin && time < gate.end)) return;
    light.frame = sensor_.gate.frameOf(time);
    if (light.frame < 0) return;
    light.light = light.light * visibility.transmittance * sensor_.weight(time);
    received.push_back(light);
}

float lightPerConnection(std::vector<float> expected, double wanted) {
    constexpr double MostOfOne = 64.0;
    std::erase_if(expected, [](float light) { return !(light > 0.0f); });
    std::sort(expected.begin(), expected.end(), std::greater<>());
    double rest = 0.0;
    for (const float light : expected) rest += double(light);
    // While the greatest connect as often as they may, the others share what is left.
    for (size_t greatest = 0; greatest < expected.size(); ++greatest) {
        const double left = wanted - MostOfOne * double(greatest);
        if (left <= 0.0) break;
        const double each = rest / left;
        if (double(expected[greatest]) <= MostOfOne * each) return float(each);
        rest -= double(expected[greatest]);
    }
    return expected.empty() ? 0.0f : expected.back() / float(MostOfOne);
}

} // namespace tungsten::photon
