// Light paths: which photons they store.

#include "photon/light/PhotonPass.h"
#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/GroundTruthScenes.h"
#include "support/Render.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// Traces a pass in which every photon's power overflows.
PhotonMaps traceOverflow(const std::string& setting, Statistics& statistics) {
    const test::SceneFile file(test::fogOverFloor(R"("transient_time_center": 7, "transient_time_width": 4)"));
    const LoadedScene loaded =
        loadScene(file.path(), {{},
                                {R"(primitives.2.emission=[2e38, 1, 1])", R"(primitives.3.emission=[2e38, 1, 1])",
                                 "integrator.photon_count=2000", "integrator." + setting}});
    const PhotonSettings settings = readPhotonSettings(loaded.integratorSettings, *loaded.scene, true);
    return PhotonPass(*loaded.scene, settings, PhotonPlan::of(*loaded.scene, settings, analyseScene(*loaded.scene)))
        .trace({0, 0, 1, 1}, nullptr, statistics);
}

TEST(PhotonWalk, CountsPowersThatAreNotFiniteAndStoresNone) {
    for (const std::string setting : {"darts=off", "darts=best", "volume_photon_type=beams"}) {
        SCOPED_TRACE(setting);
        Statistics statistics;
        const PhotonMaps maps = traceOverflow(setting, statistics);
        EXPECT_EQ(maps.surface.records.size(), 0u);
        std::visit([](const auto& store) { EXPECT_EQ(store.records.size(), 0u); }, maps.volume);
        EXPECT_GT(statistics.counter("non-finite samples"), 100u);
    }
}

} // namespace
} // namespace tungsten::photon
