#include "photon/primitives/sliced/RecordBudget.h"

#include "photon/Tuning.h"

#include <tbb/parallel_for.h>

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

// ---- Roulette by frame

namespace {

/// Logarithms for what leaves its base after the frame has ended, and for what should not get to the camera before.
constexpr float Never = -Infinity, Dark = std::numeric_limits<float>::lowest();

} // namespace

FrameRoulette::FrameRoulette(const Scene& scene, const TimeGate& gate, const std::vector<SliceRecord>& records,
                             const ProgressToken& watch)
    : frames_(size_t(gate.frames)) {
    if (frames_ == 1) return;
    factors_.resize(records.size() * frames_);
    tbb::parallel_for(size_t(0), records.size(), [&](size_t i) {
        watch.advanceWithin(64, i);
        for (size_t f = 0; f < frames_; ++f) {
            const double end = gate.frameStart(int(f) + 1);
            float& log = factors_[i * frames_ + f];
            if (!(end > records[i].time))
                log = Never;
            else if (lengthToSpare(scene, records[i], end) > 0.0)
                log = float(logSliceLight(scene, records[i], gate.frameStart(int(f))));
            else
                log = Dark;
        }
    });
    for (const FlightShape shape :
         {FlightShape::Ball, FlightShape::Plane, FlightShape::Volume, FlightShape::Hypervolume})
        chooseAmong(shape, records);
}

/// Turns logarithms of light into factors.
void FrameRoulette::chooseAmong(FlightShape shape, const std::vector<SliceRecord>& records) {
    const auto each = [&](size_t i, const auto& visit) {
        for (size_t f = 0; f < frames_ && records[i].shape == shape; ++f) visit(f, factors_[i * frames_ + f]);
    };
    std::vector<float> tops(frames_, Dark);
    for (size_t i = 0; i < records.size(); ++i) each(i, [&](size_t f, float log) { tops[f] = std::max(tops[f], log); });
    // Light of the brightest, below 0 for what never is.
    tbb::parallel_for(size_t(0), records.size(), [&](size_t i) {
        each(i, [&](size_t f, float& log) {
            log = log == Never ? -1.0f : log == Dark ? 0.0f : std::exp(log - tops[f]);
        });
    });
    // Means over what is seen, in the records' order.
    std::vector<double> sums(frames_), counts(frames_);
    for (size_t i = 0; i < records.size(); ++i)
        each(i, [&](size_t f, float light) {
            if (!(light > 0.0f)) return;
            sums[f] += double(light);
            counts[f] += 1.0;
        });
    tbb::parallel_for(size_t(0), records.size(), [&](size_t i) {
        each(i, [&](size_t f, float& factor) {
            const double share = factor < 0.0f ? 0.0 : shareOf(double(factor) * counts[f], sums[f]);
            // Another irrational number than that of frameRotation: points on chords are drawn by the same random one.
            constexpr double Turn = 0.7548776662466927;
            const double u = records[i].randomNumber(1) + double(f) * Turn;
            factor = u - std::floor(u) < share ? float(1.0 / share) : 0.0f;
        });
    });
}

double FrameRoulette::shareOf(double light, double mean) {
    if (!(mean > 0.0)) return 1.0;
    constexpr auto Even = double(tuning::EvenInFrames);
    return Even + (1.0 - Even) * std::min(light / mean, 1.0);
}

} // namespace tungsten::photon
