// Paths in bodies sealed by walls that refract: the ways out, the draws against their density, and means against plain
// paths.

#include "path/techniques/RefractiveConnections.h"

#include "support/PathsAndPhotons.h"

#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <array>

namespace tungsten::path {
namespace {

using test::renderPaths;

TEST(RefractedPath, BendsByTheIndexAndEndsWhereItShall) {
    for (const float index : {1.333f, 1.0f, 0.75f, 2.4f})
        for (const float depth : {1e-3f, 0.5f, 20.0f})
            for (const float lateral : {0.0f, 0.3f, 4.0f, 60.0f}) {
                constexpr float Height = 1.5f;
                const auto way = refractedPath(depth, Height, lateral, index);
                ASSERT_TRUE(way);
                const auto sine = [](double cosine) { return std::sqrt(std::max(1.0 - cosine * cosine, 0.0)); };
                const double in = double(way->cosInside), out = double(way->cosOutside);
                const double reached = double(depth) * sine(in) / in + double(Height) * sine(out) / out;
                // Float cosines near 1 tell small angles, and near 0 long ways, to a few digits only.
                EXPECT_NEAR(reached, double(lateral), 2e-3 * (1.0 + double(lateral + depth))) << index << " " << depth;
                EXPECT_NEAR(sine(out), double(index) * sine(in), 2e-3) << index << " " << depth << " " << lateral;
            }
    EXPECT_FALSE(refractedPath(0.0f, 1.0f, 1.0f, 1.5f));
    EXPECT_FALSE(refractedPath(1.0f, -1.0f, 1.0f, 1.5f));
}

TEST(RefractedPath, AreasAreThoseOfTheirSolidAngles) {
    for (const float index : {1.5f, 0.8f})
        for (const double angle : {0.05, 0.3, 0.6}) {
            constexpr double Depth = 0.4, Height = 1.3, Step = 1e-4;
            const auto lateral = [&](double at) {
                return Depth * std::tan(at) + Height * std::tan(std::asin(double(index) * std::sin(at)));
            };
            const double from = angle - Step, to = angle + Step;
            const double area = lateral(to) * lateral(to) - lateral(from) * lateral(from);
            const double solidAngle = 2.0 * (std::cos(from) - std::cos(to));
            const RefractedPath way{float(Depth), float(Height), float(std::cos(angle)),
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
const std::string SealedBox = R"({"type": "cube", "int_medium": "fog", "bsdf": {"type": "dielectric", "ior": 1.4},
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
double letsOut(const transport::BoundedMedium& body, size_t face, const Vec3f& direction) {
    if (body.sphere) return 1.0;
    return 1.0 - double(fresnelDielectric(1.4f, std::max(direction.dot(body.faces[face].normal), 0.0f)));
}

/// Sums by cells of equal solid angle of a direction, and over all, of several rounds that are alike.
class CellSums {
  public:
    static constexpr int Rows = 12, Columns = 24;
    static constexpr size_t Count = size_t(Rows * Columns);

    /// Where a direction of this height and azimuth (over 2 pi) lies.
    static size_t cellOf(double z, double azimuth) {
        const int row = std::min(int((z + 1.0) * 0.5 * Rows), Rows - 1);
        return size_t(row * Columns + std::min(int(azimuth * Columns), Columns - 1));
    }
    void add(size_t cell, double value) { round_[cell] += value, round_[Count] += value; }
    void endRound() {
        for (size_t k = 0; k <= Count; ++k) {
            sums_[k] += round_[k];
            squares_[k] += round_[k] * round_[k];
        }
        round_.fill(0.0);
        ++rounds_;
    }
    /// The whole sum is that of cell Count.
    [[nodiscard]] double mean(size_t cell = Count) const { return sums_[cell] / rounds_; }
    [[nodiscard]] double variance(size_t cell = Count) const { // of the mean
        return std::max(squares_[cell] / rounds_ - mean(cell) * mean(cell), 0.0) / (rounds_ - 1);
    }

  private:
    std::array<double, Count + 1> round_{}, sums_{}, squares_{};
    int rounds_ = 0;
};

/// The integral of the density times what is let out, by a random point in each part of a fine grid: midpoints, beside
/// edges that lie along the grid, are off by up to 0.7 %. (With 4.7 million points a round and 3000 passes draws and
/// integral differ by 0.06, 0.08 and -0.18 %, standard errors 0.08, 0.08 and 0.17 %.)
CellSums integrated(const RefractiveConnections& light, const transport::BoundedMedium& body,
                    const SealedVertex& vertex, size_t emitters) {
    constexpr int Rounds = 16, Fine = 16, Rows = CellSums::Rows * Fine, Columns = CellSums::Columns * Fine;
    CellSums sums;
    Sampler sampler(4, RandomStream::Test, 0, 0);
    for (int round = 0; round < Rounds; ++round, sums.endRound())
        for (int i = 0; i < Rows; ++i)
            for (int j = 0; j < Columns; ++j) {
                const double z = 2.0 * (i + sampler.nextDouble()) / Rows - 1.0,
                             azimuth = (j + sampler.nextDouble()) / Columns;
                const double r = std::sqrt(1.0 - z * z), phi = 2.0 * M_PI * azimuth;
                const Vec3f direction(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z));
                for (size_t face = 0; face < light.faces(0); ++face)
                    for (size_t emitter = 0; emitter < emitters; ++emitter)
                        sums.add(CellSums::cellOf(z, azimuth),
                                 double(light.density(vertex, direction, face, int(emitter))) *
                                     letsOut(body, face, direction) * 4.0 * M_PI / (Rows * Columns));
            }
    return sums;
}

/// The sum over draws of `weight` times what is let out, by cells; a pass is a round.
CellSums drawn(RefractiveConnections& light, const transport::BoundedMedium& body, const SealedVertex& vertex) {
    constexpr int Passes = 96, Draws = 4000;
    CellSums sums;
    for (uint32_t pass = 0; pass < Passes; ++pass, sums.endRound()) {
        light.trace(PassInfo{.index = pass, .seed = 5});
        for (int i = 0; i < Draws; ++i) {
            Sampler sampler(3, RandomStream::Test, pass, uint64_t(i));
            const auto one = light.draw(vertex, sampler);
            if (!one) continue;
            const double azimuth = std::atan2(double(one->direction.y), double(one->direction.x)) / (2.0 * M_PI);
            sums.add(CellSums::cellOf(double(one->direction.z), azimuth + (azimuth < 0.0 ? 1.0 : 0.0)),
                     double(one->weight) * letsOut(body, one->face, one->direction) / Draws);
        }
    }
    return sums;
}

void expectDrawsAsDense(const std::string& json, const Vec3f& position, double time) {
    const test::SceneFile file(json);
    const LoadedScene loaded = loadScene(file.path());
    const Scene& scene = *loaded.scene;
    const transport::BoundedMedium body = transport::boundedMediaOf(scene)[0];
    RefractiveConnections light;
    light.prepare(scene, {}, {});
    const SealedVertex vertex{position, Vec3f(0.6f, 0.0f, 0.8f), time, scene.primitives[0].inside};
    const CellSums exact = integrated(light, body, vertex, scene.emitters.size()), found = drawn(light, body, vertex);
    double statistic = 0.0;
    int cells = 0;
    for (size_t k = 0; k < CellSums::Count; ++k) {
        cells += exact.mean(k) > 0.01 * exact.mean() ? 1 : 0;
        // Of cells that few draws meet the variance is not known.
        const double error = std::sqrt(found.variance(k) + exact.variance(k) + std::pow(3e-4 * exact.mean(), 2));
        EXPECT_NEAR(found.mean(k), exact.mean(k), 5.0 * error) << k;
        statistic += std::pow((found.mean(k) - exact.mean(k)) / error, 2);
    }
    EXPECT_GT(cells, 5);
    EXPECT_LT(statistic, double(CellSums::Count));
    const double error = std::sqrt(found.variance() + exact.variance());
    EXPECT_NEAR(found.mean(), exact.mean(), 4.5 * error);
    EXPECT_LT(error, 0.012 * exact.mean());
}

TEST(RefractiveConnections, DrawsAreAsDenseAsItSays) {
    expectDrawsAsDense(sealedScene(SealedBox, Around, Even, 7.0, 0.6), Vec3f(0.1f, 0.45f, 0.2f), 5.0);
    expectDrawsAsDense(sealedScene(SealedBox, Around, Even, 7.0, 4.0), Vec3f(0.1f, 0.45f, 0.2f), 4.3);
    expectDrawsAsDense(sealedScene(Ball, "", Forward, 7.0, 0.3), Vec3f(0.1f, 0.45f, 0.3f), 4.6);
}

TEST(RefractiveConnections, AgreesWithPathsThatMeetLightsByChance) {
    struct Case {
        std::string scene;
        uint32_t plain, aimed;
    };
    const Case cases[] = {{sealedScene(SealedBox, Around, Even, 7.0, 0.6), 256, 64},
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
            EXPECT_EQ(rendered->statistics.counter("refractive connections") > 0, aimed);
        }
        EXPECT_NEAR(mean[1], mean[0], 4.5 * std::hypot(error[0], error[1]));
        EXPECT_LT(std::hypot(error[0], error[1]), 0.05 * mean[0]);
        EXPECT_LT(error[1], 1.5 * error[0]); // a quarter of the plain paths would have twice as much
    }
}

/// Beside a lamp so wide that walks which scatter forward meet it nearly as often as aimed ones.
TEST(RefractiveConnections, AgreesBesideAWideLamp) {
    const std::string scene = R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 3, "sigma_a": 0.1,
                   "phase_function": {"type": "henyey_greenstein", "g": 0.8}}],
        "primitives": [)" + SealedBox +
                              R"({"type": "quad", "bsdf": {"type": "null"}, "emission": 10,
                        "transform": {"position": [0, 0, -2], "scale": 30, "rotation": [90, 0, 0]}}],
        "camera": {"type": "pinhole", "fov": 10, "resolution": 1, "transform": {"position": [0, 0, 4],
                   "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "min_bounces": 3, "max_bounces": 16, "transient_time_center": 7,
                       "transient_time_width": 4}})";
    const auto plain = renderPaths(scene, {{"integrator.darts=off"}, 64, 500}),
               aimed = renderPaths(scene, {{"integrator.darts=best"}, 64, 500});
    EXPECT_GT(aimed->statistics.counter("refractive connections"), 0u);
    const double error = std::hypot(plain->pixelError(), aimed->pixelError());
    EXPECT_NEAR(aimed->mean(), plain->mean(), 4.5 * error);
    EXPECT_LT(error, 0.02 * plain->mean()) << "the test would not see a wrong weight";
}

} // namespace
} // namespace tungsten::path
