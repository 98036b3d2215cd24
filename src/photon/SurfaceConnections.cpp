#include "photon/SurfaceConnections.h"

#include <numeric>

namespace tungsten::photon {

SurfaceConnections::SurfaceConnections(const Scene& scene, const Sensor& sensor, const SensorRecord& record,
                                       const PassInfo& pass)
    : scene_(scene), sensor_(sensor), points_(record.points), speed_(double(scene.cameraRegion.speed)) {
    if (points_.empty()) return;
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    Sampler sampler(pass.seed, RandomStream::Resample, pass.index, 0);
    for (size_t i = order_.size() - 1; i > 0; --i)
        std::swap(order_[i], order_[std::min(size_t(double(sampler.next1D()) * double(i + 1)), i)]);
    // Runs that begin near the end go on at the beginning.
    for (size_t i = 0; i < Tested; ++i) order_.push_back(order_[i % points_.size()]);
    const double pixelArea =
        4.0 / (double(record.width) * double(record.width)); // at the distance where the image is 2 wide
    double area = 0.0;
    for (const uint32_t index : order_) {
        const SensorPoint& point = points_[index];
        x_.push_back(point.hit.position.x);
        y_.push_back(point.hit.position.y);
        z_.push_back(point.hit.position.z);
        const double length = scene.transport.cameraUnwarped ? 0.0 : point.time * speed_;
        cameraLength_.push_back(float(length));
        const double cosine = std::max(std::abs(double(point.direction.dot(point.hit.ng))), 0.05);
        area += point.time * speed_ * point.time * speed_ * pixelArea / cosine;
    }
    const double fov = std::get<Pinhole>(scene.camera.model).fovDegrees * double(Pi) / 180.0;
    area *= std::tan(0.5 * fov) * std::tan(0.5 * fov) / double(order_.size());
    nearField_ = float(NearFieldShare * area * double(points_.size()) / (4.0 * double(Pi) * double(Tested)));
    perTested_ = float(double(points_.size()) / double(Tested));
}

void SurfaceConnections::find(const LightVertex& vertex, const darts::TimeGate& gate, Sampler& sampler,
                              Candidates& candidates) const {
    if (points_.empty()) return;
    const double low = speed_ * (gate.begin - vertex.time), high = speed_ * (gate.end - vertex.time);
    if (!(high > 0.0)) return;
    // A little wide: arrive() tests exactly.
    const float slack = 4e-6f * float(high) + 1e-5f * float(high - low);
    const size_t first = std::min(size_t(double(sampler.next1D()) * double(points_.size())), points_.size() - 1);
    std::array<uint8_t, Tested> inTime{};
    const float *x = x_.data() + first, *y = y_.data() + first, *z = z_.data() + first,
                *camera = cameraLength_.data() + first;
    const auto test = [&](const darts::TimeGate& open) {
        const float least = float(speed_ * (open.begin - vertex.time)) - slack,
                    most = float(speed_ * (open.end - vertex.time)) + slack;
        for (size_t i = 0; i < Tested; ++i) {
            const float dx = x[i] - vertex.position.x, dy = y[i] - vertex.position.y, dz = z[i] - vertex.position.z;
            const float length = std::sqrt(dx * dx + dy * dy + dz * dz) + camera[i];
            inTime[i] |= uint8_t(length >= least) & uint8_t(length < most);
        }
    };
    if (!sensor_.response) test(gate);
    for (const darts::TimeGate& open : sensor_.openTimes)
        if (open.end > vertex.time) test(open);
    int total = 0;
    for (size_t i = 0; i < Tested; ++i) {
        if (!inTime[i]) continue;
        // Of more than fit, every one with the same probability.
        const int slot = total < int(MostCandidates) ? total : int(sampler.next1D() * float(total + 1));
        ++total;
        if (slot >= int(MostCandidates)) continue;
        const Vec3f offset(x[i] - vertex.position.x, y[i] - vertex.position.y, z[i] - vertex.position.z);
        const float squared = offset.length2(), distance = std::sqrt(squared);
        candidates.list[size_t(slot)] = {uint32_t(first + i), distance,
                                         distance > 0.0f ? offset / distance : Vec3f(0.0f, 0.0f, 1.0f)};
    }
    candidates.count = std::min(total, int(MostCandidates));
    candidates.found = total > 0 ? float(total) / float(candidates.count) : 1.0f;
}

void SurfaceConnections::arrive(const LightVertex& vertex, const darts::TimeGate& gate, const Candidate& candidate,
                                const Rgb& scale, std::vector<SurfaceArrival>& arrivals, uint64_t& rays) const {
    const SensorPoint& point = points_[order_[candidate.point]];
    const SurfaceInteraction surface = makeInteraction(scene_, point.hit, point.direction);
    const Vec3f toVertex = -candidate.direction;
    // Not by the value of the BSDF: neighbours whose texture is not black here may share what arrives.
    if (!surface.consistent(toVertex, scene_.transport.consistencyChecks) ||
        ((surface.bsdf->lobes() & lobe::Transmissive) == 0 && surface.frame.toLocal(toVertex).z * surface.wi.z <= 0.0f))
        return;
    const Visibility visibility = traceVisibility(scene_, vertex.position, vertex.onSurface, candidate.direction,
                                                  candidate.distance, true, vertex.region, rays);
    if (isBlack(visibility.transmittance)) return;
    const int interactions = point.interactions + vertex.bounce + 1 + visibility.crossings;
    if (interactions < scene_.transport.minBounces || interactions >= scene_.transport.maxBounces) return;
    const double arrival = vertex.time + visibility.time + (scene_.transport.cameraUnwarped ? 0.0 : point.time);
    if (!(arrival >= gate.begin && arrival < gate.end)) return;
    const int frame = sensor_.gate.frameOf(arrival);
    if (frame < 0) return;
    const float geometry = sensor_.weight(arrival) / (candidate.distance * candidate.distance + nearField_);
    arrivals.push_back({order_[candidate.point], frame, toVertex, scale * visibility.transmittance * geometry});
}

} // namespace tungsten::photon
