// What the progress bar says.

#include "tungsten/session/Progress.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

ProgressState half() {
    ProgressState state;
    state.passes = 5;
    state.totalPasses = 10;
    state.samples = 80;
    state.totalSamples = 160;
    state.elapsedSeconds = 30.0;
    state.relativeError = 0.0213;
    return state;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Progress, SaysPassesSamplesTimesAndError) {
    const std::string line = progressLine(half());
    for (const char* part :
         {"############............", "pass 5/10", "80/160 spp", "0m30s elapsed", "0m30s left", "2.13 %"})
        EXPECT_TRUE(contains(line, part)) << part << " in " << line;
}

TEST(Progress, TheLimitThatComesFirstDecides) {
    ProgressState state = half();
    EXPECT_DOUBLE_EQ(progressFraction(state), 0.5);
    state.timeoutSeconds = 40.0;
    EXPECT_DOUBLE_EQ(progressFraction(state), 0.75);
    EXPECT_TRUE(contains(progressLine(state), "0m10s left"));
    state.errorBound = 0.0213;
    state.targetError = 0.0213; // reached
    EXPECT_DOUBLE_EQ(progressFraction(state), 1.0);
    state.targetError = 0.001;
    EXPECT_DOUBLE_EQ(progressFraction(state), 0.75);
}

TEST(Progress, BiasIsShownWhereItIsEstimatedAndCounts) {
    ProgressState state = half();
    state.timeoutSeconds = 0.0;
    state.relativeError = 0.02;
    state.errorBound = 0.03;
    EXPECT_FALSE(contains(progressLine(state), "bias"));
    state.bias = {0.01, 0.04};
    EXPECT_TRUE(contains(progressLine(state), "standard error 2 % (below 3 %), bias 1 % (below 4 %)"));
    state.targetError = 0.05; // reached by both together
    EXPECT_DOUBLE_EQ(progressFraction(state), 1.0);
    state.targetError = 0.04;
    EXPECT_NEAR(progressFraction(state), 0.64, 1e-12);
    constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
    state.bias = {Unknown, Unknown};
    EXPECT_TRUE(contains(progressLine(state), "bias not known yet"));
}

TEST(Progress, ResumedSamplesTakeNoTimeAgain) {
    ProgressState state = half();
    state.resumedSamples = 40; // 40 of the remaining 120 in 30 s
    EXPECT_NEAR(progressFraction(state), 1.0 / 3.0, 1e-12);
    EXPECT_TRUE(contains(progressLine(state), "1m00s left"));
}

TEST(Progress, OnePassHasNoErrorYet) {
    ProgressState state = half();
    state.relativeError = std::numeric_limits<double>::quiet_NaN();
    state.targetError = 0.01;
    EXPECT_TRUE(contains(progressLine(state), "not known yet"));
    EXPECT_DOUBLE_EQ(progressFraction(state), 0.5);
}

TEST(Progress, LongTimesAreInHours) {
    ProgressState state = half();
    state.elapsedSeconds = 3 * 3600.0 + 5 * 60.0;
    EXPECT_TRUE(contains(progressLine(state), "3h05m elapsed"));
}

} // namespace
} // namespace tungsten
