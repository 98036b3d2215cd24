#pragma once
// Figures of a film's errors: of its noise, and of what kernels leave in its mean.

#include "tungsten/film/Film.h"

namespace tungsten {

/// Over pixels, channels and frames: of the mean, and of its square.
double meanValue(const Film& film);
double meanSquare(const Film& film);
/// rms over pixels and frames of the standard error, relative to the mean pixel value. NaN while it is unknown: with
/// fewer than two passes, or black.
double relativeStandardError(const Film& film);
/// Factor >= 1 from the root of Film::meanSquaredError() to what the error that was made does not exceed with a
/// confidence of 95 %. NaN with fewer than five passes.
double boundFactor(const Film& film);
/// What the error that was made, as relativeStandardError() counts it, does not exceed with a confidence of 95 %. NaN
/// while it is unknown: with fewer than five passes, or black.
double relativeErrorBound(const Film& film);

/// What kernels leave is estimated from passes that are looked at a second time with narrower ones.
/// Passes that the pass of this index stands for in the mean of biases, itself included; 0: its bias is not measured.
/// Every pass at first, one in four later on: kernels that shrink do so ever more slowly.
uint32_t passesOfItsBias(uint32_t pass);

/// The bias of a film as a number, in the measure of relativeStandardError().
struct RelativeBias {
    double estimate; ///< rms over pixels and frames; what the estimate's own noise can bring to it is taken off
    double bound; ///< the larger of what its noise may hide (confidence 95 %), and the bias if all of it lay at edges

    /// `bias` holds the biases of measured passes (PassWeight::Repeats). NaN with fewer than five of them, or black.
    static RelativeBias of(const Film& film, const Film& bias);
};

} // namespace tungsten
