// Reflected light: what its vertices bring, and that paths that use it find as much light as paths that do not.

#include "path/techniques/GlossyLightVertices.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

/// A corner of two glossy walls and a matt one, in thick fog or thin.
std::string corner(const std::string& light, bool thick = true) {
    const std::string fog =
        thick ? R"("sigma_a": 0.1, "sigma_s": [0.4, 0.5, 0.6])" : R"("sigma_a": 0, "sigma_s": 0.01)";
    return R"({"media": [{"name": "fog", "type": "homogeneous", )" + fog +
           R"(, "phase_function": {"type": "henyey_greenstein", "g": 0.3}}],
     "bsdfs": [{"name": "metal", "type": "rough_conductor", "material": "Au", "distribution": "ggx", "roughness": 0.35},
               {"name": "grey", "type": "lambert", "albedo": 0.6}],
     "primitives": [{"type": "quad", "bsdf": "metal", "int_medium": "fog", "ext_medium": "fog",
                     "transform": {"scale": [9, 1, 9]}},
                    {"type": "quad", "bsdf": "metal", "int_medium": "fog", "ext_medium": "fog",
                     "transform": {"position": [-1.2, 1, 0], "rotation": [0, 0, -90], "scale": [9, 1, 9]}},
                    {"type": "quad", "bsdf": "grey", "int_medium": "fog", "ext_medium": "fog",
                     "transform": {"position": [0, 1, -1.2], "rotation": [90, 0, 0], "scale": [9, 1, 9]}}, )" +
           light + R"(],
     "camera": {"type": "pinhole", "fov": 50, "resolution": [8, 8], "reconstruction_filter": "box", "medium": "fog",
                "transform": {"position": [1.5, 1.3, 2], "look_at": [-0.3, 0.5, -0.3], "up": [0, 1, 0]}},
     "integrator": {"type": "path_tracer", "max_bounces": 4, "transient_time_center": 5.5, "transient_time_width": 3}})";
}
const std::string Point = R"({"type": "point", "emission": 3, "transform": {"position": [0.3, 0.9, 0.2]}})";
const std::string Ball = R"({"type": "sphere", "bsdf": {"type": "null"}, "emission": 20, "ext_medium": "fog",
                             "transform": {"position": [0.3, 0.9, 0.2], "scale": 0.15}})";

struct Estimate {
    double mean = 0.0, error = 0.0;
};
/// Of the image's mean, its error from the spread of runs.
Estimate estimate(const std::string& scene, const std::vector<std::string>& overrides, uint32_t samples) {
    constexpr int Runs = 24;
    double sum = 0.0, squares = 0.0;
    for (uint64_t run = 0; run < Runs; ++run) {
        RenderOptions options;
        options.overrides = overrides;
        options.passes = 4;
        options.samplesPerPass = samples / 4;
        options.seed = 100 + run;
        const double mean = renderPaths(scene, options)->mean();
        sum += mean / Runs;
        squares += mean * mean / Runs;
    }
    return {sum, std::sqrt(std::max(squares - sum * sum, 0.0) / (Runs - 1))};
}

/// Means of two values over light paths, which are the integrals of value x density over glossy points and ends.
template <typename Values>
std::array<Estimate, 2> overPaths(const Scene& scene, const Values& values) {
    constexpr uint32_t Passes = 40, Paths = 100000;
    std::array<double, 2> sum{}, squares{};
    path::GlossyVertexCache cache;
    for (uint32_t pass = 0; pass < Passes; ++pass) {
        cache.trace(scene, scene.emitters[0], {}, Paths, {.index = pass, .seed = 3}, {0.8f});
        std::array<double, 2> mean{};
        for (const path::GlossyLightVertex& vertex : cache.vertices()) {
            const std::array<double, 2> found = values(vertex);
            for (size_t k = 0; k < 2; ++k) mean[k] += found[k] / Paths;
        }
        for (size_t k = 0; k < 2; ++k) {
            sum[k] += mean[k] / Passes;
            squares[k] += mean[k] * mean[k] / Passes;
        }
    }
    std::array<Estimate, 2> estimates;
    for (size_t k = 0; k < 2; ++k) estimates[k] = {sum[k], std::sqrt((squares[k] - sum[k] * sum[k]) / (Passes - 1))};
    return estimates;
}

TEST(GlossyLightVertices, ItsDensityIsThatOfWhereItGoes) {
    const SceneFile file(corner(Point));
    const auto scene = loadScene(file.path()).scene;
    // Light mirrored by the floor near `glossy` meets the left wall near `wall` and passes `fog`.
    const Vec3f glossy(-0.3f, 0.0f, 0.0f), wall(-1.2f, 1.35f, -0.3f), fog(-0.6f, 0.45f, -0.1f);
    const double disk = M_PI * 0.3 * 0.3;
    const auto inside = [&](const path::GlossyLightVertex& vertex, const Vec3f& centre, float radius) {
        return (vertex.glossy.vertex.position() - glossy).length() < 0.3f &&
               (vertex.position() - centre).length() < radius;
    };
    const auto [areas, volumes] = overPaths(*scene, [&](const path::GlossyLightVertex& vertex) {
        const bool found = vertex.surface ? inside(vertex, wall, 0.4f) : inside(vertex, fog, 0.25f);
        const double value = found ? 1.0 / double(vertex.density) : 0.0;
        return vertex.surface ? std::array{value, 0.0} : std::array{0.0, value};
    });
    EXPECT_NEAR(areas.mean, disk * M_PI * 0.4 * 0.4, 4.5 * areas.error);
    EXPECT_LT(areas.error, 0.02 * areas.mean) << "the test would not see a wrong density";
    EXPECT_NEAR(volumes.mean, disk * 4.0 / 3.0 * M_PI * std::pow(0.25, 3), 4.5 * volumes.error);
    EXPECT_LT(volumes.error, 0.04 * volumes.mean) << "the test would not see a wrong density";
}

struct CornerCase {
    const char* name;
    std::string light;
    bool thick;
};

class WithReflectedLight : public testing::TestWithParam<CornerCase> {};

TEST_P(WithReflectedLight, MeansAreAsWithout) {
    const CornerCase& room = GetParam();
    // Three vertices are the fewest that reflected light takes part in.
    const std::vector<std::string> limits{"integrator.min_bounces=3", "integrator.max_bounces=4"};
    std::vector<std::string> with = limits, without = limits;
    with.push_back(R"(integrator.darts={"plain_share": 0})");
    without.push_back(R"(integrator.darts={"plain_share": 0, "surface_connections": false})");
    const std::string scene = corner(room.light, room.thick);
    const Estimate a = estimate(scene, with, 240), b = estimate(scene, without, 440);
    const double error = std::hypot(a.error, b.error);
    EXPECT_NEAR(a.mean, b.mean, 4.5 * error);
    EXPECT_LT(error, 0.016 * b.mean) << "the test would not see a wrong weight";
}

INSTANTIATE_TEST_SUITE_P(Corners, WithReflectedLight,
                         testing::Values(CornerCase{"Point", Point, true}, CornerCase{"BallThinFog", Ball, false}),
                         [](const auto& instance) { return instance.param.name; });

} // namespace
} // namespace tungsten::test
