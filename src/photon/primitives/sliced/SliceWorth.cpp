#include "photon/primitives/sliced/SliceWorth.h"

namespace tungsten::photon {

namespace {

constexpr float MostPerBase = 8.0f, LeastPerBase = 1e-3f;

} // namespace

SliceWorth::SliceWorth(const Scene& scene, const TimeGate& gate) : scene_(scene), gate_(gate) {}

void SliceWorth::setTargets(std::span<const CollapsedFlights> records, float share) {
    std::array<double, 5> sums{}, counts{};
    for (const CollapsedFlights& record : records) {
        sums[size_t(record.shape)] += double(worth(record));
        counts[size_t(record.shape)] += 1.0;
    }
    for (size_t shape = 0; shape < targets_.size(); ++shape)
        if (counts[shape] > 0.0) targets_[shape] = sums[shape] / (counts[shape] * double(share));
}

float SliceWorth::expected(const CollapsedFlights& record) const {
    const double target = targets_[size_t(record.shape)];
    if (!(target > 0.0)) return 1.0f;
    return std::clamp(float(double(worth(record)) / target), LeastPerBase, MostPerBase);
}

/// Radiance that it adds to a ray, about, without what all of its shape share: the power that gets to the gate, a
/// ball's spread over its sphere. Balls that share their paths with volumes fade below a mean free path
/// (docs/photon-primitives.md, eq. 16).
float SliceWorth::worth(const CollapsedFlights& record) const {
    const Medium& medium = scene_.media[size_t(record.medium)];
    const float sigmaT = std::max(meanComponent(medium.sigmaT()), 1e-20f), power = meanComponent(record.power);
    const double soonest =
        scene_.transport.gate.delta && !record.blurredInTime() ? scene_.transport.gate.start : gate_.start;
    const auto left = float(std::max((soonest - record.time) * double(medium.speedOfLight), 0.0));
    const float bright = power * std::exp(-sigmaT * left);
    if (record.shape != FlightShape::Ball) return bright;
    float legs = left;
    if (!scene_.transport.cameraUnwarped && !scene_.camera.hasParallelRays())
        legs = std::max(left - (scene_.camera.position() - record.base).length(), 0.0f);
    return bright / (1.0f + sqr(sigmaT * legs));
}

} // namespace tungsten::photon
