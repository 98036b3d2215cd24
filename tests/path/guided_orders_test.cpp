// Guided paths, order by order, against verified values (docs/photon-primitives.md, section 6): presets in full, every
// switch alone.

#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

using test::VerifiedValue;

/// How paths are sampled.
struct Sampling {
    std::string name;
    std::vector<std::string> fields;
    /// Relative allowance beside the standard error: directions that ignore the connection's weight have a heavy tail,
    /// and guides alone, whose directions suit its median length, where the gate holds the straight way; beside plain
    /// paths they have none.
    double slack;
    uint32_t samples = 5000; ///< per pass
};

/// Guided paths alone, unless `plainShare` says so.
std::string switches(const std::string& fields, const std::string& preset = "best",
                     const std::string& plainShare = "0") {
    return R"(integrator.darts={"preset": ")" + preset + R"(", "plain_share": )" + plainShare +
           (fields.empty() ? "" : ", " + fields) + "}";
}

const std::vector<Sampling> Presets{{"Best", {switches("")}, 0.01},
                                    {"BesideFewPlain", {switches("", "best", "0.1")}, 0.01},
                                    {"BesidePlain", {switches("", "best", "0.5")}, 0.01},
                                    {"BestByPilot", {"integrator.darts=best"}, 0.01},
                                    {"Published", {"integrator.darts=published"}, 0.01}};

const std::vector<Sampling> Switches{
    {"GuidingOnly", {"integrator.enable_guiding=true", "media.0.type=guided_homo"}, 0.03},
    {"EllipticalOnly", {"integrator.enable_elliptical=true"}, 0.02},
    {"PhaseDirections", {switches(R"("direction": "phase")")}, 0.02, 40000},
    {"EdaDirections", {switches(R"("direction": "eda")")}, 0.01},
    {"ConnectionLobe", {switches(R"("direction": "connection")")}, 0.01},
    {"DirectionRis", {switches(R"("direction": "ris", "length_first": true, "bounded": true)", "published")}, 0.0},
    {"Unbounded", {switches(R"("bounded": false)")}, 0.01},
    {"PlainDistances", {switches(R"("distance": "plain")")}, 0.01},
    {"Causal", {switches(R"("greens_function": "causal")")}, 0.01},
    {"Diffusion", {switches(R"("greens_function": "diffusion")")}, 0.01},
    {"LengthFirst", {switches(R"("direction": "connection", "length_first": true)", "published")}, 0.01},
    {"NoRoulette", {switches(R"("roulette": 0)")}, 0.01},
};

std::unique_ptr<test::Rendered> renderOrder(const VerifiedValue& value, const Sampling& sampling) {
    test::RenderOptions options{test::gateOf(value), 40, sampling.samples};
    options.overrides.insert(options.overrides.end(), sampling.fields.begin(), sampling.fields.end());
    options.overrides.emplace_back("integrator.type=path_tracer");
    return test::renderPaths(test::sceneOf(value), options);
}

class GuidedOrders : public testing::TestWithParam<std::tuple<Sampling, VerifiedValue>> {};

TEST_P(GuidedOrders, MatchVerifiedValues) {
    const test::OtherSeeds seeds{{"Published_B2WarpedDelta", 1}, {"Published_B2UnwarpedBox", 1}};
    const auto& [sampling, value] = GetParam();
    const auto rendered = renderOrder(value, sampling);
    const double error = rendered->pixelError(), expected = value.radiance;
    constexpr double Rounding = 2e-4; // of the printed values, and of the pixel's width
    EXPECT_NEAR(rendered->mean(), expected, 4.0 * (error + value.uncertainty) + (sampling.slack + Rounding) * expected)
        << "standard error " << error;
    EXPECT_LT(error, (sampling.slack > 0.0 ? 0.07 : 0.015) * expected) << "the test would not see a wrong value";
    EXPECT_EQ(rendered->statistics.counter("non-finite samples"), 0u);
}

/// Test names such as Best_B2UnwarpedDelta.
std::string nameOf(const testing::TestParamInfo<std::tuple<Sampling, VerifiedValue>>& info) {
    const auto& [sampling, value] = info.param;
    return sampling.name + "_" + test::nameOf(value);
}

// Every configuration, order, way to count time and kind of gate, not the product of them.
const std::vector<VerifiedValue> Boxes{test::verified("A1UnwarpedBox"), test::verified("A2WarpedBox"),
                                       test::verified("A3UnwarpedBox"), test::verified("B2UnwarpedBox"),
                                       test::verified("B3WarpedBox"),   test::verified("C2WarpedBox"),
                                       test::verified("C3UnwarpedBox")};
const std::vector<VerifiedValue> Deltas{test::verified("A1WarpedDelta"), test::verified("A2UnwarpedDelta"),
                                        test::verified("A3WarpedDelta"), test::verified("B2WarpedDelta"),
                                        test::verified("C2UnwarpedDelta")};
const std::vector<VerifiedValue> Few{test::verified("A3UnwarpedBox"), test::verified("B2WarpedBox"),
                                     test::verified("C2WarpedBox")};

INSTANTIATE_TEST_SUITE_P(BoxGates, GuidedOrders, testing::Combine(testing::ValuesIn(Presets), testing::ValuesIn(Boxes)),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(DeltaGates, GuidedOrders,
                         testing::Combine(testing::ValuesIn(Presets), testing::ValuesIn(Deltas)), nameOf);
INSTANTIATE_TEST_SUITE_P(SwitchesAlone, GuidedOrders,
                         testing::Combine(testing::ValuesIn(Switches), testing::ValuesIn(Few)), nameOf);

} // namespace
} // namespace tungsten::path
