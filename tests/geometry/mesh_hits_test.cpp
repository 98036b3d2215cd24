// Hits on meshes: against slabs, without leaks, with every field.

#include "geometry/test_scene.h"

namespace tungsten {
namespace {

using test::expectNear;
using test::expectOpenInterval;
using test::randomDirection;
using test::Roots;
using test::TestScene;
using test::turned;

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
        const Tangents tangents = scene.geometry.tangents(*hit);
        expectNear(tangents.u, transform.x, 1e-4f);
        expectNear(tangents.v, transform.z, 1e-4f);
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
    const TestScene scene({mesh});
    const auto hit = scene.geometry.intersect(ray);
    ASSERT_TRUE(hit);
    expectNear(hit->ns, Vec3f(0.2f, 0.3f, 0.5f).normalized(), 1e-5f);
    expectNear(hit->ng, {0, 0, 1}, 1e-6f);
    EXPECT_EQ(hit->material, -7);
    EXPECT_EQ(hit->uv, Vec2f(0.0f));
    const Tangents tangents = scene.geometry.tangents(*hit);
    EXPECT_NEAR(tangents.u.cross(tangents.v).dot(hit->ng), 1.0f, 1e-5f); // any frame, without uvs
    mesh.normals.assign(3, Vec3f(0.0f));
    expectNear(TestScene({mesh}).geometry.intersect(ray)->ns, {0, 0, 1}, 1e-6f);
    mesh.normals.clear();
    expectNear(TestScene({mesh}).geometry.intersect(ray)->ns, {0, 0, 1}, 1e-6f);
    mesh = singleTriangle();
    mesh.smooth = false;
    expectNear(TestScene({mesh}).geometry.intersect(ray)->ns, {0, 0, 1}, 1e-6f);
}

TEST(MeshHits, TrianglesHaveMaterialsOfTheirOwn) {
    TriangleMesh mesh;
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(1, 1, 0)}) mesh.positions.push_back(p);
    mesh.triangles = {{{0, 1, 2}}, {{1, 3, 2}}};
    mesh.materials = {3, 5};
    const TestScene scene({mesh});
    EXPECT_EQ(scene.geometry.intersect({{0.2f, 0.3f, 1}, {0, 0, -1}})->material, 3);
    EXPECT_EQ(scene.geometry.intersect({{0.8f, 0.7f, 1}, {0, 0, -1}})->material, 5);
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
        const Tangents tangents = scene.geometry.tangents(*hit);
        for (const Vec3f& v : {hit->position, hit->ng, hit->ns, tangents.u, tangents.v})
            EXPECT_TRUE(std::isfinite(v.length()));
        EXPECT_NEAR(hit->ng.length(), 1.0f, 1e-5f);
    }
    EXPECT_GT(hits, 1000);
}

} // namespace
} // namespace tungsten
