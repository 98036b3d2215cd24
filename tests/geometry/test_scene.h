#pragma once
// Scenes of a few shapes, and what every hit on them keeps.

#include "support/ExpectNear.h"
#include "support/Turned.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"
#include "tungsten/geometry/SceneGeometry.h"

#include <gtest/gtest.h>

namespace tungsten::test {

/// Shapes that stay put, and their Embree scene.
struct TestScene {
    explicit TestScene(std::vector<Shape> given) : shapes(std::move(given)), geometry(pointers()) {}
    std::vector<Shape> shapes;
    SceneGeometry geometry;

  private:
    [[nodiscard]] std::vector<const Shape*> pointers() const {
        std::vector<const Shape*> result;
        for (const Shape& shape : shapes) result.push_back(&shape);
        return result;
    }
};

inline Vec3f randomDirection(Sampler& random) {
    return warp::squareToSphere(random.next2D()).normalized();
}

/// Where a ray enters and leaves.
struct Roots {
    long double first, second;
};

/// The tMin and tMax of a hit are excluded, everything next to them is not.
inline void expectOpenInterval(const SceneGeometry& geometry, Ray ray, float t) {
    ray.tMin = 0.0f;
    ray.tMax = t;
    EXPECT_FALSE(geometry.intersect(ray)) << t;
    EXPECT_FALSE(geometry.occluded(ray)) << t;
    ray.tMax = std::nextafter(t, Infinity);
    ASSERT_TRUE(geometry.intersect(ray)) << t;
    EXPECT_EQ(geometry.intersect(ray)->t, t);
    EXPECT_TRUE(geometry.occluded(ray)) << t;
    ray.tMax = Infinity;
    ray.tMin = t;
    const auto beyond = geometry.intersect(ray);
    EXPECT_TRUE(!beyond || beyond->t > t);
    EXPECT_EQ(geometry.occluded(ray), beyond.has_value());
    ray.tMin = std::nextafter(t, 0.0f);
    ASSERT_TRUE(geometry.intersect(ray)) << t;
    EXPECT_EQ(geometry.intersect(ray)->t, t);
}

} // namespace tungsten::test
