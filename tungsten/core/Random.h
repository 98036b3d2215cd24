#pragma once
// Counter-based random numbers: a sample is a pure function of (seed, stream, pass, path index, place on the path), so
// results do not depend on the number of threads or the order of work (Salmon et al. 2011, Philox4x32), and what one
// vertex of a path draws moves no number of another.

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
    DetectorLight = 14,
    // Branches of a path's stream (Sampler::branch).
    Target = 15,     ///< the point of a light that a camera path aims at
    EntryPoint = 16, ///< others of its points
    Aimed = 17,      ///< a walk that is aimed through a wall
    Record = 18,     ///< of photons, thinned and drawn by themselves
    Connection = 19, ///< from a vertex to many surfaces
    Copy = 20        ///< of a path that is split
};

/// What a vertex of a path draws, by the place of its first number among the vertex' own. What a flight draws belongs
/// to the vertex that it leads to; vertex 0 is where the path starts.
enum class Draw : uint32_t {
    Flight = 0,            ///< 1: channel and distance of a plain one
    Direction = 1,         ///< 3: of a phase function 2, of a BSDF 2 and its lobe
    Light = 4,             ///< 3: which, and which of its points
    Roulette = 7,          ///< 1
    Distance = 8,          ///< 4: of a guided flight
    ControlVertex = 12,    ///< 1: whether it is connected
    FlightConnection = 13, ///< 1: length of the connection for a control vertex
    Connection = 14,       ///< 1: the same, drawn before the direction
    LightVertex = 16,      ///< 2
    ReflectedLight = 18,   ///< 2
    Untimed = 20,          ///< 2: a control vertex of a flight that takes no time
    Sensor = 22,           ///< 2: a point of the lens
    Emission = 24,         ///< 4: position and direction
    GuidedDirection = 32   ///< up to 32
};

/// The random numbers of one path, one after the other from any place. Copying it copies the place.
class Sampler {
  public:
    /// `path` counts paths within the pass (pixel × sample, or photon index).
    Sampler(uint64_t seed, RandomStream stream, uint32_t pass, uint64_t path)
        : key_{uint32_t(seed), uint32_t(seed >> 32) ^ (uint32_t(stream) * StreamFactor)}, path_{pass, uint32_t(path),
                                                                                                uint32_t(path >> 32)} {}

    /// What this vertex draws for this purpose comes next.
    void at(int vertex, Draw draw) { next_ = uint64_t(uint32_t(vertex)) * NumbersPerVertex + uint32_t(draw); }
    /// A stream of its own for what has no bound, or is a path of its own: `place` tells several from one path apart.
    [[nodiscard]] Sampler branch(RandomStream stream, uint64_t place) const {
        const auto root = philox4x32<7>({uint32_t(place), path_[0] ^ uint32_t(place >> 32), path_[1], path_[2]},
                                        {key_[0], key_[1] ^ (uint32_t(stream) * StreamFactor)});
        Sampler branch = *this;
        branch.key_ = {root[0], root[1]};
        branch.path_[0] = root[2] ^ root[3];
        branch.next_ = 0;
        branch.cached_ = {None, None};
        return branch;
    }
    /// Of one of the copies that a path is split into at a vertex.
    [[nodiscard]] Sampler copy(int vertex, int index) const {
        return branch(RandomStream::Copy, (uint64_t(uint32_t(vertex)) << 32) | uint32_t(index));
    }

    /// 32 uniform random bits.
    uint32_t nextBits() {
        const auto block = uint32_t(next_ >> 2);
        std::array<uint32_t, 4>& numbers = blocks_[block & 1];
        if (cached_[block & 1] != block) {
            numbers = philox4x32<7>({block, path_[0], path_[1], path_[2]}, key_);
            cached_[block & 1] = block;
        }
        return numbers[next_++ & 3];
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
    static constexpr uint32_t StreamFactor = 0x632BE5ABu, NumbersPerVertex = 64, None = ~0u;

    std::array<uint32_t, 2> key_;
    std::array<uint32_t, 3> path_;
    uint64_t next_ = 0; ///< place of the next number
    /// The last even and the last odd block of four.
    std::array<std::array<uint32_t, 4>, 2> blocks_{};
    std::array<uint32_t, 2> cached_{None, None};
};

} // namespace tungsten
