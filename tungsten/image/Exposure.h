#pragma once
// How bright an 8-bit image is shown: a factor on linear values before the tone curve.

#include "tungsten/image/Image.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace tungsten {

/// What is asked for.
struct ExposureChoice {
    bool automatic = true;
    double stops = 0.0; ///< otherwise

    /// "auto" or a number of stops; none: neither.
    static std::optional<ExposureChoice> read(const std::string& text);
};

/// A scene or command may say no more.
inline constexpr double MostStops = 100.0;

/// 2^stops.
float exposureFactor(double stops);

/// Chooses a factor for images that are to be shown alike: it brings the brightest of their light to white, but for the
/// share of pixels that are brighter than a percentile of all that are lit. Keeps counts alone.
class AutomaticExposure {
  public:
    static constexpr double Percentile = 0.99; ///< of lit pixels, by their brightest channel
    static constexpr double White = 0.9;       ///< what that percentile becomes

    void include(const Image& image);
    /// 1 where nothing is lit. Exact to 2 %.
    [[nodiscard]] float factor() const;

  private:
    static constexpr int PerOctave = 32, Octaves = 256;

    std::array<uint64_t, size_t(PerOctave) * size_t(Octaves)> counts_{};
    uint64_t lit_ = 0;
};

} // namespace tungsten
