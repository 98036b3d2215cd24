#pragma once
// The few operations that the candidates' loop needs of a register of floats (xsimd::batch) and of one float.

#include "darts/Stratification.h"

#include <xsimd/xsimd.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <type_traits>

namespace darts {

namespace lanes {

inline float select(bool condition, float a, float b) {
    return condition ? a : b;
}
inline bool all(bool condition) {
    return condition;
}
inline float sum(float a) {
    return a;
}
inline float most(float a) {
    return a;
}
template <typename Batch>
float sum(const Batch& a) {
    if constexpr (requires { reduce_add(a); }) // as newer versions of xsimd call it
        return reduce_add(a);
    else
        return hadd(a);
}
template <typename Batch>
inline float most(const Batch& a) {
    alignas(64) std::array<float, Batch::size> v;
    a.store_aligned(v.data());
    for (size_t half = Batch::size / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i) v[i] = std::max(v[i], v[i + half]);
    return v[0];
}
template <typename Batch>
Batch get(const float* from) {
    if constexpr (std::is_same_v<Batch, float>)
        return *from;
    else
        return Batch::load_aligned(from);
}
template <typename Batch>
void put(float* to, const Batch& value) {
    if constexpr (std::is_same_v<Batch, float>)
        *to = value;
    else
        value.store_aligned(to);
}

template <typename Batch>
inline constexpr int Width = std::is_same_v<Batch, float> ? 1 : int(sizeof(Batch) / sizeof(float));

/// 0, 1, 2, ...
struct Numbers {
    alignas(64) std::array<float, MostCandidates> values{};
    constexpr Numbers() {
        for (int i = 0; i < MostCandidates; ++i) values[size_t(i)] = float(i);
    }
};
inline constexpr Numbers Count{};

/// e^x for x in [-87, 88], to 3e-7; the ends' values beyond.
template <typename Batch>
Batch exp(const Batch& exponent) {
    if constexpr (std::is_same_v<Batch, float>) {
        return std::exp(exponent);
    } else {
        using Integers = xsimd::as_integer_t<Batch>;
        const Batch x = xsimd::min(xsimd::max(exponent, Batch(-87.0f)), Batch(88.0f));
        // Adding 1.5 2^23 rounds to an integer, which the sum's last bits then hold.
        const Batch shifted = xsimd::fma(x, Batch(1.44269504f), Batch(12582912.0f)), n = shifted - Batch(12582912.0f);
        const Batch r = xsimd::fnma(n, Batch(-2.12194440e-4f), xsimd::fnma(n, Batch(0.693359375f), x));
        // 1 + r + r^2 (1/2! + r/3!) + r^4 (1/4! + r/5! + r^2/6!): short chains, for the latency.
        const Batch r2 = r * r, low = xsimd::fma(r, Batch(1.66666667e-1f), Batch(0.5f));
        const Batch high =
            xsimd::fma(r2, Batch(1.3888889e-3f), xsimd::fma(r, Batch(8.3333333e-3f), Batch(4.16666667e-2f)));
        const Batch p = xsimd::fma(r2, xsimd::fma(r2, high, low), r + Batch(1.0f));
        const Integers power = (std::bit_cast<Integers>(shifted) << 23) + Integers(0x3f800000);
        return p * std::bit_cast<Batch>(power);
    }
}
/// Natural logarithm of normal x > 0, to 3e-7 of its value.
template <typename Batch>
Batch log(const Batch& x) {
    if constexpr (std::is_same_v<Batch, float>) {
        return std::log(x);
    } else {
        using Integers = xsimd::as_integer_t<Batch>;
        // x = 2^n m with m in [1/sqrt 2, sqrt 2).
        const Integers bits = std::bit_cast<Integers>(x), n = (bits - Integers(0x3f3504f3)) >> 23;
        const Batch m = std::bit_cast<Batch>(bits - (n << 23)), exponent = xsimd::to_float(n);
        // log(1 + f) = f - f^2 / 2 + f^3 p(f), p interpolated at Chebyshev's points.
        const Batch f = m - Batch(1.0f), f2 = f * f, f4 = f2 * f2;
        const Batch p01 = xsimd::fma(f, Batch(-0.24999997f), Batch(0.333333312f)),
                    p23 = xsimd::fma(f, Batch(-0.166678023f), Batch(0.200007157f)),
                    p45 = xsimd::fma(f, Batch(-0.124256873f), Batch(0.142490576f)),
                    p67 = xsimd::fma(f, Batch(-0.114797338f), Batch(0.116854199f));
        const Batch high = xsimd::fma(f4, Batch(0.0697161145f), xsimd::fma(f2, p67, p45));
        const Batch p = xsimd::fma(f4, high, xsimd::fma(f2, p23, p01));
        const Batch fraction = xsimd::fma(f2, xsimd::fma(f, p, Batch(-0.5f)), f);
        return xsimd::fma(exponent, Batch(0.693359375f), xsimd::fma(exponent, Batch(-2.12194440e-4f), fraction));
    }
}

/// Index of one of N weights, in proportion to them, from u in [0, 1); `sum` receives their sum. Counts instead of
/// branching, which would be mispredicted. A weight of zero is only chosen if all are.
template <int N>
[[gnu::always_inline]] inline size_t choose(const float* weights, float u, float& sum) {
    alignas(64) std::array<float, size_t(N)> upTo;
    sum = 0.0f;
    for (size_t i = 0; i < N; ++i) upTo[i] = sum += weights[i];
    const float place = u * sum;
    int below = 0;
    for (size_t i = 0; i < N; ++i) below += upTo[i] <= place ? 1 : 0;
    auto chosen = size_t(std::min(below, N - 1));
    while (chosen > 0 && !(weights[chosen] > 0.0f)) --chosen; // rounding at the end
    return chosen;
}

} // namespace lanes

namespace detail {

template <int N>
struct Register {
    using type = std::conditional_t<(N < int(xsimd::batch<float>::size)), xsimd::make_sized_batch_t<float, size_t(N)>,
                                    xsimd::batch<float>>;
};
template <>
struct Register<1> {
    using type = float;
};

} // namespace detail

/// The widest register of the machine compiled for that N numbers fill.
template <int N>
using RegisterOf = typename detail::Register<N>::type;

} // namespace darts
