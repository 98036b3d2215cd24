// Planes, volumes, balls and hypervolumes against beams, which are tested against paths.

#include "support/GroundTruthScenes.h"

#include "photon/sliced/box_of_fog.h"

#include "photon/primitives/sliced/Slices.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

struct AgreementCase {
    const char* name;
    bool unwarped;
    const char *gate, *beamGate;
    int frame;
    uint32_t passes;
};

class SliceAgreement : public testing::TestWithParam<AgreementCase> {};

TEST_P(SliceAgreement, WithBeams) {
    const AgreementCase& c = GetParam();
    const Mean beams = meanOf(boxOfFog(c.unwarped, c.beamGate), "beams", "20000", 80, c.frame);
    for (const SliceName& name : SliceNames) {
        const Mean slices = meanOf(boxOfFog(c.unwarped, c.gate), name.type, "5000", c.passes, c.frame);
        for (int k = 0; k < 3; ++k) {
            const double error = std::hypot(slices.error[k], beams.error[k]);
            EXPECT_NEAR(slices.value[k], beams.value[k], 4.0 * error) << name.type << " channel " << k;
            if (name.kind != SliceKind::Planes && name.kind != SliceKind::Balls) {
                EXPECT_LT(error, 0.25 * beams.value[k]) << name.type << ": the test would not see a wrong value";
            }
        }
    }
}

constexpr const char* UnwarpedSequence = R"("start_time": 0.4, "transient_time_width": 0.4, "frame_num": 10)";

INSTANTIATE_TEST_SUITE_P(
    Gates, SliceAgreement,
    testing::Values(AgreementCase{"UnwarpedFrame", true, UnwarpedSequence, UnwarpedSequence, 4, 30},
                    AgreementCase{
                        "WarpedDelta", false,
                        R"("transient_time_center": 5.6, "transient_time_width": 0.05, "delta_time_gate": true)",
                        R"("transient_time_center": 5.6, "transient_time_width": 0.05)", 0, 50}),
    [](const auto& test) { return test.param.name; });

/// Thin fog over a bright floor: light that the floor sends into the fog, and little else.
TEST(SlicesAboveFloors, AgreeWithBeams) {
    const std::string scene = R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 0.02}],
        "primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.8}, "ext_medium": "fog", "transform": {"scale": 8}},
                       {"type": "point", "emission": 4, "ext_medium": "fog", "transform": {"position": [0, 1, 0]}}],
        "camera": {"type": "pinhole", "resolution": [2, 2], "fov": 15, "medium": "fog", "reconstruction_filter": "box",
                   "transform": {"position": [0, 0.8, 3], "look_at": [0, 0.8, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "min_bounces": 2, "max_bounces": 3,
                       "include_surfaces": false, "alpha": 1, "volume_alpha": 1,
                       "volume_gather_radius": 0.03, "transient_time_center": 5.2, )";
    const Mean beams = meanOf(scene + R"("transient_time_width": 0.2}})", "beams", "20000", 80, 0);
    const Mean slices =
        meanOf(scene + R"("transient_time_width": 0.05, "delta_time_gate": true}})", "volumes", "5000", 20, 0);
    const double error = std::hypot(slices.error[0], beams.error[0]);
    EXPECT_NEAR(slices.value[0], beams.value[0], 4.5 * error + 0.02 * beams.value[0]);
    EXPECT_LT(error, 0.06 * beams.value[0]) << "the test would not see a wrong value";
}

/// With all light at one speed straight rays may look at a choice of the records while others fold; slices have none.
TEST(SlicesBesideMirrors, AgreeWithBeams) {
    std::string json = boxOfFog(true, R"("transient_time_center": 2, "transient_time_width": 0.4)");
    const std::string plaster = R"("bsdf": {"type": "lambert", "albedo": 0.5})";
    json.replace(json.find(plaster), plaster.size(), R"("bsdf": {"type": "mirror"})");
    const Mean beams = meanOf(json, "beams", "20000", 60, 0);
    for (const char* type : {"volumes", "mis_volumes_balls"}) {
        const Mean slices = meanOf(json, type, "5000", 20, 0);
        for (int k = 0; k < 3; ++k) {
            const double error = std::hypot(slices.error[k], beams.error[k]);
            EXPECT_NEAR(slices.value[k], beams.value[k], 4.0 * error) << type << " channel " << k;
            EXPECT_LT(error, 0.25 * beams.value[k]) << type;
        }
    }
}

/// Planes and volumes, which have one.
TEST(SliceSteadyState, AgreesWithBeams) {
    const std::string json = boxOfFog(false, test::SteadyState);
    const auto steady = [&](const std::string& type, const char* count, uint32_t passes) {
        std::string scene = json;
        const std::string transient = "progressive_transient_photon_map";
        scene.replace(scene.find(transient), transient.size(), "progressive_photon_map");
        return meanOf(scene, type, count, passes, 0);
    };
    const Mean beams = steady("beams", "8000", 40);
    for (const char* type : {"planes", "volumes"}) {
        const Mean slices = steady(type, "3000", 30);
        for (int k = 0; k < 3; ++k) {
            const double error = std::hypot(slices.error[k], beams.error[k]);
            EXPECT_NEAR(slices.value[k], beams.value[k], 4.0 * error) << type << " channel " << k;
            EXPECT_LT(error, 0.2 * beams.value[k]) << type;
        }
    }
}

} // namespace
} // namespace tungsten::photon
