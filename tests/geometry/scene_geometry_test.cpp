// Hits on spheres and disks against analytic roots, and scenes of many shapes.

#include "geometry/test_scene.h"

namespace tungsten {
namespace {

using test::expectNear;
using test::expectOpenInterval;
using test::randomDirection;
using test::Roots;
using test::TestScene;
using test::turned;

/// Of |o + t d - c| = r, the reference in long double.
std::optional<Roots> sphereRoots(const Sphere& sphere, const Ray& ray) {
    using Real = long double;
    Real a = 0, b = 0, f2 = 0;
    for (int k = 0; k < 3; ++k) {
        const Real d = ray.direction[k], f = Real(ray.origin[k]) - Real(sphere.centre[k]);
        a += d * d;
        b += d * f;
        f2 += f * f;
    }
    const Real discriminant = b * b - a * (f2 - Real(sphere.radius) * Real(sphere.radius));
    if (discriminant < 0) return std::nullopt;
    const Real root = std::sqrt(discriminant);
    return Roots{(-b - root) / a, (-b + root) / a};
}

TEST(SphereHits, MatchTheAnalyticRoots) {
    Sampler random(1, RandomStream::Test, 0, 0);
    for (const Vec3f& centre : {Vec3f(0.0f), Vec3f(1e4f, -2e4f, 3e4f)})
        for (const float radius : {1e-2f, 1.0f, 300.0f}) {
            const TestScene scene({Sphere{centre, radius, Frame{}}});
            const Sphere& sphere = std::get<Sphere>(scene.shapes[0]);
            int hits = 0;
            for (int i = 0; i < 2000; ++i) {
                // Origins inside, near and far; directions at points around the sphere.
                const float distance = radius * (i % 3 == 0 ? 0.9f * random.next1D() : i % 3 == 1 ? 1.5f : 100.0f);
                const Vec3f origin = centre + randomDirection(random) * distance;
                const Vec3f target = centre + randomDirection(random) * (radius * random.next1D() * 1.4f);
                if (target == origin) continue; // far out, floats are coarser than small spheres
                const Ray ray{origin, (target - origin).normalized()};
                const auto roots = sphereRoots(sphere, ray);
                const auto hit = scene.geometry.intersect(ray);
                EXPECT_EQ(scene.geometry.occluded(ray), hit.has_value());
                if (!roots || roots->second <= 0) {
                    EXPECT_FALSE(hit);
                    continue;
                }
                const auto expected = double(roots->first > 0 ? roots->first : roots->second);
                if (!hit) {
                    EXPECT_LT(expected, 1e-30);
                    continue;
                }
                ++hits;
                EXPECT_NEAR(hit->t, expected, 1e-6 * expected + 1e-12 * double(distance));
                expectNear(hit->position, ray.at(hit->t), 4e-7f * (distance + centre.length() + radius));
                EXPECT_NEAR((hit->position - centre).length(), radius, 1e-6f * radius + 2e-7f * centre.length());
                EXPECT_NEAR(hit->ng.length(), 1.0f, 1e-6f);
                EXPECT_EQ(hit->ng, hit->ns);
                if (i % 50 == 0) expectOpenInterval(scene.geometry, ray, hit->t);
            }
            EXPECT_GT(hits, 800);
        }
}

TEST(SphereHits, GrazingRaysFromFarAway) {
    const TestScene scene({Sphere{{0, 0, 0}, 1.0f, Frame{}}});
    for (const float distance : {10.0f, 1000.0f, 30000.0f}) {
        for (const float height : {0.0f, 0.5f, 0.999f, 0.9999f, 0.99999f}) {
            const auto hit = scene.geometry.intersect({{-distance, height, 0}, {1, 0, 0}});
            ASSERT_TRUE(hit) << height;
            EXPECT_NEAR(hit->position.x, -std::sqrt(1.0 - double(height) * double(height)), 1e-6f * distance);
        }
        for (const float height : {1.00001f, 1.0001f, 1.1f})
            EXPECT_FALSE(scene.geometry.intersect({{-distance, height, 0}, {1, 0, 0}})) << height;
    }
}

TEST(SphereHits, UvAndTangentsBelongTogether) {
    const Sphere sphere = makeSphere(turned({10, 20, 30}, Vec3f(2.0f), {4, 5, 6}));
    const TestScene scene({sphere});
    const auto pointAt = [&](double u, double v) { // the parametrisation of the format
        const double phi = 2.0 * M_PI * (u - 0.5), theta = M_PI * v;
        const Vec3d local(std::cos(phi) * std::sin(theta), std::sin(phi) * std::sin(theta), std::cos(theta));
        return Vec3d(sphere.centre) +
               (Vec3d(sphere.frame.s) * local.x + Vec3d(sphere.frame.t) * local.y + Vec3d(sphere.frame.n) * local.z) *
                   double(sphere.radius);
    };
    Sampler random(2, RandomStream::Test, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const auto hit = scene.geometry.intersect({sphere.centre, randomDirection(random)});
        ASSERT_TRUE(hit);
        const double u = hit->uv.x, v = hit->uv.y, step = 1e-5;
        expectNear(Vec3f(pointAt(u, v)), hit->position, 1e-4f);
        const Vec3d dpdu = (pointAt(u + step, v) - pointAt(u - step, v)) / (2 * step);
        const Vec3d dpdv = (pointAt(u, v + step) - pointAt(u, v - step)) / (2 * step);
        const Tangents tangents = scene.geometry.tangents(*hit);
        expectNear(tangents.u, Vec3f(dpdu), 1e-3f);
        expectNear(tangents.v, Vec3f(dpdv), 1e-3f);
    }
    for (const float side : {-1.0f, 1.0f}) { // the poles have tangents too
        const auto hit = scene.geometry.intersect({sphere.centre, sphere.frame.n * side});
        ASSERT_TRUE(hit);
        const Tangents tangents = scene.geometry.tangents(*hit);
        EXPECT_NEAR(tangents.u.cross(tangents.v).length(), 1.0f, 1e-3f);
        EXPECT_NEAR(hit->uv.y, side > 0 ? 0.0f : 1.0f, 1e-3f);
    }
}

TEST(DiskHits, BothSidesRimAndUv) {
    const Disk disk = makeDisk(turned({10, 20, 30}, Vec3f(2.0f), {400, 500, 600}), 90.0f);
    const TestScene scene({disk});
    Sampler random(3, RandomStream::Test, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const float r = 2.2f * random.next1D(), phi = 2.0f * Pi * random.next1D();
        const Vec3f target = disk.centre + disk.frame.toWorld({r * std::cos(phi), r * std::sin(phi), 0});
        const Vec3f origin = target + randomDirection(random) * 5.0f;
        const Ray ray{origin, (target - origin).normalized()};
        const float slant = std::abs(ray.direction.dot(disk.frame.n));
        if (std::abs(r - 2.0f) < 2e-4f / slant || slant < 1e-3f) continue; // the target itself is rounded
        const auto hit = scene.geometry.intersect(ray);
        EXPECT_EQ(hit.has_value(), r < 2.0f) << r;
        EXPECT_EQ(scene.geometry.occluded(ray), r < 2.0f);
        if (!hit) continue;
        EXPECT_NEAR(hit->t, (target - origin).length(), 1e-4f / slant);
        EXPECT_NEAR(disk.frame.n.dot(hit->position - disk.centre), 0.0f, 1e-4f);
        EXPECT_EQ(hit->ng, disk.frame.n);
        EXPECT_NEAR(hit->uv.y, r / 2.0f, 1e-3f / slant);
        const Tangents tangents = scene.geometry.tangents(*hit);
        EXPECT_NEAR(tangents.v.length(), 2.0f, 1e-4f);
        EXPECT_NEAR(tangents.u.length(), 2.0f * Pi * r, 1e-2f / slant);
        if (i % 20 == 0) expectOpenInterval(scene.geometry, ray, hit->t);
    }
    EXPECT_FALSE(scene.geometry.intersect({disk.centre - disk.frame.s * 9.0f, disk.frame.s})); // in the plane
    const TestScene disks({Disk{}});
    const auto centre = disks.geometry.intersect({{0, 0, 1}, {0, 0, -1}});
    ASSERT_TRUE(centre);
    const Tangents tangents = disks.geometry.tangents(*centre);
    EXPECT_GT(tangents.u.cross(tangents.v).length(), 0.5f);
}

TEST(SceneGeometryTest, EmptyScenesHaveNoHitsAndNoBounds) {
    const TestScene scene(std::vector<Shape>{});
    EXPECT_FALSE(scene.geometry.intersect({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_FALSE(scene.geometry.occluded({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(scene.geometry.boundsMin(), Vec3f(0.0f));
    EXPECT_EQ(scene.geometry.boundsMax(), Vec3f(0.0f));
    EXPECT_EQ(TestScene({TriangleMesh{}}).geometry.triangleCount(), 0u);
}

TEST(SceneGeometryTest, BoundsAndTheClosestOfManyShapes) {
    std::vector<Shape> shapes;
    for (int i = 0; i < 30; ++i) {
        const Transform transform = turned(Vec3f(0.0f), Vec3f(1.0f), {0, 0, float(10 * i)});
        if (i % 3 == 0)
            shapes.emplace_back(makeSphere(turned(Vec3f(0.0f), Vec3f(0.5f), {0, 0, float(10 * i)})));
        else if (i % 3 == 1)
            shapes.emplace_back(makeDisk(turned({90, 0, 0}, Vec3f(1.0f), {0, 0, float(10 * i)}), 90.0f));
        else
            shapes.emplace_back(makeCube(transform));
    }
    const TestScene scene(std::move(shapes));
    expectNear(scene.geometry.boundsMin(), {-1, -1, -0.5f}, 1e-3f);
    expectNear(scene.geometry.boundsMax(), {1, 1, 290.5f}, 1e-3f);
    for (int i = 0; i < 30; ++i) {
        const float start = 10.0f * float(i) - 5.0f, reach = i % 3 == 1 ? 5.0f : 4.5f;
        const auto hit = scene.geometry.intersect({{0.05f, 0.02f, start}, {0, 0, 1}});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->shape, uint32_t(i));
        EXPECT_NEAR(hit->t, reach, 0.01f);
        EXPECT_FALSE(scene.geometry.occluded({{0.05f, 0.02f, start}, {0, 0, 1}, 0.0f, reach - 0.02f}));
    }
}

} // namespace
} // namespace tungsten
