#include "tungsten/render/RoundPass.h"

#include "tungsten/core/Errors.h"

namespace tungsten {

namespace {

/// Keys of samples that are rendered in parts; whole ones come before. Integrators number up to six camera paths of
/// each in 32 bits.
constexpr uint64_t FirstPartialSample = uint64_t(1) << 29;

} // namespace

PassInfo RoundPass::info(uint32_t firstPass, uint64_t sppStep, uint64_t seed) const {
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

std::vector<RoundPass> roundOf(const PassSizes& sizes, RoundPass first, size_t ranks, double samples) {
    std::vector<RoundPass> round{first};
    while (round.size() < ranks) {
        const RoundPass& last = round.back();
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

} // namespace tungsten
