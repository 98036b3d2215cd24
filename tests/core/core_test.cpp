// Random numbers, warps, distributions, transforms, names, folders.

#include "support/ChiSquare.h"
#include "support/ExpectNear.h"
#include "support/SceneFile.h"

#include "tungsten/core/Distribution.h"
#include "tungsten/core/Errors.h"
#include "tungsten/core/InsideFolder.h"
#include "tungsten/core/ModelSet.h"
#include "tungsten/core/Transform.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace tungsten {
namespace {

struct Wide {
    static constexpr const char* Type = "wide";
};
struct Narrow {
    static constexpr const char* Type = "narrow";
};

TEST(ModelSet, KnowsItsModelsByTheirTypes) {
    using Set = ModelSet<Wide, Narrow>;
    EXPECT_EQ(Set::types(), (std::vector<std::string>{"narrow", "wide"}));
    EXPECT_TRUE(Set::has("wide"));
    EXPECT_FALSE(Set::has("wid"));
    const auto made = Set::read("narrow", []<typename Model> { return Set::Variant(Model()); });
    EXPECT_TRUE(std::holds_alternative<Narrow>(made));
}

using Words = std::array<uint32_t, 4>;

TEST(Philox, KnownAnswers) {
    // Published test vectors of Philox4x32-10 (Salmon et al. 2011).
    EXPECT_EQ((philox4x32<10>({0, 0, 0, 0}, {0, 0})), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ((philox4x32<10>({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u})),
              (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ((philox4x32<10>({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0})),
              (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, PairsAreTheNumbersOfTwoCounters) {
    const std::array<uint32_t, 3> rest{0x85a308d3, 0x13198a2e, 0x03707344};
    const std::array<uint32_t, 2> key{0xa4093822, 0x299f31d0};
    for (const uint32_t first : {0u, 6u, 0x7fffffffu, 0xfffffffeu, ~0u}) {
        const auto pair = philox4x32Pair<7>(first, rest, key);
        for (uint32_t i = 0; i < 2; ++i)
            EXPECT_EQ((Words{pair[4 * i], pair[4 * i + 1], pair[4 * i + 2], pair[4 * i + 3]}),
                      (philox4x32<7>({first + i, rest[0], rest[1], rest[2]}, key)))
                << first << " + " << i;
    }
}

TEST(Sampler, IsUniformAndIndependentOfItsNeighbours) {
    EXPECT_GT(test::chiSquareUniform([](Sampler& s) { return double(s.next1D()); }), test::SmallestPValue);
    // Products of numbers of neighbouring paths, passes and streams average to 1/4.
    constexpr int Count = 200000;
    double path = 0.0, pass = 0.0, stream = 0.0;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler a(5, RandomStream::Camera, 0, i), b(5, RandomStream::Camera, 0, i + 1),
            c(5, RandomStream::Camera, 1, i), d(5, RandomStream::Photon, 0, i);
        const double x = double(a.next1D());
        path += x * double(b.next1D());
        pass += x * double(c.next1D());
        stream += x * double(d.next1D());
    }
    const double sigma = std::sqrt((1.0 / 9.0 - 1.0 / 16.0) / Count);
    for (const double sum : {path, pass, stream}) EXPECT_NEAR(sum / Count, 0.25, 4.5 * sigma);
}

/// What a vertex draws depends on nothing that is drawn elsewhere, nor on the order.
TEST(Sampler, PlacesHaveNumbersOfTheirOwn) {
    Sampler straight(1, RandomStream::Camera, 2, 3);
    straight.at(7, Draw::Light);
    const std::array<uint32_t, 3> light{straight.nextBits(), straight.nextBits(), straight.nextBits()};
    Sampler busy(1, RandomStream::Camera, 2, 3);
    for (int i = 0; i < 1000; ++i) busy.nextBits();
    busy.at(7, Draw::Roulette);
    const uint32_t roulette = busy.nextBits();
    busy.at(7, Draw::Light);
    for (const uint32_t bits : light) EXPECT_EQ(busy.nextBits(), bits);
    // Numbers follow one another from any place: roulette's is next to light's.
    EXPECT_EQ(busy.nextBits(), roulette);
    std::set<uint32_t> all(light.begin(), light.end());
    for (const int vertex : {0, 6, 8, 1'000'000}) {
        busy.at(vertex, Draw::Light);
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(all.insert(busy.nextBits()).second) << vertex;
    }
}

TEST(Sampler, BranchesAreStreamsOfTheirOwn) {
    const Sampler path(1, RandomStream::Photon, 2, 3), other(1, RandomStream::Photon, 2, 4);
    std::set<uint64_t> all;
    const auto expectNew = [&](Sampler sampler) {
        const uint64_t high = sampler.nextBits();
        EXPECT_TRUE(all.insert((high << 32) | sampler.nextBits()).second);
    };
    for (const Sampler& root : {path, other}) {
        expectNew(root);
        for (uint64_t place = 0; place < 1000; ++place) {
            expectNew(root.branch(RandomStream::Record, place));
            expectNew(root.branch(RandomStream::Connection, place));
            expectNew(root.copy(int(place), 1).copy(int(place), 1)); // lineage
            expectNew(root.copy(int(place), 2));
        }
    }
    // Where it is on its own path does not matter.
    Sampler moved = path;
    moved.at(5, Draw::Distance);
    moved.next1D();
    EXPECT_EQ(moved.branch(RandomStream::Record, 9).nextBits(), path.branch(RandomStream::Record, 9).nextBits());
    EXPECT_GT(test::chiSquareUniform([count = uint64_t(0)](Sampler& s) mutable {
                  return double(s.branch(RandomStream::Record, count++).next1D());
              }),
              test::SmallestPValue);
}

TEST(Sampler, IsAPureFunctionOfItsKey) {
    Sampler a(1, RandomStream::Camera, 2, 3), b(1, RandomStream::Camera, 2, 3);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(a.nextBits(), b.nextBits());
}

TEST(Warp, DirectionsFollowTheirDensities) {
    EXPECT_GT(test::chiSquareSphere([](Sampler& s) { return std::optional(warp::squareToSphere(s.next2D())); },
                                    [](const Vec3f&) { return double(warp::squareToSpherePdf()); }),
              test::SmallestPValue);
    EXPECT_GT(
        test::chiSquareSphere([](Sampler& s) { return std::optional(warp::squareToCosineHemisphere(s.next2D())); },
                              [](const Vec3f& v) { return double(warp::squareToCosineHemispherePdf(v)); }),
        test::SmallestPValue);
    // Cones whose edge is a cell boundary of the test.
    EXPECT_GT(
        test::chiSquareSphere([](Sampler& s) { return std::optional(warp::squareToCosineCone(s.next2D(), 0.5f)); },
                              [](const Vec3f& v) { return double(warp::squareToCosineConePdf(v, 0.5f)); }),
        test::SmallestPValue);
    EXPECT_GT(
        test::chiSquareSphere([](Sampler& s) { return std::optional(warp::squareToCone(s.next2D(), 0.5f)); },
                              [](const Vec3f& v) { return v.z >= 0.5f ? double(warp::squareToConePdf(0.5f)) : 0.0; }),
        test::SmallestPValue);
}

TEST(Warp, DiskRadiusAndTriangleCoordinatesAreUniform) {
    EXPECT_GT(test::chiSquareUniform([](Sampler& s) { return double(warp::squareToDisk(s.next2D()).length2()); }),
              test::SmallestPValue);
    // On a uniform triangle, 1 - (1 - b)^2 of either barycentric coordinate is uniform.
    EXPECT_GT(test::chiSquareUniform([](Sampler& s) {
                  const double b = double(warp::squareToTriangle(s.next2D()).x);
                  return 1.0 - (1.0 - b) * (1.0 - b);
              }),
              test::SmallestPValue);
}

TEST(Distribution, SamplesProportionallyAndSkipsZeros) {
    const Distribution1D distribution({0.0f, 3.0f, 0.0f, 1.0f, 0.0f});
    EXPECT_EQ(distribution.sample(0.0f).index, 1u);
    EXPECT_EQ(distribution.sample(0.7499f).index, 1u);
    EXPECT_EQ(distribution.sample(0.7501f).index, 3u);
    EXPECT_EQ(distribution.sample(0x1.fffffep-1f).index, 3u);
    EXPECT_FLOAT_EQ(distribution.sample(0.375f).remapped, 0.5f);
    EXPECT_FLOAT_EQ(distribution.probability(1), 0.75f);
    EXPECT_DOUBLE_EQ(distribution.total(), 4.0);
    EXPECT_FLOAT_EQ(Distribution1D({0.0f, 0.0f}).probability(1), 0.5f);
}

TEST(Distribution, TwoDimensionalDensityMatchesSamples) {
    const std::vector<float> weights{1, 2, 3, 4, 5, 6};
    const Distribution2D distribution(weights, 3, 2);
    std::vector<double> observed(6, 0.0), expected(6, 0.0);
    constexpr int Count = 60000;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler sampler(1, RandomStream::Test, 0, i);
        float pdf = 0.0f;
        const Vec2f p = distribution.sample(sampler.next2D(), pdf);
        EXPECT_FLOAT_EQ(pdf, distribution.pdf(p));
        observed[size_t(p.y * 2.0f) * 3 + size_t(p.x * 3.0f)] += 1.0;
    }
    for (size_t i = 0; i < 6; ++i) expected[i] = double(weights[i]) / 21.0 * Count;
    EXPECT_GT(test::chiSquarePValue(observed, expected), test::SmallestPValue);
}

TEST(Transform, LookAtAndUpGiveARightHandedFrame) {
    TransformRecipe recipe;
    recipe.position = Vec3f(1, 2, 3);
    recipe.hasZ = recipe.hasY = true;
    recipe.zAxis = Vec3f(0, 0, -5);
    recipe.yAxis = Vec3f(0, 1, 0.1f);
    const Transform t = composeTransform(recipe);
    test::expectNear(t.z, Vec3f(0, 0, -1));
    test::expectNear(t.y, Vec3f(0, 1, 0));
    test::expectNear(t.x, t.y.cross(t.z));
    test::expectNear(t.translation, Vec3f(1, 2, 3));
}

TEST(Transform, ExplicitAxesAreKeptInTheirOrder) {
    TransformRecipe recipe;
    recipe.hasX = recipe.hasZ = true;
    recipe.xAxis = Vec3f(1, 0, 1);
    recipe.zAxis = Vec3f(0, 0, 1);
    const Transform t = composeTransform(recipe); // x and z given: z is kept, x orthogonalised
    test::expectNear(t.z, Vec3f(0, 0, 1));
    test::expectNear(t.x, Vec3f(1, 0, 0));
    EXPECT_GT(t.determinant(), 0.99f);
    TransformRecipe parallel;
    parallel.hasZ = parallel.hasY = true;
    parallel.zAxis = parallel.yAxis = Vec3f(0, 1, 0);
    EXPECT_NEAR(composeTransform(parallel).determinant(), 1.0f, 1e-5f);
}

TEST(Transform, RotatesAboutNegatedYThenXThenZ) {
    TransformRecipe recipe;
    recipe.scale = Vec3f(2, 1, 1);
    recipe.rotationDegrees = Vec3f(0, 90, 0);
    test::expectNear(composeTransform(recipe).x, Vec3f(0, 0, 2)); // -90 degrees about y takes x to +z
    recipe.rotationDegrees = Vec3f(90, 0, 90);
    // z first (x -> y), then x (y -> z).
    test::expectNear(composeTransform(recipe).x, Vec3f(0, 0, 2));
}

TEST(Errors, NamesNearEnough) {
    EXPECT_EQ(nearestName("homogenous", {"homogeneous", "voxel"}), "homogeneous");
    EXPECT_EQ(nearestName("xyzzy", {"homogeneous", "voxel"}), "");
    EXPECT_EQ(nearestName("heterogeneous", {"homogeneous", "guided_homo"}), "") << "the opposite";
    for (const char* metal : {"TiN", "Ti", "W", "K", "Fe", "Zn"})
        EXPECT_EQ(nearestName(metal, {"Ag", "Al", "Au", "Cr", "Cu", "Li", "VN"}), "") << metal;
    EXPECT_EQ(nearestName("cu", {"Ag", "Al", "Au", "Cr", "Cu", "Li", "VN"}), "Cu");
    EXPECT_EQ(nearestName("fgo", {"gas", "fog"}), "fog") << "neighbours swapped";
    EXPECT_EQ(nearestName("SIGMA_S", {"sigma_a", "sigma_s"}), "sigma_s");
    EXPECT_EQ(nearestName("lamert", {"lambert", "mirror"}), "lambert");
    EXPECT_EQ(nearestName("bidirectional_path_tracer", {"path_tracer", "photon_map"}), "");
    EXPECT_EQ(listOf({"a", "b", "c"}), "a, b or c");
    EXPECT_EQ((Problem{"f.json", "a[0]", "bad"}.text()), "f.json: a[0]: bad");
}

TEST(InsideFolder, IsWhatLiesInItOrBelow) {
    const test::TemporaryFolder temporary;
    const std::filesystem::path folder = temporary.path() / "scene";
    std::filesystem::create_directories(folder);
    for (const char* name : {"a.png", "sub/a.png", "sub/../a.png", "../scene/a.png", "..a.png"})
        EXPECT_TRUE(isInside(folder / name, folder)) << name;
    for (const char* name : {"../a.png", "sub/../../a.png", "../scene2/a.png", "..", "/etc/passwd"})
        EXPECT_FALSE(isInside(folder / name, folder)) << name;
    std::filesystem::create_directory_symlink(temporary.path(), folder / "link");
    EXPECT_FALSE(isInside(folder / "link" / "a.png", folder)) << "links are followed";
    EXPECT_TRUE(isInside("a.png", "")) << "the current folder";
    EXPECT_FALSE(isInside("../a.png", ""));
}

} // namespace
} // namespace tungsten
