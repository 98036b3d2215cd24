// A box of coloured fog seen through its index-matched front, with blocks that occlude and two lights whose pulses
// start at different times: planes, volumes, balls and hypervolumes against beams, which are tested against paths.

#include "photon/render_photons.h"

#include "photon/primitives/sliced/SliceKind.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

std::string boxOfFog(bool unwarped, const std::string& gate) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": [0.1, 0.2, 0.05], "sigma_s": [0.8, 0.6, 1.0],
                          "phase_function": {"type": "henyey_greenstein", "g": 0.2}}],
     "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": [3, 2.2, 2.6]}},
                    {"type": "cube", "ext_medium": "fog", "bsdf": {"type": "lambert", "albedo": [0.6, 0.5, 0.4]},
                     "transform": {"position": [0.3, -0.2, 0.2], "scale": 0.6, "rotation": [10, 30, 0]}},
                    {"type": "quad", "int_medium": "fog", "ext_medium": "fog", "bsdf": {"type": "lambert", "albedo": 0.5},
                     "transform": {"position": [-0.7, 0.1, 0], "rotation": [0, 0, 90], "scale": [1, 1, 1.2]}},
                    {"type": "point", "emission": 4, "ext_medium": "fog", "transform": {"position": [-1.3, 0.95, 0.3]}},
                    {"type": "point", "emission": 2, "emission_time": 0.8, "ext_medium": "fog",
                     "transform": {"position": [1.3, -0.95, -0.6]}}],
     "camera": {"type": "pinhole", "resolution": [2, 2], "fov": 23, "reconstruction_filter": "box",
                "transform": {"position": [0.4, 0.3, 4], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "min_bounces": 0, "max_bounces": 8, "include_surfaces": false,
                    "volume_photon_count": 10000000, "gather_radius": 0.1, "volume_gather_radius": 0.02, "alpha": 1,
                    "volume_alpha": 1, "camera_unwarped": )" +
           std::string(unwarped ? "true" : "false") + ", " + gate + "}}";
}

/// The image's mean: pixels of a pass share photons, so that their errors may all go the same way.
struct Mean {
    Vec3d value{0.0}, error{0.0};
};
Mean meanOf(const std::string& json, const std::string& type, const char* count, uint32_t passes, int frame) {
    const auto rendered = test::renderPhotons(
        json, {{"integrator.volume_photon_type=" + type, std::string("integrator.photon_count=") + count}, passes, 1});
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
    const Image values = rendered->film.mean(frame), errors = rendered->film.standardError(frame);
    Mean mean;
    for (size_t i = 0; i < values.pixels.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            mean.value[k] += double(values.pixels[i][k]) / double(values.pixels.size());
            mean.error[k] += double(errors.pixels[i][k]) / double(values.pixels.size());
        }
    return mean;
}

struct GateCase {
    const char* name;
    bool unwarped;
    const char *gate, *beamGate;
    int frame;
    uint32_t passes;
};

class SliceAgreement : public testing::TestWithParam<GateCase> {};

TEST_P(SliceAgreement, WithBeams) {
    const GateCase& c = GetParam();
    const Mean beams = meanOf(boxOfFog(c.unwarped, c.beamGate), "beams", "20000", 120, c.frame);
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

constexpr const char* Sequence = R"("start_time": 3.9, "transient_time_width": 0.4, "frame_num": 10)";
constexpr const char* UnwarpedSequence = R"("start_time": 0.4, "transient_time_width": 0.4, "frame_num": 10)";

INSTANTIATE_TEST_SUITE_P(
    Gates, SliceAgreement,
    testing::Values(GateCase{"WarpedFrame", false, Sequence, Sequence, 4, 30},
                    GateCase{"UnwarpedFrame", true, UnwarpedSequence, UnwarpedSequence, 4, 30},
                    GateCase{"WarpedDelta", false,
                             R"("transient_time_center": 5.6, "transient_time_width": 0.05, "delta_time_gate": true)",
                             R"("transient_time_center": 5.6, "transient_time_width": 0.05)", 0, 160},
                    GateCase{"UnwarpedDelta", true,
                             R"("transient_time_center": 2, "transient_time_width": 0.05, "delta_time_gate": true)",
                             R"("transient_time_center": 2, "transient_time_width": 0.05)", 0, 160}),
    [](const auto& test) { return test.param.name; });

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
