// Photon beams against verified values, closed forms, photon points and the path tracer.

#include "photon/primitives/Primitive.h"
#include "tungsten/core/Errors.h"

#include "support/Folders.h"
#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::Overrides;
using test::renderBeams;
using test::Rendered;
using test::RenderOptions;
using test::renderPhotons;
using test::setting;
using test::VerifiedValue;

struct BeamOrderCase {
    VerifiedValue value;
    uint32_t passes = 30;
};

class BeamOrders : public testing::TestWithParam<BeamOrderCase> {};

TEST_P(BeamOrders, MatchVerifiedValues) {
    const BeamOrderCase& c = GetParam();
    Overrides overrides = test::gateOf(c.value);
    overrides.insert(overrides.end(), {setting("volume_gather_radius", 0.1), setting("photon_count", 25000)});
    const auto rendered = renderBeams(test::sceneOf(c.value), {overrides, c.passes, 1});
    const double error = rendered->pixelError(), exact = c.value.radiance;
    constexpr double KernelBias = 0.01;
    EXPECT_NEAR(rendered->mean(), exact, 4.0 * error + KernelBias * exact) << "standard error " << error;
    EXPECT_LT(error, 0.1 * exact) << "the test would not see a wrong value";
    RecordProperty("deviation in standard errors", std::to_string((rendered->mean() - exact) / error));
    RecordProperty("relative standard error", std::to_string(error / exact));
}

INSTANTIATE_TEST_SUITE_P(
    Configurations, BeamOrders,
    testing::Values(BeamOrderCase{test::verified("A1UnwarpedBox")}, BeamOrderCase{test::verified("A1WarpedDelta")},
                    BeamOrderCase{test::verified("A2WarpedBox")}, BeamOrderCase{test::verified("A2UnwarpedDelta")},
                    BeamOrderCase{test::verified("A3UnwarpedBox")}, BeamOrderCase{test::verified("B2UnwarpedBox")},
                    BeamOrderCase{test::verified("C2WarpedBox")}, BeamOrderCase{test::verified("C2WarpedDelta")}),
    [](const auto& test) { return tungsten::test::nameOf(test.param.value); });

TEST(BeamMap, SingleScatteringInAFoggedBox) {
    const auto rendered =
        renderBeams(test::foggedBox(), {{setting("volume_gather_radius", 0.05), setting("photon_count", 8000)}, 40, 1});
    const double expected = test::foggedBoxSingleScattering();
    EXPECT_NEAR(rendered->mean(), expected, 4.0 * rendered->pixelError() + 0.01 * expected);
    EXPECT_LT(rendered->pixelError(), 0.05 * expected);
}

TEST(BeamMap, ShrinkingKernelsConvergeOnTheDeltaGate) {
    const auto rendered = renderBeams(test::configurationA(1, true),
                                      {{setting("volume_gather_radius", 0.2), setting("transient_time_width", 0.5),
                                        setting("transient_time_center", 2.2), setting("volume_alpha", 0.4),
                                        setting("photon_count", 20000), "integrator.delta_time_gate=true"},
                                       60,
                                       1});
    constexpr double Exact = 26.6081e-4;
    EXPECT_NEAR(rendered->mean(), Exact, 4.0 * rendered->pixelError() + 0.01 * Exact);
    EXPECT_LT(rendered->pixelError(), 0.05 * Exact);
}

TEST(BeamMap, KernelsShrinkAsPublished) {
    for (const uint32_t pass : {0u, 1u, 7u, 500u}) {
        EXPECT_NEAR(double(beamRadiusFactor(pass, 0.8f)), radiusScale(pass, double(0.8f)), 1e-6);
        EXPECT_NEAR(deltaGateFactor(pass, 0.6f) * deltaGateFactor(pass, 0.6f), radiusScale(pass, double(0.6f)), 1e-6);
    }
}

/// The box of fog that ships, its image in quarters: one pixel each, so that the passes' spread is the exact error.
class CornellFog : public testing::Test {
  protected:
    static constexpr int Frames = 3;
    std::filesystem::path file = test::dataFolder() / "scenes/cornell-fog/scene.json";
    Overrides overrides{"camera.resolution=[2, 2]",
                        "integrator.frame_num=3",
                        "integrator.start_time=4.6",
                        "integrator.transient_time_width=1.2",
                        "integrator.photon_count=10000",
                        "integrator.volume_photon_count=1000000",
                        "integrator.alpha=1",
                        "integrator.volume_alpha=1",
                        "integrator.gather_radius=0.03",
                        "integrator.volume_gather_radius=0.05",
                        "integrator.max_bounces=6",
                        "integrator.enable_rr=false",
                        "media.fog.sigma_s=[0.6, 0.3, 0.1]"};

    [[nodiscard]] std::unique_ptr<Rendered> photons(const std::string& primitive, uint32_t passes) const {
        Overrides all = overrides;
        all.push_back("integrator.volume_photon_type=" + primitive);
        return test::renderPhotonFile(file, {all, passes, 48});
    }
    [[nodiscard]] std::unique_ptr<Rendered> paths(const std::string& preset, uint32_t passes, uint32_t samples) const {
        Overrides all = overrides;
        all.push_back("integrator.darts=" + preset);
        return test::renderPathFile(file, {all, passes, samples});
    }
    /// Every quarter, frame and channel; `bias` relative to the value.
    static void expectSame(const Rendered& a, const Rendered& b, double bias, double largestError) {
        for (int frame = 0; frame < Frames; ++frame) {
            const Image va = a.film.mean(frame), vb = b.film.mean(frame);
            const Image ea = a.film.standardError(frame), eb = b.film.standardError(frame);
            for (size_t i = 0; i < va.pixels.size(); ++i)
                for (int k = 0; k < 3; ++k) {
                    const double value = double(vb.pixels[i][k]);
                    const double error = std::hypot(double(ea.pixels[i][k]), double(eb.pixels[i][k]));
                    EXPECT_NEAR(double(va.pixels[i][k]), value, 4.5 * error + bias * value)
                        << "frame " << frame << " quarter " << i << " channel " << k << " error " << error;
                    EXPECT_LT(error, largestError * value) << "frame " << frame << " quarter " << i << " channel " << k;
                }
        }
    }
};

TEST_F(CornellFog, BeamsAgreeWithPathsAndPoints) {
    const test::OtherSeeds seeds(1);
    const auto beams = photons("beams", 26);
    // Plain paths are as noisy with four times as many samples.
    expectSame(*beams, *paths(R"({"plain_share": 0})", 20, 1024), 0.02, 0.15);
    // The same seed gives the same light paths and surface photons: only the fog's estimate differs.
    expectSame(*beams, *photons("points", 26), 0.01, 0.15);
    EXPECT_GT(beams->statistics.counter("gathered beams"), 100000u);
    EXPECT_EQ(beams->statistics.counter("stored volume photons"), 0u);
}

TEST_F(CornellFog, BeamsAgreeWithPathsThroughAMirror) {
    const test::OtherSeeds seeds(1);
    overrides.emplace_back(R"(primitives.tall block.bsdf={"type": "mirror", "albedo": 0.9})");
    // A lamp that paths can hit through the mirror.
    overrides.emplace_back(
        R"(primitives.pulse={"type": "quad", "int_medium": "fog", "ext_medium": "fog", "emission": 40,
        "transform": {"position": [0.3, 1.7, 0.1], "scale": [0.5, 1, 0.5], "rotation": [180, 0, 0]}})");
    const auto beams = photons("beams", 20);
    expectSame(*beams, *paths("off", 16, 4096), 0.02, 0.15);
}

TEST(BeamMap, FramesSumToTheSteadyState) {
    const auto steady =
        renderBeams(test::fogOverFloor(test::SteadyState), {{"integrator.type=progressive_photon_map"}, 3, 1});
    const auto frames =
        renderBeams(test::fogOverFloor(R"("start_time": 0, "transient_time_width": 5, "frame_num": 30)"), {{}, 3, 1});
    const Image whole = steady->film.mean(0), mean = frames->film.meanOverFrames();
    for (size_t i = 0; i < whole.pixels.size(); ++i)
        EXPECT_NEAR(mean.pixels[i].y * 150.0f, whole.pixels[i].y, 1e-4f * whole.pixels[i].y + 1e-6f);
    EXPECT_GT(steady->statistics.counter("gathered beams"), 1000u);
    EXPECT_EQ(steady->statistics.counter("gathered beams"), frames->statistics.counter("gathered beams"));
}

TEST(BeamMap, PartsOfBeamsMakeTheSameImageAsWholeOnes) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 0.5)");
    // Too small to be met, but it lets camera subpaths fold: beams are kept up to the gate's end.
    std::string folded = json;
    const std::string first = R"("primitives": [)";
    folded.insert(folded.find(first) + first.size(), R"({"type": "quad", "bsdf": {"type": "mirror"},
        "transform": {"position": [2.5, 1, -2.5], "scale": 0.0001}},)");
    // Where surfaces end kernels beams are cut, other parts at other places.
    const test::RenderOptions options{{"integrator.boundary_kernels=false"}, 4, 1};
    const auto parts = renderBeams(json, options), whole = renderBeams(folded, options);
    const Image a = parts->film.mean(0), b = whole->film.mean(0);
    for (size_t i = 0; i < a.pixels.size(); ++i)
        EXPECT_NEAR(a.pixels[i].y, b.pixels[i].y, 1e-4f * b.pixels[i].y + 1e-7f);
    EXPECT_LT(5 * parts->statistics.counter("photon beams"), 4 * whole->statistics.counter("photon beams"));
    EXPECT_EQ(parts->statistics.counter("gathered beams"), whole->statistics.counter("gathered beams"));
    EXPECT_GT(parts->statistics.counter("gathered beams"), 1000u);
}

TEST(BeamMap, SameImageOnOneAndTwoThreadsWithinAMillionth) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4)");
    const auto one = renderBeams(json, {{}, 3, 2, 7, 1}), two = renderBeams(json, {{}, 3, 2, 7, 2});
    const Image a = one->film.mean(0), b = two->film.mean(0);
    for (size_t i = 0; i < a.pixels.size(); ++i) EXPECT_NEAR(a.pixels[i].y, b.pixels[i].y, 1e-6f * a.pixels[i].y);
    EXPECT_EQ(one->statistics.counter("photon beams"), two->statistics.counter("photon beams"));
    EXPECT_GT(one->mean(), 0.0);
}

TEST(BeamMap, FullStoresStayUnbiased) {
    const std::string json = test::configurationA(2, false);
    const auto big = renderBeams(json, {{setting("photon_count", 25000)}, 20, 1});
    const auto small = renderBeams(json, {{"integrator.volume_photon_count=1000"}, 300, 1});
    EXPECT_LE(small->statistics.counter("photon beams"), 300u * 1000u);
    EXPECT_GT(small->statistics.counter("photon beams"), 300u * 950u);
    EXPECT_NEAR(small->mean(), big->mean(), 4.0 * std::hypot(small->pixelError(), big->pixelError()));
    EXPECT_LT(small->pixelError(), 0.1 * small->mean());
}

TEST(BeamMap, OrdersAndLimitsAsForPoints) {
    const std::string few = setting("photon_count", 20000);
    const RenderOptions lowOrders{{few, "integrator.low_order_scattering=false"}, 2, 1};
    EXPECT_EQ(renderBeams(test::configurationA(1, true), lowOrders)->statistics.counter("gathered beams"), 0u);
    const auto all = renderBeams(test::configurationA(2, true), {{few}, 2, 1});
    const auto high = renderBeams(test::configurationA(2, true), lowOrders);
    EXPECT_GT(all->mean(), 0.0);
    EXPECT_NEAR(high->mean(), all->mean(), 1e-6 * all->mean());
    EXPECT_LT(high->statistics.counter("photon beams"), all->statistics.counter("photon beams"));
    // One distance in the medium: single scattering alone.
    const RenderOptions oneFlight{{few, "media.fog.max_bounces=1"}, 2, 1};
    EXPECT_GT(renderBeams(test::configurationA(1, true), oneFlight)->mean(), 0.0);
    EXPECT_EQ(renderBeams(test::configurationA(2, true), oneFlight)->mean(), 0.0);
}

TEST(BeamMap, UnusedStagesCostNothing) {
    const auto noMedium = renderBeams(test::litFloor(1), {{"integrator.transient_time_width=5"}, 1, 1});
    EXPECT_EQ(noMedium->statistics.counter("photon beams"), 0u);
    EXPECT_GT(noMedium->statistics.counter("stored surface photons"), 0u);
    const auto points = renderPhotons(test::configurationA(1, false), {{}, 1, 1});
    EXPECT_EQ(points->statistics.counter("photon beams"), 0u);
}

TEST(BeamMap, WrongSettingsAreExplained) {
    const std::string delta = "integrator.delta_time_gate=true", noWidth = "integrator.transient_time_width=0";
    EXPECT_NO_THROW(renderBeams(test::configurationA(1, false), {{delta}, 1, 1}));
    EXPECT_THROW(renderBeams(test::configurationA(1, false), {{delta, noWidth}, 1, 1}), InputError);
    EXPECT_THROW(renderPhotons(test::configurationA(1, false), {{delta, noWidth}, 1, 1}), InputError);
    EXPECT_THROW(renderBeams(test::configurationA(1, false), {{"integrator.volume_gather_radius=0"}, 1, 1}),
                 InputError);
    // Without any radius there is one that suits the scene.
    const std::string radius = R"("volume_gather_radius": 0.15,)";
    std::string json = test::configurationA(1, false);
    json.erase(json.find(radius), radius.size());
    EXPECT_NO_THROW(renderBeams(json, {{}, 1, 1}));
}

TEST(BeamMap, SharedScenesLoadAndRender) {
    const std::filesystem::path folder = test::sharedFolder() / "scenes";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not here";
    for (const char* name : {"cbox/transient-beams.json", "dragon/scene-beams-short.json",
                             "dragon/scene-beams-darts-long.json", "dragon/transient-beams.json"}) {
        SCOPED_TRACE(name);
        const auto rendered = test::renderPhotonFile(
            folder / name, {{"camera.resolution=[8, 8]", "integrator.photon_count=20000"}, 1, 1});
        EXPECT_GT(rendered->statistics.counter("gathered beams"), 0u);
        EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
    }
}

} // namespace
} // namespace tungsten::photon
