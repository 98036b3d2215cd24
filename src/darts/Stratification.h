#pragma once
// Rows of stratified numbers for the candidates of one draw.

#include <array>
#include <cstddef>
#include <cstdint>

namespace darts {

inline constexpr int StratifiedRows = 32;
inline constexpr int MostCandidates = 16;

namespace detail {

/// Direction numbers m_1..m_5 of the first 16 Sobol dimensions (Joe and Kuo 2008).
inline constexpr std::array<std::array<uint32_t, 5>, MostCandidates> SobolNumbers{{
    {1, 1, 1, 1, 1},
    {1, 3, 5, 15, 17},
    {1, 3, 3, 9, 29},
    {1, 3, 1, 5, 31},
    {1, 1, 1, 11, 31},
    {1, 1, 3, 3, 25},
    {1, 3, 5, 13, 11},
    {1, 1, 5, 5, 17},
    {1, 1, 5, 5, 5},
    {1, 1, 7, 11, 19},
    {1, 1, 5, 1, 1},
    {1, 1, 1, 3, 11},
    {1, 3, 5, 5, 31},
    {1, 3, 3, 9, 7},
    {1, 1, 1, 15, 21},
    {1, 3, 1, 13, 27},
}};

} // namespace detail

/// N strata of [0, 1), one number in each; from row to row the numbers fill their strata as the dimensions of a Sobol
/// sequence. A row chosen at random and rotated by one uniform offset modulo 1 has N uniform marginals.
template <int N>
struct StratifiedTable {
    static_assert(N >= 1 && N <= MostCandidates);
    alignas(64) std::array<std::array<float, N>, StratifiedRows> rows{};

    /// Even strata for the first half of the numbers, odd ones for the second: where the halves come from two
    /// densities, each is stratified over all of [0, 1). (Up to 5 times less variance in dense media:
    /// benchmarks/infinite_medium, cases 12 to 16.)
    [[nodiscard]] static constexpr int stratum(int number) {
        if (N == 1) return 0;
        return number < N / 2 ? 2 * number : 2 * (number - N / 2) + 1;
    }

    constexpr StratifiedTable() {
        for (uint32_t row = 0; row < StratifiedRows; ++row)
            for (int dimension = 0; dimension < N; ++dimension) {
                uint32_t bits = 0; // of the point, as a fraction with 5 binary digits
                for (uint32_t k = 0; k < 5; ++k)
                    if ((row >> k) & 1u) bits ^= detail::SobolNumbers[std::size_t(dimension)][k] << (4 - k);
                rows[row][std::size_t(dimension)] =
                    (float(stratum(dimension)) + (float(bits) + 0.5f) / 32.0f) / float(N);
            }
    }
};

template <int N>
inline constexpr StratifiedTable<N> Stratified{};

} // namespace darts
