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
    camera.model = Orthographic{{}, 2.0f};
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
        if (orthographic) camera.model = Orthographic{{}, 1.5f};
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

/// A lens under a transform with unequal scales and shear, a pinhole and an orthographic camera.
std::vector<Camera> unlikeCameras() {
    Camera pinhole = lookingAlongMinusZ();
    pinhole.toWorld.x *= 2.0f;
    pinhole.toWorld.z *= 0.7f;
    Camera lens = pinhole, orthographic = pinhole;
    pinhole.model = Pinhole{70.0f};
    lens.model = ThinLens{60.0f, 2.5f, 0.4f};
    lens.toWorld.y += Vec3f(0.1f, 0.0f, 0.0f);
    orthographic.model = Orthographic{{}, 1.5f};
    return {pinhole, lens, orthographic};
}

TEST(Camera, SensorSamplesAreItsOwnRays) {
    for (const Camera& camera : unlikeCameras())
        for (const Vec2f& uLens : {Vec2f(0.3f, 0.8f), Vec2f(0.9f, 0.45f)}) {
            const Ray ray = camera.generateRay({31, 4}, {0.5f, 0.5f}, uLens);
            for (const float distance : {0.8f, 3.0f}) {
                const auto sample = camera.sampleSensor(ray.at(distance), uLens);
                ASSERT_TRUE(sample);
                EXPECT_NEAR(sample->raster.x, 31.0f, 1e-3f);
                EXPECT_NEAR(sample->raster.y, 4.0f, 1e-3f);
                EXPECT_NEAR(sample->distance, distance, 1e-5f);
                EXPECT_LT((sample->direction + ray.direction).length(), 1e-5f);
            }
            EXPECT_FALSE(camera.sampleSensor(ray.at(-5.0f), uLens));
        }
}

/// Box pixels see a diffuse wall of radiance 1 through sampleSensor as through generateRay: each has the mean 1. Points
/// of the wall are drawn evenly; their numbers in the pixels follow the weight, pixel by pixel.
TEST(Camera, SensorWeightsAreTheDensityOfRays) {
    for (Camera camera : unlikeCameras()) {
        camera.resolution = {8, 4};
        constexpr int Points = 400000;
        constexpr float Half = 12.0f, Depth = 3.0f;
        std::vector<double> sums(32, 0.0), squares(32, 0.0);
        for (int i = 0; i < Points; ++i) {
            Sampler s(5, RandomStream::Test, 0, uint64_t(i));
            const Vec2f u = s.next2D(), uLens = s.next2D();
            const Vec3f point(1.0f + Half * (2.0f * u.x - 1.0f), 2.0f + Half * (2.0f * u.y - 1.0f), 3.0f - Depth);
            const auto sample = camera.sampleSensor(point, uLens);
            ASSERT_TRUE(sample);
            const int x = int(std::floor(sample->raster.x + 0.5f)), y = int(std::floor(sample->raster.y + 0.5f));
            if (x < 0 || y < 0 || x >= 8 || y >= 4) continue;
            // radiance x cosine at the wall, over the density of the point
            const double value = double(sample->direction.z) * double(sample->weight) * double(sqr(2.0f * Half));
            sums[size_t(y * 8 + x)] += value;
            squares[size_t(y * 8 + x)] += value * value;
        }
        for (size_t pixel = 0; pixel < sums.size(); ++pixel) {
            const double mean = sums[pixel] / Points, error = std::sqrt(squares[pixel]) / Points;
            EXPECT_NEAR(mean, 1.0, 5.0 * error) << pixel;
            EXPECT_LT(error, 0.05);
        }
    }
}

TEST(ReconstructionFilter, OffsetsFollowTheirDensity) {
    for (const std::string& name : filterNames()) {
        const ReconstructionFilter filter(*filterByName(name));
        if (filter.type() == FilterType::Dirac) continue;
        // Between the edges of the table's bins the density is constant.
        const float step = filter.type() == FilterType::Box ? 0.125f : filter.halfWidth() / 31.0f;
        const int cells = int(std::lround(filter.reach() / step));
        std::vector<double> observed(size_t(2 * cells), 0.0), expected;
        constexpr int Count = 200000;
        for (int i = 0; i < Count; ++i) {
            Sampler s(6, RandomStream::Test, 0, uint64_t(i));
            const int cell = int(std::floor(filter.sample(s.next2D()).x / step)) + cells;
            observed[size_t(std::clamp(cell, 0, 2 * cells - 1))] += 1.0;
        }
        double total = 0.0;
        for (int cell = 0; cell < 2 * cells; ++cell) {
            expected.push_back(double(filter.pdf((float(cell - cells) + 0.5f) * step)) * double(step) * Count);
            total += expected.back();
        }
        EXPECT_NEAR(total / Count, 1.0, 1e-5) << name;
        EXPECT_GT(test::chiSquarePValue(observed, expected), test::SmallestPValue) << name;
        EXPECT_EQ(filter.pdf(filter.reach() * 1.001f), 0.0f);
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
