// The plan names what a scene calls for, and why.

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Report.h"

#include <gtest/gtest.h>

#include <sstream>

namespace tungsten {
namespace {

EffectPlan planOf(const std::string& json) {
    const test::SceneFile file(json);
    return analyseScene(*loadScene(file.path()).scene);
}

std::string textOf(const EffectPlan& plan) {
    std::ostringstream out;
    printEffects(plan, out);
    return out.str();
}

void expectIn(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

const char* const Bare = R"({"primitives": [{"type": "point", "emission": 1},
    {"name": "floor", "type": "quad", "bsdf": {"type": "lambert"}}]})";

TEST(EffectPlan, ABareSceneCallsForLittle) {
    const EffectPlan plan = planOf(Bare);
    EXPECT_FALSE(plan.timeResolved);
    EXPECT_FALSE(plan.mediumScattering);
    EXPECT_TRUE(plan.greyMedia);
    EXPECT_EQ(plan.heterogeneity(), "");
    EXPECT_TRUE(plan.surfaceScattering);
    EXPECT_FALSE(plan.specularSensorPaths);
    EXPECT_FALSE(plan.forwardBoundaries);
    EXPECT_FALSE(plan.surfaceEmission);
    EXPECT_FALSE(plan.environment);
    EXPECT_FALSE(plan.textures);
    EXPECT_FALSE(plan.speedsDiffer);
    EXPECT_EQ(plan.highestSpeed, 1.0f);
    expectIn(textOf(plan), {"steady state", "'floor'", "no reachable medium scatters"});
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

TEST(EffectPlan, EveryEffectOfARichSceneIsOnWithItsReason) {
    const EffectPlan plan = planOf(Rich);
    EXPECT_TRUE(plan.timeResolved);
    EXPECT_TRUE(plan.multipleFrames);
    EXPECT_TRUE(plan.mediumScattering);
    EXPECT_FALSE(plan.greyMedia);
    EXPECT_TRUE(plan.surfaceScattering);
    EXPECT_TRUE(plan.specularSensorPaths);
    EXPECT_TRUE(plan.forwardBoundaries);
    EXPECT_TRUE(plan.surfaceEmission);
    EXPECT_TRUE(plan.textures);
    EXPECT_TRUE(plan.speedsDiffer);
    const std::string text = textOf(plan);
    expectIn(text, {"4 frames of width 0.25 over [1, 2)", "'smoke'", "'cloud'", "'looking glass'", "'panel'",
                    "2 speeds, from 0.5 to 1"});
    EXPECT_EQ(text.find("unused"), std::string::npos) << "a medium that no path can reach does not count";
}

TEST(EffectPlan, SpeedsDoNotMatterInSteadyState) {
    std::string steady = Rich;
    steady.erase(steady.find(R"(, "start_time")"),
                 std::string(R"(, "start_time": 1, "transient_time_width": 0.25, "frame_num": 4)").size());
    EXPECT_FALSE(planOf(steady).speedsDiffer);
}

TEST(EffectPlan, AnEnvironmentIsNamed) {
    const EffectPlan plan = planOf(R"({"primitives": [{"name": "sky", "type": "infinite_sphere", "emission": 1}]})");
    EXPECT_TRUE(plan.environment);
    expectIn(textOf(plan), {"escaping rays see 'sky'"});
}

} // namespace
} // namespace tungsten
