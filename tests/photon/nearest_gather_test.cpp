// Surfaces by their nearest photons: the mean of the estimate against closed forms.

#include "tungsten/core/Errors.h"

#include "support/GroundTruthScenes.h"
#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr int LitFrame = 15;
/// Of test::litFloor(): intensity 3, 1.25 away, in a frame of 0.25.
constexpr double FloorRadiance = 0.5 / 3.14159265358979 * 3.0 * (1.0 / 1.25) / (1.25 * 1.25) / 0.25;

/// Some 200 photons per unit of area: 20 of them within 0.18, which the floor's radiance changes by 0.2 % over.
std::unique_ptr<test::Rendered> floorByNearest(int count, double radius, uint32_t passes, bool bias = false) {
    return test::renderPhotons(test::litFloor(20), {.overrides = {test::setting("photon_count", 5000),
                                                                  test::setting("gather_photon_count", count),
                                                                  test::setting("gather_radius", radius)},
                                                    .passes = passes,
                                                    .bias = bias});
}

struct NearestCase {
    const char* name;
    int count;
    double radius; ///< the largest
    uint32_t passes;
    double counted = 1.0; ///< at least that part of the estimates has found so many
};

class NearestGather : public testing::TestWithParam<NearestCase> {};

/// k photons over the area up to the k-th are k / (k - 1) times too many; where the radius may end before, as many
/// as there are over its area are right, and so is any mixture of both.
TEST_P(NearestGather, IsRightOnAverage) {
    const NearestCase& c = GetParam();
    const auto rendered = floorByNearest(c.count, c.radius, c.passes);
    const double error = rendered->pixelError(LitFrame), bound = 4.5 * error + 2e-3 * FloorRadiance;
    EXPECT_NEAR(rendered->mean(LitFrame), FloorRadiance, bound) << rendered->mean(LitFrame) / FloorRadiance;
    EXPECT_LT(bound, c.counted * FloorRadiance / double(c.count - 1)) << "the test would not see a wrong value";
}

INSTANTIATE_TEST_SUITE_P(Counts, NearestGather,
                         testing::Values(NearestCase{"Five", 5, 1e30, 1000}, NearestCase{"Twenty", 20, 1e30, 1500},
                                         NearestCase{"FiveAtMost", 5, 0.085, 1500, 0.5}),
                         [](const auto& test) { return test.param.name; });

/// What narrower kernels say: nothing is left but noise.
TEST(NearestGatherBias, IsNone) {
    const auto rendered = floorByNearest(20, 1e30, 2500, true);
    const auto bias = double(rendered->bias.mean(LitFrame).at(0, 0).y);
    const double bound = 4.5 * double(rendered->bias.standardError(LitFrame).at(0, 0).y) + 2e-3 * FloorRadiance;
    EXPECT_NEAR(bias, 0.0, bound) << bias / FloorRadiance;
    EXPECT_LT(bound, 0.1 * FloorRadiance) << "the test would not see a wrong value";
}

/// A single one would leave none inside its distance.
TEST(NearestGatherSettings, NeedTwoPhotons) {
    try {
        test::renderPhotons(test::litFloor(20), {{test::setting("gather_photon_count", 1)}, 1, 1});
        FAIL() << "one photon is accepted";
    } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("gather_photon_count"), std::string::npos) << what;
        EXPECT_NE(what.find("2"), std::string::npos) << what;
    }
}

} // namespace
} // namespace tungsten::photon
