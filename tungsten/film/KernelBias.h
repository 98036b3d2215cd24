#pragma once
// What kernels leave in the mean of a film, estimated from passes that are looked at a second time with narrower ones.

#include "tungsten/film/Film.h"

namespace tungsten {

/// Passes that the pass of this index stands for in the mean of biases, itself included; 0: its bias is not measured.
/// Every pass at first, one in four later on: kernels that shrink do so ever more slowly.
uint32_t passesOfItsBias(uint32_t pass);

/// The bias of a film as a number, in the measure of Film::relativeStandardError().
struct RelativeBias {
    double estimate; ///< rms over pixels and frames; what the estimate's own noise can bring to it is taken off
    double bound;    ///< what its noise may hide, with a confidence of 95 %; what it were if all of it lay at edges, if
                     ///< that is more

    /// `bias` holds the biases of measured passes (PassWeight::Repeats). NaN with fewer than five of them, or black.
    static RelativeBias of(const Film& film, const Film& bias);
};

} // namespace tungsten
