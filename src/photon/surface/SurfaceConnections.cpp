#include "photon/surface/SurfaceConnections.h"

#include "transport/BounceLimits.h"
#include "transport/GateBounds.h"

#include <algorithm>

namespace tungsten::photon {

namespace {

float meanIntensity(const ConnectingVertex& from) {
    return meanComponent(from.power) * from.meanScattering;
}

/// Towards the side of the direction alone: a boundary's other side is another region, where connections do not go.
Rgb scatteringHere(const transport::Vertex& vertex, const Vec3f& direction) {
    const Region &here = vertex.region(), ahead = vertex.regionTowards(direction);
    if (ahead.medium != here.medium || ahead.speed != here.speed) return Rgb(0.0f);
    return vertex.scattering(direction);
}

} // namespace

SurfaceConnections::SurfaceConnections(const Scene& scene, const transport::TimeSensor& sensor,
                                       const CameraRecord& record, const PassInfo& pass, const ConnectionBlur& spread,
                                       bool forwardBoundaries)
    : scene_(scene), sensor_(sensor), connector_(scene, forwardBoundaries), points_(record.points),
      speed_(double(scene.cameraRegion.speed)) {
    if (points_.empty()) return;
    const double pixelArea =
        4.0 / (double(record.width) * double(record.width)); // at the distance where the image is 2 wide
    const double plane = scene.camera.fieldOfView()->planeDistance;
    std::vector<VisibleClusterPoint> points;
    for (const VisiblePoint& point : points_) {
        const double length = point.time * speed_;
        const double cosine = std::max(std::abs(double(point.direction.dot(point.hit.ng))), 0.05);
        const double area = length * length * pixelArea / (cosine * plane * plane);
        spread_.push_back(std::min(spread.pixels * float(std::sqrt(area)), spread.most));
        points.push_back(
            {point.hit.position, point.hit.ng, scene.transport.cameraUnwarped ? 0.0f : float(length), spread_.back()});
    }
    clusters_ =
        std::make_unique<VisiblePointClusters>(points, Sampler(pass.seed, RandomStream::Resample, pass.index, 0));
    perKept_ = float(double(points_.size()) / double(clusters_->order().size()));
}

SurfaceConnections::Ranges SurfaceConnections::openRanges(const ConnectingVertex& from,
                                                          const darts::TimeGate& gate) const {
    Ranges ranges;
    const double low = speed_ * (gate.begin - from.time), high = speed_ * (gate.end - from.time);
    if (!clusters_ || !(high > 0.0)) return ranges;
    // receive() tests exactly.
    constexpr auto Slack = float(transport::FlightSlack); // a few times: clusters add lengths in float
    const float slack = 4.0f * Slack * float(high) + 10.0f * Slack * float(high - low);
    const auto open = [&](const darts::TimeGate& times) {
        const LengthRange range{float(speed_ * (times.begin - from.time)) - slack,
                                float(speed_ * (times.end - from.time)) + slack};
        if (ranges.count == MostRanges)
            ranges.list[MostRanges - 1].most = range.most;
        else
            ranges.list[ranges.count++] = range;
    };
    if (!sensor_.response) open(gate);
    for (const darts::TimeGate& times : sensor_.openTimes)
        if (times.end > from.time) open(times);
    return ranges;
}

float SurfaceConnections::expectedLight(const ConnectingVertex& from, const darts::TimeGate& gate) const {
    const Ranges ranges = openRanges(from, gate);
    if (ranges.count == 0) return 0.0f;
    return meanIntensity(from) * clusters_->weight({from.vertex.position(), {ranges.list.data(), ranges.count}});
}

void SurfaceConnections::find(const ConnectingVertex& from, const darts::TimeGate& gate, Sampler& sampler,
                              std::vector<VisiblePointSample>& draws) const {
    draws.clear();
    const Ranges ranges = openRanges(from, gate);
    const float each = meanIntensity(from);
    if (ranges.count == 0 || !(each > 0.0f)) return;
    clusters_->draw({from.vertex.position(), {ranges.list.data(), ranges.count}}, *lightPerConnection_ / each, sampler,
                    draws);
}

void SurfaceConnections::connect(const ConnectingVertex& from, const darts::TimeGate& gate, Sampler& sampler,
                                 std::vector<VisiblePointSample>& draws, std::vector<ConnectionRecord>& received,
                                 uint64_t& rays) const {
    find(from, gate, sampler, draws);
    const bool onSurface = from.vertex.margin().onSurface();
    const auto scattering = [&](const Vec3f& direction) { return scatteringHere(from.vertex, direction); };
    for (const VisiblePointSample& draw : draws) {
        if (onSurface && isBlack(scattering(draw.direction))) continue; // not on this side
        const RegularisedConnection seen = spreadAt(draw);
        const Rgb light = from.power * seen.light(scattering) * (draw.inverseExpectation * perKept_);
        if (!isBlack(light)) receive(from, gate, draw, {draw.point, 0, 0.0f, seen.from, light}, received, rays);
    }
}

void SurfaceConnections::receive(const ConnectingVertex& from, const darts::TimeGate& gate,
                                 const VisiblePointSample& draw, ConnectionRecord light,
                                 std::vector<ConnectionRecord>& received, uint64_t& rays) const {
    const VisiblePoint& point = points_[draw.point];
    const transport::Vertex at = point.vertex(scene_);
    const SurfaceInteraction& surface = *at.surface();
    const SurfaceMargin margin = from.vertex.margin();
    const Vec3f toVertex = -draw.direction;
    // The other side of a thin wall: rounding tells neither side from the other, and spreading would lift light
    // through.
    const float height = std::abs(toVertex.dot(point.hit.ng)) * draw.distance;
    if (margin.onSurface() && height < 4.0f * (margin.error + point.hit.error)) return;
    // Not by the value of the BSDF: neighbours whose texture is not black here may share what arrives.
    if (!surface.consistent(toVertex, scene_.transport.consistencyChecks) ||
        ((surface.bsdf->lobes() & lobe::Transmissive) == 0 && surface.frame.toLocal(toVertex).z * surface.wi.z <= 0.0f))
        return;
    Ray ray = margin.spawnRay(from.vertex.position(), draw.direction);
    ray.tMax = point.hit.margin().before(draw.direction, draw.distance);
    const Visibility visibility = connector_.visibility(ray, draw.distance, from.vertex.region(), rays);
    if (isBlack(visibility.transmittance)) return;
    const int interactions = point.interactions + from.bounce + 1 + visibility.crossings;
    if (!transport::BounceLimits(scene_.transport).renders(interactions)) return;
    const double time = from.time + visibility.time + (scene_.transport.cameraUnwarped ? 0.0 : point.time);
    if (!(time >= gate.begin && time < gate.end)) return;
    light.frame = sensor_.gate.frameOf(time);
    if (light.frame < 0) return;
    light.offCentre = float(2.0 * (time - sensor_.gate.frameStart(light.frame)) / sensor_.gate.frameWidth - 1.0);
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
