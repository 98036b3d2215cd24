// What a ray meets at a surface: which side is shaded, and how.

#include "support/SceneFile.h"

#include "tungsten/scene/Interaction.h"
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

} // namespace
} // namespace tungsten
