// Where slices have guided light paths, with the reason in the plan.

#include "photon/PhotonPlan.h"

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr const char* DeltaGate = R"("transient_time_center": 3, "transient_time_width": 0.1, "delta_time_gate": true)";

std::string fog(const std::string& gate, const std::string& media = {}, const char* g = "0") {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1,
                          "phase_function": {"type": "henyey_greenstein", "g": )" +
           std::string(g) + "}}" + media + R"(],
        "camera": {"type": "pinhole", "medium": "fog"},
        "primitives": [{"type": "point", "emission": 1, "ext_medium": "fog"}],
        "integrator": {"type": "progressive_transient_photon_map", "darts": "best", )" +
           gate + "}}";
}
constexpr const char* SlowGlass = R"(, {"name": "glass", "type": "homogeneous", "speed_of_light": 0.6})";

/// What reading the integrator warns of.
std::string warningsOf(const std::string& json, const std::vector<std::string>& further) {
    const test::SceneFile file(json);
    const LoadedScene loaded = loadScene(file.path(), {{}, further});
    (void)readPhotonSettings(loaded.integratorSettings, *loaded.scene, true);
    std::string warnings;
    for (const Problem& warning : loaded.diagnostics->warnings)
        warnings += warning.path + ": " + warning.message + "\n";
    return warnings;
}

struct Planned {
    PhotonSettings settings;
    PhotonPlan plan;
};
Planned planOf(const std::string& json, const std::vector<std::string>& further) {
    const test::SceneFile file(json);
    const LoadedScene loaded = loadScene(file.path(), {{}, further});
    const PhotonSettings settings = readPhotonSettings(loaded.integratorSettings, *loaded.scene, true);
    return {settings, PhotonPlan::of(*loaded.scene, settings, analyseScene(*loaded.scene))};
}

std::string with(const char* primitive, const std::string& json) {
    std::string scene = json;
    const std::string first = R"("primitives": [)";
    scene.insert(scene.find(first) + first.size(), std::string(primitive) + ", ");
    return scene;
}

std::string inCube(const std::string& json) {
    return with(R"({"type": "cube", "bsdf": {"type": "dielectric", "ior": 1.5}, "int_medium": "glass",
        "ext_medium": "fog", "transform": {"position": [0, 0, 3]}})",
                json);
}

TEST(SlicesInForwardPeaks, AreWarnedOf) {
    for (const char* g : {"0.95", "-0.95"}) {
        const std::string told = warningsOf(fog(DeltaGate, {}, g), {"integrator.volume_photon_type=volumes"});
        EXPECT_NE(told.find("integrator.volume_photon_type: 'volumes' evaluates phase functions"), std::string::npos)
            << told;
        EXPECT_NE(told.find("0.95"), std::string::npos) << told;
    }
    EXPECT_EQ(warningsOf(fog(DeltaGate, {}, "0.9"), {"integrator.volume_photon_type=volumes"}), "");
    EXPECT_EQ(warningsOf(fog(DeltaGate, {}, "0.95"), {"integrator.volume_photon_type=points"}), "");
}

TEST(GuidedSlicesPlan, PlainWhereGuidingLoses) {
    const Planned speeds = planOf(inCube(fog(DeltaGate, SlowGlass)),
                                  {"integrator.volume_photon_type=volumes", "integrator.volume_gather_radius=0.1"});
    EXPECT_FALSE(speeds.plan.guidance.on);
    EXPECT_NE(speeds.plan.guidance.reason.find("speeds of light"), std::string::npos) << speeds.plan.guidance.reason;
    const Planned forward = planOf(fog(DeltaGate, {}, "0.9"), {"integrator.volume_photon_type=volumes"});
    EXPECT_FALSE(forward.plan.guidance.on);
    EXPECT_NE(forward.plan.guidance.reason.find("forward"), std::string::npos) << forward.plan.guidance.reason;
}

TEST(GuidedSlicesPlan, OrthographicCamerasNeedTimeWithoutTheirLeg) {
    const std::vector<std::string> mis{"integrator.volume_photon_type=mis_volumes_balls", "camera.type=orthographic"};
    EXPECT_FALSE(planOf(fog(DeltaGate), mis).plan.guidance.on);
    auto unwarped = mis;
    unwarped.emplace_back("integrator.camera_unwarped=true");
    EXPECT_TRUE(planOf(fog(DeltaGate), unwarped).plan.guidance.on);
}

} // namespace
} // namespace tungsten::photon
