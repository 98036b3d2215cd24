#include "tungsten/geometry/Mesh.h"

#include "support/ExpectNear.h"
#include "support/Turned.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::expectNear;
using test::turned;

/// Vertex positions as a function of uv must be affine on each face: the uv of a point inside.
Vec2f uvAt(const TriangleMesh& mesh, const Vec3f& point) {
    for (const Triangle& triangle : mesh.triangles) {
        const Vec3f p0 = mesh.positions[triangle.v[0]], e1 = mesh.positions[triangle.v[1]] - p0,
                    e2 = mesh.positions[triangle.v[2]] - p0, d = point - p0, n = e1.cross(e2);
        const float b1 = d.cross(e2).dot(n) / n.length2(), b2 = e1.cross(d).dot(n) / n.length2();
        if (std::abs(d.dot(n)) > 1e-5f || b1 < -1e-4f || b2 < -1e-4f || b1 + b2 > 1.0001f) continue;
        return mesh.uvs[triangle.v[0]] * (1 - b1 - b2) + mesh.uvs[triangle.v[1]] * b1 + mesh.uvs[triangle.v[2]] * b2;
    }
    ADD_FAILURE() << "no face holds " << point;
    return {};
}

TEST(Quad, LooksUpWithUvAlongXAndZ) {
    const TriangleMesh quad = makeQuad(Transform{});
    ASSERT_EQ(quad.triangles.size(), 2u);
    for (uint32_t i = 0; i < 2; ++i) {
        expectNear(quad.faceNormal(i), {0, 1, 0});
        EXPECT_FLOAT_EQ(quad.faceArea(i), 0.5f);
    }
    const Vec2f uv = uvAt(quad, {0.1f, 0, -0.3f});
    EXPECT_NEAR(uv.x, 0.6f, 1e-6f);
    EXPECT_NEAR(uv.y, 0.2f, 1e-6f);
}

TEST(Quad, NormalIsZCrossXSoAMirrorFlipsIt) {
    for (const Vec3f& scale : {Vec3f(2, 1, 3), Vec3f(-2, 1, 3), Vec3f(2, 1, -3), Vec3f(-2, 1, -3), Vec3f(2, -1, 3)}) {
        const Transform transform = turned({20, 50, -35}, scale, {1, 2, 3});
        const TriangleMesh quad = makeQuad(transform);
        const Vec3f expected = transform.z.cross(transform.x).normalized();
        for (uint32_t i = 0; i < 2; ++i) expectNear(quad.faceNormal(i), expected);
        EXPECT_NEAR(quad.faceArea(0) + quad.faceArea(1), 6.0f, 1e-4f);
    }
}

TEST(Cube, OutwardNormalsAndUvByFollowingAxes) {
    for (const Vec3f& scale : {Vec3f(1, 2, 3), Vec3f(-1, 2, 3), Vec3f(-1, -2, -3)}) {
        const Transform transform = turned({15, 25, 65}, scale, {4, 5, 6});
        const TriangleMesh cube = makeCube(transform);
        ASSERT_EQ(cube.triangles.size(), 12u);
        float area = 0.0f;
        for (uint32_t i = 0; i < 12; ++i) {
            area += cube.faceArea(i);
            const Triangle& t = cube.triangles[i];
            const Vec3f middle = (cube.positions[t.v[0]] + cube.positions[t.v[1]] + cube.positions[t.v[2]]) / 3.0f;
            EXPECT_GT(cube.faceNormal(i).dot(middle - transform.translation), 0.0f);
        }
        EXPECT_NEAR(area, 22.0f, 1e-4f);
    }
    const TriangleMesh cube = makeCube(Transform{});
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-0.5f, 0.5f}) {
            Vec3f point;
            point[axis] = side;
            point[(axis + 1) % 3] = 0.1f;
            point[(axis + 2) % 3] = -0.3f;
            const Vec2f uv = uvAt(cube, point);
            EXPECT_NEAR(uv.x, 0.6f, 1e-6f);
            EXPECT_NEAR(uv.y, 0.2f, 1e-6f);
        }
}

TEST(FaceNormal, DegenerateAndExtremeTriangles) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1e30f, 0, 0}, {0, 1e30f, 0}, {1e-30f, 0, 0}, {0, 1e-30f, 0}};
    mesh.triangles = {{{0, 1, 2}}, {{0, 0, 0}}, {{0, 3, 4}}, {{0, 5, 6}}};
    EXPECT_EQ(mesh.faceNormal(0), Vec3f(0, 1, 0));
    EXPECT_EQ(mesh.faceNormal(1), Vec3f(0, 1, 0));
    EXPECT_EQ(mesh.faceNormal(2), Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.faceNormal(3), Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.faceArea(0), 0.0f);
}

TEST(TransformMesh, NormalsTakeTheInverseSquareScaleOnTheLeft) {
    // Scale (2, 1, 1), then a turn by 90 degrees about z: x -> 2y, y -> -x. Column lengths (2, 1, 1).
    const Transform transform = turned({0, 0, 90}, {2, 1, 1}, {7, 8, 9});
    TriangleMesh mesh;
    mesh.positions = {{1, 2, 3}};
    mesh.normals.assign(2, Vec3f(0.0f));
    mesh.normals[0] = Vec3f(1, 1, 0).normalized();
    transformMesh(mesh, transform);
    expectNear(mesh.positions[0], {7 - 2, 8 + 2, 9 + 3});
    // M n = (-1, 2, 0) / sqrt 2; S^-2 on the left gives (-1/4, 2, 0). (The true normal would be (-1, 1/2, 0).)
    expectNear(mesh.normals[0], Vec3f(-0.25f, 2, 0).normalized());
    EXPECT_EQ(mesh.normals[1], Vec3f(0.0f));
}

TEST(TransformMesh, UniformScalesRotateNormals) {
    const Transform transform = turned({30, 40, 50}, Vec3f(3.0f));
    TriangleMesh mesh;
    mesh.normals = {{0, 0, 1}};
    transformMesh(mesh, transform);
    expectNear(mesh.normals[0], transform.z / 3.0f);
}

TEST(TransformMesh, FlattenedMeshesStayFinite) {
    TriangleMesh mesh;
    mesh.positions = {{1, 2, 3}};
    mesh.normals.assign(1, Vec3f(0, 1, 0));
    mesh.normals.push_back({1, 0, 0});
    Transform flat;
    flat.y = Vec3f(0.0f);
    transformMesh(mesh, flat);
    for (const Vec3f& n : mesh.normals) EXPECT_TRUE(std::isfinite(n.x + n.y + n.z));
}

/// A strip of two faces sharing the edge on the x axis: the first in the xz plane (area 2a), the second tilted by
/// `degrees`.
TriangleMesh roof(float degrees, bool welded) {
    const float angle = degrees * Pi / 180.0f;
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 2}, {0, std::sin(angle), -std::cos(angle)}};
    mesh.triangles = {{{0, 2, 1}}, {{0, 1, 3}}};
    if (!welded) {
        mesh.positions.push_back({0, -0.0f, 0});
        mesh.positions.push_back({1, 0, 0});
        mesh.triangles[1] = {{4, 5, 3}};
    }
    mesh.uvs.assign(mesh.positions.size(), Vec2f(0.25f, 0.75f));
    mesh.materials = {1, 2};
    return mesh;
}

TEST(RecomputeNormals, ShallowEdgesAverageByArea) {
    for (const bool welded : {true, false}) { // duplicates at the same position (and -0) are averaged all the same
        TriangleMesh mesh = roof(20.0f, welded);
        const size_t vertices = mesh.positions.size();
        const Vec3f first = mesh.faceNormal(0), second = mesh.faceNormal(1);
        recomputeNormals(mesh);
        EXPECT_EQ(mesh.positions.size(), vertices);
        const Vec3f shared = (first * 2.0f + second * 1.0f).normalized(); // cross products of lengths 2 and 1
        expectNear(mesh.normals[0], shared);
        expectNear(mesh.normals[1], shared);
        expectNear(mesh.normals[2], first);
        expectNear(mesh.normals[3], second);
        if (!welded) expectNear(mesh.normals[4], shared);
    }
}

TEST(RecomputeNormals, CreasesBeyond27DegreesAreSplit) {
    TriangleMesh mesh = roof(30.0f, true);
    const Vec3f first = mesh.faceNormal(0), second = mesh.faceNormal(1);
    recomputeNormals(mesh);
    ASSERT_EQ(mesh.positions.size(), 6u); // private copies of both edge vertices
    EXPECT_EQ(mesh.uvs.size(), 6u);
    EXPECT_EQ(mesh.normals.size(), 6u);
    EXPECT_GT(mesh.positions.capacity(), mesh.positions.size());
    for (const uint32_t v : mesh.triangles[0].v) expectNear(mesh.normals[v], first);
    for (const uint32_t v : mesh.triangles[1].v) expectNear(mesh.normals[v], second);
    EXPECT_EQ(mesh.uvs[5], Vec2f(0.25f, 0.75f));
    TriangleMesh below = roof(26.9f, true), above = roof(27.1f, true);
    recomputeNormals(below);
    recomputeNormals(above);
    EXPECT_EQ(below.positions.size(), 4u);
    EXPECT_EQ(above.positions.size(), 6u);
}

TEST(RecomputeNormals, CopiesKeepTheFlatNormal) {
    // Faces about one vertex, tilted about x by 0, 40 and 20 degrees: the 40 degree one gets a copy, which stays flat
    // although the 20 degree one is near; the original vertex averages 0 and 20 degrees.
    TriangleMesh mesh;
    mesh.positions.push_back({0, 0, 0});
    for (const float degrees : {0.0f, 40.0f, 20.0f}) {
        const float angle = degrees * Pi / 180.0f;
        const auto first = uint32_t(mesh.positions.size());
        mesh.positions.push_back({0.0f, std::sin(angle), std::cos(angle)});
        mesh.positions.push_back({1.0f, 0.0f, 0.0f});
        mesh.triangles.push_back({{0, first, first + 1}});
    }
    // Keep the far corners apart, so that only vertex 0 is shared.
    for (size_t i = 2; i < mesh.positions.size(); i += 2) mesh.positions[i].x += 0.001f * float(i);
    const Vec3f flat0 = mesh.faceNormal(0), flat40 = mesh.faceNormal(1), flat20 = mesh.faceNormal(2);
    recomputeNormals(mesh);
    expectNear(mesh.normals[mesh.triangles[1].v[0]], flat40);
    expectNear(mesh.normals[0], (flat0 * 1.002f + flat20 * 1.006f).normalized());
    EXPECT_EQ(mesh.triangles[2].v[0], 0u);
}

TEST(RecomputeNormals, WeldedCubeBecomesFlat) {
    TriangleMesh cube = makeCube(Transform{});
    // Weld: eight corners by sign.
    TriangleMesh welded;
    for (int i = 0; i < 8; ++i)
        welded.positions.push_back({i & 1 ? .5f : -.5f, i & 2 ? .5f : -.5f, i & 4 ? .5f : -.5f});
    for (const Triangle& t : cube.triangles) {
        Triangle w{};
        for (int k = 0; k < 3; ++k) {
            const Vec3f& p = cube.positions[t.v[k]];
            w.v[k] = uint32_t((p.x > 0) | ((p.y > 0) << 1) | ((p.z > 0) << 2));
        }
        welded.triangles.push_back(w);
    }
    recomputeNormals(welded);
    for (uint32_t i = 0; i < 12; ++i)
        for (const uint32_t v : welded.triangles[i].v) expectNear(welded.normals[v], welded.faceNormal(i));
}

TEST(RecomputeNormals, DegenerateFacesCountAsUp) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
    mesh.triangles = {{{0, 1, 2}}};
    recomputeNormals(mesh);
    for (int v = 0; v < 3; ++v) EXPECT_EQ(mesh.normals[size_t(v)], Vec3f(0, 1, 0));
    EXPECT_EQ(mesh.normals[3], Vec3f(0.0f)); // belongs to no face
}

TEST(DropUnused, KeepsNormalsOfSmoothMeshesOnly) {
    TriangleMesh mesh;
    mesh.normals = {{0, 0, 1}};
    mesh.smooth = true;
    dropUnused(mesh);
    EXPECT_EQ(mesh.normals.size(), 1u);
    mesh.smooth = false;
    dropUnused(mesh);
    EXPECT_EQ(mesh.normals.capacity(), 0u);
}

} // namespace
} // namespace tungsten
