// Photon points and surface photons against closed forms, verified values and the path tracer.

#include "photon/primitives/Primitive.h"
#include "tungsten/core/Errors.h"

#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::renderPaths;
using test::renderPhotons;

const std::string SteadyMap = "integrator.type=progressive_photon_map";

TEST(ProgressiveSchedule, FollowsItsProduct) {
    double product = 1.0;
    for (uint32_t pass = 0; pass < 200; ++pass) {
        EXPECT_NEAR(radiusScale(pass, 0.7), product, 1e-12 * product + 1e-13);
        product *= (double(pass) + 1.0 + 0.7) / (double(pass) + 2.0);
    }
    EXPECT_EQ(radiusScale(0, 0.3), 1.0);
    EXPECT_NEAR(radiusScale(1000, 1.0), 1.0, 1e-10);
}

struct PointOrderCase {
    test::VerifiedValue value;
    uint32_t passes = 20;
};

class PointOrders : public testing::TestWithParam<PointOrderCase> {};

TEST_P(PointOrders, MatchVerifiedValues) {
    const PointOrderCase& c = GetParam();
    const auto rendered = renderPhotons(test::sceneOf(c.value), {test::gateOf(c.value), c.passes, 1});
    const double error = rendered->pixelError(), exact = c.value.radiance;
    constexpr double KernelBias = 0.01;
    EXPECT_NEAR(rendered->mean(), exact, 4.0 * error + KernelBias * exact) << "standard error " << error;
    EXPECT_LT(error, 0.13 * exact) << "the test would not see a wrong value";
}

INSTANTIATE_TEST_SUITE_P(ConfigurationsAAndB, PointOrders,
                         testing::Values(PointOrderCase{test::verified("A1UnwarpedBox")},
                                         PointOrderCase{test::verified("A2UnwarpedBox")},
                                         PointOrderCase{test::verified("A3WarpedBox")},
                                         PointOrderCase{test::verified("B2WarpedBox"), 40}),
                         [](const auto& test) { return tungsten::test::nameOf(test.param.value); });

TEST(PhotonMap, SingleScatteringInAFoggedBox) {
    const auto rendered = renderPhotons(test::foggedBox(), {{"integrator.photon_count=30000"}, 60, 1});
    const double expected = test::foggedBoxSingleScattering();
    EXPECT_NEAR(rendered->mean(), expected, 4.0 * rendered->pixelError() + 0.01 * expected);
    EXPECT_LT(rendered->pixelError(), 0.05 * expected);
}

TEST(PhotonMap, DirectLightingAndItsArrivalTime) {
    const auto rendered = renderPhotons(test::litFloor(20), {{"integrator.photon_count=40000"}, 40, 1});
    const double expected = 0.5 / 3.14159265358979 * 3.0 * (1.0 / 1.25) / (1.25 * 1.25) / 0.25;
    EXPECT_NEAR(rendered->mean(15), expected, 4.0 * rendered->pixelError(15) + 0.01 * expected);
    EXPECT_LT(rendered->pixelError(15), 0.05 * expected);
    for (int frame = 0; frame < 20; ++frame) EXPECT_EQ(rendered->mean(frame) > 0.0, frame == 15) << frame;
}

/// A lamp that fills the left half of a pixel: passes of a single camera path see it or not.
TEST(PhotonMap, PassesHaveCameraPathsOfTheirOwn) {
    const auto rendered = renderPhotons(R"({"primitives": [
        {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0}, "emission": 2, "transform": {"position": [-1, 0, 0], "scale": [2, 1, 2]}}],
        "camera": {"type": "orthographic", "orthographic_size": 1, "resolution": [1, 1], "reconstruction_filter": "box",
                   "transform": {"position": [0, 2, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}},
        "integrator": {"type": "progressive_transient_photon_map", "photon_count": 10, "max_bounces": 1,
                       "start_time": 0, "transient_time_width": 10, "frame_num": 1}})",
                                        {{}, 400, 1});
    EXPECT_NEAR(rendered->mean(), 0.1, 4.5 * 0.1 / std::sqrt(400.0)) << "half of 2, over a gate of 10";
}

TEST(PhotonMap, DirectLightingIsOneBounce) {
    const auto mean = [](const std::string& most, const std::string& least) {
        return renderPhotons(test::litFloor(20), {{"integrator.photon_count=4000", "integrator.max_bounces=" + most,
                                                   "integrator.min_bounces=" + least},
                                                  1,
                                                  1})
            ->mean(15);
    };
    EXPECT_GT(mean("2", "1"), 0.0);
    EXPECT_EQ(mean("3", "2"), 0.0);
}

/// Under a lamp, a floor whose shading normals lean by 37 degrees is as bright as their cosine says.
TEST(PhotonMap, ShadingNormalsWeighWhatArrives) {
    const test::FileFolder folder;
    folder.write("leaning.obj",
                 "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nvn 0 0.8 0.6\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n");
    const auto scene = folder.write("scene.json", R"({"primitives": [
        {"type": "mesh", "file": "leaning.obj", "smooth": true, "bsdf": {"type": "lambert", "albedo": 0.5}},
        {"type": "point", "emission": 3, "transform": {"position": [0, 1, 0]}}],
        "camera": {"type": "orthographic", "orthographic_size": 0.001, "resolution": [1, 1],
                   "transform": {"position": [0, 2, 0], "look_at": [0, 0, 0], "up": [1, 0, 0]}},
        "integrator": {"type": "progressive_photon_map", "photon_count": 20000, "gather_radius": 0.05,
                       "gather_photon_count": 1000000, "alpha": 1, "max_bounces": 2}})");
    const auto rendered = test::renderPhotonFile(scene, {{}, 100, 1});
    const double expected = 0.5 / 3.14159265358979 * 3.0 * 0.8;
    EXPECT_NEAR(rendered->mean(), expected, 4.0 * rendered->pixelError() + 0.01 * expected);
    EXPECT_LT(rendered->pixelError(), 0.05 * expected);
}

TEST(PhotonMap, AgreesWithPathsInEveryFrame) {
    const std::string json = test::fogOverFloor(R"("start_time": 6, "transient_time_width": 2, "frame_num": 3)");
    const auto points = renderPhotons(json, {{}, 48, 1});
    const auto paths = renderPaths(json, {{}, 30, 48});
    for (int frame = 0; frame < 3; ++frame) {
        SCOPED_TRACE(frame);
        // Quarters of the image: block means whose errors follow from the pixels' (points: fully correlated at worst).
        const Image a = points->film.mean(frame), b = paths->film.mean(frame);
        const Image ea = points->film.standardError(frame), eb = paths->film.standardError(frame);
        const double average = std::max(paths->mean(frame), 1e-12);
        for (int block = 0; block < 4; ++block) {
            double difference = 0.0, correlated = 0.0, independent = 0.0;
            for (int i = 0; i < 64; ++i) {
                const int x = 8 * (block % 2) + i % 8, y = 8 * (block / 2) + i / 8;
                difference += double(a.at(x, y).y - b.at(x, y).y) / 64.0;
                correlated += double(ea.at(x, y).y) / 64.0;
                independent += double(eb.at(x, y).y * eb.at(x, y).y) / (64.0 * 64.0);
            }
            constexpr double KernelBias = 0.05; // radius 0.15 on surfaces, edges of the floor and cube in view
            EXPECT_LT(std::abs(difference),
                      4.0 * std::sqrt(correlated * correlated + independent) + KernelBias * average)
                << block;
            EXPECT_LT(correlated, 0.3 * average);
        }
    }
}

TEST(PhotonMap, FramesSumToTheSteadyState) {
    const auto steady = renderPhotons(test::fogOverFloor(test::SteadyState), {{SteadyMap}, 3, 1});
    const auto frames =
        renderPhotons(test::fogOverFloor(R"("start_time": 0, "transient_time_width": 5, "frame_num": 30)"), {{}, 3, 1});
    const Image whole = steady->film.mean(0), mean = frames->film.meanOverFrames();
    for (size_t i = 0; i < whole.pixels.size(); ++i)
        EXPECT_NEAR(mean.pixels[i].y * 150.0f, whole.pixels[i].y, 1e-4f * whole.pixels[i].y + 1e-6f);
    EXPECT_GT(steady->mean(), 0.0);
}

TEST(PhotonMap, SameImageOnOneAndTwoThreadsWithinAMillionth) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4)");
    const auto one = renderPhotons(json, {{}, 3, 2, 7, 1}), two = renderPhotons(json, {{}, 3, 2, 7, 2});
    const Image a = one->film.mean(0), b = two->film.mean(0);
    for (size_t i = 0; i < a.pixels.size(); ++i) EXPECT_NEAR(a.pixels[i].y, b.pixels[i].y, 1e-6f * a.pixels[i].y);
    EXPECT_EQ(one->statistics.counter("stored volume photons"), two->statistics.counter("stored volume photons"));
    EXPECT_GT(one->mean(), 0.0);
}

TEST(PhotonMap, FullStoresStayUnbiased) {
    const std::string json = test::configurationA(2, false);
    const auto big = renderPhotons(json, {{}, 20, 1});
    const auto small = renderPhotons(json, {{"integrator.volume_photon_count=4000"}, 200, 1});
    EXPECT_LE(small->statistics.counter("stored volume photons"), 200u * 4000u);
    EXPECT_GT(small->statistics.counter("stored volume photons"), 200u * 3900u);
    EXPECT_NEAR(small->mean(), big->mean(), 4.0 * std::hypot(small->pixelError(), big->pixelError()));
    EXPECT_LT(small->pixelError(), 0.1 * small->mean());
}

/// Without progression too: what the spread of a render's passes tells is what the spread over seeds is. Radii are
/// those of a progressive map's first pass.
TEST(PhotonMap, WithoutProgressionTellsItsError) {
    const test::SceneFile file(test::foggedBox());
    const auto render = [&](uint64_t seed, uint32_t passes, bool progressive) {
        const test::RenderOptions options{
            {"integrator.photon_count=1000", "integrator.volume_gather_radius=0.3", "integrator.volume_alpha=0.5"},
            passes,
            1,
            seed};
        return test::renderPhotonFile(file.path(), options, progressive);
    };
    constexpr int Seeds = 200;
    double sum = 0.0, squares = 0.0, told = 0.0;
    for (uint64_t seed = 1; seed <= Seeds; ++seed) {
        const auto rendered = render(seed, 8, false);
        sum += rendered->mean();
        squares += rendered->mean() * rendered->mean();
        told += rendered->pixelError() * rendered->pixelError() / Seeds;
    }
    const double made = (squares - sum * sum / Seeds) / (Seeds - 1);
    // The variance of 200 means has a relative error of sqrt(2 / 199).
    EXPECT_NEAR(told, made, 5.0 * 0.1 * made);
    EXPECT_GT(made, 0.0);
    EXPECT_EQ(render(1, 1, false)->mean(), render(1, 1, true)->mean());
}

TEST(PhotonMap, UnusedStagesCostNothing) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 8, "transient_time_width": 4)");
    const auto noSurfaces = renderPhotons(json, {{"integrator.include_surfaces=false"}, 1, 1});
    EXPECT_EQ(noSurfaces->statistics.counter("stored surface photons"), 0u);
    EXPECT_GT(noSurfaces->statistics.counter("stored volume photons"), 0u);
    const auto noMedium = renderPhotons(test::litFloor(1), {{"integrator.transient_time_width=5"}, 1, 1});
    EXPECT_EQ(noMedium->statistics.counter("stored volume photons"), 0u);
    EXPECT_GT(noMedium->statistics.counter("stored surface photons"), 0u);
}

TEST(PhotonMap, AdaptiveRadiiEstimateTheSameRadiance) {
    const std::string json = test::configurationA(1, false);
    const auto adaptive =
        renderPhotons(json, {{"integrator.fixed_volume_radius=false", "integrator.photon_count=120000"}, 20, 1});
    EXPECT_NEAR(adaptive->mean(), 2.22436e-4, 4.0 * adaptive->pixelError() + 0.05 * 2.22436e-4);
    EXPECT_LT(adaptive->pixelError(), 0.1 * 2.22436e-4) << "the test would not see a wrong value";
}

TEST(PhotonMap, WrongSettingsAreExplained) {
    for (const char* bad : {"integrator.volume_photon_type=beans", "integrator.volume_photon_type=planes_1d",
                            "integrator.photon_count=0", "integrator.alpha=2"})
        EXPECT_THROW(renderPhotons(test::litFloor(1), {{bad}, 1, 1}), InputError) << bad;
}

} // namespace
} // namespace tungsten::photon
