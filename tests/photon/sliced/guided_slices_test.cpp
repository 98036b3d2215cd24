// Sliced primitives on guided light paths: against verified values, and against plain paths and beams.

#include "support/VerifiedValues.h"

#include "photon/primitives/sliced/Slices.h"
#include "photon/sliced/box_of_fog.h"

namespace tungsten::photon {
namespace {

using test::Overrides;
using test::setting;
using test::VerifiedValue;

class GuidedSliceOrders : public testing::TestWithParam<std::tuple<SliceName, VerifiedValue>> {};

TEST_P(GuidedSliceOrders, MatchVerifiedValues) {
    const auto& [kind, value] = GetParam();
    Overrides overrides = test::gateOf(value, 0.05);
    overrides.insert(overrides.end(),
                     {std::string("integrator.volume_photon_type=") + kind.type, "integrator.darts=best",
                      setting("volume_gather_radius", 0.1), setting("photon_count", 4000)});
    const auto rendered = test::renderPhotons(test::sceneOf(value), {overrides, 40, 1, 1});
    const double error = rendered->pixelError(), exact = value.radiance;
    const bool planes = kind.kind == SliceKind::Planes, kernel = planes && value.delta;
    EXPECT_NEAR(rendered->mean(), exact, 4.0 * std::hypot(error, value.uncertainty) + (kernel ? 0.01 : 1e-3) * exact)
        << "standard error " << error;
    RecordProperty("relative standard error", std::to_string(error / exact));
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
    if (!planes && kind.kind != SliceKind::Balls) {
        EXPECT_LT(error, 0.1 * exact) << "the test would not see a wrong value";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, GuidedSliceOrders,
    testing::Combine(testing::ValuesIn(SliceNames),
                     testing::Values(test::verified("A3WarpedBox"), test::verified("A3UnwarpedDelta"),
                                     test::verified("B3UnwarpedBox"), test::verified("C3WarpedDelta"),
                                     test::verified("W4WarpedDelta"))),
    [](const auto& test) { return std::string(std::get<0>(test.param).type) + test::nameOf(std::get<1>(test.param)); });

struct GuidedCase {
    const char* name;
    bool unwarped, delta;
    const char* g;
};

class GuidedSlices : public testing::TestWithParam<GuidedCase> {};

TEST_P(GuidedSlices, AgreeWithPlainSlicesAndBeams) {
    const GuidedCase& c = GetParam();
    const std::string box = c.unwarped ? R"("transient_time_center": 2, "transient_time_width": 0.05)"
                                       : R"("transient_time_center": 5.6, "transient_time_width": 0.05)";
    const std::string gate = c.delta ? box + R"(, "delta_time_gate": true)" : box;
    const bool forward = std::string(c.g) != "0"; // light that scatters forward rarely turns to the camera
    const Mean beams = meanOf(boxOfFog(c.unwarped, box, c.g), "beams", "20000", 40, 0);
    for (const SliceName& name : SliceNames) {
        if (name.kind == SliceKind::Balls || name.kind == SliceKind::VolumesBalls) continue; // others have theirs
        const Mean plain = meanOf(boxOfFog(c.unwarped, gate, c.g), name.type, "4000", 40, 0);
        const Mean guided = meanOf(boxOfFog(c.unwarped, gate, c.g), name.type, "4000", forward ? 80 : 40, 0, "best");
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(guided.value[k], plain.value[k], 4.0 * std::hypot(guided.error[k], plain.error[k]))
                << name.type << " channel " << k;
            EXPECT_NEAR(guided.value[k], beams.value[k], 4.0 * std::hypot(guided.error[k], beams.error[k]))
                << name.type << " channel " << k;
            if (k == 0)
                RecordProperty(std::string(name.type) + " errors, guided and plain",
                               std::to_string(guided.error[k] / guided.value[k]) + " " +
                                   std::to_string(plain.error[k] / guided.value[k]));
        }
        if (name.kind == SliceKind::MisVolumesBalls) {
            EXPECT_LT(guided.error[0], (forward ? 0.35 : 0.15) * guided.value[0])
                << "the test would not see a wrong value";
        }
    }
}

/// The other gates: GuidedSliceOrders, which sees far smaller differences. This is for occluders, colour and two
/// lights.
INSTANTIATE_TEST_SUITE_P(Fog, GuidedSlices,
                         testing::Values(GuidedCase{"WarpedBox", false, false, "0"},
                                         GuidedCase{"UnwarpedDeltaForward", true, true, "0.7"}),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace tungsten::photon
