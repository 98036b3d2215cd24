// What takes a medium's coefficients for constant is declined where they vary, with the reason in the plan.

#include "photon/PhotonPlan.h"

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

const char* const Fog = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1}],
    "camera": {"type": "pinhole", "medium": "fog"}, "primitives": [{"type": "point", "emission": 1, "ext_medium": "fog"}],
    "integrator": {"type": "progressive_transient_photon_map", "volume_gather_radius": 0.1, "darts": "best", "start_time": 1, "transient_time_width": 1}})";

PhotonPlan planOf(const std::string& photons, const std::vector<int>& varyingMedia) {
    const test::SceneFile file(Fog);
    const LoadedScene loaded = loadScene(file.path(), {{}, {"integrator.volume_photon_type=" + photons}});
    SceneFacts facts = analyseScene(*loaded.scene);
    EXPECT_TRUE(facts.heterogeneousMedia.empty());
    facts.heterogeneousMedia = varyingMedia;
    return PhotonPlan::of(*loaded.scene, readPhotonSettings(loaded.integratorSettings, *loaded.scene, true), facts);
}

TEST(HeterogeneousPlan, HomogeneousMediaAreGuidedAndSplatted) {
    for (const char* photons : {"points", "beams"}) {
        const PhotonPlan plan = planOf(photons, {});
        EXPECT_TRUE(plan.guidance.on) << photons << plan.guidance.reason;
        EXPECT_TRUE(plan.volume.on) << photons;
        EXPECT_TRUE(plan.splats()) << photons;
    }
}

TEST(HeterogeneousPlan, VaryingMediaKeepPlainPhotonPointsAlone) {
    const PhotonPlan points = planOf("points", {0});
    EXPECT_FALSE(points.guidance.on);
    EXPECT_NE(points.guidance.reason.find("vary from place to place in 'fog'"), std::string::npos)
        << points.guidance.reason;
    EXPECT_TRUE(points.volume.on);
    EXPECT_FALSE(points.splats());
    EXPECT_FALSE(points.connections.on);

    const PhotonPlan beams = planOf("beams", {0});
    EXPECT_FALSE(beams.volume.on);
    EXPECT_NE(beams.volume.reason.find("'fog'"), std::string::npos) << beams.volume.reason;
}

} // namespace
} // namespace tungsten::photon
