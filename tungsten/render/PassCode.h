#pragma once
// A film's pass image, deflated: row by row, so that no second image is needed.

#include <vector>

namespace tungsten {

class Film;

/// Of the pass in progress. Throws std::bad_alloc.
[[nodiscard]] std::vector<unsigned char> deflatePass(const Film& film);
/// The reverse, after Film::beginPass(). False where the bytes are not those of such a pass.
[[nodiscard]] bool inflatePass(const std::vector<unsigned char>& bytes, Film& film);

} // namespace tungsten
