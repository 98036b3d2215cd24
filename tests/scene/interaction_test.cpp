// What a ray meets at a surface: which side is shaded, and how.

#include "support/SceneFile.h"

#include "tungsten/scene/Interaction.h"
#include "tungsten/scene/LightChoice.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

/// Value of a card's BSDF for light and view 0.6 off its normal on opposite azimuths, both on the same side.
Rgb valueSeenFrom(float side, const std::string& bsdf, const std::string& integrator = "") {
    const test::SceneFile file(R"({"primitives": [{"type": "quad", "bsdf": )" + bsdf + R"(}], "integrator": {)" +
                               integrator + "}}");
    const LoadedScene loaded = loadScene(file.path());
    const Vec3f ray(0.6f, -0.8f * side, 0.0f);
    const auto hit = loaded.scene->geometry->intersect({-ray, ray});
    const SurfaceInteraction surface = makeInteraction(*loaded.scene, hit.value(), ray);
    return surface.bsdf->eval(surface.query(TransportMode::Radiance), surface.wi,
                              surface.frame.toLocal(Vec3f(0.6f, 0.8f * side, 0.0f)));
}

const std::string Leaf = R"({"type": "lambert", "albedo": [0.3, 0.7, 0.2]})";

/// What lets light straight through, wholly or in part, still reflects on both sides, as in the format.
TEST(Interaction, VeiledSurfacesReflectOnBothSides) {
    const Rgb lambert = valueSeenFrom(-1.0f, Leaf);
    EXPECT_NEAR(lambert.y, 0.7f * 0.8f / Pi, 1e-6f);
    for (const float side : {1.0f, -1.0f}) {
        EXPECT_EQ(valueSeenFrom(side, R"({"type": "transparency", "alpha": 1, "base": )" + Leaf + "}"), lambert);
        EXPECT_EQ(valueSeenFrom(side, R"({"type": "mixed", "bsdf0": {"type": "forward"}, "bsdf1": )" + Leaf + "}"),
                  lambert * 0.5f);
    }
}

TEST(Interaction, BacksAreBlackBesideRefractionAndWithoutTwoSidedShading) {
    const std::string beside = R"({"type": "mixed", "bsdf0": {"type": "dielectric"}, "bsdf1": )" + Leaf + "}";
    EXPECT_GT(valueSeenFrom(1.0f, beside).y, 0.05f);
    EXPECT_EQ(valueSeenFrom(-1.0f, beside), Rgb(0.0f));
    EXPECT_EQ(valueSeenFrom(-1.0f, Leaf, R"("enable_two_sided_shading": false)"), Rgb(0.0f));
}

/// What leaves on the side that the light came from is kept, at a front and at a back, whose frame is turned around.
TEST(Interaction, ConsistencyChecksLookAtBothSidesAlike) {
    const test::SceneFile file(R"({"primitives": [{"type": "quad", "bsdf": )" + Leaf + "}]}");
    const LoadedScene loaded = loadScene(file.path());
    const Vec3f up(0.0f, 1.0f, 0.0f);
    for (const Vec3f& side : {up, -up}) {
        const auto hit = loaded.scene->geometry->intersect({side, -side});
        SurfaceInteraction surface = makeInteraction(*loaded.scene, hit.value(), -side);
        EXPECT_GT(surface.frame.n.dot(side), 0.999f);
        EXPECT_TRUE(surface.consistent(side, true));
        EXPECT_TRUE(surface.consistent(-side, true)) << "through it";
        // A shading normal 53 degrees off: a direction before the one and behind the other surface.
        surface.frame = Frame(side * 0.6f + Vec3f(0.8f, 0.0f, 0.0f));
        const Vec3f between = Vec3f(1.0f, 0.0f, 0.0f) - side * 0.2f;
        EXPECT_FALSE(surface.consistent(between.normalized(), true));
        EXPECT_TRUE(surface.consistent(between.normalized(), false));
        EXPECT_TRUE(surface.consistent(side, true));
    }
}

/// Into fog, out of it, reflected from within, and from without, where the box names nothing.
TEST(Interaction, RegionsAreThoseOfTheSideThatAPathLeavesFrom) {
    const test::SceneFile file(
        R"({"media": [{"name": "fog", "type": "homogeneous"}, {"name": "haze", "type": "homogeneous"}],
        "primitives": [{"type": "cube", "int_medium": "fog"}]})");
    const LoadedScene loaded = loadScene(file.path());
    const Region fog{0, 1.0f}, haze{1, 1.0f};
    const Vec3f up(0.0f, 1.0f, 0.0f);
    const auto meet = [&](const Vec3f& origin, const Vec3f& direction) {
        const auto hit = loaded.scene->geometry->intersect({origin, direction});
        return makeInteraction(*loaded.scene, hit.value(), direction);
    };
    const SurfaceInteraction fromAbove = meet({0.1f, 3.0f, 0.1f}, -up), fromWithin = meet({0.1f, 0.0f, 0.1f}, up);
    EXPECT_EQ(regionBeyond(fromAbove, -up, haze).medium, 0);
    EXPECT_EQ(regionBeyond(fromAbove, up, haze).medium, 1);
    EXPECT_EQ(regionBeyond(fromWithin, up, fog).medium, -1);
    EXPECT_EQ(regionBeyond(fromWithin, -up, fog).medium, 0);
}

TEST(LightChoice, IsHalfByPowerAndHalfEven) {
    const test::SceneFile file(R"({"primitives": [{"type": "point", "emission": 1}, {"type": "point", "emission": 3},
        {"type": "point", "emission": 96}]})");
    const LoadedScene loaded = loadScene(file.path());
    const LightChoice every(*loaded.scene), some(*loaded.scene, {false, false, true});
    const float expected[] = {0.005f + 0.5f / 3.0f, 0.015f + 0.5f / 3.0f, 0.48f + 0.5f / 3.0f};
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(every.probability(i), expected[i], 1e-5f) << i;
    EXPECT_NEAR(some.probability(0), 0.125f + 0.25f, 1e-5f);
    EXPECT_NEAR(some.probability(1), 0.375f + 0.25f, 1e-5f);
    EXPECT_EQ(some.probability(2), 0.0f);
}

} // namespace
} // namespace tungsten
