// What light paths that aim at lasers find: where their light is scattered first.

#include "path/PathTarget.h"

#include "support/SceneFile.h"

#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <set>

namespace tungsten::path {
namespace {

/// A laser through a sheet, which light passes straight, onto varnish, and from there onto a wall.
std::shared_ptr<const Scene> laserOnVarnish(int maxBounces) {
    const test::SceneFile file(R"({
      "media": [{"name": "dark", "type": "homogeneous", "sigma_a": 0.3, "sigma_s": 0, "speed_of_light": 0.5}],
      "primitives": [{"type": "quad", "bsdf": {"type": "plastic", "albedo": 0.5, "ior": 1.5}, "transform": {"scale": 8}},
                     {"type": "cube", "int_medium": "dark", "bsdf": {"type": "forward"},
                      "transform": {"position": [0, 2.5, 0], "scale": [20, 1, 20]}},
                     {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5},
                      "transform": {"position": [6, 0, 0], "rotation": [0, 0, 90], "scale": 40}},
                     {"type": "collimated", "emission": 3, "emission_time": 7,
                      "transform": {"position": [-3, 4, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}}],
      "camera": {"resolution": 1}, "integrator": {"type": "path_tracer", "max_bounces": )" +
                               std::to_string(maxBounces) + R"(}, "renderer": {}})");
    return loadScene(file.path()).scene;
}

TEST(TargetChoice, LasersBecomeVirtualSourcesWhereTheyAreScattered) {
    constexpr int Count = 4000;
    const auto scene = laserOnVarnish(100);
    const TargetChoice choice(*scene, TargetChoice::Emitters::SingleDirections);
    const float through = std::exp(-0.3f * 1.25f), mirrored = fresnelDielectric(1.0f / 1.5f, 0.8f);
    PathCounters counters;
    int onVarnish = 0;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler sampler(1, RandomStream::Test, 0, i);
        const auto target = choice.sample(0.5f, sampler, {}, counters);
        ASSERT_TRUE(target);
        EXPECT_EQ(target->index, -1);
        EXPECT_EQ(target->mediumScatters, 0);
        const bool first = target->vertex.position().y < 1e-3f;
        onVarnish += first ? 1 : 0;
        // Half of the paths scatter on the varnish. The others are mirrored: to the wall after 10, through the dark
        // once more.
        EXPECT_NEAR(target->power.x, first ? 3.0f * through / 0.5f : 3.0f * through * through * mirrored / 0.5f, 1e-4f);
        EXPECT_EQ(target->interactions, first ? 3 : 6);
        EXPECT_NEAR(target->start, first ? 7.0 + 5.0 + 1.25 : 7.0 + 5.0 + 10.0 + 2.5, 1e-4);
        EXPECT_FALSE(target->vertex.reflects(first ? Vec3f(0, -1, 0) : Vec3f(1, 0, 0)));
    }
    EXPECT_NEAR(double(onVarnish) / Count, 0.5, 4.5 * 0.5 / std::sqrt(double(Count)));
    EXPECT_GT(counters.rays, uint64_t(3 * Count));
}

/// The vertex itself is an interaction of the whole path, which has at least one more.
TEST(TargetChoice, LasersEndWhereNoPathWouldCount) {
    PathCounters counters;
    const auto found = [&](int maxBounces) {
        const auto scene = laserOnVarnish(maxBounces);
        const TargetChoice choice(*scene, TargetChoice::Emitters::SingleDirections);
        int most = 0;
        for (uint64_t i = 0; i < 20; ++i) {
            Sampler sampler(1, RandomStream::Test, 0, i);
            if (const auto target = choice.sample(0.5f, sampler, {}, counters))
                most = std::max(most, target->interactions);
        }
        return most;
    };
    EXPECT_EQ(found(3), 0);
    EXPECT_EQ(found(4), 3);
    EXPECT_EQ(found(6), 3);
    EXPECT_EQ(found(7), 6);
}

TEST(TargetChoice, PointsOfALatticeHaveOneSetOfOthers) {
    constexpr size_t Points = TargetChoice::Points;
    const auto setOf = [](const Vec2f& u) {
        std::set<std::pair<float, float>> set;
        for (size_t k = 0; k < Points; ++k) {
            const Vec2f other = TargetChoice::otherPoint(u, k);
            EXPECT_TRUE(other.x >= 0.0f && other.x < 1.0f && other.y >= 0.0f && other.y < 1.0f) << other.x << other.y;
            set.insert({other.x, other.y});
        }
        return set;
    };
    Sampler sampler(1, RandomStream::Test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec2f u = i == 0 ? Vec2f(0.0f) : sampler.next2D();
        EXPECT_EQ(TargetChoice::otherPoint(u, 0), u);
        const auto set = setOf(u);
        ASSERT_EQ(set.size(), Points);
        for (size_t k = 1; k < Points; ++k) ASSERT_EQ(setOf(TargetChoice::otherPoint(u, k)), set);
    }
}

} // namespace
} // namespace tungsten::path
