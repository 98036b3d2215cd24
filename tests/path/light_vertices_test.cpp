// Light vertices and shell chords: what they sample, against quadrature and their own densities.

#include "path/techniques/LightVertices.h"
#include "path/techniques/ShellChord.h"

#include "support/ChiSquare.h"
#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

/// A Lambert floor of albedo 0.5 at y = 0, 8 x 8, under `light`.
std::shared_ptr<const Scene> floorUnder(const std::string& light) {
    const test::SceneFile file(R"({"primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5},
                                                   "transform": {"scale": [8, 1, 8]}}, )" +
                               light + "]}");
    return loadScene(file.path()).scene;
}
const std::string Point = R"({"type": "point", "emission": 3, "transform": {"position": [0, 1, 0]}})";

/// Light of the point on its way over the floor to `x`, for lengths in [low, high): midpoint rule.
double quadrature(const Vec3d& x, double low, double high) {
    constexpr int Steps = 1500;
    double sum = 0.0;
    for (int i = 0; i < Steps; ++i)
        for (int j = 0; j < Steps; ++j) {
            const Vec3d y(8.0 * (i + 0.5) / Steps - 4.0, 0.0, 8.0 * (j + 0.5) / Steps - 4.0);
            const Vec3d toLight = Vec3d(0.0, 1.0, 0.0) - y, toX = x - y;
            const double r = toLight.length(), d = toX.length();
            if (r + d >= low && r + d < high) sum += 0.5 / M_PI * 3.0 * (1.0 / r) / (r * r) * (toX.y / d) / (d * d);
        }
    return sum * 64.0 / (double(Steps) * Steps);
}

TEST(LightVertices, FindTheLightOfASurfaceInsideALengthRange) {
    const auto scene = floorUnder(Point);
    const Vec3f x(0.75f, 1.5f, 0.3f);
    for (const auto& [low, high] : {std::pair(0.0, 100.0), std::pair(2.8, 2.9), std::pair(4.0, 5.0)}) {
        double sum = 0.0, squares = 0.0;
        constexpr int Caches = 60, Draws = 2000;
        for (uint32_t pass = 0; pass < Caches; ++pass) {
            LightVertexCache cache;
            cache.trace(*scene, scene->emitters[0], {}, 2000, {pass, 0, 1, 5});
            double mean = 0.0;
            for (int i = 0; i < Draws; ++i) {
                Sampler sampler(3, RandomStream::Test, pass, uint64_t(i));
                const auto choice = cache.choose(x, float(low), float(high), sampler.next2D());
                if (!choice.vertex) continue;
                const Vec3f offset = choice.vertex->vertex.position() - x, direction = offset.normalized();
                const double length = double(offset.length() + choice.vertex->distance);
                if (length < low || length >= high) continue;
                mean +=
                    double(choice.vertex->weighedIntensity(-direction).y * choice.weight / offset.length2()) / Draws;
            }
            sum += mean / Caches;
            squares += mean * mean / Caches;
        }
        const double error = std::sqrt((squares - sum * sum) / Caches), expected = quadrature(Vec3d(x), low, high);
        EXPECT_NEAR(sum, expected, 4.5 * error + 1e-3 * expected) << low;
        EXPECT_LT(error, 0.02 * expected) << "the test would not see a wrong value";
    }
}

/// From what the surface was met along.
Vec3f vertexToLight(const LightVertex& vertex) {
    const SurfaceInteraction& surface = *vertex.vertex.surface();
    return surface.frame.toWorld(surface.wi);
}

TEST(LightVertices, TheirDensityIsWhatWalksWeighAgainst) {
    const std::string at = R"("transform": {"position": [0.2, 1, 0.1], "rotation": [180, 0, 0], "scale": 0.6}})";
    const std::vector<std::string> lights{
        Point, R"({"type": "spot", "emission": 3, "cone_angle": 40, "transform": {"position": [0, 1, 0],
                     "look_at": [0.3, 0, 0], "up": [0, 0, 1]}})",
        R"({"type": "disk", "emission": 3, "bsdf": {"type": "null"}, )" + at,
        R"({"type": "quad", "emission": 3, "bsdf": {"type": "null"}, )" + at,
        R"({"type": "sphere", "emission": 3, "bsdf": {"type": "null"}, )" + at};
    for (const std::string& light : lights) {
        const auto scene = floorUnder(light);
        const Emitter& emitter = scene->emitters[0];
        LightVertexCache cache;
        cache.trace(*scene, emitter, {}, 4000, {0, 0, 1, 5});
        int seen = 0;
        for (int i = 0; i < 500; ++i) {
            Sampler sampler(4, RandomStream::Test, 0, uint64_t(i));
            const auto choice = cache.choose({0.5f, 2.0f, 0.5f}, 0.0f, 100.0f, sampler.next2D());
            if (!choice.vertex) continue;
            const LightVertex& vertex = *choice.vertex;
            // The floor is at y = 0, seen from above.
            const Vec3f toLight = vertexToLight(vertex), origin = vertex.vertex.position() + toLight * vertex.distance;
            Vec3f normal = -toLight;
            if (std::holds_alternative<AreaEmitter>(emitter.model))
                normal = light.find("sphere") != std::string::npos ? (origin - Vec3f(0.2f, 1.0f, 0.1f)).normalized()
                                                                   : Vec3f(0.0f, -1.0f, 0.0f);
            const float pdf = pdfEmissionDirection(emitter, {origin, normal, Vec2f(0.0f)}, -toLight);
            EXPECT_NEAR(vertex.areaPdf, pdf * toLight.y / sqr(vertex.distance), 2e-3f * vertex.areaPdf) << light;
            EXPECT_NEAR(vertex.incidence, toLight.y, 1e-5f);
            ++seen;
        }
        EXPECT_GT(seen, 300) << light;
    }
}

TEST(LightVertices, OnlyOpaqueSmoothSurfacesSeenFromTheLightsSide) {
    EXPECT_TRUE(holdsLightVertices(lobe::DiffuseReflection));
    EXPECT_TRUE(holdsLightVertices(lobe::GlossyReflection | lobe::SpecularReflection));
    EXPECT_FALSE(holdsLightVertices(lobe::SpecularReflection));
    EXPECT_FALSE(holdsLightVertices(lobe::GlossyReflection | lobe::GlossyTransmission));
    EXPECT_FALSE(holdsLightVertices(lobe::DiffuseReflection | lobe::Forward));
    const auto scene = floorUnder(Point);
    Sampler sampler(5, RandomStream::Test, 0, 0);
    std::optional<LightVertex> vertex;
    while (!vertex) vertex = traceLightVertex(*scene, scene->emitters[0], {}, sampler);
    EXPECT_GT(vertex->weighedIntensity({0.6f, 0.8f, 0.0f}).y, 0.0f);
    EXPECT_EQ(vertex->weighedIntensity({0.6f, -0.8f, 0.0f}).y, 0.0f);
}

TEST(ShellChord, SamplesItsDensity) {
    const Vec3f toCentre(0.3f, 0.4f, 2.0f), along(0.0f, 0.0f, 1.0f);
    struct Shell {
        double low, high, tMax;
    };
    for (const Shell& shell : {Shell{0.0, 1.0, 100.0}, {0.7, 1.5, 100.0}, {0.2, 1.0, 2.3}, {1.0, 3.0, 100.0}}) {
        const double low = shell.low, high = shell.high, tMax = shell.tMax; // Clang 14 captures no structured binding
        const ShellChord chord(toCentre, along, low, high, tMax);
        ASSERT_FALSE(chord.empty());
        // The distribution from the density, by the midpoint rule.
        constexpr int Steps = 40000;
        const double width = (chord.end() - chord.begin()) / Steps;
        std::vector<double> distribution(Steps + 1, 0.0);
        for (int i = 0; i < Steps; ++i)
            distribution[size_t(i) + 1] =
                distribution[size_t(i)] + width * chord.pdf(chord.begin() + (i + 0.5) * width);
        EXPECT_NEAR(distribution.back(), 1.0, 1e-3) << low;
        const double p = test::chiSquareUniform(
            [&](Sampler& s) {
                const double t = chord.sample(s.nextDouble());
                const double distance = (Vec3d(toCentre) - Vec3d(along) * t).length();
                EXPECT_GE(distance, low - 1e-9);
                EXPECT_LE(distance, high + 1e-9);
                EXPECT_LE(t, tMax);
                const auto i = size_t(std::clamp((t - chord.begin()) / width, 0.0, double(Steps)));
                return std::min(distribution[i], 1.0 - 1e-12);
            },
            20, 20000);
        EXPECT_GT(p, test::SmallestPValue) << low;
    }
    EXPECT_TRUE(ShellChord(toCentre, along, 0.0, 0.4, 100.0).empty());
    EXPECT_EQ(ShellChord(toCentre, along, 0.7, 1.5, 100.0).pdf(2.0), 0.0);
}

TEST(ShellChord, MeetsASphereWhereTheDistanceIsItsRadius) {
    const Vec3f toCentre(0.3f, 0.4f, 2.0f);
    const ShellChord chord(toCentre, {0.0f, 0.0f, 1.0f}, 1.0, 1.0, 2.5);
    std::array<double, 2> t{}, perRadius{}, other{}, unused{};
    ASSERT_EQ(chord.intersect(1.0, t, perRadius), 1); // the second lies beyond tMax
    EXPECT_NEAR(t[0], 2.0 - std::sqrt(0.75), 1e-7);
    constexpr double Step = 1e-5;
    ASSERT_EQ(chord.intersect(1.0 + Step, other, unused), 1);
    EXPECT_NEAR(perRadius[0], std::abs(other[0] - t[0]) / Step, 1e-4);
    EXPECT_EQ(chord.intersect(0.4, t, perRadius), 0);
}

} // namespace
} // namespace tungsten::path
