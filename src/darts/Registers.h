#pragma once
// Registers of floats that so many numbers fill.

#include "darts/Lanes.h"

namespace darts {

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
