// The plan names what a scene calls for, and why.

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Report.h"

#include <gtest/gtest.h>

#include <sstream>

namespace tungsten {
namespace {

struct Analysed {
    explicit Analysed(const std::string& json)
        : file(json), scene(loadScene(file.path()).scene), facts(analyseScene(*scene)) {}

    test::SceneFile file;
    std::shared_ptr<const Scene> scene;
    SceneFacts facts;
};

std::string textOf(const Analysed& of) {
    std::ostringstream out;
    printFeatures(featuresOf(*of.scene, of.facts), out);
    return out.str();
}

void expectIn(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

const char* const Bare = R"({"primitives": [{"type": "point", "emission": 1},
    {"name": "floor", "type": "quad", "bsdf": {"type": "lambert"}}]})";

TEST(SceneFacts, ABareSceneCallsForLittle) {
    const Analysed of(Bare);
    const SceneFacts& facts = of.facts;
    EXPECT_FALSE(facts.timeResolved);
    EXPECT_FALSE(facts.mediumScattering);
    EXPECT_TRUE(facts.greyMedia);
    EXPECT_EQ(heterogeneity(*of.scene, facts), "");
    EXPECT_TRUE(facts.surfaceScattering);
    EXPECT_FALSE(facts.specularCameraSubpaths);
    EXPECT_FALSE(facts.forwardBoundaries);
    EXPECT_FALSE(facts.surfaceEmission);
    EXPECT_FALSE(facts.environment);
    EXPECT_FALSE(facts.textures);
    EXPECT_FALSE(facts.speedsDiffer);
    EXPECT_EQ(facts.highestSpeed, 1.0f);
    expectIn(textOf(of), {"steady state", "'floor'", "no reachable medium scatters"});
}

const char* const Rich = R"({
    "media": [{"name": "smoke", "type": "homogeneous", "sigma_s": [1, 2, 3], "speed_of_light": 0.5},
              {"name": "unused", "type": "homogeneous", "sigma_s": 1}],
    "primitives": [
        {"name": "cloud", "type": "cube", "int_medium": "smoke", "bsdf": {"type": "forward"}},
        {"name": "looking glass", "type": "quad", "bsdf": {"type": "mirror"}, "transform": {"position": [0, -3, 0]}},
        {"name": "panel", "type": "quad", "emission": 2, "bsdf": {"type": "lambert", "albedo": {"type": "checker"}},
         "transform": {"position": [0, 3, 0]}}],
    "integrator": {"type": "path_tracer", "start_time": 1, "transient_time_width": 0.25, "frame_num": 4}})";

TEST(SceneFacts, EveryEffectOfARichSceneIsOnWithItsReason) {
    const Analysed of(Rich);
    const SceneFacts& facts = of.facts;
    EXPECT_TRUE(facts.timeResolved);
    EXPECT_TRUE(facts.multipleFrames);
    EXPECT_TRUE(facts.mediumScattering);
    EXPECT_FALSE(facts.greyMedia);
    EXPECT_TRUE(facts.surfaceScattering);
    EXPECT_TRUE(facts.specularCameraSubpaths);
    EXPECT_TRUE(facts.forwardBoundaries);
    EXPECT_TRUE(facts.surfaceEmission);
    EXPECT_TRUE(facts.textures);
    EXPECT_TRUE(facts.speedsDiffer);
    const std::string text = textOf(of);
    expectIn(text, {"4 frames of width 0.25 over [1, 2)", "'smoke'", "'cloud'", "'looking glass'", "'panel'",
                    "2 speeds, from 0.5 to 1"});
    EXPECT_EQ(text.find("unused"), std::string::npos) << "a medium that no path can reach does not count";
}

TEST(SceneFacts, SpeedsDoNotMatterInSteadyState) {
    std::string steady = Rich;
    steady.erase(steady.find(R"(, "start_time")"),
                 std::string(R"(, "start_time": 1, "transient_time_width": 0.25, "frame_num": 4)").size());
    EXPECT_FALSE(Analysed(steady).facts.speedsDiffer);
}

TEST(SceneFacts, AnEnvironmentIsNamed) {
    const Analysed of(R"({"primitives": [{"name": "sky", "type": "infinite_sphere", "emission": 1}]})");
    const SceneFacts& facts = of.facts;
    EXPECT_TRUE(facts.environment);
    expectIn(textOf(of), {"escaping rays see 'sky'"});
}

} // namespace
} // namespace tungsten
