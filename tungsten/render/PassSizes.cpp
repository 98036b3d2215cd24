#include "tungsten/render/PassSizes.h"

#include <algorithm>
#include <cmath>

namespace tungsten {

namespace {

constexpr double LeastShare = 1.0 / 4096.0; ///< of a sample: smaller passes would be overhead alone

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

} // namespace tungsten
