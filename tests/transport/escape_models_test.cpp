// How light gets out of bodies: which model a vertex gets, and the numbers in it.

#include "transport/EscapeModels.h"

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::transport {
namespace {

/// A block of milk about the origin, 2 wide and high, 4 deep, in something; camera and lamp outside.
std::string sceneWith(const std::string& boundary, const std::string& more = "", const std::string& outside = "") {
    return R"({"media": [{"name": "milk", "type": "homogeneous", "sigma_s": 20, "sigma_a": 1},
                         {"name": "tissue", "type": "homogeneous", "sigma_s": 5, "sigma_a": 0.25},
                         {"name": "haze", "type": "homogeneous", "sigma_s": 0.01, "sigma_a": 0}],
               "primitives": [)" +
           more + R"({"type": "cube", "int_medium": "milk", )" + outside + R"("bsdf": )" + boundary +
           R"(, "transform": {"scale": [2, 2, 4]}},
              {"type": "point", "emission": 1, "transform": {"position": [0, 0, 9]}}],
              "camera": {"resolution": 1, "transform": {"position": [0, 0, 8], "look_at": [0, 0, 0]}},
              "integrator": {"type": "path_tracer", "transient_time_center": 15, "transient_time_width": 1},
              "renderer": {}})";
}
const std::string Forward = R"({"type": "forward"})", Glass = R"({"type": "dielectric", "ior": 1.4})";

struct View {
    LoadedScene loaded;
    EscapeModels escapeModels;
    uint64_t rays = 0;

    explicit View(const std::string& json) : loaded(load(json)), escapeModels(*loaded.scene) {}
    static LoadedScene load(const std::string& json) {
        const test::SceneFile file(json);
        return loadScene(file.path());
    }
    darts::TimeBudget choose(const Vec3f& position, const EscapeTarget& aim, int medium = 0) {
        const Vec3f offset = aim.position - position;
        darts::TimeBudget budget =
            darts::TimeBudget::of(darts::vec3(offset), {double(offset.length()), double(offset.length()) + 5.0});
        escapeModels.choose({position}, {medium, 1.0f}, aim, budget, rays);
        return budget;
    }
};

TEST(EscapeModels, StraightOutOfABlock) {
    View view(sceneWith(Forward));
    const EscapeTarget aim{{0.0f, 0.0f, 8.0f}};
    const darts::TimeBudget budget = view.choose({0.2f, 0.0f, 1.5f}, aim);
    ASSERT_EQ(budget.model, darts::EscapeModel::Bounded);
    const darts::EscapeGeometry& exit = budget.escape;
    EXPECT_TRUE(exit.straightExit);
    EXPECT_EQ(exit.faces.size(), 1u);
    EXPECT_EQ(exit.reflectionA, 1.0f);
    EXPECT_NEAR(exit.faces[0].depth, 0.5f, 1e-5f);
    EXPECT_NEAR(exit.faces[0].height, 6.0f, 1e-5f);
    EXPECT_NEAR(exit.faces[0].thickness, 4.0f, 1e-4f);
    EXPECT_NEAR(exit.faces[0].normal.z, 1.0f, 1e-5f);
    EXPECT_NEAR(exit.inside, 0.5f * std::sqrt(6.5f * 6.5f + 0.04f) / 6.5f, 1e-4f);
    EXPECT_EQ(view.rays, 0u); // a block is known
}

TEST(EscapeModels, EveryFaceThatTheTargetSeesFromNearby) {
    View view(sceneWith(Forward));
    const EscapeTarget aim{{5.0f, 0.0f, 8.0f}};
    EXPECT_EQ(view.choose({0.85f, 0.0f, 1.8f}, aim).escape.faces.size(), 2u);
    EXPECT_EQ(view.choose({0.6f, 0.0f, 1.8f}, aim).escape.faces.size(), 1u); // the other one is deeper
}

TEST(EscapeModels, RefractionHidesTheWayButNotTheDepth) {
    View view(sceneWith(Glass));
    const EscapeTarget aim{{0.0f, 0.0f, 8.0f}};
    const darts::TimeBudget budget = view.choose({0.0f, 0.0f, 1.5f}, aim);
    EXPECT_EQ(budget.model, darts::EscapeModel::Bounded);
    EXPECT_FALSE(budget.escape.straightExit);
    EXPECT_TRUE(budget.escape.refractedOnly);
    EXPECT_GT(budget.escape.reflectionA, 2.5f);
    EXPECT_TRUE(isSealed(*view.loaded.scene));
    EXPECT_FALSE(isSealed(*View(sceneWith(Forward)).loaded.scene));
}

TEST(EscapeModels, TargetsInTheSameBodyAndThinFogNeedNoWayOut) {
    View view(sceneWith(Forward, "", R"("ext_medium": "haze", )"));
    EXPECT_EQ(view.choose({0.0f, 0.0f, 1.5f}, {{0.0f, 0.0f, -1.0f}, 0}).model, darts::EscapeModel::Infinite);
    EXPECT_EQ(view.choose({0.0f, 0.0f, 6.0f}, {{0.0f, 0.0f, -1.0f}, 0}, 2).model, darts::EscapeModel::Infinite);
    EXPECT_EQ(view.choose({0.0f, 0.0f, 1.5f}, {{0.0f, 0.0f, 8.0f}, 2}).model, darts::EscapeModel::Bounded);
}

TEST(EscapeModels, WhatDiffusesFartherOutIsDepth) {
    // A coat of tissue, 0.5 thick, diffuses 4 times as fast: it delays as much as half its thickness of milk.
    const std::string coat = R"({"type": "cube", "int_medium": "tissue", "bsdf": {"type": "forward"},
                                "transform": {"scale": [3, 3, 5]}}, )";
    View view(sceneWith(Forward, coat, R"("ext_medium": "tissue", )"));
    const darts::TimeBudget budget = view.choose({0.0f, 0.0f, 1.5f}, {{0.0f, 0.0f, 8.0f}});
    ASSERT_EQ(budget.model, darts::EscapeModel::Bounded);
    EXPECT_NEAR(budget.escape.faces[0].outerDepth, 0.5f * std::sqrt(5.25f / 21.0f), 1e-3f);
    EXPECT_NEAR(budget.escape.faces[0].thickness, 4.5f, 1e-3f); // light in the coat is not lost
}

TEST(EscapeModels, LightGoesAroundWhatLiesInTheBody) {
    const std::string coat = R"({"type": "cube", "int_medium": "tissue", "bsdf": {"type": "forward"},
                                "transform": {"scale": [3, 3, 5]}}, )";
    View view(sceneWith(Forward, coat, R"("ext_medium": "tissue", )"));
    const darts::TimeBudget budget = view.choose({0.0f, 0.0f, -2.25f}, {{0.0f, 0.0f, 8.0f}}, 1);
    ASSERT_EQ(budget.model, darts::EscapeModel::Bounded);
    EXPECT_NEAR(budget.escape.faces[0].depth, 4.75f, 1e-4f);
    EXPECT_NEAR(budget.escape.lengthPerDepth, 1.0f, 1e-4f);
    // What is inside the milk is to be entered.
    EXPECT_NEAR(view.choose({0.0f, 0.0f, -2.25f}, {{0.0f, 0.0f, 1.0f}, 0}, 1).escape.faces[0].depth, 0.25f, 1e-4f);
}

/// At the boundary there is no depth: ways in the body must follow from the face's slant (best paths fell to 0.64).
TEST(EscapeModels, FlightsThatEnterABodyHaveALookFromInside) {
    const std::string coat = R"({"type": "cube", "int_medium": "tissue", "bsdf": {"type": "forward"},
                                "transform": {"scale": [3, 3, 5]}}, )";
    View view(sceneWith(Forward, coat, R"("ext_medium": "tissue", )"));
    const EscapeTarget aim{{4.0f, 0.0f, 5.5f}};
    darts::TimeBudget budget = darts::TimeBudget::of({4.0f, 0.0f, 3.0f}, {5.0, 9.0});
    view.escapeModels.choose(FlightStart::along({{0.0f, 0.0f, 2.5f}, {0.0f, 0.0f, -1.0f}, 1e-5f}), {1, 1.0f}, aim,
                             budget, view.rays);
    ASSERT_EQ(budget.model, darts::EscapeModel::Bounded);
    EXPECT_NEAR(budget.escape.faces[0].depth, 0.0f, 1e-4f);
    EXPECT_NEAR(budget.escape.lengthPerDepth, 5.0f / 3.0f, 1e-4f);
}

TEST(EscapeModels, NoneWhereNothingEndsOrThePolicyLeavesThemOut) {
    Policy policy;
    policy.sampling.on = true;
    const View view(sceneWith(Forward));
    EXPECT_NE(EscapeModels::make(*view.loaded.scene, policy), nullptr);
    EXPECT_EQ(EscapeModels::make(*View(sceneWith(R"({"type": "lambert"})")).loaded.scene, policy), nullptr);
    policy.bodies = false;
    EXPECT_EQ(EscapeModels::make(*view.loaded.scene, policy), nullptr);
    Features features;
    policy.bodies = true;
    EscapeModels::plan(*view.loaded.scene, policy, features);
    ASSERT_EQ(features.all.size(), 3u);
    EXPECT_NE(features.all[0].reason.find("half-space where light must get out"), std::string::npos);
    Features sealed;
    EscapeModels::plan(*View(sceneWith(Glass)).loaded.scene, policy, sealed);
    EXPECT_NE(sealed.all[0].reason.find("internal reflection"), std::string::npos);
}

} // namespace
} // namespace tungsten::transport
