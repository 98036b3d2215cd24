// Single orders by planes, volumes, balls and hypervolumes against the verified values. Longer:
// benchmarks/verified_values.

#include "support/SlicedOrders.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

class SlicedValues : public testing::TestWithParam<VerifiedValue> {};

TEST_P(SlicedValues, AreMetByEveryRow) {
    const VerifiedValue value = GetParam();
    const SlicedMeans means = SlicedOrder(value).means(300000, 1);
    for (size_t row = 0; row < means.size(); ++row) {
        if (!exists(Sliced(row), value) || Sliced(row) == Sliced::ShortWithoutGhosts) continue;
        const auto [mean, error] = means[row];
        const double slack = infiniteVariance(Sliced(row)) ? 0.1 * value.radiance : 0.0;
        EXPECT_NEAR(mean, value.radiance, 4.0 * std::hypot(error, value.uncertainty) + slack) << SlicedNames[row];
        EXPECT_GT(mean, 0.0) << SlicedNames[row];
    }
    // What is neither noisy nor singular proves most.
    const auto& best = means[size_t(value.order >= 4   ? Sliced::Hypervolumes
                                    : value.order == 3 ? Sliced::Shared
                                                       : Sliced::Balls)];
    EXPECT_LT(best.error, (value.order >= 3 ? 0.05 : 0.2) * value.radiance);
}

INSTANTIATE_TEST_SUITE_P(Configurations, SlicedValues, testing::ValuesIn(VerifiedValues),
                         [](const auto& test) { return nameOf(test.param); });

/// Ending paths at a wall loses what their ghosts would have brought.
TEST(SlicedValues, NeedGhosts) {
    const VerifiedValue value = verified("W3UnwarpedDelta");
    const SlicedMeans means = SlicedOrder(value).means(400000, 2);
    const auto [mean, error] = means[size_t(Sliced::ShortWithoutGhosts)];
    EXPECT_NEAR(mean, 15.440e-4, 4.0 * error + 0.043e-4);
    EXPECT_LT(mean, 0.9 * value.radiance);
}

} // namespace
} // namespace tungsten::test
