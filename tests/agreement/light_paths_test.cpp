// Photon maps against the light tracer where camera paths find no light, or little: beams of light, points of light
// and glass, in the scenes that ship for single moments. Gates here have a width, which the light tracer needs.

#include "support/AgreementScenes.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

struct Moment {
    const char* scene;
    bool unwarped;
    double time;        ///< centre of the gate
    double beams = 0.3; ///< of the light paths of points
};

AgreementScene sceneOf(const Moment& moment) {
    const Effort effort{24, 24, 24, 50000};
    return shippedScene(moment.scene,
                        {"integrator.delta_time_gate=false", "integrator.transient_time_width=0.2",
                         std::string("integrator.camera_unwarped=") + (moment.unwarped ? "true" : "false"),
                         "integrator.transient_time_center=" + std::to_string(moment.time)},
                        0.05, effort);
}

void PrintTo(const Moment& moment, std::ostream* out) {
    *out << moment.scene << " at " << moment.time;
}

class MomentsAgree : public testing::TestWithParam<Moment> {};

TEST_P(MomentsAgree, WithTheLightTracer) {
    const test::OtherSeeds seeds{{"fogged_box_unwarped", 1}, {"amber_half_space_warped", 3}};
    const AgreementScene scene = sceneOf(GetParam());
    const BlockMeans reference = renderBlocks(scene, {"light paths", {"type=light_tracer"}, false, 1});
    ASSERT_GT(channelMean(reference.whole(0)), 0.0);
    for (const Method& method : {photonMethod("points", {"volume_photon_type=points"}, 2),
                                 beamMethod(photonMethod("beams", {}, 3), GetParam().beams)}) {
        SCOPED_TRACE(method.name);
        const Agreement agreement = compare(renderBlocks(scene, method), reference);
        EXPECT_LE(agreement.score(), 1.0) << agreement;
        EXPECT_LT(agreement.wholeError, 0.03) << "too noisy to be a proof: " << agreement;
        EXPECT_LT(agreement.shrink, 0.08) << "too large a radius to be a proof: " << agreement;
        RecordProperty("difference", std::to_string(agreement.difference));
    }
}

// The light tracer's connections to a camera amid the fog of laser-in-fog are too noisy where the way to it counts, and
// it does not show the fog behind the ball of volumetric-caustic.
INSTANTIATE_TEST_SUITE_P(Scenes, MomentsAgree,
                         testing::Values(Moment{"fogged-box", true, 1.6}, Moment{"laser-in-fog", true, 1.8},
                                         Moment{"amber-half-space", false, 5.9, 0.6}),
                         [](const auto& test) {
                             std::string name = test.param.scene;
                             for (char& c : name) c = c == '-' ? '_' : c;
                             return name + (test.param.unwarped ? "_unwarped" : "_warped");
                         });

} // namespace
} // namespace tungsten::test
