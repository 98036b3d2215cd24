// Slices seen from far away, against plain paths.

#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr const char *OneGate = R"("start_time": 1.6, "transient_time_width": 1, "frame_num": 1)",
                     *TwoFrames = R"("start_time": 1.6, "transient_time_width": 0.6, "frame_num": 2)";

struct FarCase {
    const char *name, *type;
    double distance; ///< of the camera
    bool twice;      ///< only light that has scattered exactly twice
    const char* gate = OneGate;
    float sigmaS = 4.0f;
    const char* darts = R"({"plain_share": 0})";
    uint32_t passes = 8;
};

/// A small ball of fog in vacuum beside a lamp. The camera opens so much later as it is farther away.
std::string ballOfFog(const FarCase& c) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.02, "sigma_s": )" +
           std::to_string(c.sigmaS) + R"(}],
        "primitives": [{"type": "sphere", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 0.6}},
                       {"type": "point", "emission": 40, "emission_time": )" +
           std::to_string(-c.distance) + R"(, "transform": {"position": [0.8, 0.8, 0.9]}}],
        "camera": {"type": "pinhole", "resolution": [8, 8], "reconstruction_filter": "box", "fov": )" +
           std::to_string(90.0 / c.distance) + R"(, "transform": {"position": [0, 0, )" + std::to_string(c.distance) +
           R"(], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "photon_count": 3000, "volume_photon_count": 1000000,
                       "volume_gather_radius": 0.06, "fixed_volume_radius": true, "min_bounces": )" +
           (c.twice ? R"(4, "max_bounces": 5, )" : R"(0, "max_bounces": 64, )") + c.gate + "}}";
}

/// Mean over the image and its standard error, from the spread over seeds.
template <typename Render>
std::pair<double, double> farMean(int frame, const Render& render) {
    constexpr int Seeds = 8;
    double sum = 0.0, squares = 0.0;
    for (uint64_t seed = 1; seed <= Seeds; ++seed) {
        const double mean = render(seed).mean(frame);
        sum += mean / Seeds;
        squares += mean * mean / Seeds;
    }
    return {sum, std::sqrt((squares - sum * sum) / (Seeds - 1))};
}

class FarSlices : public testing::TestWithParam<FarCase> {};

TEST_P(FarSlices, BringWhatPathsBring) {
    const test::OtherSeeds seeds{{"PlainFilm", 2}, {"DenseFilm", 1}};
    const FarCase& c = GetParam();
    const std::string json = ballOfFog(c);
    const test::Overrides slices{std::string("integrator.volume_photon_type=") + c.type,
                                 std::string("integrator.darts=") + c.darts};
    std::vector<std::unique_ptr<test::Rendered>> paths, photons;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        paths.push_back(test::renderPaths(json, {{"integrator.darts=off"}, 4, 256, seed}));
        photons.push_back(test::renderPhotons(json, {slices, c.passes, 1, seed}));
    }
    for (int frame = 0; frame < paths[0]->film.frames(); ++frame) {
        const auto [expected, pathError] = farMean(
            frame, [&](uint64_t seed) -> auto& { return *paths[seed - 1]; });
        const auto [mean, error] = farMean(
            frame, [&](uint64_t seed) -> auto& { return *photons[seed - 1]; });
        // Of 8 seeds: Student's t of 7 degrees of freedom is as often beyond 6 as a normal one beyond 4.5, about.
        EXPECT_NEAR(mean, expected, 6.0 * std::hypot(error, pathError)) << mean / expected << ", frame " << frame;
        EXPECT_LT(6.0 * std::hypot(error, pathError), 0.16 * expected) << "the test would not see a wrong value";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, FarSlices,
    testing::Values(
        FarCase{"BallsNear", "balls", 5.0, true}, FarCase{"Balls", "balls", 1e4, true},
        FarCase{"BallsFarther", "balls", 8e4, true}, FarCase{"Planes", "planes", 1e4, true, OneGate, 4.0f, "best", 128},
        FarCase{"Volumes", "volumes", 1e4, false}, FarCase{"Shared", "mis_volumes_balls", 1e4, false},
        FarCase{"Hypervolumes", "hypervolumes", 1e4, false},
        FarCase{"PlainFilm", "balls", 40.0, false, TwoFrames, 4.0f, "off", 96},
        FarCase{"FilmOfBalls", "balls", 400.0, false, TwoFrames},
        FarCase{"FilmOfVolumes", "volumes", 40.0, false, TwoFrames, 4.0f, R"({"plain_share": 0})", 12},
        FarCase{"SharedFilm", "mis_volumes_balls", 40.0, false, TwoFrames, 4.0f, R"({"plain_share": 0})", 12},
        FarCase{"DenseFilm", "mis_volumes_balls", 5.0, false, TwoFrames, 9.0f, R"({"plain_share": 0})", 16}),
    [](const auto& test) { return test.param.name; });

} // namespace
} // namespace tungsten::photon
