// Weights of techniques that find the same path.

#include "transport/Balance.h"

#include <gtest/gtest.h>

#include <limits>

namespace tungsten::transport {
namespace {

TEST(Balance, WeightsAddUpToOne) {
    const float a = 0.3f, b = 7.0f, c = 1e-3f;
    EXPECT_NEAR(balance(a, b, c) + balance(b, c, a) + balance(c, a, b), 1.0f, 1e-6f);
    EXPECT_NEAR(powerHeuristic(a, b) + powerHeuristic(b, a), 1.0f, 1e-6f);
}

TEST(Balance, IsTheShareOfTheDensities) {
    EXPECT_FLOAT_EQ(balance(1.0f, 3.0f), 0.25f);
    EXPECT_FLOAT_EQ(balance(2.0f, 3.0f, 5.0f), 0.2f);
    EXPECT_FLOAT_EQ(powerHeuristic(1.0f, 3.0f), 0.1f);
    EXPECT_EQ(balance(0.5f), 1.0f) << "alone";
}

TEST(Balance, WhatDoesNotFindAPathHasNoShareOfIt) {
    EXPECT_EQ(balance(0.0f, 2.0f), 0.0f);
    EXPECT_EQ(balance(2.0f, 0.0f), 1.0f);
    EXPECT_EQ(balance(0.0f, 0.0f), 0.0f) << "not 0 / 0";
    EXPECT_EQ(powerHeuristic(0.0f, 0.0f), 0.0f);
}

TEST(Balance, FreeFlightsEndSomewhere) {
    const float sigmaT = 2.5f, step = 1e-3f;
    double sum = 0.0;
    for (float distance = 0.5f * step; distance < 10.0f; distance += step)
        sum += pdfFreeFlight(sigmaT, distance) * step;
    EXPECT_NEAR(sum, 1.0, 1e-3);
}

} // namespace
} // namespace tungsten::transport
