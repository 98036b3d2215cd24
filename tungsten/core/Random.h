#pragma once
// Counter-based random numbers: a sample is a pure function of (seed, stream, pass, path index, dimension), so results
// do not depend on the number of threads or the order of work (Salmon et al. 2011, Philox4x32).

#include "tungsten/core/Types.h"

#include <array>
#include <cstdint>

namespace tungsten {

/// Philox4x32 with `Rounds` rounds: a keyed bijection of the 128-bit counter.
template <int Rounds>
inline std::array<uint32_t, 4> philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
    constexpr uint32_t M0 = 0xD2511F53u, M1 = 0xCD9E8D57u, W0 = 0x9E3779B9u, W1 = 0xBB67AE85u;
    for (int round = 0; round < Rounds; ++round) {
        const uint64_t p0 = uint64_t(M0) * counter[0];
        const uint64_t p1 = uint64_t(M1) * counter[2];
        counter = {uint32_t(p1 >> 32) ^ counter[1] ^ key[0], uint32_t(p1), uint32_t(p0 >> 32) ^ counter[3] ^ key[1],
                   uint32_t(p0)};
        key = {key[0] + W0, key[1] + W1};
    }
    return counter;
}

/// What a random stream is for; streams with different purposes never share numbers.
enum class RandomStream : uint32_t {
    Camera = 1,
    Photon = 2,
    Resample = 3,
    Test = 4,
    Emitter = 5, ///< which of them, and which of its points
    LightVertex = 6,
    SensorPoint = 7,
    Pilot = 8,
    Frame = 9,
    Folded = 10,
    ReflectedLight = 11,
    Highlight = 12,
    RefractedLight = 13,
    DetectorLight = 14
};

/// The random numbers of one path. Copying it copies the position in the stream.
class Sampler {
  public:
    /// `path` counts paths within the pass (pixel × sample, or photon index).
    Sampler(uint64_t seed, RandomStream stream, uint32_t pass, uint64_t path)
        : key_{uint32_t(seed), uint32_t(seed >> 32) ^ (uint32_t(stream) * 0x632BE5ABu)}, counter_{
                                                                                             0, pass, uint32_t(path),
                                                                                             uint32_t(path >> 32)} {}

    /// 32 uniform random bits.
    uint32_t nextBits() {
        if (used_ == 4) {
            block_ = philox4x32<7>(counter_, key_);
            ++counter_[0];
            used_ = 0;
        }
        return block_[used_++];
    }
    /// Uniform in [0, 1), 24 bits.
    float next1D() { return float(nextBits() >> 8) * 0x1p-24f; }
    Vec2f next2D() {
        const float u = next1D();
        return {u, next1D()};
    }
    /// Uniform in [0, 1), 53 bits: for times and lengths.
    double nextDouble() {
        const uint64_t high = nextBits();
        return double(((high << 32) | nextBits()) >> 11) * 0x1p-53;
    }

  private:
    std::array<uint32_t, 2> key_;
    std::array<uint32_t, 4> counter_;
    std::array<uint32_t, 4> block_{};
    uint32_t used_ = 4;
};

} // namespace tungsten
