#include "tungsten/geometry/Shape.h"

#include "support/Turned.h"

#include "tungsten/core/Random.h"

#include <boost/math/special_functions/gamma.hpp>
#include <gtest/gtest.h>

#include <functional>

namespace tungsten {
namespace {

using test::turned;

/// Probability of a chi-square at least this large when the counts follow `expected` (which sums to the same total).
double chiSquarePValue(const std::vector<double>& counts, const std::vector<double>& expected) {
    double chiSquare = 0.0;
    for (size_t i = 0; i < counts.size(); ++i)
        chiSquare += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    return boost::math::gamma_q(0.5 * double(counts.size() - 1), 0.5 * chiSquare);
}

constexpr int Samples = 200000;

/// Draws points and bins them by `cell` into cells of equal area; checks that they are equally full.
void expectUniform(const Shape& shape, size_t cells, const std::function<size_t(const SurfaceSample&)>& cell) {
    const AreaSampler areaSampler(shape);
    Sampler random(17, RandomStream::Test, 0, 0);
    std::vector<double> counts(cells, 0.0);
    for (int i = 0; i < Samples; ++i) {
        const size_t chosen = cell(areaSampler.sample(shape, random.next2D()));
        ASSERT_LT(chosen, cells);
        counts[chosen] += 1.0;
    }
    EXPECT_GT(chiSquarePValue(counts, std::vector<double>(cells, double(Samples) / double(cells))), 1e-4);
}

size_t gridCell(float x, float y, size_t size) {
    const auto index = [&](float c) { return std::min(size_t(std::max(c, 0.0f) * float(size)), size - 1); };
    return index(x) + size * index(y);
}

TEST(Shapes, SphereRadiusIsTheLargestScale) {
    const Sphere sphere = makeSphere(turned({10, 20, 30}, {1, -3, 2}, {4, 5, 6}));
    EXPECT_NEAR(sphere.radius, 3.0f, 1e-5f);
    EXPECT_EQ(sphere.centre, Vec3f(4, 5, 6));
    EXPECT_NEAR(surfaceArea(Shape(sphere)), 36.0f * Pi, 1e-3f);
}

TEST(Shapes, DiskRadiusIgnoresTheYScale) {
    const Transform transform = turned({10, 20, 30}, {2, 9, 3}, {4, 5, 6});
    const Disk disk = makeDisk(transform, 60.0f);
    EXPECT_NEAR(disk.radius, 3.0f, 1e-5f);
    EXPECT_LT((disk.frame.n - transform.y.normalized()).length(), 1e-6f);
    EXPECT_NEAR(disk.cosConeAngle, 0.5f, 1e-6f);
    EXPECT_EQ(makeDisk(transform, 90.0f).cosConeAngle, 0.0f);
    EXPECT_NEAR(surfaceArea(Shape(disk)), 9.0f * Pi, 1e-3f);
    Transform flat;
    flat.y = Vec3f(0.0f);
    EXPECT_EQ(makeDisk(flat, 90.0f).frame.n, Vec3f(0, 1, 0));
}

TEST(Shapes, MeshAreaIsTheSumOfItsFaces) {
    EXPECT_NEAR(surfaceArea(Shape(makeCube(turned({1, 2, 3}, {1, 2, 3}, {0, 0, 0})))), 22.0f, 1e-4f);
    EXPECT_NEAR(surfaceArea(Shape(makeQuad(turned({1, 2, 3}, {4, 7, 3}, {0, 0, 0})))), 12.0f, 1e-4f);
    EXPECT_EQ(surfaceArea(Shape(TriangleMesh{})), 0.0f);
}

TEST(AreaSampler, UniformOnAQuad) {
    const Transform transform = turned({10, 20, 30}, {2, 1, 5}, {4, 5, 6});
    const Shape quad = makeQuad(transform);
    expectUniform(quad, 64, [&](const SurfaceSample& sample) {
        const Vec3f d = sample.position - transform.translation;
        const float x = d.dot(transform.x) / transform.x.length2() + 0.5f,
                    z = d.dot(transform.z) / transform.z.length2() + 0.5f;
        EXPECT_NEAR(sample.uv.x, x, 1e-5f);
        EXPECT_NEAR(sample.uv.y, z, 1e-5f);
        EXPECT_NEAR(d.dot(transform.y), 0.0f, 1e-5f);
        return gridCell(x, z, 8);
    });
}

TEST(AreaSampler, UniformOnASphere) {
    const Sphere sphere = makeSphere(turned({10, 20, 30}, Vec3f(2.0f), {4, 5, 6}));
    const Shape shape = sphere;
    expectUniform(shape, 64, [&](const SurfaceSample& sample) {
        const Vec3f n = (sample.position - sphere.centre) / sphere.radius;
        EXPECT_NEAR((n - sample.normal).length(), 0.0f, 1e-5f);
        // Equal areas in height and azimuth, about an axis that is not the sphere's own.
        return gridCell(0.5f * (n.x + 1.0f), std::atan2(n.z, n.y) / (2.0f * Pi) + 0.5f, 8);
    });
}

TEST(AreaSampler, UniformOnADisk) {
    const Disk disk = makeDisk(turned({10, 20, 30}, Vec3f(2.0f), {4, 5, 6}), 90.0f);
    const Shape shape = disk;
    expectUniform(shape, 64, [&](const SurfaceSample& sample) {
        const Vec3f d = disk.frame.toLocal(sample.position - disk.centre) / disk.radius;
        EXPECT_NEAR(d.z, 0.0f, 1e-6f);
        EXPECT_NEAR(sample.uv.y, std::hypot(d.x, d.y), 1e-5f);
        return gridCell(d.x * d.x + d.y * d.y, std::atan2(d.y, d.x) / (2.0f * Pi) + 0.5f, 8);
    });
}

TEST(AreaSampler, TrianglesByAreaAndUniformInside) {
    // Triangles in a row whose bases grow, one of them without area; expected counts by exact areas.
    TriangleMesh mesh;
    std::vector<double> expected;
    const float bases[] = {0.5f, 1.0f, 0.0f, 2.0f, 4.5f};
    for (size_t i = 0; i < 5; ++i) {
        const auto first = uint32_t(mesh.positions.size());
        const float z = float(i);
        for (const Vec3f& p : {Vec3f(0, 0, z), Vec3f(bases[i], 0, z), Vec3f(0, 3, z)}) mesh.positions.push_back(p);
        mesh.triangles.push_back({{first, first + 1, first + 2}});
        // Four similar triangles of a quarter each: three at the corners, one in the middle.
        for (int k = 0; k < 4; ++k)
            if (bases[i] > 0.0f) expected.push_back(double(Samples) * double(bases[i]) / 8.0 / 4.0);
    }
    const Shape shape = mesh;
    const AreaSampler areaSampler(shape);
    EXPECT_FLOAT_EQ(areaSampler.area(), 12.0f);
    std::vector<double> counts(expected.size(), 0.0);
    Sampler random(23, RandomStream::Test, 0, 0);
    for (int i = 0; i < Samples; ++i) {
        const Vec3f p = areaSampler.sample(shape, random.next2D()).position;
        const auto triangle = size_t(std::lround(p.z));
        ASSERT_NE(triangle, 2u);
        const float b1 = p.x / bases[triangle], b2 = p.y / 3.0f;
        const size_t part = b1 > 0.5f ? 0 : b2 > 0.5f ? 1 : b1 + b2 < 0.5f ? 2 : 3;
        counts[(triangle < 2 ? triangle : triangle - 1) * 4 + part] += 1.0;
    }
    EXPECT_GT(chiSquarePValue(counts, expected), 1e-4);
}

TEST(AreaSampler, ShapesWithoutAreaGiveFinitePoints) {
    for (const Shape& shape : {Shape(TriangleMesh{}), Shape(makeQuad(turned(Vec3f(0.0f), Vec3f(0.0f), {1, 2, 3})))}) {
        const SurfaceSample sample = AreaSampler(shape).sample(shape, {0.3f, 0.999f});
        EXPECT_TRUE(std::isfinite(sample.position.length() + sample.normal.length()));
    }
}

} // namespace
} // namespace tungsten
