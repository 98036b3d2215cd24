// The densities that candidate distances come from.

#include "darts/CandidateKernel.h"

#include "support/ChiSquare.h"

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
    const auto density = [&](double d) { return double(proposal.pdf(float(d))); };
    auto edges = tungsten::test::ratioEdges(bound * 1e-6, bound, 100);
    edges.insert(edges.begin(), 0.0);
    double integral = 0.0;
    for (size_t i = 0; i + 1 < edges.size(); ++i)
        integral +=
            boost::math::quadrature::gauss_kronrod<double, 15>::integrate(density, edges[i], edges[i + 1], 8, 1e-7);
    EXPECT_NEAR(integral, 1.0, 1e-5);
    edges.back() = bound * 1.000001;
    const double p = tungsten::test::chiSquareInterval(
        [&](Sampler& s) {
            const int lane = std::min(int(s.next1D() * N), N - 1);
            float pdf = 0.0f;
            const float d = proposal.sample(s.next1D(), lane, pdf);
            EXPECT_NEAR(pdf / proposal.pdf(d), 1.0f, 2e-5f) << d;
            EXPECT_TRUE(d >= 0.0f && d <= draw.bound);
            return double(d);
        },
        density, edges);
    EXPECT_GT(p, tungsten::test::SmallestPValue);
}

TEST(Proposal, EveryKindSamplesItsDensityWhichIntegratesToOne) {
    for (const Proposals kind :
         {Proposals::Exponential, Proposals::MixedUniform, Proposals::MixedQuarter, Proposals::Equiangular})
        for (const float depth : {1e-6f, 0.04f, 0.06f, 1.0f, 8.0f, 60.0f})
            for (const float excess : {1e-3f, 0.5f, 4.0f})
                for (const float h : {1e-4f, 0.7f}) {
                    SCOPED_TRACE(testing::Message() << "proposals " << int(kind) << " depth " << depth << " excess "
                                                    << excess << " h " << h);
                    const Medium grey{{0, 0, 0}, {depth, depth, depth}, 0.0f};
                    expectSamplesDensity<1>(drawOf(grey, 1.0f, excess, h, INFINITY, kind));
                    const Medium coloured{{0.1f * depth, 0, 0}, {0.2f * depth, depth, 0.5f * depth}, 0.0f};
                    expectSamplesDensity<3>(drawOf(coloured, 1.0f, excess, h, 0.9f, kind));
                }
}

TEST(Proposal, NothingBoundsTheExponential) {
    const Medium medium{{0, 0, 0}, {2, 2, 2}, 0.0f};
    CandidateDraw draw = drawOf(medium, 1.0f, 0.5f, 0.7f, INFINITY, Proposals::MixedUniform);
    draw.bound = INFINITY; // where a mixture would have to be infinite
    const Proposal<float, N, 1> proposal(draw);
    const double p = tungsten::test::chiSquareUniform([&](Sampler& s) {
        float pdf = 0.0f;
        const float d = proposal.sample(s.next1D(), 0, pdf);
        EXPECT_NEAR(pdf, 2.0f * std::exp(-2.0f * d), 1e-6f);
        return 1.0 - std::exp(-2.0 * double(d));
    });
    EXPECT_GT(p, tungsten::test::SmallestPValue);
}

} // namespace
} // namespace darts
