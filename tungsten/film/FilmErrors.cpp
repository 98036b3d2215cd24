#include "tungsten/film/FilmErrors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tungsten {
namespace {

/// What a bias that follows the width of its kernel, as beside edges sharper than it, is to one that follows its square
/// where both change alike between the widths of a pass and of its second look: (1 - 1/2) / (1 - sqrt(1/2)). Of a step
/// alone, rms over the image, by kernel and pixels to a radius: 1.2 (one) to 1.6 (four), 1.9 at most.
constexpr double AtEdges = 1.707;

constexpr double UnknownError = std::numeric_limits<double>::quiet_NaN();

} // namespace

double meanValue(const Film& film) {
    return film.meanOf([](double value) { return value; });
}

double meanSquare(const Film& film) {
    return film.meanOf([](double value) { return value * value; });
}

double relativeStandardError(const Film& film) {
    const double mean = meanValue(film);
    return mean > 0.0 ? std::sqrt(film.meanSquaredError()) / mean : UnknownError;
}

double boundFactor(const Film& film) {
    return film.confidence().boundFactor();
}

double relativeErrorBound(const Film& film) {
    return relativeStandardError(film) * boundFactor(film);
}

uint32_t passesOfItsBias(uint32_t pass) {
    constexpr uint32_t MeasuredPerOctave = 8, Most = 4;
    const uint32_t group = std::clamp(std::bit_floor(pass) / MeasuredPerOctave, 1u, Most);
    return pass % group == (group - 1) / 2 ? group : 0;
}

RelativeBias RelativeBias::of(const Film& film, const Film& bias) {
    const double mean = meanValue(film), noise = bias.meanSquaredError(), factor = boundFactor(bias);
    if (!(mean > 0.0) || std::isnan(noise)) return {UnknownError, UnknownError};
    const double square = std::max(meanSquare(bias) - noise, 0.0);
    // The noise is uncertain, and so is its product with the bias: over k independent pixels they scatter by noise
    // sqrt(2 / k) and 2 sqrt(square noise / k). The factor says what the first may be, with two standard deviations;
    // what one explains is no bias that is seen.
    const double doubt = (factor * factor - 1.0) * std::sqrt(noise * (noise + 2.0 * square));
    return {std::sqrt(std::max(square - 0.5 * doubt, 0.0)) / mean,
            std::sqrt(std::max(square + doubt, AtEdges * AtEdges * square)) / mean};
}

} // namespace tungsten
