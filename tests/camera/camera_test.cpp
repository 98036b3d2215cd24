// Rays of every camera, and the sampled reconstruction filters.

#include "support/ChiSquare.h"

#include "tungsten/camera/Camera.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

Camera lookingAlongMinusZ() {
    TransformRecipe recipe;
    recipe.position = Vec3f(1, 2, 3);
    recipe.hasZ = recipe.hasY = true;
    recipe.zAxis = Vec3f(0, 0, -1);
    recipe.yAxis = Vec3f(0, 1, 0);
    Camera camera;
    camera.resolution = {40, 20};
    camera.toWorld = cameraTransform(composeTransform(recipe));
    camera.filter = ReconstructionFilter(FilterType::Dirac);
    return camera;
}

TEST(Camera, PinholeIsNotMirroredAndItsFieldOfViewIsHorizontal) {
    Camera camera = lookingAlongMinusZ();
    camera.model = Pinhole{90.0f};
    const Ray right = camera.generateRay({39, 10}, {0.5f, 0.5f}, {0.5f, 0.5f});
    EXPECT_GT(right.direction.x, 0.0f); // +x is on the right
    EXPECT_NEAR(right.direction.x / -right.direction.z, 39.0f / 40.0f, 1e-5f);
    const Ray top = camera.generateRay({20, 0}, {0.5f, 0.5f}, {0.5f, 0.5f});
    EXPECT_NEAR(top.direction.y / -top.direction.z, 0.5f - 1.0f / 40.0f, 1e-5f);
    EXPECT_EQ(top.origin, Vec3f(1, 2, 3));
    EXPECT_NEAR(top.direction.length(), 1.0f, 1e-6f);
}

TEST(Camera, TheApertureIsTheLensInTheWorld) {
    Camera camera = lookingAlongMinusZ();
    EXPECT_EQ(camera.aperture(), 0.0f);
    camera.model = ThinLens{60.0f, 2.0f, 0.1f};
    camera.toWorld.x *= 5.0f;
    camera.toWorld.y *= 5.0f;
    float furthest = 0.0f;
    for (int i = 0; i < 100; ++i) {
        const Ray ray = camera.generateRay({20, 10}, {0.5f, 0.5f}, {1.0f - 0.01f * float(i), 0.3f});
        furthest = std::max(furthest, (ray.origin - camera.position()).length());
    }
    EXPECT_NEAR(camera.aperture(), 0.5f, 1e-6f);
    EXPECT_LE(furthest, camera.aperture() * 1.0001f);
    EXPECT_GT(furthest, 0.9f * camera.aperture());
}

TEST(Camera, OrthographicSpansTwiceItsSize) {
    Camera camera = lookingAlongMinusZ();
    camera.model = Orthographic{2.0f};
    const Ray corner = camera.generateRay({0, 0}, {0.5f, 0.5f}, {0.5f, 0.5f});
    EXPECT_NEAR(corner.origin.x, 1.0f - 4.0f + 0.1f, 1e-5f);
    EXPECT_NEAR(corner.origin.y, 2.0f + 2.0f - 0.1f, 1e-5f);
    EXPECT_EQ(corner.direction, Vec3f(0, 0, -1));
}

TEST(Camera, ThinLensFocusesAndLeavesOutHalfAPixel) {
    Camera camera = lookingAlongMinusZ();
    camera.model = ThinLens{90.0f, 5.0f, 0.3f};
    Vec3f first;
    for (int i = 0; i < 20; ++i) {
        Sampler s(1, RandomStream::Test, 0, uint64_t(i));
        const Ray ray = camera.generateRay({30, 7}, {0.5f, 0.5f}, s.next2D());
        EXPECT_LE((ray.origin - camera.position()).length(), 0.3001f);
        const Vec3f focus = ray.at(5.0f / -ray.direction.z); // the plane of focus
        if (i == 0) first = focus;
        EXPECT_LT((focus - first).length(), 1e-4f);
    }
    // The pinhole through the same pixel meets the plane half a pixel to the right and below.
    camera.model = Pinhole{90.0f};
    const Ray ray = camera.generateRay({30, 7}, {0.5f, 0.5f}, {0.5f, 0.5f});
    const Vec3f shifted = ray.at(5.0f / -ray.direction.z);
    EXPECT_NEAR(shifted.x - first.x, 5.0f / 40.0f, 1e-4f);
    EXPECT_NEAR(first.y - shifted.y, 5.0f / 40.0f, 1e-4f);
}

TEST(Camera, ProjectionInvertsRays) {
    for (const bool orthographic : {false, true}) {
        Camera camera = lookingAlongMinusZ();
        if (orthographic) camera.model = Orthographic{1.5f};
        for (const Vec2i& pixel : {Vec2i(0, 0), Vec2i(39, 19), Vec2i(13, 4)}) {
            const Ray ray = camera.generateRay(pixel, {0.5f, 0.5f}, {0.5f, 0.5f});
            const auto raster = camera.project(ray.at(7.0f));
            ASSERT_TRUE(raster);
            EXPECT_NEAR(raster->x, float(pixel.x) + 0.5f, 1e-3f);
            EXPECT_NEAR(raster->y, float(pixel.y) + 0.5f, 1e-3f);
        }
        EXPECT_FALSE(camera.project(Vec3f(1, 2, 10)));
    }
}

TEST(ReconstructionFilter, BoxIsUniformAndTentHasTheFormatsOffset) {
    const ReconstructionFilter box(FilterType::Box), tent(FilterType::Tent);
    EXPECT_GT(test::chiSquareUniform([&](Sampler& s) { return double(box.sample(s.next2D()).y) + 0.5; }),
              test::SmallestPValue);
    double squared = 0.0, smallest = 10.0, largest = 0.0;
    constexpr int Count = 200000;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler s(1, RandomStream::Test, 0, i);
        const double x = std::abs(double(tent.sample(s.next2D()).x));
        squared += x * x;
        smallest = std::min(smallest, x);
        largest = std::max(largest, x);
    }
    // The format's off-by-one table: nothing within 1/31 of the centre; rms 0.441 instead of 0.408.
    EXPECT_NEAR(std::sqrt(squared / Count), 0.4415, 0.002);
    EXPECT_GE(smallest, 1.0 / 31.0 - 1e-6);
    EXPECT_LE(largest, 32.0 / 31.0 + 1e-6);
}

TEST(ReconstructionFilter, ProfilesAndNames) {
    EXPECT_NEAR(ReconstructionFilter(FilterType::Gaussian).eval(1.0f), std::exp(-2.0f) - std::exp(-8.0f), 1e-6f);
    EXPECT_NEAR(ReconstructionFilter(FilterType::MitchellNetravali).eval(0.0f), 8.0f / 9.0f, 1e-6f);
    EXPECT_NEAR(ReconstructionFilter(FilterType::CatmullRom).eval(0.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(ReconstructionFilter(FilterType::CatmullRom).eval(1.0f), 0.0f, 1e-6f);
    EXPECT_NEAR(ReconstructionFilter(FilterType::Lanczos).eval(1.0f), 0.0f, 1e-6f);
    EXPECT_EQ(ReconstructionFilter(FilterType::Dirac).sample({0.1f, 0.9f}), Vec2f(0.0f, 0.0f));
    for (const std::string& name : filterNames()) {
        const ReconstructionFilter filter(*filterByName(name));
        Sampler s(3, RandomStream::Test, 0, 0);
        for (int i = 0; i < 1000; ++i)
            EXPECT_LE(std::abs(filter.sample(s.next2D()).x), filter.halfWidth() * 32.0f / 31.0f + 1e-6f);
    }
    EXPECT_FALSE(filterByName("boxx"));
}

} // namespace
} // namespace tungsten
