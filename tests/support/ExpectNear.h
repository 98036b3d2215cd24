#pragma once

#include "tungsten/core/Types.h"

#include <gtest/gtest.h>

namespace tungsten::test {

inline void expectNear(const Vec3f& found, const Vec3f& expected, float tolerance = 1e-5f) {
    EXPECT_LT((found - expected).length(), tolerance) << "found " << found << ", expected " << expected;
}

} // namespace tungsten::test
