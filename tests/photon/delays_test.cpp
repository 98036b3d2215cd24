// Light that does not start, or is not recorded, in a moment: pulses of emitters and the sensor's response in
// sequences.

#include "support/GroundTruthScenes.h"
#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using Distribution = std::function<double(double)>;
using Overrides = std::vector<std::string>;

Distribution flash() {
    return [](double t) { return t >= 0.0 ? 1.0 : 0.0; };
}
Distribution box(double from, double to) {
    return [=](double t) { return std::clamp((t - from) / (to - from), 0.0, 1.0); };
}
Distribution gaussian(double centre, double sigma) {
    return [=](double t) { return 0.5 * std::erfc((centre - t) / (sigma * std::sqrt(2.0))); };
}
Distribution exponential(double from, double decay) {
    return [=](double t) { return t > from ? -std::expm1((from - t) / decay) : 0.0; };
}
/// Of the sum of a time with this distribution and one even over [from, to].
Distribution plusBox(const Distribution& first, double from, double to) {
    return [=](double t) {
        double sum = 0.0;
        for (int i = 0; i < 50; ++i) sum += first(t - from - (to - from) * (i + 0.5) / 50.0);
        return sum / 50.0;
    };
}

/// Frames of configuration A: 12 from 2.5 on, 0.5 wide.
constexpr int Frames = 12;
constexpr double Start = 2.5, Width = 0.5;
Overrides frames(int count = Frames, double width = Width) {
    return {"integrator.start_time=2.5", "integrator.transient_time_width=" + std::to_string(width),
            "integrator.frame_num=" + std::to_string(count)};
}

/// Order 1 of configuration A, as the mean over each frame, the camera's segment counted or not: over the distance z
/// along the ray, the light sigma_s e^{-sigma_t (r + z)} / (4 pi r^2) that arrives at r + z (or r), times the part of
/// it that is recorded in the frame.
double singleScattering(int frame, const Distribution& delay, bool unwarped = false) {
    constexpr int Steps = 10000;
    constexpr double Depth = 12.0;
    double sum = 0.0;
    for (int i = 0; i < Steps; ++i) {
        const double z = Depth * (i + 0.5) / Steps, r = std::sqrt(1.2 * 1.2 + 0.5 * 0.5 + (z - 2.0) * (z - 2.0));
        const double arrival = unwarped ? r : r + z, start = Start + frame * Width;
        sum += (delay(start + Width - arrival) - delay(start - arrival)) * 0.5 * std::exp(-0.6 * (r + z)) /
               (4.0 * M_PI * r * r) * Depth / Steps;
    }
    return sum / Width;
}

struct Delay {
    const char* name;
    Overrides overrides;
    Distribution distribution;
};
std::vector<Delay> delays() {
    const std::string response = "integrator.temporal_response=", pulse = "primitives.0.pulse=";
    const std::string gaussianText = R"({"type": "gaussian", "center": 0.9, "sigma": 0.3})",
                      decay = R"({"type": "exponential", "start": 0.2, "decay": 0.8})",
                      boxText = R"({"type": "box", "start": -0.3, "end": 0.9})";
    return {{"response", {response + gaussianText}, gaussian(0.9, 0.3)},
            {"decay", {response + decay}, exponential(0.2, 0.8)},
            {"box", {response + boxText}, box(-0.3, 0.9)},
            {"pulse", {pulse + decay}, exponential(0.2, 0.8)},
            {"both", {pulse + gaussianText, response + boxText}, plusBox(gaussian(0.9, 0.3), -0.3, 0.9)}};
}

struct DelayCase {
    const char* name;
    Overrides overrides;
    uint32_t passes, samples; ///< photons where samples is 1
    double bias;              ///< of kernels, as a part of the largest frame
};
std::string delayName(const testing::TestParamInfo<DelayCase>& info) {
    return info.param.name;
}

class Delays : public testing::TestWithParam<DelayCase> {
  protected:
    static std::unique_ptr<test::Rendered> renderOrder(int order, bool unwarped, Overrides overrides) {
        const DelayCase& c = GetParam();
        const std::string json = test::configurationA(order, unwarped);
        overrides.insert(overrides.end(), c.overrides.begin(), c.overrides.end());
        if (c.samples > 1) return test::renderPaths(json, {overrides, c.passes, c.samples});
        overrides.push_back("integrator.volume_gather_radius=0.1");
        return test::renderPhotons(json, {overrides, order == 1 ? c.passes / 2 : c.passes, 1});
    }
};

Overrides joined(Overrides a, const Overrides& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Frames against what they should hold, with what is known of their errors.
void expectFrames(const test::Rendered& rendered, const std::vector<double>& expected,
                  const std::vector<double>& errors, double bias, const std::string& what) {
    const double largest = *std::max_element(expected.begin(), expected.end());
    double all = 0.0, allExpected = 0.0, allErrors = 0.0;
    for (size_t i = 0; i < expected.size(); ++i) {
        const double error = std::hypot(rendered.pixelError(int(i)), errors.empty() ? 0.0 : errors[i]);
        EXPECT_NEAR(rendered.mean(int(i)), expected[i], 4.5 * error + bias * largest) << what << ", frame " << i;
        EXPECT_LT(error, 0.25 * largest) << what << ": too noisy to see a wrong value";
        all += rendered.mean(int(i));
        allExpected += expected[i];
        allErrors += error;
    }
    // Frames share paths: at worst all err together.
    EXPECT_NEAR(all, allExpected, 4.5 * allErrors + bias * allExpected) << what << ", all frames";
}

TEST_P(Delays, SingleScatteringIsTheClosedFormByFrame) {
    const std::vector<Delay> all = delays();
    // To light paths every delay is a number that is drawn.
    const size_t first = GetParam().samples > 1 ? 0 : all.size() - 1;
    for (size_t d = first; d < all.size(); ++d)
        for (const bool unwarped : {false, true}) {
            if (unwarped && d + 1 < all.size()) continue;
            std::vector<double> expected;
            for (int i = 0; i < Frames; ++i) expected.push_back(singleScattering(i, all[d].distribution, unwarped));
            const auto rendered = renderOrder(1, unwarped, joined(frames(), all[d].overrides));
            expectFrames(*rendered, expected, {}, GetParam().bias,
                         all[d].name + std::string(unwarped ? ", unwarped" : ""));
        }
}

/// Frames of order 2 from a film of fine ones without a delay, spread by it, and their errors.
struct SpreadFrames {
    std::vector<double> frames, errors;
};
SpreadFrames spreadDoubleScattering(const Distribution& delay) {
    constexpr int Fine = 560;
    constexpr double FineWidth = 0.0125, FineStart = 2.3; // the first light arrives at 2.385
    const auto fine = test::renderPaths(
        test::configurationA(2, false),
        {joined(frames(Fine, FineWidth), {"integrator.darts=best", "integrator.start_time=2.3"}), 16, 2000});
    SpreadFrames spread;
    for (int i = 0; i < Frames; ++i) {
        double mean = 0.0, squaredError = 0.0;
        for (int k = 0; k < Fine; ++k) {
            const double arrival = FineStart + (k + 0.5) * FineWidth, start = Start + i * Width;
            const double share = (delay(start + Width - arrival) - delay(start - arrival)) * FineWidth / Width;
            mean += share * fine->mean(k);
            squaredError += share * share * fine->pixelError(k) * fine->pixelError(k);
        }
        spread.frames.push_back(mean);
        spread.errors.push_back(std::sqrt(squaredError));
    }
    return spread;
}

TEST_P(Delays, DoubleScatteringIsTheSequenceConvolved) {
    const Delay delay = delays().back();
    static const SpreadFrames expected = spreadDoubleScattering(delay.distribution);
    const auto rendered = renderOrder(2, false, joined(frames(), delay.overrides));
    expectFrames(*rendered, expected.frames, expected.errors, GetParam().bias + 0.002, "order 2");
}

std::string primitive(const std::string& name) {
    return "integrator.volume_photon_type=" + name;
}
INSTANTIATE_TEST_SUITE_P(
    Sampling, Delays,
    testing::Values(
        DelayCase{"PlainPaths", {"integrator.darts=off"}, 20, 8000, 1e-3},
        DelayCase{"PublishedPaths", {test::PublishedPreset}, 10, 1000, 1e-3},
        DelayCase{"BestPaths", {test::BestPreset}, 10, 1000, 1e-3},
        DelayCase{"PlainPoints", {"integrator.photon_count=100000"}, 24, 1, 0.02},
        DelayCase{"BestPoints", {test::BestPreset, "integrator.photon_count=40000"}, 24, 1, 0.02},
        DelayCase{"PlainBeams", {primitive("beams"), "integrator.photon_count=20000"}, 24, 1, 0.02},
        DelayCase{"BestBeams", {primitive("beams"), test::BestPreset, "integrator.photon_count=10000"}, 24, 1, 0.02},
        DelayCase{"BestBalls",
                  {primitive("mis_volumes_balls"), test::BestPreset, "integrator.photon_count=10000"},
                  24,
                  1,
                  0.02}),
    delayName);

TEST(Delays, EachEmitterHasItsOwnPulse) {
    const std::string two = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 0.5}],
        "primitives": [{"type": "point", "emission": 1, "ext_medium": "fog", "transform": {"position": [1.2, 0.5, 2]},
                        "pulse": {"type": "exponential", "decay": 0.8}},
                       {"type": "point", "emission": 3, "ext_medium": "fog", "transform": {"position": [-0.5, 1.2, 2]},
                        "emission_time": 0.5, "pulse": {"type": "box", "start": 0, "end": 0.7}},
                       {"type": "point", "emission": 2, "ext_medium": "fog", "transform": {"position": [0.5, -1.2, 2]}}],
        "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 0.001, "medium": "fog", "reconstruction_filter": "dirac",
                   "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "min_bounces": 1, "max_bounces": 2, "photon_count": 60000,
                       "fixed_volume_radius": true, "volume_gather_radius": 0.1, "alpha": 1, "volume_alpha": 1}})";
    const Distribution late = box(0.5, 1.2), decay = exponential(0.0, 0.8), none = flash();
    const Distribution all = [&](double t) { return decay(t) + 3.0 * late(t) + 2.0 * none(t); };
    for (const char* darts : {"off", "best"})
        for (const bool photons : {false, true}) {
            const Overrides settings = joined(frames(), {std::string("integrator.darts=") + darts});
            const auto rendered =
                photons ? test::renderPhotons(two, {settings, 24, 1}) : test::renderPaths(two, {settings, 10, 2000});
            for (int i = 0; i < Frames; ++i) {
                const double expected = singleScattering(i, all);
                EXPECT_NEAR(rendered->mean(i), expected, 4.5 * rendered->pixelError(i) + 0.003)
                    << darts << photons << " frame " << i;
                EXPECT_LT(rendered->pixelError(i), 0.01);
            }
        }
}

/// A response of no width, and no response, are the same paths.
TEST(Delays, OfNoWidthChangeNothing) {
    const std::string json = test::configurationA(1, false);
    const std::string response = R"(integrator.temporal_response={"type": "box", "start": 0, "end": 1e-9})";
    for (const char* darts : {"off", "published", "best"}) {
        const Overrides settings = joined(frames(), {std::string("integrator.darts=") + darts});
        const auto without = test::renderPaths(json, {settings, 4, 500}),
                   with = test::renderPaths(json, {joined(settings, {response}), 4, 500});
        for (int i = 0; i < Frames; ++i)
            EXPECT_NEAR(with->mean(i), without->mean(i), 1e-5 * without->mean(i) + 1e-7) << darts << i;
    }
}

TEST(Delays, VisibleEmissionIsRecordedOverTime) {
    // A black panel of radiance 3 at distance 2, whose light starts at 1 and decays: by frames from 3 on.
    const std::string json = R"({"primitives": [{"type": "quad", "bsdf": {"type": "null"}, "emission": 3,
            "emission_time": 1, "pulse": {"type": "exponential", "decay": 0.7},
            "transform": {"position": [0, 0, 2], "rotation": [-90, 0, 0], "scale": 1}}],
        "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 0.001, "reconstruction_filter": "dirac",
                   "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1], "up": [0, 1, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "photon_count": 100, "gather_radius": 0.1,
                       "start_time": 2.5, "transient_time_width": 0.5, "frame_num": 8}})";
    const auto photons = test::renderPhotons(json, {{}, 2, 1}), paths = test::renderPaths(json, {{}, 2, 4});
    const Distribution decay = exponential(3.0, 0.7);
    for (int i = 0; i < 8; ++i) {
        const double expected = 3.0 * (decay(3.0 + 0.5 * i) - decay(2.5 + 0.5 * i)) / 0.5;
        EXPECT_NEAR(photons->mean(i), expected, 1e-5) << i;
        EXPECT_NEAR(paths->mean(i), expected, 1e-5) << i;
    }
    // Steady state has no use for a pulse.
    const Overrides steady{"integrator.type=path_tracer", "integrator.frame_num=0",
                           "integrator.transient_time_width=0"};
    EXPECT_NEAR(test::renderPaths(json, {steady, 1, 4})->mean(), 3.0, 1e-5);
}

/// Floor, walls and a lamp with a surface seen: connections, photons on surfaces, emission that is met.
TEST(Delays, OfLightOnSurfacesAgree) {
    const std::string json = test::fogOverFloor(R"("start_time": 4, "transient_time_width": 1, "frame_num": 6)");
    const Overrides delay{R"(integrator.temporal_response={"type": "gaussian", "center": 0.6, "sigma": 0.2})"};
    const auto best = test::renderPaths(json, {joined(delay, {"integrator.darts=best"}), 16, 24});
    double largest = 0.0;
    for (int i = 0; i < 6; ++i) largest = std::max(largest, best->mean(i));
    const auto expectBest = [&](const test::Rendered& rendered, const std::string& what) {
        for (int i = 0; i < 6; ++i)
            EXPECT_NEAR(rendered.mean(i), best->mean(i), 0.03 * largest) << what << ", frame " << i;
    };
    expectBest(*test::renderPaths(json, {joined(delay, {"integrator.darts=off"}), 24, 48}), "plain paths");
    for (const std::string darts : {"off", "best"})
        expectBest(*test::renderPhotons(json, {joined(delay, {"integrator.darts=" + darts}), 10, 1}),
                   "photons, " + darts);
}

} // namespace
} // namespace tungsten::photon
