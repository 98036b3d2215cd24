// Guided paths, order by order, against verified values (photon-primitives.md, section 6): presets in full, every
// switch alone.

#include "path/render_paths.h"
#include "support/GroundTruthScenes.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

struct Order {
    char configuration;
    int order;
    bool unwarped, delta;
    double expected;
    double uncertainty = 0.0; ///< relative, of values that were simulated
};

/// How paths are sampled.
struct Sampling {
    std::string name;
    std::vector<std::string> fields;
    /// Relative allowance beside the standard error: directions that ignore the connection's weight have a heavy tail.
    double slack;
    uint32_t samples = 5000; ///< per pass
};

std::string switches(const std::string& fields) {
    return R"(integrator.darts={"preset": "best", )" + fields + "}";
}

const std::vector<Sampling> Presets{{"Best", {"integrator.darts=best"}, 0.0},
                                    {"Published", {"integrator.darts=published"}, 0.01}};

const std::vector<Sampling> Switches{
    {"GuidingOnly", {"integrator.enable_guiding=true", "media.0.type=guided_homo"}, 0.03},
    {"EllipticalOnly", {"integrator.enable_elliptical=true"}, 0.02},
    {"PhaseDirections", {switches(R"("direction": "phase")")}, 0.02, 40000},
    {"EdaDirections", {switches(R"("direction": "eda")")}, 0.01},
    {"ConnectionLobe", {switches(R"("direction": "connection")")}, 0.0},
    {"DirectionRis", {switches(R"("direction": "ris")")}, 0.0},
    {"Unbounded", {switches(R"("bounded": false)")}, 0.0},
    {"PlainDistances", {switches(R"("distance": "plain")")}, 0.0},
    {"Causal", {switches(R"("greens_function": "causal")")}, 0.0},
    {"Diffusion", {switches(R"("greens_function": "diffusion")")}, 0.0},
    {"LengthLast", {switches(R"("length_first": false)")}, 0.01},
    {"NoRoulette", {switches(R"("roulette": 0)")}, 0.0},
};

std::unique_ptr<test::Rendered> renderOrder(const Order& c, const Sampling& sampling, test::RenderOptions options) {
    const bool laser = c.configuration == 'C';
    const double g = laser ? 0.3 : c.configuration == 'B' ? 0.6 : 0.0;
    const std::string json = test::configurationA(c.order, c.unwarped, g);
    options.overrides = sampling.fields;
    options.overrides.emplace_back("integrator.type=path_tracer");
    const double unwarpedCentre = laser ? 3.5 : c.delta ? 2.2 : 2.5;
    const double width = c.delta ? 0.0 : 1.0, start = c.unwarped ? (laser ? 3.0 : 2.0) : 5.0;
    const double centre = c.delta ? (c.unwarped ? unwarpedCentre : 5.5) : start + 0.5 * width;
    options.overrides.push_back("integrator.transient_time_center=" + std::to_string(centre));
    if (c.delta) options.overrides.emplace_back("integrator.delta_time_gate=true");
    return test::renderWithPathTracer(laser ? test::withLaser(json) : json, options);
}

class GuidedOrders : public testing::TestWithParam<std::tuple<Sampling, Order>> {};

TEST_P(GuidedOrders, MatchVerifiedValues) {
    const auto& [sampling, c] = GetParam();
    const auto rendered = renderOrder(c, sampling, {{}, 40, sampling.samples});
    const double error = rendered->pixelError();
    constexpr double Rounding = 2e-4; // of the printed values, and of the pixel's width
    EXPECT_NEAR(rendered->mean(), c.expected, 4.0 * error + (sampling.slack + c.uncertainty + Rounding) * c.expected)
        << "standard error " << error;
    EXPECT_LT(error, (sampling.slack > 0.0 ? 0.07 : 0.015) * c.expected) << "the test would not see a wrong value";
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
}

/// Test names such as Best_B2UnwarpedDelta.
std::string nameOf(const testing::TestParamInfo<std::tuple<Sampling, Order>>& info) {
    const auto& [sampling, c] = info.param;
    return sampling.name + "_" + c.configuration + std::to_string(c.order) + (c.unwarped ? "Unwarped" : "Warped") +
           (c.delta ? "Delta" : "Box");
}

const std::vector<Order> Boxes{{'A', 1, false, false, 2.22436e-4},         {'A', 1, true, false, 11.1009e-4},
                               {'A', 2, false, false, 5.97962e-4},         {'A', 2, true, false, 29.4416e-4},
                               {'A', 3, false, false, 7.81135e-4},         {'A', 3, true, false, 22.1036e-4},
                               {'B', 2, false, false, 1.28207e-4, 0.002},  {'B', 2, true, false, 36.250e-4, 0.002},
                               {'B', 3, false, false, 1.900e-4, 0.008},    {'B', 3, true, false, 24.88e-4, 0.008},
                               {'C', 2, false, false, 9.56707e-5},         {'C', 2, true, false, 8.34604e-5},
                               {'C', 3, false, false, 10.6284e-5, 0.0024}, {'C', 3, true, false, 12.5775e-5, 0.0013}};
const std::vector<Order> Deltas{{'A', 1, false, true, 2.1055e-4},          {'A', 1, true, true, 26.6081e-4},
                                {'A', 2, false, true, 5.79199e-4},         {'A', 2, true, true, 40.7037e-4},
                                {'A', 3, false, true, 7.70375e-4},         {'A', 3, true, true, 24.0969e-4},
                                {'B', 2, false, true, 1.22185e-4, 0.0022}, {'B', 2, true, true, 67.886e-4, 0.0016},
                                {'C', 2, false, true, 8.55486e-5},         {'C', 2, true, true, 7.63581e-5}};
const std::vector<Order> Few{Boxes[2], Boxes[3], Boxes[4], Boxes[6], Boxes[10]};

INSTANTIATE_TEST_SUITE_P(BoxGates, GuidedOrders, testing::Combine(testing::ValuesIn(Presets), testing::ValuesIn(Boxes)),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(DeltaGates, GuidedOrders,
                         testing::Combine(testing::ValuesIn(Presets), testing::ValuesIn(Deltas)), nameOf);
INSTANTIATE_TEST_SUITE_P(SwitchesAlone, GuidedOrders,
                         testing::Combine(testing::ValuesIn(Switches), testing::ValuesIn(Few)), nameOf);

} // namespace
} // namespace tungsten::path
