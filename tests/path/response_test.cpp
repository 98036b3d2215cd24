// Sensors that weigh times of arrival by a response.

#include "support/GroundTruthScenes.h"
#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

constexpr double Peaks[2] = {5.05, 5.85}, HalfWidth = 0.05;

const std::string TwoPeaks = R"(integrator.temporal_response={"times": [5, 5.05, 5.1, 5.8, 5.85, 5.9],
                                                               "values": [0, 3, 0, 0, 1, 0]})";
const std::string Gaussian = R"(integrator.temporal_response={"type": "gaussian", "center": 5.5, "sigma": 0.1})";
const std::string Box = R"(integrator.temporal_response={"type": "box", "start": 5, "end": 6})";

double triangle(double x) {
    return std::max(1.0 - std::abs(x), 0.0);
}
/// The same responses, not normalised.
double twoPeaks(double time) {
    return 3.0 * triangle((time - Peaks[0]) / HalfWidth) + triangle((time - Peaks[1]) / HalfWidth);
}
double gaussian(double time) {
    return std::exp(-0.5 * (time - 5.5) * (time - 5.5) / 0.01);
}
double box(double time) {
    return time >= 5.0 && time < 6.0 ? 1.0 : 0.0;
}

/// Configuration A, order 1: sigma_s e^{-sigma_t S} / (2 pi |o + S w - x|^2), weighed by W / integral W.
double weighedSingleScattering(double (*response)(double)) {
    constexpr int Steps = 200000;
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < Steps; ++i) {
        const double S = 4.5 + 2.0 * (i + 0.5) / Steps, w = response(S);
        const double squared = 1.2 * 1.2 + 0.5 * 0.5 + (S - 2.0) * (S - 2.0);
        sum += w * 0.5 * std::exp(-0.6 * S) / (2.0 * M_PI * squared);
        weights += w;
    }
    return sum / weights;
}

std::unique_ptr<test::Rendered> renderOrder(int order, const std::string& response, const std::string& darts,
                                            uint32_t samples) {
    return test::renderPaths(test::configurationA(order, false),
                             {{"integrator.type=path_tracer", response, "integrator.darts=" + darts}, 40, samples});
}

TEST(Response, WeighsSingleScatteringAsTheClosedForm) {
    const std::vector<std::pair<std::string, double (*)(double)>> responses{
        {TwoPeaks, twoPeaks}, {Gaussian, gaussian}, {Box, box}};
    for (const auto& [json, response] : responses)
        for (const char* darts : {"off", "published", "best"}) {
            const auto rendered = renderOrder(1, json, darts, std::string(darts) == "off" ? 20000 : 5000);
            const double expected = weighedSingleScattering(response), error = rendered->pixelError();
            // The gaussian is cut at 4 standard deviations and linear between 65 points.
            EXPECT_NEAR(rendered->mean(), expected, 4.0 * error + 5e-4 * expected) << json << darts;
            EXPECT_LT(error, 0.02 * expected) << "too noisy to see a wrong value";
        }
}

TEST(Response, GuidedAndPlainPathsAgree) {
    for (const auto& [order, response] : {std::pair{2, TwoPeaks}, {3, Gaussian}}) {
        const auto plain = renderOrder(order, response, "off", 20000),
                   best = renderOrder(order, response, "best", 5000);
        const double error = std::hypot(plain->pixelError(), best->pixelError());
        // Plain connections near the light have a heavy tail.
        EXPECT_NEAR(plain->mean(), best->mean(), 4.0 * error + 0.02 * best->mean()) << order << response;
        EXPECT_LT(error, 0.06 * best->mean()) << "too noisy to see a wrong value";
    }
}

TEST(Response, BoxIsAGate) {
    const auto box = renderOrder(2, Box, "best", 5000);
    EXPECT_NEAR(box->mean(), 5.97962e-4, 4.0 * box->pixelError());
}

/// The experiment of He et al. 2024, figure 7: paths of all orders to a sensor that sees two short times.
TEST(Response, ControlVerticesHitTwoPeaksThatPlainConnectionsMiss) {
    const auto outside = [](const std::string& darts, const char* tried) {
        const auto rendered = test::renderPaths(test::configurationA(1, false),
                                                {{"integrator.type=path_tracer", "integrator.min_bounces=0",
                                                  "integrator.max_bounces=1000", TwoPeaks, "integrator.darts=" + darts},
                                                 1,
                                                 20000});
        const Statistics& statistics = rendered->statistics;
        EXPECT_GT(statistics.counter(tried), 20000u);
        return 1.0 -
               double(statistics.counter("arrivals while the sensor is open")) / double(statistics.counter(tried));
    };
    const double plain = outside("off", "connections"), guided = outside("best", "control vertices");
    EXPECT_GT(plain, 0.80);
    EXPECT_LT(guided, 0.03);
    RecordProperty("plain connections outside", std::to_string(plain));
    RecordProperty("control vertices outside", std::to_string(guided));
}

} // namespace
} // namespace tungsten::path
