// The densities that candidate distances come from.

#include "darts/CandidateKernel.h"

#include "support/ChiSquare.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::Sampler;
constexpr int N = 8;

CandidateDraw drawOf(const Medium& medium, float C, float excess, float h, float bound, Proposals proposals) {
    CandidateDraw draw;
    draw.latest = {C, excess, h};
    draw.firstLeg = draw.latest.firstLeg();
    draw.bound = std::min(bound, draw.firstLeg);
    draw.proposals = proposals;
    draw.throughput = {0.5f, 1.0f, 0.8f};
    draw.medium = &medium;
    return draw;
}

/// A candidate chosen evenly among the N has the mixture's density, which integrates to 1 over [0, bound).
template <int Channels>
void expectSamplesDensity(const CandidateDraw& draw) {
    const Proposal<float, N, Channels> proposal(draw);
    const double bound = draw.bound;
    float transmittance = 0.0f;
    const auto density = [&](double d) { return double(proposal.pdf(float(d), transmittance)); };
    auto edges = tungsten::test::ratioEdges(bound * 1e-6, bound, 100);
    edges.insert(edges.begin(), 0.0);
    double integral = 0.0;
    for (size_t i = 0; i + 1 < edges.size(); ++i)
        integral += tungsten::test::integrate<15>(density, edges[i], edges[i + 1], 8, 1e-7);
    EXPECT_NEAR(integral, 1.0, 1e-5);
    edges.back() = bound * 1.000001;
    const double p = tungsten::test::chiSquareInterval(
        [&](Sampler& s) {
            const int lane = std::min(int(s.next1D() * N), N - 1);
            float pdf = 0.0f;
            const float d = proposal.sample(s.next1D(), lane, pdf, transmittance);
            if (Channels == 1) {
                EXPECT_NEAR(transmittance, std::exp(-draw.medium->sigmaS.x * d), 1e-6f) << d;
            }
            EXPECT_NEAR(pdf / proposal.pdf(d, transmittance), 1.0f, 2e-5f) << d;
            EXPECT_TRUE(d >= 0.0f && d <= draw.bound);
            return double(d);
        },
        density, edges);
    EXPECT_GT(p, tungsten::test::SmallestPValue);
}

TEST(Proposal, EveryKindSamplesItsDensityWhichIntegratesToOne) {
    for (const Proposals kind :
         {Proposals::Exponential, Proposals::MixedUniform, Proposals::MixedQuarter, Proposals::Equiangular})
        for (const float depth : {1e-6f, 0.04f, 0.06f, 1.0f, 60.0f})
            for (const float excess : {1e-3f, 4.0f})
                for (const float h : {1e-4f, 0.7f}) {
                    SCOPED_TRACE(testing::Message() << "proposals " << int(kind) << " depth " << depth << " excess "
                                                    << excess << " h " << h);
                    const Medium grey{{0, 0, 0}, {depth, depth, depth}, 0.0f};
                    expectSamplesDensity<1>(drawOf(grey, 1.0f, excess, h, INFINITY, kind));
                    const Medium coloured{{0.1f * depth, 0, 0}, {0.2f * depth, depth, 0.5f * depth}, 0.0f};
                    expectSamplesDensity<3>(drawOf(coloured, 1.0f, excess, h, 0.9f, kind));
                }
}

/// Registers are as good as the standard library.
TEST(Lanes, ExponentialAndLogarithm) {
    using Register = RegisterOf<8>;
    alignas(64) std::array<float, 8> in{}, out{};
    for (int i = 0; i < 200000; ++i) {
        Sampler s(31, tungsten::RandomStream::Test, 0, uint64_t(i));
        const float x = i % 2 ? -87.0f * s.next1D() : 88.0f * std::exp(-20.0f * s.next1D());
        in.fill(x);
        lanes::put(out.data(), lanes::exp(lanes::get<Register>(in.data())));
        ASSERT_NEAR(double(out[0]) / std::exp(double(x)), 1.0, 4e-7 + 6e-8 * std::abs(double(x))) << x;
        const float y = i % 2 ? std::exp(176.0f * s.next1D() - 87.0f) : 1.0f + 0.01f * (s.next1D() - 0.5f);
        in.fill(y);
        lanes::put(out.data(), lanes::log(lanes::get<Register>(in.data())));
        ASSERT_NEAR(double(out[0]), std::log(double(y)), 3e-7 * std::abs(std::log(double(y)))) << y;
    }
    in.fill(-1e30f);
    lanes::put(out.data(), lanes::exp(lanes::get<Register>(in.data())));
    EXPECT_NEAR(out[0] / std::exp(-87.0f), 1.0f, 1e-5f); // never zero
}

TEST(Lanes, ChoiceInProportionToWeights) {
    constexpr int Draws = 100000;
    const std::array<float, 8> weights{0.0f, 1.0f, 0.0f, 5.0f, 2.0f, 0.0f, 0.5f, 0.0f};
    std::vector<double> observed(8, 0.0), expected;
    for (const float w : weights) expected.push_back(double(w) / 8.5 * Draws);
    float sum = 0.0f;
    for (int i = 0; i < Draws; ++i) {
        Sampler s(32, tungsten::RandomStream::Test, 0, uint64_t(i));
        observed[lanes::choose<8>(weights.data(), s.next1D(), sum)] += 1.0;
    }
    EXPECT_EQ(sum, 8.5f);
    EXPECT_GT(tungsten::test::chiSquarePValue(observed, expected), tungsten::test::SmallestPValue);
    for (const size_t never : {0u, 2u, 5u, 7u}) EXPECT_EQ(observed[never], 0.0);
    EXPECT_EQ(lanes::choose<8>(weights.data(), 1.0f, sum), 6u); // rounded up, beyond the last positive weight
}

TEST(Proposal, NothingBoundsTheExponential) {
    const Medium medium{{0, 0, 0}, {2, 2, 2}, 0.0f};
    CandidateDraw draw = drawOf(medium, 1.0f, 0.5f, 0.7f, INFINITY, Proposals::MixedUniform);
    draw.bound = INFINITY; // where a mixture would have to be infinite
    const Proposal<float, N, 1> proposal(draw);
    const double p = tungsten::test::chiSquareUniform([&](Sampler& s) {
        float pdf = 0.0f, transmittance = 0.0f;
        const float d = proposal.sample(s.next1D(), 0, pdf, transmittance);
        EXPECT_NEAR(pdf, 2.0f * std::exp(-2.0f * d), 1e-6f);
        return 1.0 - std::exp(-2.0 * double(d));
    });
    EXPECT_GT(p, tungsten::test::SmallestPValue);
}

} // namespace
} // namespace darts
