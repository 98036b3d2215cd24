#pragma once
// What the samplers are asked in a walk.

#include "darts/TimeBudget.h"

#include <array>
#include <random>

namespace darts::benchmarks {

/// A vertex between one and three mean free paths from the target, with what is left of a 2 % gate; h = 1 - cos between
/// the ray and the target's direction.
struct Vertex {
    TimeBudget budget;
    float h;
    std::array<float, 4> random;
};
inline constexpr size_t Vertices = 512; ///< few enough to stay in the nearest cache

inline std::array<Vertex, Vertices> walk() {
    std::mt19937 bits(7);
    std::uniform_real_distribution<float> uniform;
    std::array<Vertex, Vertices> result;
    for (Vertex& v : result) {
        const float C = 1.0f + 2.0f * uniform(bits), S = C * (1.02f + uniform(bits));
        v.budget = TimeBudget::of({0, 0, C}, {0.98 * double(S), double(S)});
        v.h = 2.0f * uniform(bits);
        for (float& u : v.random) u = uniform(bits);
    }
    return result;
}

} // namespace darts::benchmarks
