#pragma once
// Philox4x32, a keyed bijection of a 128-bit counter (Salmon et al. 2011): the random numbers' source.

#include <array>
#include <cstdint>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace tungsten {

namespace philox {
inline constexpr uint32_t M0 = 0xD2511F53u, M1 = 0xCD9E8D57u, W0 = 0x9E3779B9u, W1 = 0xBB67AE85u;
} // namespace philox

/// Philox4x32 with `Rounds` rounds.
template <int Rounds>
inline std::array<uint32_t, 4> philox4x32(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
    for (int round = 0; round < Rounds; ++round) {
        const uint64_t p0 = uint64_t(philox::M0) * counter[0];
        const uint64_t p1 = uint64_t(philox::M1) * counter[2];
        counter = {uint32_t(p1 >> 32) ^ counter[1] ^ key[0], uint32_t(p1), uint32_t(p0 >> 32) ^ counter[3] ^ key[1],
                   uint32_t(p0)};
        key = {key[0] + philox::W0, key[1] + philox::W1};
    }
    return counter;
}

/// The same of counter {`first`, rest...} and of {`first` + 1, rest...}, one after the other. Both have room in one
/// AVX2 register.
template <int Rounds>
inline std::array<uint32_t, 8> philox4x32Pair(uint32_t first, const std::array<uint32_t, 3>& rest,
                                              const std::array<uint32_t, 2>& key) {
    std::array<uint32_t, 8> numbers;
#ifdef __AVX2__
    // Words 0 and 2 of both counters, then words 1 and 3, in the low halves of 64 bits; the high halves are of no use.
    // Every round swaps words 0 and 2, and 1 and 3, so that no product waits for a shuffle.
    const auto twice = [](uint32_t low, uint32_t high) {
        return _mm256_set_epi64x(int64_t(high), int64_t(low), int64_t(high), int64_t(low));
    };
    const auto swapped = [](__m256i words) { return _mm256_shuffle_epi32(words, _MM_SHUFFLE(1, 0, 3, 2)); };
    __m256i even = _mm256_add_epi64(twice(first, rest[1]), _mm256_set_epi64x(0, 1, 0, 0));
    __m256i odd = twice(rest[0], rest[2]);
    __m256i keys = twice(key[0], key[1]), steps = twice(philox::W0, philox::W1);
    __m256i factors = twice(philox::M0, philox::M1);
    for (int round = 0; round < Rounds; ++round) {
        const __m256i product = _mm256_mul_epu32(even, factors);
        even = _mm256_xor_si256(_mm256_srli_epi64(product, 32), swapped(_mm256_xor_si256(odd, keys)));
        odd = product;
        keys = swapped(_mm256_add_epi32(keys, steps));
        steps = swapped(steps);
        factors = swapped(factors);
    }
    if constexpr (Rounds % 2 == 1) {
        even = swapped(even);
        odd = swapped(odd);
    }
    const __m256i result = _mm256_blend_epi32(even, _mm256_slli_epi64(odd, 32), 0b10101010);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(numbers.data()), result);
#else
    for (uint32_t i = 0; i < 2; ++i) {
        const auto four = philox4x32<Rounds>({first + i, rest[0], rest[1], rest[2]}, key);
        for (uint32_t k = 0; k < 4; ++k) numbers[4 * i + k] = four[k];
    }
#endif
    return numbers;
}

} // namespace tungsten
