#pragma once

#include "tungsten/core/Random.h"

#include <cmath>

namespace tungsten::test {

/// Between positive ends, its logarithm uniform: every order of magnitude is as likely.
inline double logUniform(Sampler& sampler, double low, double high) {
    return low * std::pow(high / low, sampler.nextDouble());
}

} // namespace tungsten::test
