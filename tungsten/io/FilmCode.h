#pragma once
// Films as pages keep them: few bytes for every sample, in a form that deflates well and that a browser unpacks.

#include "tungsten/image/Image.h"

#include <string>
#include <vector>

namespace tungsten {

/// A film with the errors of its frames, as outputs show them. Errors are of the mean of the channels, in the manner of
/// studies: the mean of the channels' errors, which is exact where they vary together and else an upper bound.
struct FilmImages {
    std::vector<Image> means, standardErrors; ///< one each for every frame; no errors where they are unknown
};

/// How a film is kept. Samples are the means Y of the channels:
///   code 0: Y <= 0; code c in 1..65535: Y = 2^(top - (65535 - c) step),
/// of which the zigzag differences of neighbours (modulo 2^16) stand as a plane of low bytes, then one of high bytes.
/// Planes of blocks of `block` x `block` pixels follow: the shares of red and of green in R + G + B in 255ths, and,
/// where `hasError`, the rms standard error of Y: code 0 is 0, code c in 1..255 is
///   2^(errorTop - (255 - c) ErrorStep).
/// These planes stand as differences of neighbours, modulo 256. All of them are deflated as one (zlib).
struct FilmCode {
    static constexpr double ErrorStep = 0.125; ///< octaves
    int width = 0, height = 0, frames = 0, block = 1;
    double step = 0.0;                ///< octaves between codes
    double top = 0.0, errorTop = 0.0; ///< octaves
    bool hasError = false;
    std::vector<uint8_t> deflated;
};

/// Encodes within about `budgetBytes` (by the entropy of single bytes): colours and errors by the smallest blocks of 1,
/// 2, 4 or 8 pixels' side that take at most a third of them, values by the finest step from 1/1024 octave (0.07 %) to
/// 1/2 octave that leaves all within them.
FilmCode encodeFilm(const FilmImages& film, double budgetBytes);

std::string base64(const std::vector<uint8_t>& bytes);

} // namespace tungsten
