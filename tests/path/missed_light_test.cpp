// What paths miss of points behind glass and mirrors: said where it is so, and nowhere else.

#include "path/MissedLight.h"
#include "path/PathTracer.h"
#include "support/PathsAndPhotons.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tungsten::path {
namespace {

struct MissedCase {
    std::string name, primitives;
    std::string warning; ///< part of it; empty: none
    std::string integrator = "";
};

/// A jar of milk about the origin, of these walls.
std::string jarOf(const std::string& bsdf) {
    return R"({"name": "jar", "type": "cube", "bsdf": )" + bsdf +
           R"(, "int_medium": "milk", "transform": {"scale": 2}})";
}
const std::string SmoothGlass = R"({"type": "dielectric", "ior": 1.5})", Lambert = R"({"type": "lambert"})";

std::string missedLamp(const std::string& type, const std::string& position) {
    const std::string power = type == "sphere" ? R"("power": 1, "bsdf": {"type": "null"})" : R"("emission": 1)";
    const std::string scale = type == "sphere" ? R"(, "scale": 0.1)" : "";
    return R"(, {"name": "lamp", "type": ")" + type + R"(", )" + power + R"(, "transform": {"position": )" + position +
           R"(, "look_at": [0, 0.1, 0], "up": [0, 0, 1])" + scale + "}}";
}
std::string groundOf(const std::string& bsdf, double height) {
    return R"({"name": "ground", "type": "quad", "bsdf": )" + bsdf +
           R"(, "transform": {"scale": 40, "position": [0, )" + std::to_string(height) + ", 0]}}";
}
/// A small mirror at the height 0; light of a lamp above goes up again.
const std::string Mirror =
    R"({"name": "mirror", "type": "quad", "bsdf": {"type": "mirror"}, "transform": {"scale": 0.2}})";

std::vector<MissedCase> missedCases() {
    const std::string refracts = "'lamp' that 'jar' refracts before anything scatters it",
                      glassJar = jarOf(SmoothGlass);
    const std::string bulb = R"({"name": "bulb", "type": "sphere", "bsdf": {"type": "dielectric", "ior": 1.5},
                                 "transform": {"position": [2, 5, 3], "scale": 0.3}},)";
    const std::string cover = R"({"type": "cube", "bsdf": {"type": "lambert"}, "transform": {"scale": 0.5,
                                 "position": [2, 5, 3]}},)";
    const std::string above = "[2, 5, 3]";
    const std::string gate = R"(, "transient_time_width": 1, "frame_num": 1, "start_time": )";
    return {
        {"point", glassJar + missedLamp("point", above), refracts},
        {"spot", glassJar + missedLamp("spot", above), refracts},
        {"laser in the jar", glassJar + missedLamp("collimated", above), "'jar' mirrors between its first two"},
        {"laser on the ground", glassJar + "," + groundOf(Lambert, -2) + missedLamp("directional_point", "[6, 5, 6]"),
         "between its first two"},
        {"area", glassJar + missedLamp("sphere", above), ""},
        {"environment", glassJar + R"(, {"type": "infinite_sphere", "emission": 1})", ""},
        {"rough glass",
         jarOf(R"({"type": "rough_dielectric", "ior": 1.5, "roughness": 0.1})") + missedLamp("point", above), ""},
        {"no boundary", jarOf(R"({"type": "forward"})") + missedLamp("point", above), ""},
        {"in the milk", glassJar + R"(, {"name": "lamp", "type": "point", "emission": 1, "ext_medium": "milk"})",
         "'lamp' that 'jar' mirrors before"},
        {"bulb", bulb + groundOf(Lambert, -2) + missedLamp("point", above), "'lamp' that 'bulb' refracts"},
        {"covered", cover + glassJar + missedLamp("point", above), ""},
        {"mirror under a ceiling", Mirror + "," + groundOf(Lambert, 9) + missedLamp("point", above),
         "'lamp' that 'mirror' mirrors"},
        {"mirror above all", Mirror + "," + groundOf(Lambert, -2) + missedLamp("point", above), ""},
        {"nothing but glass", R"({"type": "sphere", "bsdf": {"type": "dielectric"}})" + missedLamp("point", above), ""},
        {"half silvered",
         R"({"name": "pane", "type": "quad", "bsdf": {"type": "transparency", "alpha": 0.5, "base": "silver"}},)" +
             groundOf(Lambert, 9) + missedLamp("point", above),
         "'lamp' that 'pane' mirrors"},
        {"coat", groundOf(R"({"type": "plastic"})", -2) + "," + groundOf(Lambert, 9) + missedLamp("point", above), ""},
        {"too late", glassJar + missedLamp("point", above), "", gate + "0.5"},
        {"in time", glassJar + missedLamp("point", above), refracts, gate + "15"},
        {"one bounce", glassJar + missedLamp("point", above), "", R"(, "max_bounces": 1)"},
    };
}

class MissedLightCases : public testing::TestWithParam<MissedCase> {};

TEST_P(MissedLightCases, AreSaid) {
    const MissedCase& given = GetParam();
    for (const std::string darts : {"off", "best"}) {
        const test::SceneFile file(R"({"media": [{"name": "milk", "type": "homogeneous", "sigma_s": 2}],
            "bsdfs": [{"name": "silver", "type": "conductor", "material": "Ag"}],
            "primitives": [)" + given.primitives +
                                   R"(], "camera": {"resolution": 1, "transform":
            {"position": [0, 1, 7], "look_at": [0, 0, 0]}}, "integrator": {"type": "path_tracer", "darts": ")" +
                                   darts + "\"" + given.integrator + "}}");
        const LoadedScene loaded = loadScene(file.path());
        SceneFacts facts = analyseScene(*loaded.scene);
        Features features = featuresOf(*loaded.scene, facts);
        PathTracer(loaded.scene, loaded.integratorSettings).plan(facts, features);
        std::string text, limitations;
        for (const Problem& warning : loaded.diagnostics->warnings)
            if (warning.message.find("paths miss light of") != std::string::npos) text += warning.message;
        for (const std::string& limitation : features.limitations)
            if (limitation.find("light of points by mirrors and refraction") == 0) limitations += limitation;
        EXPECT_EQ(text.empty(), given.warning.empty()) << text;
        EXPECT_NE(text.find(given.warning), std::string::npos) << text;
        EXPECT_EQ(limitations.empty(), given.warning.empty()) << limitations;
        EXPECT_NE(limitations.find(given.warning), std::string::npos) << limitations;
    }
}

INSTANTIATE_TEST_SUITE_P(All, MissedLightCases, testing::ValuesIn(missedCases()), [](const auto& test) {
    std::string name = test.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

/// The warning is true: nothing of a point's light is in a jar of milk, which photon maps light, and which a lamp of
/// the same power with an area lights by paths as well.
TEST(MissedLight, IsThereInPhotonMapsAndOfLampsWithAnArea) {
    const auto scene = [](const std::string& lamp) {
        return R"({"media": [{"name": "milk", "type": "homogeneous", "sigma_a": 0.05, "sigma_s": 2}], "primitives": [)" +
               jarOf(SmoothGlass) + R"(, {"power": 1000, )" + lamp + R"(], "camera": {"resolution": 4, "fov": 10,
               "reconstruction_filter": "box", "transform": {"position": [0, 1, 7], "look_at": [0, 0, 0]}}})";
    };
    const std::string point = scene(R"("type": "point", "transform": {"position": [2, 5, 3]}})");
    const std::string ball = scene(R"("type": "sphere", "bsdf": {"type": "null"}, "transform": {"position": [2, 5, 3],
                                      "scale": 0.8}})");
    EXPECT_EQ(test::renderPaths(point, {{}, 4, 64})->mean(), 0.0);
    const test::RenderOptions photons{{"integrator.volume_photon_count=20000", "integrator.gather_radius=0.1"}, 16};
    const double byPhotons = test::renderPhotons(point, photons)->mean();
    const double ofBall = test::renderPaths(ball, {{}, 16, 256})->mean();
    EXPECT_NEAR(ofBall, byPhotons, 0.15 * byPhotons) << "the ball is not quite where the point is";
}

} // namespace
} // namespace tungsten::path
