// Where slices come close to their singularities: every sample stays finite, on plain and on guided paths.

#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include "photon/primitives/sliced/SliceLanes.h"
#include "photon/primitives/sliced/Slices.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

struct Extreme {
    const char* name;
    test::Overrides overrides;
    bool dark = false; ///< nothing arrives
};

class RobustSlices : public testing::TestWithParam<Extreme> {};

TEST_P(RobustSlices, StayFinite) {
    const Extreme& c = GetParam();
    for (const SliceName& kind : SliceNames)
        for (const bool unwarped : {false, true})
            for (const char* darts : {"off", "best"})
                for (const char* delta : {"false", "true"}) {
                    test::Overrides overrides{std::string("integrator.volume_photon_type=") + kind.type,
                                              std::string("integrator.darts=") + darts,
                                              std::string("integrator.delta_time_gate=") + delta,
                                              test::setting("volume_gather_radius", 0.1),
                                              test::setting("photon_count", 300),
                                              "integrator.min_bounces=0"};
                    overrides.insert(overrides.end(), c.overrides.begin(), c.overrides.end());
                    const auto rendered = test::renderPhotons(test::configurationA(3, unwarped), {overrides, 2, 1});
                    const std::string which = std::string(kind.type) + (unwarped ? " unwarped " : " ") + darts;
                    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u) << which;
                    EXPECT_TRUE(std::isfinite(rendered->mean())) << which;
                    EXPECT_GE(rendered->mean(), 0.0) << which;
                    if (c.dark) {
                        EXPECT_EQ(rendered->mean(), 0.0) << which;
                    }
                }
}

const std::string Position = "camera.transform.position=";

INSTANTIATE_TEST_SUITE_P(
    Cases, RobustSlices,
    testing::Values(Extreme{"CameraAtTheLight", {Position + "[1.2, 0.5, 2]"}},
                    Extreme{"CameraInsidePrimitives", {Position + "[1.2, 0.5, 1.9]"}},
                    Extreme{"ParallelEdges", {"media.0.phase_function.g=0.999", "integrator.max_bounces=20"}},
                    Extreme{"ThousandsOfBounces",
                            {"media.0.sigma_a=0", "media.0.sigma_s=400", "integrator.max_bounces=4000",
                             "media.0.max_bounces=4000", "integrator.photon_count=20"}},
                    Extreme{"GateBeforeTheBase", {"primitives.0.emission_time=20"}, true}),
    [](const auto& test) { return test.param.name; });

/// The random number 0 at the dark end of a long chord was a point of density 0 and infinite weight: one in 2^24 draws.
/// Empty chords beside it are no concern of the others.
TEST(ChordLanes, ReachHasAWeightForEveryRandomNumber) {
    LaneRecord record{};
    record.sigmaT = Rgb(100.0f);
    record.grey = record.drawsPoints = true;
    ChordLanes<3> chord{};
    chord.offset.fill(Batch(10.0f)); // shorter along the ray by twice its length
    chord.slope.fill(Batch(-2.0f / 3.0f));
    alignas(64) float starts[Lanes] = {}, ends[Lanes];
    std::fill_n(ends, Lanes, 5.0f);
    starts[1] = Infinity;
    ends[1] = -Infinity;
    chord.start = Batch::load_aligned(starts);
    chord.end = Batch::load_aligned(ends);
    for (const float u : {0.0f, 0x1p-24f, 0.5f, 1.0f - 0x1p-24f}) {
        const LaneHit hit = chord.hit(record, chord.holds(), Batch(1.0f), Batch(u));
        alignas(64) float factor[Lanes], along[Lanes];
        hit.factor.store_aligned(factor);
        hit.alongRay.store_aligned(along);
        EXPECT_TRUE(std::isfinite(factor[0])) << u;
        EXPECT_GE(factor[0], 0.0f) << u;
        EXPECT_GE(along[0], 0.0f) << u;
        EXPECT_LE(along[0], 5.0f) << u;
    }
}

} // namespace
} // namespace tungsten::photon
