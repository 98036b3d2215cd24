#include "photon/primitives/sliced/RecordCounts.h"

#include "photon/Tuning.h"

namespace tungsten::photon {

/// Balls that share their paths with volumes fade below a mean free path (docs/photon-primitives.md, eq. 16).
float sliceLight(const Scene& scene, const CollapsedFlights& record, double time) {
    const Medium& medium = scene.media[size_t(record.medium)];
    // A ball on a light holds no light yet.
    const Rgb held =
        record.emitter >= 0 ? record.power * emitterPower(scene.emitters[size_t(record.emitter)]) : record.power;
    const float sigmaT = std::max(meanComponent(medium.sigmaT()), 1e-20f), power = meanComponent(held);
    const auto left = float(std::max((time - record.time) * double(medium.speedOfLight), 0.0));
    const float bright = power * std::exp(-sigmaT * left);
    if (record.shape != FlightShape::Ball) return bright;
    float legs = left;
    if (!scene.transport.cameraUnwarped && !scene.camera.hasParallelRays())
        legs = std::max(left - (scene.camera.position() - record.base).length(), 0.0f);
    return bright / (1.0f + sqr(sigmaT * legs));
}

RecordCounts::RecordCounts(const Scene& scene, const TimeGate& gate) : scene_(scene), gate_(gate) {}

void RecordCounts::measure(std::span<const CollapsedFlights> records, const SliceClasses& classes) {
    std::array<double, Groups> sums{}, counts{};
    for (const CollapsedFlights& record : records) {
        sums[group(record)] += double(lightOf(record));
        counts[group(record)] += double(classes.shareOf(record));
    }
    for (size_t i = 0; i < Groups; ++i)
        if (counts[i] > 0.0) lightOfOne_[i] = sums[i] / counts[i];
}

float RecordCounts::expected(const CollapsedFlights& record) const {
    const double one = lightOfOne_[group(record)];
    if (!(one > 0.0)) return 1.0f;
    return std::clamp(float(double(lightOf(record)) / one), tuning::LeastPerBase, tuning::MostPerBase);
}

float RecordCounts::lightOf(const CollapsedFlights& record) const {
    const double soonest =
        scene_.transport.gate.delta && !record.blurredInTime() ? scene_.transport.gate.start : gate_.start;
    return sliceLight(scene_, record, soonest);
}

} // namespace tungsten::photon
