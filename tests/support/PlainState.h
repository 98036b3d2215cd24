#pragma once
// A guided walk's state as a plain walk that went the same way would have it.

#include "transport/Walk.h"

#include <cmath>

namespace tungsten::test {

/// Throughput times the density of guided walks over that of plain ones, along the way.
inline transport::PathState plainly(const transport::PathState& path) {
    transport::PathState plain = path;
    plain.throughput = path.throughput * std::exp(path.logRatio);
    return plain;
}

} // namespace tungsten::test
