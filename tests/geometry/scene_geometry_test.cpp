#include "tungsten/geometry/SceneGeometry.h"

#include "support/Turned.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::turned;

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

void expectNear(const Vec3f& found, const Vec3f& expected, float tolerance) {
    EXPECT_LT((found - expected).length(), tolerance) << "found " << found << ", expected " << expected;
}

Vec3f randomDirection(Sampler& random) {
    return warp::squareToSphere(random.next2D()).normalized();
}

/// Roots of |o + t d - c| = r, the reference in long double.
struct Roots {
    long double first, second;
};
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

/// The tMin and tMax of a hit are excluded, everything next to them is not.
void expectOpenInterval(const SceneGeometry& geometry, Ray ray, float t) {
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
        expectNear(hit->dpdu, Vec3f(dpdu), 1e-3f);
        expectNear(hit->dpdv, Vec3f(dpdv), 1e-3f);
    }
    for (const float side : {-1.0f, 1.0f}) { // the poles have tangents too
        const auto hit = scene.geometry.intersect({sphere.centre, sphere.frame.n * side});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->dpdu.cross(hit->dpdv).length(), 1.0f, 1e-3f);
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
        EXPECT_NEAR(hit->dpdv.length(), 2.0f, 1e-4f);
        EXPECT_NEAR(hit->dpdu.length(), 2.0f * Pi * r, 1e-2f / slant);
        if (i % 20 == 0) expectOpenInterval(scene.geometry, ray, hit->t);
    }
    EXPECT_FALSE(scene.geometry.intersect({disk.centre - disk.frame.s * 9.0f, disk.frame.s})); // in the plane
    const auto centre = TestScene({Disk{}}).geometry.intersect({{0, 0, 1}, {0, 0, -1}});
    ASSERT_TRUE(centre);
    EXPECT_GT(centre->dpdu.cross(centre->dpdv).length(), 0.5f);
}

/// Entry and exit of the axis-aligned cube of half width h at c.
std::optional<Roots> slabRoots(const Vec3f& centre, float half, const Ray& ray) {
    Roots roots{-INFINITY, INFINITY};
    for (int k = 0; k < 3; ++k) {
        const long double inverse = 1.0L / ray.direction[k], offset = (long double)(centre[k]) - ray.origin[k];
        const long double a = (offset - half) * inverse, b = (offset + half) * inverse;
        roots.first = std::max(roots.first, std::min(a, b));
        roots.second = std::min(roots.second, std::max(a, b));
    }
    if (roots.first > roots.second) return std::nullopt;
    return roots;
}

TEST(MeshHits, CubeMatchesItsSlabs) {
    Sampler random(4, RandomStream::Test, 0, 0);
    for (const Vec3f& centre : {Vec3f(0.0f), Vec3f(4096, -8192, 2048)}) {
        const TestScene scene({makeCube(turned(Vec3f(0.0f), Vec3f(2.0f), centre))});
        for (int i = 0; i < 3000; ++i) {
            const Vec3f origin = centre + randomDirection(random) * (i % 2 ? 0.9f : 20.0f);
            const Vec3f target = centre + randomDirection(random) * (1.9f * random.next1D());
            const Ray ray{origin, (target - origin).normalized()};
            const auto roots = slabRoots(centre, 1.0f, ray);
            const auto hit = scene.geometry.intersect(ray);
            EXPECT_EQ(scene.geometry.occluded(ray), hit.has_value());
            if (roots && roots->second - roots->first < 1e-2) continue; // an edge, within rounding
            ASSERT_EQ(hit.has_value(), roots.has_value());
            if (!hit) continue;
            const double expected = double(roots->first > 0 ? roots->first : roots->second);
            const double slant = std::abs(double(hit->ng.dot(ray.direction)));
            EXPECT_NEAR(hit->t, expected, (1e-5 + 2e-7 * double(centre.length())) / slant);
            const float largest = std::max({std::abs(hit->position.x - centre.x), std::abs(hit->position.y - centre.y),
                                            std::abs(hit->position.z - centre.z)});
            EXPECT_NEAR(largest, 1.0f, 1e-6f + 2e-7f * centre.length());
            EXPECT_GT(hit->ng.dot(hit->position - centre), 0.9f);
            if (i % 50 == 0) expectOpenInterval(scene.geometry, ray, hit->t);
        }
    }
}

TEST(MeshHits, NoRayLeaksThroughEdgesAndCorners) {
    const TestScene scene({makeCube(turned({13, 57, 31}, Vec3f(2.0f), {3, 4, 5}))});
    const auto& cube = std::get<TriangleMesh>(scene.shapes[0]);
    Sampler random(5, RandomStream::Test, 0, 0);
    for (int i = 0; i < 20000; ++i) {
        const Triangle& triangle = cube.triangles[size_t(i) % 12];
        const Vec3f a = cube.positions[triangle.v[0]], b = cube.positions[triangle.v[1 + i % 2]];
        const Vec3f target = i % 3 == 0 ? a : a + (b - a) * random.next1D();
        const Vec3f origin = Vec3f(3, 4, 5) + randomDirection(random) * 0.8f;
        EXPECT_TRUE(scene.geometry.occluded({origin, (target - origin).normalized()}));
    }
}

TEST(MeshHits, QuadFillsEveryField) {
    const Transform transform = turned({10, 20, 30}, {-2, 1, 3}, {4, 5, 6});
    const TestScene scene({TriangleMesh{}, makeQuad(transform)}); // an empty mesh is skipped, indices stay
    const Vec3f normal = transform.z.cross(transform.x).normalized();
    const Vec3f target = transform.point({0.1f, 0, -0.3f});
    for (const float side : {-1.0f, 1.0f}) {
        const auto hit = scene.geometry.intersect({target + normal * (2 * side), normal * -side});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->shape, 1u);
        EXPECT_EQ(hit->material, 0);
        EXPECT_NEAR(hit->t, 2.0f, 1e-5f);
        expectNear(hit->position, target, 1e-5f);
        expectNear(hit->ng, normal, 1e-5f); // not flipped
        expectNear(hit->ns, normal, 1e-5f);
        expectNear(hit->dpdu, transform.x, 1e-4f);
        expectNear(hit->dpdv, transform.z, 1e-4f);
        EXPECT_NEAR(hit->uv.x, 0.6f, 1e-5f);
        EXPECT_NEAR(hit->uv.y, 0.2f, 1e-5f);
    }
    EXPECT_EQ(scene.geometry.triangleCount(), 2u);
}

TriangleMesh singleTriangle() {
    TriangleMesh mesh;
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}) mesh.positions.push_back(p);
    for (const Vec3f& n : {Vec3f(0, 0, 1), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}) mesh.normals.push_back(n);
    mesh.triangles = {{{0, 1, 2}}};
    mesh.materials = {-7};
    mesh.smooth = true;
    return mesh;
}

TEST(MeshHits, SmoothNormalsAreInterpolated) {
    TriangleMesh mesh = singleTriangle();
    const Ray ray{{0.2f, 0.3f, 1}, {0, 0, -1}};
    const auto hit = TestScene({mesh}).geometry.intersect(ray);
    ASSERT_TRUE(hit);
    expectNear(hit->ns, Vec3f(0.2f, 0.3f, 0.5f).normalized(), 1e-5f);
    expectNear(hit->ng, {0, 0, 1}, 1e-6f);
    EXPECT_EQ(hit->material, -7);
    EXPECT_EQ(hit->uv, Vec2f(0.0f));
    EXPECT_NEAR(hit->dpdu.cross(hit->dpdv).dot(hit->ng), 1.0f, 1e-5f); // any frame, without uvs
    mesh.normals.assign(3, Vec3f(0.0f));
    expectNear(TestScene({mesh}).geometry.intersect(ray)->ns, {0, 0, 1}, 1e-6f);
    mesh.normals.clear();
    expectNear(TestScene({mesh}).geometry.intersect(ray)->ns, {0, 0, 1}, 1e-6f);
    mesh = singleTriangle();
    mesh.smooth = false;
    expectNear(TestScene({mesh}).geometry.intersect(ray)->ns, {0, 0, 1}, 1e-6f);
}

TEST(MeshHits, VertexBufferWithoutPaddingIsCopied) {
    TriangleMesh mesh = singleTriangle();
    mesh.positions.shrink_to_fit();
    ASSERT_EQ(mesh.positions.capacity(), mesh.positions.size());
    const TestScene scene({std::move(mesh)});
    EXPECT_TRUE(scene.geometry.intersect({{0.2f, 0.3f, 1}, {0, 0, -1}}));
}

TEST(MeshHits, DegenerateAndInvalidTrianglesNeverGiveNaN) {
    TriangleMesh mesh;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3f& p : {Vec3f(-1, 0, 0), Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(nan, 0, 0),
                           Vec3f(1e-20f, 0, 0), Vec3f(0, 1e-20f, 0)})
        mesh.positions.push_back(p);
    mesh.uvs.assign(mesh.positions.size(), Vec2f(0.5f, 0.5f));
    mesh.triangles = {{{0, 1, 2}}, {{1, 1, 1}}, {{0, 2, 4}}, {{1, 5, 6}}, {{0, 2, 3}}};
    const TestScene scene({mesh, makeQuad(turned(Vec3f(0.0f), {1, 1, 0}, {0, 0, -1})), Sphere{{0, 0, 0}, 0.0f, Frame{}},
                           Disk{{0, 0, 0}, 0.0f, Frame{}, 0.0f}});
    Sampler random(6, RandomStream::Test, 0, 0);
    int hits = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3f target(2 * random.next1D() - 1, i % 2 ? 0.0f : random.next1D(), 0);
        const Vec3f origin = target + randomDirection(random) * 2.0f;
        const auto hit = scene.geometry.intersect({origin, (target - origin).normalized()});
        if (!hit) continue;
        ++hits;
        for (const Vec3f& v : {hit->position, hit->ng, hit->ns, hit->dpdu, hit->dpdv})
            EXPECT_TRUE(std::isfinite(v.length()));
        EXPECT_NEAR(hit->ng.length(), 1.0f, 1e-5f);
    }
    EXPECT_GT(hits, 1000);
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
