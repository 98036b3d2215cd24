#pragma once
// Bins of nearly equal ratio whose number is read off a float's bits, without a logarithm.

#include <algorithm>
#include <bit>
#include <cstdint>

namespace darts {

/// [2^lowest, 2^(lowest + octaves)), every octave cut into 2^log2PerOctave equal bins (at most 2^8).
class OctaveBins {
  public:
    OctaveBins(int lowest, int octaves, int log2PerOctave)
        : shift_(23 - log2PerOctave), base_((lowest + 127) << log2PerOctave), count_(octaves << log2PerOctave) {}

    [[nodiscard]] int count() const { return count_; }
    /// The bin that holds x; the nearest one for x outside the range.
    [[nodiscard]] int index(float x) const {
        return std::clamp((std::bit_cast<std::int32_t>(x) >> shift_) - base_, 0, count_ - 1);
    }
    /// Lower edge of bin i; edge(count()) is the end of the range.
    [[nodiscard]] float edge(int i) const { return std::bit_cast<float>((base_ + i) << shift_); }
    [[nodiscard]] float centre(int i) const { return 0.5f * (edge(i) + edge(i + 1)); }

  private:
    int shift_, base_, count_;
};

} // namespace darts
