// Rays that leave a surface do not meet it again, rays that end on it are not stopped by it, and the margins that this
// takes depend on the point alone.

#include "geometry/test_scene.h"

#include <functional>

namespace tungsten {
namespace {

using test::randomDirection;
using Draw = std::function<Shape(Sampler&)>;

/// 10^x, x uniform in [low, high].
float randomScale(Sampler& random, float low, float high) {
    return std::pow(10.0f, low + (high - low) * random.next1D());
}

/// A triangle whose two edges differ in length by up to 10^4, at a random angle and place.
Shape anyTriangle(Sampler& random) {
    const Vec3f place = randomDirection(random) * randomScale(random, -3.0f, 4.0f);
    const float size = randomScale(random, -2.0f, 4.0f);
    TriangleMesh mesh;
    mesh.positions = {place, place + randomDirection(random) * size,
                      place + randomDirection(random) * (size * randomScale(random, -2.0f, 0.0f))};
    mesh.triangles = {{{0, 1, 2}}};
    return mesh;
}

Shape anySphere(Sampler& random) {
    return Sphere{randomDirection(random) * randomScale(random, -3.0f, 5.0f), randomScale(random, -2.0f, 5.0f), {}};
}

Shape anyDisk(Sampler& random) {
    return Disk{randomDirection(random) * randomScale(random, -3.0f, 4.0f), randomScale(random, -2.0f, 4.0f),
                Frame(randomDirection(random))};
}

/// A direction on the side of `normal`, from straight up to grazing.
Vec3f leaving(const Vec3f& normal, Sampler& random) {
    const float cosine = randomScale(random, -3.0f, 0.0f), phi = 2.0f * Pi * random.next1D();
    const float sine = std::sqrt(1.0f - cosine * cosine);
    return Frame(normal).toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine}).normalized();
}

/// A ray from somewhere around to a point of the shape, as far away as it is large, or ten times.
Ray rayTo(const SurfaceSample& point, float size, Sampler& random) {
    const Vec3f origin = point.position + randomDirection(random) * (size * randomScale(random, 0.0f, 1.0f));
    const Vec3f offset = point.position - origin;
    return {origin, offset.normalized(), 0.0f, offset.length()};
}

struct Failures {
    int left = 0, arrived = 0, tests = 0;
};

/// Rays that left a shape from before it and met it, and rays that were stopped short of a point on it.
Failures failuresOf(const Draw& draw) {
    Failures failures;
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler random(3, RandomStream::Test, 0, i);
        const Shape shape = draw(random);
        const SceneGeometry geometry({&shape});
        const AreaSampler sampler(shape);
        const float size = std::sqrt(sampler.area());
        for (int k = 0; k < 8; ++k) {
            const SurfaceSample point = sampler.sample(shape, random.next2D());
            Ray ray = rayTo(point, size, random);
            const bool front = ray.direction.dot(point.normal) < 0.0f;
            const bool closed = std::holds_alternative<Sphere>(shape);
            if (front || !closed) {
                Ray connection = ray;
                connection.tMax = point.margin().before(ray.direction, ray.tMax);
                failures.arrived += geometry.occluded(connection);
            }
            ray.tMax = Infinity;
            const auto hit = geometry.intersect(ray);
            if (!hit) continue; // an edge
            ++failures.tests;
            const Vec3f side = closed || front ? hit->ng : -hit->ng;
            failures.left += geometry.occluded(hit->spawnRay(leaving(side, random)));
            failures.left += geometry.occluded(point.spawnRay(leaving(closed ? point.normal : side, random)));
        }
    }
    return failures;
}

TEST(SurfaceMargin, RaysAreClearOfTheSurfaceTheyStartAndEndOn) {
    for (const auto& [name, draw] :
         {std::pair{"triangle", Draw(anyTriangle)}, {"sphere", Draw(anySphere)}, {"disk", Draw(anyDisk)}}) {
        const Failures failures = failuresOf(draw);
        EXPECT_GT(failures.tests, 10000) << name;
        EXPECT_EQ(failures.left, 0) << name << " of " << failures.tests;
        EXPECT_EQ(failures.arrived, 0) << name << " of " << failures.tests;
    }
}

TriangleMesh quadOf(float size, float height) {
    Transform transform;
    transform.x = {size, 0, 0};
    transform.z = {0, 0, size};
    transform.translation = {0, height, 0};
    return makeQuad(transform);
}

float marginBelow(float size, float height, const Vec3f& origin) {
    const Shape ground = quadOf(size, height);
    return SceneGeometry({&ground}).intersect({origin, {0, -1, 0}})->margin().beyond({0.6f, 0.8f, 0.0f});
}

TEST(SurfaceMargin, IsTheSameOnASmallAndAVastGround) {
    for (const float height : {0.0f, 0.3f}) {
        const float small = marginBelow(4.0f, height, {0.4f, 1.0f, 0.2f});
        EXPECT_EQ(marginBelow(40000.0f, height, {0.4f, 1.0f, 0.2f}), small);
        EXPECT_LT(small, 1e-6f);
    }
    // Far from the origin it is a few steps of the coordinates, which are 1e-3 apart.
    EXPECT_LT(marginBelow(3e4f, 1e4f, {1e4f, 1e4f + 1.0f, 0.0f}), 5e-3f);
}

/// An inner wall is met from a point on the surface that is a few margins away.
TEST(SurfaceMargin, WhatIsCloseByIsMet) {
    const Shape ground = quadOf(4e4f, 0.25f), above = quadOf(0.5f, 0.25001f);
    const SceneGeometry geometry({&ground, &above});
    const auto hit = geometry.intersect({{0.1f, 0.0f, 0.05f}, {0, 1, 0}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->shape, 0u);
    EXPECT_TRUE(geometry.occluded(hit->spawnRay({0.0f, 1.0f, 0.0f})));
    EXPECT_TRUE(geometry.occluded(hit->spawnRay(Vec3f(0.99f, 0.1f, 0.0f).normalized())));
}

TriangleMesh quadAt(const Vec3f& place, const Vec3f& degrees) {
    TransformRecipe recipe;
    recipe.scale = Vec3f(2.0f);
    recipe.rotationDegrees = degrees;
    recipe.position = place;
    return makeQuad(composeTransform(recipe));
}

/// Six quads about the point (c, c, c).
std::vector<Shape> roomOfQuads(float c) {
    return {quadAt({c, c - 1, c}, {0, 0, 0}),   quadAt({c, c + 1, c}, {180, 0, 0}), quadAt({c, c, c - 1}, {90, 0, 0}),
            quadAt({c, c, c + 1}, {-90, 0, 0}), quadAt({c - 1, c, c}, {0, 0, -90}), quadAt({c + 1, c, c}, {0, 0, 90})};
}

std::vector<Shape> roomOfACube(const Vec3f& degrees, float c) {
    TransformRecipe recipe;
    recipe.scale = Vec3f(2.0f);
    recipe.rotationDegrees = degrees;
    recipe.position = Vec3f(c);
    return {makeCube(composeTransform(recipe))};
}

/// Of diffuse walks from the middle, those that get out of a closed room by its edges.
int walksThatGetOut(const std::vector<Shape>& walls, float c, int walks, int bounces) {
    const test::TestScene room(walls);
    int out = 0;
    for (int walk = 0; walk < walks; ++walk) {
        Sampler random(7, RandomStream::Test, 0, uint64_t(walk));
        Ray ray{Vec3f(c), randomDirection(random)};
        for (int bounce = 0; bounce < bounces; ++bounce) {
            const auto hit = room.geometry.intersect(ray);
            if (!hit) {
                ++out;
                break;
            }
            const Vec3f normal = hit->ng.dot(ray.direction) > 0.0f ? -hit->ng : hit->ng;
            ray = hit->spawnRay(Frame(normal).toWorld(warp::squareToCosineHemisphere(random.next2D())));
        }
    }
    return out;
}

/// Points on edges were beyond the neighbouring wall by rounding, and margins along grazing rays skipped it: of 10^6
/// meetings each 6 in the room away from the origin let light out.
TEST(SurfaceMargin, ClosedRoomsKeepWhatIsInThem) {
    constexpr int Walks = 100, Bounces = 10000;
    EXPECT_EQ(walksThatGetOut(roomOfQuads(0.0f), 0.0f, Walks, Bounces), 0);
    EXPECT_EQ(walksThatGetOut(roomOfQuads(100.0f), 100.0f, Walks, Bounces), 0);
    EXPECT_EQ(walksThatGetOut(roomOfACube({33, 0, 21}, 0.0f), 0.0f, Walks, Bounces), 0);
    EXPECT_EQ(walksThatGetOut(roomOfACube({33, 0, 21}, 1000.0f), 1000.0f, Walks, Bounces), 0);
}

} // namespace
} // namespace tungsten
