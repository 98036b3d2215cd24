#include "photon/primitives/sliced/FrameShares.h"

#include "photon/Tuning.h"
#include "photon/primitives/sliced/RecordCounts.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

FrameShares::FrameShares(const Scene& scene, const TimeGate& gate, const std::vector<CollapsedFlights>& records,
                         const PassWatch& watch)
    : frames_(size_t(gate.frames)) {
    if (frames_ == 1) return;
    factors_.resize(records.size() * frames_);
    tbb::parallel_for(size_t(0), records.size(), [&](size_t i) {
        watch.pollWithin(64, i);
        for (size_t f = 0; f < frames_; ++f) {
            const bool open = gate.frameStart(int(f) + 1) > records[i].time;
            factors_[i * frames_ + f] = open ? sliceLight(scene, records[i], gate.frameStart(int(f))) : 0.0f;
        }
    });
    for (const FlightShape shape :
         {FlightShape::Ball, FlightShape::Plane, FlightShape::Volume, FlightShape::Hypervolume})
        chooseAmong(shape, records);
}

/// Turns light into factors.
void FrameShares::chooseAmong(FlightShape shape, const std::vector<CollapsedFlights>& records) {
    // Means over what is seen, in the records' order.
    std::vector<double> sums(frames_), counts(frames_);
    for (size_t i = 0; i < records.size(); ++i)
        for (size_t f = 0; f < frames_ && records[i].shape == shape; ++f) {
            const float light = factors_[i * frames_ + f];
            sums[f] += double(light);
            counts[f] += light > 0.0f ? 1.0 : 0.0;
        }
    tbb::parallel_for(size_t(0), records.size(), [&](size_t i) {
        for (size_t f = 0; f < frames_ && records[i].shape == shape; ++f) {
            float& factor = factors_[i * frames_ + f];
            if (!(factor > 0.0f)) continue;
            const double ofMean = double(factor) * counts[f] / sums[f];
            const double share = std::clamp(ofMean / double(tuning::DimInFrame), double(tuning::LeastPerBase), 1.0);
            // Another irrational number than that of frameRotation: points on chords are drawn by the same random one.
            constexpr double Turn = 0.7548776662466927;
            const double u = records[i].randomNumber(1) + double(f) * Turn;
            factor = u - std::floor(u) < share ? float(1.0 / share) : 0.0f;
        }
    });
}

} // namespace tungsten::photon
