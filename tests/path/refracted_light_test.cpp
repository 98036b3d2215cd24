// Paths in bodies sealed by walls that refract: the ways out, the draws against their density, and means against plain
// paths.

#include "path/techniques/RefractedLight.h"

#include "support/PathsAndPhotons.h"

#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <numeric>

namespace tungsten::path {
namespace {

using test::renderPaths;

TEST(RefractedWay, BendsByTheIndexAndEndsWhereItShall) {
    for (const float index : {1.333f, 1.0f, 0.75f, 2.4f})
        for (const float depth : {1e-3f, 0.5f, 20.0f})
            for (const float lateral : {0.0f, 0.3f, 4.0f, 60.0f}) {
                constexpr float Height = 1.5f;
                const auto way = refractedWay(depth, Height, lateral, index);
                ASSERT_TRUE(way);
                const auto sine = [](double cosine) { return std::sqrt(std::max(1.0 - cosine * cosine, 0.0)); };
                const double in = double(way->cosInside), out = double(way->cosOutside);
                const double reached = double(depth) * sine(in) / in + double(Height) * sine(out) / out;
                // Float cosines near 1 tell small angles, and near 0 long ways, to a few digits only.
                EXPECT_NEAR(reached, double(lateral), 2e-3 * (1.0 + double(lateral + depth))) << index << " " << depth;
                EXPECT_NEAR(sine(out), double(index) * sine(in), 2e-3) << index << " " << depth << " " << lateral;
            }
    EXPECT_FALSE(refractedWay(0.0f, 1.0f, 1.0f, 1.5f));
    EXPECT_FALSE(refractedWay(1.0f, -1.0f, 1.0f, 1.5f));
}

TEST(RefractedWay, AreasAreThoseOfTheirSolidAngles) {
    for (const float index : {1.5f, 0.8f})
        for (const double angle : {0.05, 0.3, 0.6}) {
            constexpr double Depth = 0.4, Height = 1.3, Step = 1e-4;
            const auto lateral = [&](double at) {
                return Depth * std::tan(at) + Height * std::tan(std::asin(double(index) * std::sin(at)));
            };
            const double from = angle - Step, to = angle + Step;
            const double area = lateral(to) * lateral(to) - lateral(from) * lateral(from);
            const double solidAngle = 2.0 * (std::cos(from) - std::cos(to));
            const RefractedWay way{float(Depth), float(Height), float(std::cos(angle)),
                                   float(std::sqrt(1.0 - std::pow(double(index) * std::sin(angle), 2)))};
            EXPECT_NEAR(double(way.areaPerSolidAngle(index)), area / solidAngle, 1e-3 * area / solidAngle);
        }
}

/// A body of fog with `extra` primitives about it under lamps, one turned.
std::string sealedScene(const std::string& body, const std::string& extra, const std::string& medium, double centre,
                        double width) {
    std::ostringstream json;
    json << R"({"media": [{"name": "fog", "type": "homogeneous", )" << medium << R"(}], "primitives": [)" << body
         << extra << R"(
        {"type": "quad", "bsdf": {"type": "null"}, "emission": 10,
         "transform": {"position": [0.4, 2, 1.2], "scale": [2, 1, 1.5], "rotation": [200, 0, 10]}}],
        "camera": {"type": "pinhole", "fov": 24, "resolution": 4, "transform": {"position": [0, 0, 4],
                   "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "max_bounces": 64, "transient_time_center": )"
         << centre << R"(, "transient_time_width": )" << width << R"(}, "renderer": {}})";
    return json.str();
}
const std::string Box = R"({"type": "cube", "int_medium": "fog", "bsdf": {"type": "dielectric", "ior": 1.4},
                            "transform": {"rotation": [20, 30, 10], "scale": [1, 1.2, 0.8]}},)";
/// Light goes at another speed in it, and glass is about it.
const std::string Ball = R"({"type": "sphere", "int_medium": "fog", "bsdf": {"type": "dielectric", "ior": 0.9},
                             "transform": {"scale": 0.7}},
                            {"type": "sphere", "bsdf": {"type": "dielectric", "ior": 1.5}, "transform": {"scale": 0.8}},)";
/// A pane before a part of the light, and more lights of other shapes.
const std::string Around = R"({"type": "cube", "bsdf": {"type": "dielectric", "ior": 1.5},
                               "transform": {"position": [0.2, 0, 0.9], "scale": [2, 2, 0.05]}},
                              {"type": "sphere", "bsdf": {"type": "null"}, "emission": 10,
                               "transform": {"position": [-1.5, 1.2, 0.5], "scale": 0.4}},
                              {"type": "disk", "bsdf": {"type": "null"}, "emission": 6,
                               "transform": {"position": [1.8, 0.4, 0.2], "scale": 0.7, "rotation": [0, 0, 70]}},)";
const std::string Even = R"("sigma_s": 8, "sigma_a": 0.1)";
const std::string Forward = R"("sigma_s": [8, 10, 12], "sigma_a": [0.1, 0.2, 0.3], "speed_of_light": 0.75,
                               "phase_function": {"type": "henyey_greenstein", "g": 0.6})";

/// What a flat face lets out: draws leave grazing ways to few of great weight, for they bring nothing.
double letsOut(const transport::Body& body, size_t face, const Vec3f& direction) {
    if (body.sphere) return 1.0;
    return 1.0 - double(fresnelDielectric(1.4f, std::max(direction.dot(body.faces[face].normal), 0.0f)));
}

/// The sum over draws of `weight` by what is let out, in cells of direction, against the integral of the density there.
void expectDrawsAsDense(const std::string& json, const Vec3f& position, double time) {
    const test::SceneFile file(json);
    const LoadedScene loaded = loadScene(file.path());
    const Scene& scene = *loaded.scene;
    const transport::Body body = transport::bodiesOf(scene)[0];
    RefractedLight light;
    light.prepare(scene, {}, {});
    const SealedVertex vertex{position, Vec3f(0.6f, 0.0f, 0.8f), time, scene.primitives[0].inside};
    // Cells of equal solid angle; midpoints of finer ones integrate.
    constexpr int Rows = 12, Columns = 24, Fine = 40, Passes = 96, Draws = 4000;
    const size_t emitters = scene.emitters.size();
    std::vector<double> exact(Rows * Columns, 0.0), sum(exact), squares(exact);
    for (int i = 0; i < Rows * Fine; ++i)
        for (int j = 0; j < Columns * Fine; ++j) {
            const double z = 2.0 * (i + 0.5) / (Rows * Fine) - 1.0, phi = 2.0 * M_PI * (j + 0.5) / (Columns * Fine);
            const double r = std::sqrt(1.0 - z * z);
            const Vec3f direction(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z));
            for (size_t face = 0; face < light.faces(0); ++face)
                for (size_t emitter = 0; emitter < emitters; ++emitter)
                    exact[size_t(i / Fine * Columns + j / Fine)] +=
                        double(light.density(vertex, direction, face, int(emitter))) * letsOut(body, face, direction) *
                        4.0 * M_PI / (Rows * Columns * Fine * Fine);
        }
    double totals = 0.0, totalSquares = 0.0;
    for (uint32_t pass = 0; pass < Passes; ++pass) {
        light.trace(PassInfo{.index = pass, .seed = 5});
        std::vector<double> found(exact.size(), 0.0);
        for (int i = 0; i < Draws; ++i) {
            Sampler sampler(3, RandomStream::Test, pass, uint64_t(i));
            const auto drawn = light.draw(vertex, sampler);
            if (!drawn) continue;
            double phi = std::atan2(double(drawn->direction.y), double(drawn->direction.x)) / (2.0 * M_PI);
            phi += phi < 0.0 ? 1.0 : 0.0;
            const int row = std::min(int((double(drawn->direction.z) + 1.0) * 0.5 * Rows), Rows - 1);
            found[size_t(row * Columns + std::min(int(phi * Columns), Columns - 1))] +=
                double(drawn->weight) * letsOut(body, drawn->face, drawn->direction) / Draws;
        }
        for (size_t k = 0; k < found.size(); ++k) sum[k] += found[k], squares[k] += found[k] * found[k];
        const double total = std::accumulate(found.begin(), found.end(), 0.0);
        totals += total;
        totalSquares += total * total;
    }
    const double all = std::accumulate(exact.begin(), exact.end(), 0.0);
    double statistic = 0.0;
    int cells = 0;
    for (size_t k = 0; k < exact.size(); ++k) {
        const double mean = sum[k] / Passes, variance = (squares[k] / Passes - mean * mean) / (Passes - 1);
        cells += exact[k] > 0.01 * all ? 1 : 0;
        // Midpoints leave a little where edges of lamps and gates cross a cell.
        const double error = std::sqrt(variance + std::pow(0.001 * all, 2));
        EXPECT_NEAR(mean, exact[k], 5.0 * error) << k;
        statistic += std::pow((mean - exact[k]) / error, 2);
    }
    EXPECT_GT(cells, 5);
    EXPECT_LT(statistic, double(exact.size()));
    const double mean = totals / Passes, variance = (totalSquares / Passes - mean * mean) / (Passes - 1);
    EXPECT_NEAR(mean, all, 4.5 * std::sqrt(variance) + 0.003 * all);
    EXPECT_LT(std::sqrt(variance), 0.012 * all);
}

TEST(RefractedLight, DrawsAreAsDenseAsItSays) {
    expectDrawsAsDense(sealedScene(Box, Around, Even, 7.0, 0.6), Vec3f(0.1f, 0.45f, 0.2f), 5.0);
    expectDrawsAsDense(sealedScene(Box, Around, Even, 7.0, 4.0), Vec3f(0.1f, 0.45f, 0.2f), 4.3);
    expectDrawsAsDense(sealedScene(Ball, "", Forward, 7.0, 0.3), Vec3f(0.1f, 0.45f, 0.3f), 4.6);
}

TEST(RefractedLight, AgreesWithPathsThatMeetLightsByChance) {
    struct Case {
        std::string scene;
        uint32_t plain, aimed;
    };
    const Case cases[] = {{sealedScene(Box, Around, Even, 7.0, 0.6), 512, 128},
                          {sealedScene(Ball, "", Forward, 7.0, 0.5), 512, 128}};
    for (const Case& c : cases) {
        double mean[2], error[2];
        for (const bool aimed : {false, true}) {
            const auto rendered = renderPaths(
                c.scene,
                {{aimed ? "integrator.darts=best" : "integrator.darts=off"}, aimed ? c.aimed : c.plain, 64, 9});
            const Image deviation = rendered->film.standardError(0);
            double sum = 0.0;
            for (const Rgb& pixel : deviation.pixels)
                sum += double(meanComponent(pixel)) * double(meanComponent(pixel));
            mean[aimed] = rendered->mean();
            error[aimed] = std::sqrt(sum) / 16.0;
            EXPECT_EQ(rendered->statistics.counter("ways through walls") > 0, aimed);
        }
        EXPECT_NEAR(mean[1], mean[0], 4.5 * std::hypot(error[0], error[1]));
        EXPECT_LT(std::hypot(error[0], error[1]), 0.05 * mean[0]);
        EXPECT_LT(error[1], 1.5 * error[0]); // a quarter of the plain paths would have twice as much
    }
}

} // namespace
} // namespace tungsten::path
