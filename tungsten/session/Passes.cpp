#include "tungsten/session/Passes.h"

#include "tungsten/core/Errors.h"

#include <algorithm>
#include <cmath>

namespace tungsten {

namespace {

constexpr double LeastShare = 1.0 / 4096.0; ///< of a sample: smaller passes would be overhead alone

/// Keys of samples that are rendered in parts; whole ones come before. Integrators number up to six camera paths of
/// each in 32 bits.
constexpr uint64_t FirstPartialSample = uint64_t(1) << 29;

} // namespace

uint32_t PassSizes::samplesOfPass() const {
    return std::max(uint32_t(double(step_) / parts_), 1u);
}

bool PassSizes::canCut() const {
    return cutsLightPaths_ ? double(step_) / parts_ > LeastShare : samplesOfPass() > 1;
}

void PassSizes::cut(double fraction) {
    constexpr double LeastFraction = 0x1p-20; // where not even one unit of work has been done
    const double parts = std::exp2(std::ceil(std::log2(4.0 / std::clamp(fraction, LeastFraction, 1.0))));
    parts_ = std::min(parts_ * parts, cutsLightPaths_ ? double(step_) / LeastShare : std::exp2(32.0));
}

std::string PassSizes::text() const {
    const uint32_t samples = samplesOfPass();
    std::string text =
        "passes are cut to " + std::to_string(samples) + (samples > 1 ? " samples" : " sample") + " per pixel";
    if (cutsLightPaths_)
        text += " and 1/" + std::to_string(std::llround(parts_)) +
                " of the light paths; radii that follow the photons are the larger for it";
    return text;
}

PassSize PassSizes::next(double done) const {
    const uint32_t samples = std::min(samplesOfPass(), uint32_t(std::ceil(std::max(samples_ - done, 1.0))));
    const bool cut = parts_ > 1.0 && cutsLightPaths_;
    return {samples, cut ? share() : 1.0, cut ? double(step_) * share() : double(samples)};
}

PassSize PassSizes::rest(double done) const {
    const auto samples = uint32_t(std::clamp(std::ceil(samples_ - done), 1.0, 4e9));
    return {samples, 1.0, double(samples)};
}

uint32_t PassSizes::left(double done) const {
    const double each = cutsLightPaths_ ? double(step_) * share() : double(samplesOfPass());
    return uint32_t(std::min(std::ceil(std::max(samples_ - done, 0.0) / each), 4e9));
}

PassInfo PlannedPass::info(uint32_t firstPass, uint64_t sppStep, uint64_t seed) const {
    // Parts of one sample look at pixels in places of their own.
    const bool partial = size.weight < double(size.samples);
    const uint64_t firstSample = partial ? FirstPartialSample + index : firstPass * sppStep + uint64_t(done);
    PassInfo pass;
    pass.index = firstPass + index;
    pass.firstSample = firstSample;
    pass.samples = size.samples;
    pass.seed = seed;
    pass.share = size.share;
    return pass;
}

std::vector<PlannedPass> roundOf(const PassSizes& sizes, PlannedPass first, size_t ranks, double samples) {
    std::vector<PlannedPass> round{first};
    while (round.size() < ranks) {
        const PlannedPass& last = round.back();
        const double done = last.done + last.size.weight;
        if (done >= samples) break;
        round.push_back({sizes.next(done), last.index + 1, done});
    }
    return round;
}

uint64_t samplesOf(const SessionOptions& options) {
    const auto spp = uint64_t(options.spp), step = uint64_t(options.sppStep);
    if (!options.passes) return spp;
    const uint64_t passes = (spp + step - 1) / step;
    const auto [first, end] = *options.passes;
    if (end > passes)
        throw UsageError("--passes " + std::to_string(first) + ":" + std::to_string(end) + ": the render has " +
                         std::to_string(passes) + " passes, from 0, of " + std::to_string(spp) +
                         " samples per pixel in steps (spp_step) of " + std::to_string(step));
    return std::min(spp, end * step) - first * step;
}

RoundStatus RoundStatus::among(DistributedResult& shared, size_t ranks) const {
    const double firstBroken = whole ? double(ranks) : double(shared.rank());
    const auto most = shared.allReduceMax(
        {double(interrupted), double(timedOut), double(wantsFilm), -firstBroken, whole ? -1.0 : -brokenAt});
    RoundStatus all;
    all.interrupted = most[0] > 0.0;
    all.timedOut = most[1] > 0.0;
    all.wantsFilm = most[2] > 0.0;
    all.wholePasses = size_t(-most[3]);
    all.whole = all.wholePasses == ranks;
    all.brokenAt = -most[4];
    return all;
}

} // namespace tungsten
