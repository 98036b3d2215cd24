// Lights that plain paths see straight through media, with their transmittance instead of flights that get there.

#include "guided_setup.h"

#include "support/PathsAndPhotons.h"

#include "tungsten/film/FilmErrors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tungsten::path {
namespace {

/// Looked at along z from -4: fog from -1 to 1, a pane at 2 that lets half of the light through, a lamp at 3. Paths
/// straight on have three interactions, those that scatter more.
std::string lampBehindFog(const std::string& transport) {
    return R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": [0.3, 0.6, 0.9], "sigma_a": 0.2}],
        "camera": {"type": "pinhole", "fov": 20, "resolution": 4, "reconstruction_filter": "box",
                   "transform": {"position": [0, 0, -4]}},
        "primitives": [
            {"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 2}},
            {"type": "quad", "bsdf": {"type": "transparency", "alpha": 0.5, "base": {"type": "null"}},
             "transform": {"position": [0, 0, 2], "scale": 4, "rotation": [-90, 0, 0]}},
            {"type": "quad", "emission": 10, "bsdf": {"type": "null"},
             "transform": {"position": [0, 0, 3], "scale": 4, "rotation": [-90, 0, 0]}}],
        "integrator": {"type": "path_tracer", )" +
           transport + "}}";
}
constexpr const char *StraightOnly = R"("max_bounces": 4, "transient_time_center": 7, "transient_time_width": 1)",
                     *Scattered = R"("max_bounces": 16, "transient_time_center": 7, "transient_time_width": 1)";

/// Of many paths along the same ray.
PixelMean along(const Ray& ray, const GuidedSetup& setup, bool lightsInView) {
    PathContext context = setup.plain();
    context.lightsInView = lightsInView;
    return meanOfPaths(setup, 100, 200, [&](PixelAccumulator& sink, PathCounters& counters, uint32_t i) {
        tracePath<true, true>(context, sink, counters, {3, RandomStream::Camera, i, 0}, nullptr, ray);
    });
}
const Ray AlongZ{Vec3f(0.0f, 0.0f, -4.0f), Vec3f(0.0f, 0.0f, 1.0f)};

TEST(LightsInView, AreAttenuatedExactly) {
    const PixelMean seen = along(AlongZ, GuidedSetup(lampBehindFog(StraightOnly)), true);
    for (int channel = 0; channel < 3; ++channel) {
        const double sigma = 0.2 + 0.3 * (channel + 1);
        EXPECT_NEAR(seen.value[channel], 0.5 * 10.0 * std::exp(-2.0 * sigma), 1e-5);
    }
    EXPECT_LT(seen.error, 1e-5);
}

TEST(LightsInView, AreThoseThatFlightsFind) {
    for (const char* transport : {StraightOnly, Scattered}) {
        const GuidedSetup setup(lampBehindFog(transport));
        const PixelMean expected = along(AlongZ, setup, true), met = along(AlongZ, setup, false);
        EXPECT_NEAR(expected.mean, met.mean, 4.5 * std::hypot(expected.error, met.error));
        EXPECT_LT(expected.error, 0.6 * met.error) << transport;
    }
}

/// Through fog, in a mirror: what is not straight is left to flights.
TEST(LightsInView, AreNotThoseInMirrors) {
    const GuidedSetup setup(R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.2, "sigma_a": 0.2}],
        "camera": {"type": "pinhole", "fov": 20, "resolution": 4, "transform": {"position": [0, 0, -4]}},
        "primitives": [
            {"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 2}},
            {"type": "quad", "bsdf": {"type": "mirror"},
             "transform": {"position": [0, 0, 2], "scale": 4, "rotation": [-90, 0, 0]}},
            {"type": "quad", "emission": 10, "bsdf": {"type": "null"},
             "transform": {"position": [0, 0, -5], "scale": 4, "rotation": [90, 0, 0]}}],
        "integrator": {"type": "path_tracer", "max_bounces": 16,
                       "transient_time_center": 13, "transient_time_width": 1}})");
    const PixelMean with = along(AlongZ, setup, true), without = along(AlongZ, setup, false);
    EXPECT_GT(without.mean, 0.1);
    EXPECT_NEAR(with.mean, without.mean, 4.5 * std::hypot(with.error, without.error));
}

TEST(LightsInView, CountAsPathsDo) {
    const auto seen = [](const std::string& transport) {
        return along(AlongZ, GuidedSetup(lampBehindFog(transport)), true).mean;
    };
    const std::string inTime = R"("transient_time_center": 7, "transient_time_width": 1, )";
    EXPECT_GT(seen(inTime + R"("max_bounces": 4)"), 0.1);
    EXPECT_EQ(seen(inTime + R"("max_bounces": 3)"), 0.0) << "one surface too many";
    EXPECT_EQ(seen(inTime + R"("max_bounces": 4, "min_bounces": 4)"), 0.0);
    EXPECT_EQ(seen(inTime + R"("max_bounces": 4, "include_surfaces": false)"), 0.0);
    EXPECT_EQ(seen(R"("max_bounces": 4, "transient_time_center": 5, "transient_time_width": 1)"), 0.0) << "later";
}

constexpr const char* SkyBehindFog = R"({
    "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0, "sigma_a": 0.5}],
    "camera": {"type": "pinhole", "fov": 20, "resolution": 4, "transform": {"position": [0, 0, -4]}},
    "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 2}},
                   {"type": "infinite_sphere", "emission": 3}],
    "integrator": {"type": "path_tracer", "max_bounces": 8}})";

TEST(LightsInView, AreEnvironmentsToo) {
    const PixelMean seen = along(AlongZ, GuidedSetup(SkyBehindFog), true);
    EXPECT_NEAR(seen.mean, 3.0 * std::exp(-1.0), 1e-5);
    EXPECT_LT(seen.error, 1e-5);
}

std::unique_ptr<test::Rendered> render(const std::string& darts) {
    return test::renderPaths(lampBehindFog(Scattered), {{"integrator.darts=" + darts}, 100, 16});
}

uint64_t inView(const std::unique_ptr<test::Rendered>& rendered) {
    return rendered->statistics.counter("lights seen through media in expectation");
}

TEST(LightsInView, LessenTheErrorOfBestPaths) {
    const auto with = render(R"("best")"), without = render(R"({"preset": "best", "lights_in_view": false})"),
               plain = render(R"("off")");
    EXPECT_GT(inView(with), 0u);
    EXPECT_EQ(inView(without), 0u);
    EXPECT_EQ(inView(plain), 0u);
    EXPECT_EQ(inView(render(R"("published")")), 0u);
    EXPECT_EQ(inView(render(R"({"preset": "best", "plain_share": 0.5})")), 0u) << "beside guided paths";
    const double mean = meanValue(plain->film);
    const auto errorOf = [&](const auto& of) { return relativeStandardError(of->film) * meanValue(of->film) / 4.0; };
    EXPECT_NEAR(meanValue(with->film), mean, 4.5 * std::hypot(errorOf(with), errorOf(plain)));
    EXPECT_LT(errorOf(with), 0.8 * errorOf(without));
}

/// Where fog takes more of the sky than it scatters; where it only absorbs, flights have no randomness to take away.
TEST(LightsInView, OfTheSkyAreTakenWhereTheyHelp) {
    const auto withFog = [](const std::string& sigmaS) {
        return test::renderPaths(SkyBehindFog, {{"integrator.darts=best", "media.*.sigma_s=" + sigmaS}, 1, 16});
    };
    EXPECT_GT(inView(withFog("0.1")), 0u);
    EXPECT_EQ(inView(withFog("0")), 0u);
}

} // namespace
} // namespace tungsten::path
