// volume_photon_type auto, and where slices have guided light paths: with the reason in the plan.

#include "photon/PhotonPlan.h"

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr const char* DeltaGate = R"("transient_time_center": 3, "transient_time_width": 0.1, "delta_time_gate": true)";
constexpr const char* BoxGate = R"("transient_time_center": 3, "transient_time_width": 0.1)";

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

struct Planned {
    PhotonSettings settings;
    PhotonPlan plan;
    [[nodiscard]] const Slices* slices() const { return std::get_if<Slices>(&settings.primitive); }
};
Planned planOf(const std::string& json, const std::vector<std::string>& further) {
    const test::SceneFile file(json);
    std::vector<std::string> overrides{"integrator.volume_photon_type=auto"};
    overrides.insert(overrides.end(), further.begin(), further.end());
    const LoadedScene loaded = loadScene(file.path(), {{}, overrides});
    const PhotonSettings settings = readPhotonSettings(loaded.integratorSettings, *loaded.scene, true);
    return {settings, PhotonPlan::of(*loaded.scene, settings, analyseScene(*loaded.scene))};
}

using Overrides = std::vector<std::string>;
constexpr const char* Radius = "integrator.volume_gather_radius=0.1";
constexpr const char* Small = "camera.resolution=[64, 48]";
constexpr const char* Large = "camera.resolution=[640, 480]";
constexpr const char* Unwarped = "integrator.camera_unwarped=true";

TEST(AutoPrimitive, SharedVolumesAndBallsInOpenFog) {
    for (const char* gate : {DeltaGate, BoxGate}) {
        const Planned planned = planOf(fog(gate), {Small, Radius});
        ASSERT_TRUE(planned.slices()) << planned.plan.volume.reason;
        EXPECT_EQ(planned.slices()->kind, SliceKind::MisVolumesBalls);
        EXPECT_TRUE(planned.slices()->classes.shared);
        EXPECT_NE(planned.plan.volume.reason.find("64 x 48"), std::string::npos) << planned.plan.volume.reason;
        EXPECT_TRUE(planned.plan.guidance.on) << planned.plan.guidance.reason;
    }
}

/// Every slice is drawn to all pixels.
TEST(AutoPrimitive, BeamsInLargeImages) {
    const Planned beams = planOf(fog(DeltaGate), {Large, Radius});
    EXPECT_TRUE(std::holds_alternative<Beams>(beams.settings.primitive)) << beams.plan.volume.reason;
    EXPECT_NE(beams.plan.volume.reason.find("640 x 480"), std::string::npos) << beams.plan.volume.reason;
    EXPECT_TRUE(planOf(fog(DeltaGate), {Large, Radius, Unwarped}).slices());
    EXPECT_TRUE(planOf(fog(DeltaGate), {Large}).slices()) << "no kernel, where no radius is given";
}

std::string with(const char* primitive, const std::string& json) {
    std::string scene = json;
    const std::string first = R"("primitives": [)";
    scene.insert(scene.find(first) + first.size(), std::string(primitive) + ", ");
    return scene;
}

/// Fog with a lamp, and a cube of it that ends so.
bool slicedBehind(const char* bsdf, const char* resolution, const Overrides& further, const char* gate = DeltaGate) {
    const std::string cube =
        std::string(R"({"type": "cube", "int_medium": "fog", "bsdf": {"type": ")") + bsdf + R"("}})";
    Overrides overrides{std::string("camera.resolution=") + resolution, Radius};
    overrides.insert(overrides.end(), further.begin(), further.end());
    const Planned planned = planOf(with(cube.c_str(), fog(gate)), overrides);
    const bool inTheWay = planned.plan.volume.reason.find("surfaces are in the way") != std::string::npos;
    EXPECT_EQ(inTheWay, !planned.slices() && std::string(bsdf) != "forward") << planned.plan.volume.reason;
    EXPECT_NE(planned.plan.volume.reason.find(" x "), std::string::npos) << planned.plan.volume.reason;
    return planned.slices() != nullptr;
}

TEST(AutoPrimitive, BeamsInLargeImagesBehindBoundaries) {
    EXPECT_TRUE(slicedBehind("forward", "[80, 80]", {}));
    EXPECT_FALSE(slicedBehind("forward", "[100, 100]", {}));
    EXPECT_TRUE(slicedBehind("forward", "[100, 100]", {Unwarped}));
}

/// Slices need shadow rays at every pixel there, and light that scatters again.
TEST(AutoPrimitive, BeamsAmongSurfacesButInSmallImages) {
    EXPECT_TRUE(slicedBehind("lambert", "[60, 60]", {}));
    EXPECT_FALSE(slicedBehind("lambert", "[70, 70]", {}));
    EXPECT_FALSE(slicedBehind("lambert", "[16, 16]", {"integrator.transient_time_center=5"})) << "many scatterings";
    EXPECT_FALSE(slicedBehind("lambert", "[16, 16]", {}, BoxGate));
    EXPECT_TRUE(slicedBehind("lambert", "[80, 80]", {Unwarped}));
    EXPECT_FALSE(slicedBehind("lambert", "[100, 100]", {Unwarped}));
    EXPECT_TRUE(slicedBehind("lambert", "[40, 40]", {Unwarped}, BoxGate));
    EXPECT_FALSE(slicedBehind("lambert", "[50, 50]", {Unwarped}, BoxGate));
    EXPECT_FALSE(slicedBehind("lambert", "[40, 40]", {Unwarped, "integrator.transient_time_center=0.5"}));
}

TEST(AutoPrimitive, HypervolumesForManyScatteringsAndColours) {
    const auto kindOf = [](const Overrides& overrides) {
        Overrides all{Small, Radius};
        all.insert(all.end(), overrides.begin(), overrides.end());
        const Planned planned = planOf(fog(DeltaGate), all);
        return planned.slices() ? std::optional(planned.slices()->kind) : std::nullopt;
    };
    EXPECT_EQ(kindOf({"integrator.transient_time_center=3.5"}), SliceKind::MisVolumesBalls);
    EXPECT_EQ(kindOf({"integrator.transient_time_center=6"}), SliceKind::Hypervolumes);
    EXPECT_EQ(kindOf({"media.fog.sigma_s=[1, 1.2, 1.4]"}), SliceKind::Hypervolumes);
    EXPECT_EQ(kindOf({"integrator.transient_time_center=50"}), std::nullopt);
}

TEST(AutoPrimitive, PointsInDenseFog) {
    const Planned planned = planOf(fog(DeltaGate), {Small, Radius, "media.fog.sigma_s=20"});
    EXPECT_TRUE(std::holds_alternative<Points>(planned.settings.primitive)) << planned.plan.volume.reason;
    EXPECT_NE(planned.plan.volume.reason.find("dozens"), std::string::npos) << planned.plan.volume.reason;
}

/// But without the camera's leg light need not turn to the camera in time.
TEST(AutoPrimitive, ForwardPeaksHaveKernels) {
    EXPECT_TRUE(planOf(fog(DeltaGate, {}, "0.7"), {Small, Unwarped}).slices());
    const Planned planned = planOf(fog(DeltaGate, {}, "0.7"), {Small});
    EXPECT_TRUE(std::holds_alternative<Points>(planned.settings.primitive)) << planned.plan.volume.reason;
    EXPECT_NE(planned.plan.volume.reason.find("forward"), std::string::npos) << planned.plan.volume.reason;
    const Planned beams = planOf(fog(DeltaGate, {}, "0.7"), {Small, Radius});
    EXPECT_TRUE(std::holds_alternative<Beams>(beams.settings.primitive)) << beams.plan.volume.reason;
}

std::string inCube(const std::string& json) {
    return with(R"({"type": "cube", "bsdf": {"type": "dielectric", "ior": 1.5}, "int_medium": "glass",
        "ext_medium": "fog", "transform": {"position": [0, 0, 3]}})",
                json);
}

TEST(AutoPrimitive, SeveralSpeedsOfLight) {
    const std::string json = inCube(fog(DeltaGate, SlowGlass));
    const Planned warped = planOf(json, {Small, Radius});
    EXPECT_TRUE(std::holds_alternative<Beams>(warped.settings.primitive)) << warped.plan.volume.reason;
    EXPECT_NE(warped.plan.volume.reason.find("several speeds"), std::string::npos) << warped.plan.volume.reason;
    const Planned unwarped = planOf(json, {Large, Radius, Unwarped});
    EXPECT_TRUE(std::holds_alternative<Beams>(unwarped.settings.primitive)) << unwarped.plan.volume.reason;
    EXPECT_NE(unwarped.plan.volume.reason.find("in the way"), std::string::npos) << unwarped.plan.volume.reason;
}

/// Nothing but glass in light's way, a gate that lasts, and time that stops before the camera.
TEST(AutoPrimitive, PlanesBehindLenses) {
    const auto kindOf = [](const std::string& json, const char* resolution) {
        const Planned planned = planOf(json, {resolution, Radius, Unwarped});
        const bool lenses = planned.plan.volume.reason.find("lenses") != std::string::npos;
        EXPECT_EQ(lenses, planned.slices() && planned.slices()->kind == SliceKind::Planes)
            << planned.plan.volume.reason;
        return planned.slices() ? std::optional(planned.slices()->kind) : std::nullopt;
    };
    const std::string lens = inCube(fog(BoxGate, SlowGlass));
    EXPECT_EQ(kindOf(lens, Small), SliceKind::Planes);
    EXPECT_EQ(kindOf(lens, Large), std::nullopt);
    const char* wall = R"({"type": "quad", "bsdf": {"type": "lambert"}})";
    EXPECT_EQ(kindOf(with(wall, lens), Small), std::nullopt);
    std::string milk = lens;
    const std::string glass = R"("int_medium": "glass")";
    milk.replace(milk.find(glass), glass.size(), R"("int_medium": "fog")");
    EXPECT_EQ(kindOf(milk, Small), std::nullopt);
    EXPECT_EQ(kindOf(inCube(fog(DeltaGate, SlowGlass)), Small), SliceKind::MisVolumesBalls);
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
