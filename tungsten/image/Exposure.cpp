#include "tungsten/image/Exposure.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tungsten {

std::optional<ExposureChoice> ExposureChoice::read(const std::string& text) {
    if (text == "auto") return ExposureChoice{};
    double stops = 0.0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), last, stops);
    if (error != std::errc() || end != last || !(std::abs(stops) <= MostStops)) return std::nullopt;
    return ExposureChoice{false, stops};
}

float exposureFactor(double stops) {
    return float(std::exp2(stops));
}

void AutomaticExposure::include(const Image& image) {
    for (const Rgb& pixel : image.pixels) {
        const float value = std::max({pixel.x, pixel.y, pixel.z});
        if (!(value > 0.0f) || !std::isfinite(value)) continue;
        const double place = (std::log2(double(value)) + 0.5 * Octaves) * PerOctave;
        const auto bin = size_t(std::clamp(place, 0.0, double(counts_.size() - 1)));
        ++counts_[bin];
        ++lit_;
    }
}

float AutomaticExposure::factor() const {
    if (lit_ == 0) return 1.0f;
    const auto below = uint64_t(std::ceil(Percentile * double(lit_)));
    uint64_t seen = 0;
    size_t bin = 0;
    for (; bin < counts_.size() && (seen += counts_[bin]) < below; ++bin) {
    }
    const double value = std::exp2((double(bin) + 0.5) / PerOctave - 0.5 * Octaves);
    return float(White / value);
}

} // namespace tungsten
