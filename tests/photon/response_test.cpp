// Photons seen by sensors that weigh times of arrival by a response.

#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using test::Overrides;
using test::Rendered;
using test::setting;

const std::string TwoPeaks = R"(integrator.temporal_response={"times": [5, 5.05, 5.1, 5.8, 5.85, 5.9],
                                                               "values": [0, 3, 0, 0, 1, 0]})";
const std::string Gaussian = R"(integrator.temporal_response={"type": "gaussian", "center": 5.5, "sigma": 0.1})";
const std::string UnwarpedPeaks = R"(integrator.temporal_response={"times": [2, 2.1, 2.2, 2.8, 2.9, 3],
                                                                    "values": [0, 3, 0, 0, 1, 0]})";

double triangle(double x) {
    return std::max(1.0 - std::abs(x), 0.0);
}
/// The same responses, not normalised.
double twoPeaks(double time) {
    return 3.0 * triangle((time - 5.05) / 0.05) + triangle((time - 5.85) / 0.05);
}
double unwarpedPeaks(double time) {
    return 3.0 * triangle((time - 2.1) / 0.1) + triangle((time - 2.9) / 0.1);
}

/// Configuration A, order 1, at the depth z along the camera's ray: light goes r to there and z to the camera.
double weighedSingleScattering(double (*response)(double), bool unwarped) {
    constexpr int Steps = 400000;
    constexpr double Depth = 8.0, LatestTime = 10.0;
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < Steps; ++i) {
        const double z = Depth * (i + 0.5) / Steps, r = std::sqrt(1.2 * 1.2 + 0.5 * 0.5 + (z - 2.0) * (z - 2.0));
        sum += response(unwarped ? r : r + z) * 0.5 * std::exp(-0.6 * (r + z)) / (4.0 * M_PI * r * r) * Depth / Steps;
        weights += response(LatestTime * (i + 0.5) / Steps) * LatestTime / Steps;
    }
    return sum / weights;
}

struct ResponseCase {
    const char* name;
    Overrides overrides; ///< sampling and primitive
};
std::string responseName(const testing::TestParamInfo<ResponseCase>& info) {
    return info.param.name;
}

class PhotonResponse : public testing::TestWithParam<ResponseCase> {
  protected:
    static std::unique_ptr<Rendered> renderOrder(int order, bool unwarped, const std::string& response,
                                                 uint32_t passes) {
        Overrides overrides{response, setting("volume_gather_radius", 0.12), setting("photon_count", 20000)};
        const Overrides& own = GetParam().overrides;
        overrides.insert(overrides.end(), own.begin(), own.end());
        return test::renderPhotons(test::configurationA(order, unwarped), {overrides, passes, 1});
    }
};

TEST_P(PhotonResponse, WeighsSingleScatteringAsTheClosedForm) {
    struct Expected {
        std::string json;
        double (*response)(double);
        bool unwarped;
        uint32_t passes; ///< light paths find two short times more rarely
    };
    for (const Expected& e :
         {Expected{TwoPeaks, twoPeaks, false, 60}, Expected{UnwarpedPeaks, unwarpedPeaks, true, 30}}) {
        // Plain photons do not know the response, and hardly ever arrive at two short times.
        if (!e.unwarped && GetParam().name == std::string("PlainPoints")) continue;
        const auto rendered = renderOrder(1, e.unwarped, e.json, e.passes);
        const double expected = weighedSingleScattering(e.response, e.unwarped), error = rendered->pixelError();
        constexpr double KernelBias = 0.01;
        EXPECT_NEAR(rendered->mean(), expected, 4.0 * error + KernelBias * expected) << e.json << " error " << error;
        EXPECT_LT(error, 0.1 * expected) << "too noisy to see a wrong value";
    }
}

TEST_P(PhotonResponse, AgreesWithPathsInDoubleScattering) {
    const auto photons = renderOrder(2, false, Gaussian, 20);
    const auto paths =
        test::renderPaths(test::configurationA(2, false), {{Gaussian, "integrator.darts=best"}, 40, 1000});
    const double error = std::hypot(photons->pixelError(), paths->pixelError()), expected = paths->mean();
    constexpr double KernelBias = 0.01;
    EXPECT_NEAR(photons->mean(), expected, 4.0 * error + KernelBias * expected) << "error " << error;
    EXPECT_LT(error, 0.12 * expected) << "too noisy to see a wrong value";
}

const std::string Narrow = "integrator.volume_gather_radius=0.06";
INSTANTIATE_TEST_SUITE_P(
    Sampling, PhotonResponse,
    testing::Values(ResponseCase{"PlainPoints", {"integrator.photon_count=300000"}},
                    ResponseCase{"PublishedPoints", {"integrator.darts=published", "integrator.photon_count=30000"}},
                    ResponseCase{"BestPoints", {test::GuidedAlone}},
                    ResponseCase{"IndirectViewPoints",
                                 {R"(integrator.darts={"direct_view": "off", "plain_share": 0})",
                                  "integrator.photon_count=40000"}},
                    ResponseCase{"PlainBeams", {test::BeamMap, Narrow}},
                    ResponseCase{"PublishedBeams", {test::BeamMap, Narrow, "integrator.darts=published"}},
                    ResponseCase{"BestBeams", {test::BeamMap, Narrow, test::GuidedAlone}}),
    responseName);

/// Fog that light must leave: control vertices by the response's density, which free flights cannot be weighed against,
/// and vertices by lengths alone, which share with them. (0.89 of the light, when both were mixed.)
TEST(PhotonResponseOfBodies, ConnectionsByResponseAndByLengthAgree) {
    const std::string json = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 10, "sigma_a": 0.01}],
        "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}},
                       {"type": "point", "emission": 1000, "transform": {"position": [3, 0, 9]}}],
        "camera": {"type": "pinhole", "fov": 7, "resolution": 4, "reconstruction_filter": "box",
                   "transform": {"position": [0, 0, 9], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 1024, "photon_count": 25000,
                       "gather_radius": 0.1, "volume_gather_radius": 0.1, "volume_photon_type": "points",
                       "fixed_volume_radius": true, "temporal_response": {"type": "gaussian", "center": 19.5, "sigma": 0.5}}})";
    struct Mean {
        double value = 0.0, error = 0.0;
    };
    const auto mean = [&](const std::string& darts) {
        constexpr int Seeds = 8;
        double sum = 0.0, squares = 0.0;
        for (uint64_t seed = 1; seed <= Seeds; ++seed) {
            const double value = test::renderPhotons(json, {{"integrator.darts=" + darts}, 12, 1, seed})->mean();
            sum += value / Seeds;
            squares += value * value / Seeds;
        }
        return Mean{sum, std::sqrt((squares - sum * sum) / (Seeds - 1))};
    };
    const Mean byResponse = mean(R"({"plain_share": 0})"),
               byLength = mean(R"({"direct_view": "off", "plain_share": 0})");
    const double error = std::hypot(byResponse.error, byLength.error);
    EXPECT_NEAR(byResponse.value, byLength.value, 5.0 * error);
    EXPECT_GT(byLength.value, 0.0);
    EXPECT_LT(error, 0.015 * byLength.value) << "too noisy to see a wrong value";
}

/// Walls, floor and emitter seen: surface photons, surface connections, visible emission.
TEST(PhotonResponseOnSurfaces, AgreesWithPaths) {
    const std::string json = test::fogOverFloor(R"("transient_time_center": 6, "transient_time_width": 1)");
    const std::string response =
        R"(integrator.temporal_response={"times": [6, 6.2, 6.4, 7.5, 7.7, 7.9], "values": [0, 3, 0, 0, 1, 0]})";
    const auto paths = test::renderPaths(json, {{response, "integrator.darts=best"}, 20, 32});
    const double expected = paths->mean();
    for (const char* darts : {"off", "published", R"({"plain_share": 0})", R"({"plain_share": 0.3})"}) {
        // Passes are independent: the error of the image's mean from the spread of groups of them.
        constexpr int Groups = 8;
        double mean = 0.0, squares = 0.0;
        for (int group = 0; group < Groups; ++group) {
            const auto photons = test::renderPhotons(
                json, {{response, std::string("integrator.darts=") + darts}, 4, 1, uint64_t(group + 1)});
            mean += photons->mean() / Groups;
            squares += photons->mean() * photons->mean() / Groups;
        }
        const double error = std::sqrt((squares - mean * mean) / (Groups - 1));
        EXPECT_NEAR(mean, expected, 5.0 * error + 0.02 * expected) << darts << " error " << error;
        EXPECT_LT(error, 0.03 * expected) << "too noisy to see a wrong value";
    }
}

TEST(PhotonResponseOnSurfaces, VisibleEmissionIsWeighedByItsArrival) {
    // A black panel of radiance 3 at distance 2, whose light starts at 1: it arrives at 3, where W = 0.5 / 1.5.
    const std::string json = R"({"primitives": [{"type": "quad", "bsdf": {"type": "null"}, "emission": 3,
            "emission_time": 1, "transform": {"position": [0, 0, 2], "rotation": [-90, 0, 0], "scale": 1}}],
        "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 0.001, "reconstruction_filter": "dirac",
                   "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "photon_count": 100, "gather_radius": 0.1,
                       "temporal_response": {"times": [1, 2, 3, 4], "values": [0, 1, 0.5, 0]}}})";
    EXPECT_NEAR(test::renderPhotons(json, {{}, 2, 1})->mean(), 3.0 * 0.5 / 1.5, 1e-5);
}

TEST(PhotonResponseBox, IsAGate) {
    const std::string box = R"(integrator.temporal_response={"type": "box", "start": 5, "end": 6})";
    for (const auto& [darts, passes] : {std::pair{"integrator.darts=off", 60u}, {"integrator.darts=published", 24u}}) {
        const Overrides common{darts, setting("volume_gather_radius", 0.12), setting("photon_count", 40000)};
        Overrides withBox = common;
        withBox.push_back(box);
        const std::string json = test::configurationA(1, false);
        const auto gate = test::renderPhotons(json, {common, passes, 1}),
                   response = test::renderPhotons(json, {withBox, passes, 1});
        const double error = std::hypot(gate->pixelError(), response->pixelError());
        EXPECT_NEAR(response->mean(), gate->mean(), 4.0 * error + 1e-6 * gate->mean()) << darts;
        EXPECT_LT(error, 0.15 * gate->mean()) << "too noisy to see a wrong value";
    }
}

/// The experiment of He et al. 2024, figure 7: light paths of all orders to a sensor that sees two short times.
TEST(PhotonResponseRejection, ControlVerticesHitTwoPeaksThatPlainPhotonsMiss) {
    const auto outside = [](const std::string& darts) {
        const auto rendered = test::renderPhotons(test::configurationA(1, false),
                                                  {{"integrator.min_bounces=0", "integrator.max_bounces=1000", TwoPeaks,
                                                    "integrator.darts=" + darts, setting("photon_count", 60000)},
                                                   1,
                                                   1});
        const Statistics& statistics = rendered->statistics;
        EXPECT_GT(statistics.counter("volume deposits"), 1000u);
        return 1.0 - double(statistics.counter("volume deposits that may count")) /
                         double(statistics.counter("volume deposits"));
    };
    const double plain = outside("off"), published = outside("published"), best = outside(R"({"plain_share": 0})");
    EXPECT_GT(plain, 0.80);
    EXPECT_LT(published, 0.03);
    EXPECT_LT(best, 0.03);
    RecordProperty("plain photons outside", std::to_string(plain));
    RecordProperty("published control vertices outside", std::to_string(published));
    RecordProperty("best control vertices outside", std::to_string(best));
}

} // namespace
} // namespace tungsten::photon
