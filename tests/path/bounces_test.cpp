// Which paths are rendered: bounce limits, low orders, medium limits; and what time bounds may not change.

#include "path/look_along.h"
#include "support/GroundTruthScenes.h"
#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

using test::renderPaths;

/// A floor seen through two sheets of `sheet` (heights 1.9 and 1.8), its light 1.25 away behind a third; a glowing quad
/// instead of the floor's reflection when `glowing`.
std::string sheets(const std::string& sheet, bool glowing, int onlyBounce) {
    const std::string floor =
        glowing ? R"("emission": 2, "bsdf": {"type": "null"})" : R"("bsdf": {"type": "lambert", "albedo": 0.5})";
    const std::string part = R"({"type": "quad", "bsdf": )" + sheet + R"(, "transform": {"scale": 0.1, "position": )";
    return R"({"primitives": [{"type": "quad", )" + floor + R"(, "transform": {"scale": [20, 1, 20]}},)" + part +
           "[0.75, 1.9, 0]}}," + part + "[0.75, 1.8, 0]}}," + part + R"([0.375, 0.5, 0]}},
            {"type": "point", "emission": 3, "transform": {"position": [0, 1, 0]}}],)" +
           test::lookAlong("[0.75, 2, 0]", "[0.75, 0, 0]", "[1, 0, 0]") +
           R"(, "integrator": {"type": "path_tracer", "start_time": 0, "transient_time_width": 100, "frame_num": 1,
                "enable_rr": false, "min_bounces": )" +
           std::to_string(onlyBounce) + R"(, "max_bounces": )" + std::to_string(onlyBounce + 1) + "}}";
}
double litFloorValue() {
    return 0.5 / M_PI * 3.0 * 0.8 / (1.25 * 1.25) / 100.0;
}

TEST(Bounces, ForwardSheetsCountOnCameraAndShadowRays) {
    for (int bounce = 0; bounce < 7; ++bounce) {
        const double expected = bounce == 4 ? litFloorValue() : 0.0; // two sheets, the floor, one sheet
        EXPECT_NEAR(renderPaths(sheets(R"({"type": "forward"})", false, bounce), {{}, 1, 8})->mean(), expected,
                    1e-3 * litFloorValue())
            << bounce;
    }
}

TEST(Bounces, EmissionThroughForwardSheets) {
    for (int bounce = 0; bounce < 4; ++bounce)
        EXPECT_NEAR(renderPaths(sheets(R"({"type": "forward"})", true, bounce), {{}, 1, 8})->mean(),
                    bounce == 2 ? 2.0 / 100.0 : 0.0, 1e-6)
            << bounce;
}

TEST(Bounces, TransparencyWeighsEveryPassage) {
    const std::string sheet = R"({"type": "transparency", "alpha": 0.3, "base": {"type": "null"}})";
    const auto rendered = renderPaths(sheets(sheet, false, 4), {{}, 50, 200});
    EXPECT_NEAR(rendered->mean(), 0.7 * 0.7 * 0.7 * litFloorValue(),
                4.5 * rendered->pixelError() + 1e-5 * litFloorValue());
    EXPECT_LT(rendered->pixelError(), 0.02 * rendered->mean());
}

TEST(Bounces, MediumLimitsCountDistancesSinceTheLastSurface) {
    const auto value = [](int limit) {
        return renderPaths(test::configurationA(3, false),
                           {{"integrator.type=path_tracer", "media.0.max_bounces=" + std::to_string(limit)}, 1, 5000})
            ->mean();
    };
    EXPECT_EQ(value(2), 0.0);
    EXPECT_GT(value(3), 0.0);
    EXPECT_EQ(value(3), value(1024));
}

TEST(Bounces, WhatALaserMeetsFirstCountsToo) {
    const auto value = [](int maxBounces, const std::string& preset) {
        return renderPaths(test::withLaser(test::configurationA(1, false)),
                           {{"integrator.type=path_tracer", preset, "integrator.min_bounces=0",
                             "integrator.max_bounces=" + std::to_string(maxBounces)},
                            1,
                            5000})
            ->mean();
    };
    // The thin line of sight and the laser's do not meet: two scatterings at least.
    for (const std::string& preset : {std::string("integrator.darts=off"), test::BestPreset}) {
        EXPECT_EQ(value(2, preset), 0.0) << preset;
        EXPECT_GT(value(3, preset), 0.0) << preset;
    }
}

TEST(Bounces, LowOrdersCanBeLeftOut) {
    const auto value = [](int order, bool lowOrder) {
        return renderPaths(test::configurationA(order, false),
                           {{"integrator.type=path_tracer",
                             std::string("integrator.low_order_scattering=") + (lowOrder ? "true" : "false")},
                            1,
                            5000})
            ->mean();
    };
    EXPECT_GT(value(1, true), 0.0);
    EXPECT_EQ(value(1, false), 0.0);
    EXPECT_GT(value(2, false), 0.0);
}

TEST(Bounces, SurfacesCanBeLeftOut) {
    const auto value = [](const std::string& json, bool surfaces) {
        return renderPaths(json, {{"integrator.type=path_tracer",
                                   std::string("integrator.include_surfaces=") + (surfaces ? "true" : "false")},
                                  1,
                                  200})
            ->mean();
    };
    EXPECT_EQ(value(test::litFloor(20), false), 0.0);
    const double fogOnly = value(test::fogOverFloor(test::SteadyState), false);
    EXPECT_GT(fogOnly, 0.0);
    EXPECT_LT(fogOnly, value(test::fogOverFloor(test::SteadyState), true));
}

/// To the rounding of sums: a sequence's are in double for the last few frames that a path met, then in float.
void expectSamePixels(const Image& a, const Image& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (size_t i = 0; i < a.pixels.size(); ++i)
        for (const auto channel : {&Rgb::x, &Rgb::y, &Rgb::z})
            EXPECT_NEAR(a.pixels[i].*channel, b.pixels[i].*channel, 1e-6f * a.pixels[i].*channel) << i;
}

/// Connections and paths are dropped by when they can arrive at the earliest: a narrow gate must show what the same
/// frame of a long sequence shows, with the same random numbers.
TEST(TimeBounds, NarrowGatesShowTheSameFrameOfASequence) {
    for (const std::string unwarped : {"false", "true"})
        for (const std::string glass : {"forward", "dielectric"}) {
            const std::vector<std::string> overrides{
                "integrator.type=path_tracer", "integrator.camera_unwarped=" + unwarped,
                "primitives.0.bsdf={\"type\": \"" + glass + "\"}", "primitives.0.int_speed_of_light=0.7"};
            const auto sequence =
                renderPaths(test::fogOverFloor(R"("start_time": 2, "transient_time_width": 0.5, "frame_num": 40)"),
                            {overrides, 1, 32});
            int lit = 0;
            for (int frame = 0; frame < 24; frame += 3) {
                const auto gate =
                    renderPaths(test::fogOverFloor(R"("start_time": )" + std::to_string(2.0 + 0.5 * frame) +
                                                   R"(, "transient_time_width": 0.5, "frame_num": 1)"),
                                {overrides, 1, 32});
                SCOPED_TRACE(glass + std::to_string(frame));
                expectSamePixels(gate->film.mean(0), sequence->film.mean(frame));
                EXPECT_LE(gate->statistics.counter("shadow rays"), sequence->statistics.counter("shadow rays"));
                lit += gate->mean() > 0.0;
            }
            EXPECT_GE(lit, 3);
        }
}

TEST(TimeBounds, ManyLightsShareOneBound) {
    std::string lights;
    for (int i = 0; i < 12; ++i)
        lights += R"(, {"type": "point", "emission": 1, "emission_time": )" + std::to_string(0.3 * (i % 4)) +
                  R"(, "transform": {"position": [)" + std::to_string(i - 6) + ", 1, " + std::to_string(i % 3) + "]}}";
    const auto scene = [&](const std::string& gate) {
        return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.3}],
            "primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"scale": [20, 1, 20]}})" +
               lights + R"(], "camera": {"type": "pinhole", "resolution": [6, 6], "medium": "fog",
                "transform": {"position": [0, 2, 6], "look_at": [0, 0, 0]}},
            "integrator": {"type": "path_tracer", "max_bounces": 6, "transient_time_width": 0.4, )" +
               gate + "}}";
    };
    const auto sequence = renderPaths(scene(R"("start_time": 7, "frame_num": 20)"), {{}, 1, 32});
    for (const int frame : {4, 8, 12, 16}) { // before, some lights are late and left out: others are chosen
        const auto gate = renderPaths(
            scene(R"("start_time": )" + std::to_string(7.0 + 0.4 * frame) + R"(, "frame_num": 1)"), {{}, 1, 32});
        SCOPED_TRACE(frame);
        expectSamePixels(gate->film.mean(0), sequence->film.mean(frame));
        EXPECT_GT(gate->mean(), 0.0);
    }
}

TEST(TimeBounds, PathsEndWhenNothingCanArrive) {
    const std::string fog = test::configurationA(1, false);
    const auto gated = renderPaths(
        fog, {{"integrator.type=path_tracer", "integrator.min_bounces=0", "integrator.max_bounces=1000"}, 1, 2000});
    const auto late = renderPaths(fog, {{"integrator.type=path_tracer", "integrator.min_bounces=0",
                                         "integrator.max_bounces=1000", "integrator.transient_time_center=50"},
                                        1,
                                        2000});
    EXPECT_LT(2 * gated->statistics.counter("medium events"), late->statistics.counter("medium events"));
    // One speed: a connection's time is known before it is traced, so most of the early ones are never traced.
    EXPECT_LT(late->statistics.counter("shadow rays"), late->statistics.counter("medium events") / 4);
    EXPECT_GT(gated->mean(), 0.0);
}

} // namespace
} // namespace tungsten::path
