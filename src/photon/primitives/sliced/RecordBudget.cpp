#include "photon/primitives/sliced/RecordBudget.h"

#include "photon/Tuning.h"

namespace tungsten::photon {

double lengthToSpare(const Scene& scene, const SliceRecord& record, double time) {
    const double left = (time - record.time) * double(scene.media[size_t(record.medium)].speedOfLight);
    if (scene.transport.cameraUnwarped || scene.camera.hasParallelRays()) return left;
    return left - double((scene.camera.position() - record.base).length());
}

/// Balls that share their paths with volumes fade below a mean free path (docs/photon-primitives.md, eq. 16).
double logSliceLight(const Scene& scene, const SliceRecord& record, double time) {
    const Medium& medium = scene.media[size_t(record.medium)];
    // A ball on a light holds no light yet.
    const Rgb held =
        record.emitter >= 0 ? record.power * emitterPower(scene.emitters[size_t(record.emitter)]) : record.power;
    const double spare = std::max(lengthToSpare(scene, record, time), 0.0);
    const double left = std::max((time - record.time) * double(medium.speedOfLight), 0.0);
    const double inFog = scene.cameraRegion.medium == record.medium ? left : spare;
    const auto sigmaT = double(meanComponent(medium.sigmaT()));
    const double log = std::log(std::max(double(meanComponent(held)), 1e-300)) - sigmaT * inFog;
    return record.shape == FlightShape::Ball ? log - std::log1p(sigmaT * spare * sigmaT * spare) : log;
}

RecordBudget::RecordBudget(const Scene& scene, const TimeGate& gate) : scene_(scene), gate_(gate) {}

void RecordBudget::measure(std::span<const SliceRecord> records, const SliceClasses& classes) {
    std::array<double, Groups> tops, sums{}, counts{};
    tops.fill(-std::numeric_limits<double>::infinity());
    for (const SliceRecord& record : records) tops[group(record)] = std::max(tops[group(record)], logLightOf(record));
    for (const SliceRecord& record : records) {
        sums[group(record)] += std::exp(logLightOf(record) - tops[group(record)]);
        counts[group(record)] += double(classes.shareOf(record));
    }
    for (size_t i = 0; i < Groups; ++i)
        if (counts[i] > 0.0) logLightOfOne_[i] = tops[i] + std::log(sums[i] / counts[i]);
}

float RecordBudget::expected(const SliceRecord& record) const {
    const auto& one = logLightOfOne_[group(record)];
    if (!one) return 1.0f;
    const double most = std::log(double(tuning::MostPerBase));
    return std::max(float(std::exp(std::min(logLightOf(record) - *one, most))), tuning::LeastPerBase);
}

double RecordBudget::logLightOf(const SliceRecord& record) const {
    const double soonest =
        scene_.transport.gate.delta && !record.blurredInTime() ? scene_.transport.gate.start : gate_.start;
    return logSliceLight(scene_, record, soonest);
}

} // namespace tungsten::photon
