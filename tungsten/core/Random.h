#pragma once
// Counter-based random numbers: a sample is a pure function of (seed, stream, pass, path index, place on the path), so
// results do not depend on the number of threads or the order of work (Salmon et al. 2011, Philox4x32), and what one
// vertex of a path draws moves no number of another.

#include "tungsten/core/Philox.h"
#include "tungsten/core/Types.h"

#include <array>
#include <cstdint>

namespace tungsten {

/// What a random stream is for; streams with different purposes never share numbers.
enum class RandomStream : uint32_t {
    Camera = 1,
    Photon = 2,
    Resample = 3,
    Test = 4,
    Emitter = 5, ///< which of them, and which of its points
    LightVertex = 6,
    VisiblePoint = 7,
    Pilot = 8,
    Frame = 9,
    Folded = 10,
    ReflectedLight = 11,
    Highlight = 12,
    RefractedLight = 13,
    DetectorLight = 14,
    // Branches of a path's stream (Sampler::branch).
    Target = 15,     ///< the point of a light that a camera path aims at
    Strategy = 16,   ///< whether a light path is plain
    Aimed = 17,      ///< a walk that is aimed through a wall
    Record = 18,     ///< of photons, thinned and drawn by themselves
    Connection = 19, ///< from a vertex to many surfaces
    Copy = 20        ///< of a path that is split
};

/// What a vertex of a path draws, by the place of its first number among the vertex' own. What a flight draws belongs
/// to the vertex that it leads to; vertex 0 is where the path starts.
enum class Draw : uint32_t {
    Flight = 0,             ///< 1: channel and distance of a plain one
    Direction = 1,          ///< 3: of a phase function 2, of a BSDF 2 and its lobe
    Light = 4,              ///< 3: which, and which of its points
    Roulette = 7,           ///< 1
    Distance = 8,           ///< 4: of a guided flight
    ControlVertex = 12,     ///< 1: whether it is connected
    FlightConnection = 13,  ///< 1: length of the connection for a control vertex
    Connection = 14,        ///< 1: the same, drawn before the direction
    EmitterPoint = 15,      ///< 1: which of several, for a guided path that gets into a medium
    LightVertex = 16,       ///< 2
    ReflectedLight = 18,    ///< 2
    Untimed = 20,           ///< 2: a control vertex of a flight that takes no time
    Sensor = 22,            ///< 2: a point of the lens
    Emission = 24,          ///< 4: position and direction, of a light path's start
    EmissionDirection = 26, ///< 2 of these; what it draws before them are the first ones of vertex 0
    GuidedDirection = 32    ///< up to 32
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
        const auto root = philox4x32Pair<7>(uint32_t(place), {path_[0] ^ uint32_t(place >> 32), path_[1], path_[2]},
                                            {key_[0], key_[1] ^ (uint32_t(stream) * StreamFactor)});
        return Sampler({root[0], root[1]}, {root[2] ^ root[3], path_[1], path_[2]});
    }
    /// Of one of the copies that a path is split into at a vertex.
    [[nodiscard]] Sampler copy(int vertex, int index) const {
        return branch(RandomStream::Copy, (uint64_t(uint32_t(vertex)) << 32) | uint32_t(index));
    }

    /// 32 uniform random bits.
    uint32_t nextBits() {
        const auto pair = uint32_t(next_ >> 3);
        if (cached_ != pair) {
            numbers_ = philox4x32Pair<7>(2 * pair, path_, key_);
            cached_ = pair;
        }
        return numbers_[next_++ & 7];
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
    Sampler(const std::array<uint32_t, 2>& key, const std::array<uint32_t, 3>& path) : key_(key), path_(path) {}

    static constexpr uint32_t StreamFactor = 0x632BE5ABu, NumbersPerVertex = 64, None = ~0u;

    std::array<uint32_t, 2> key_;
    std::array<uint32_t, 3> path_;
    uint64_t next_ = 0;                 ///< place of the next number
    std::array<uint32_t, 8> numbers_{}; ///< from the last place that is a multiple of eight
    uint32_t cached_ = None;            ///< which one
};

} // namespace tungsten
