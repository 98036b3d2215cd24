// Distances by a density whose logarithm is linear between nodes: it integrates to 1, and samples follow it.

#include "darts/DistanceSampler.h"
#include "darts/FastMath.h"

#include "support/BodyExit.h"
#include "support/ChiSquare.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::Sampler;
using tungsten::test::outOf;

constexpr Shape Shapes[] = {Shape::TimeBound, Shape::Diffusion, Shape::Causal, Shape::FirstPassage};

/// A draw along a ray with h to the target's direction; `surface` and `kink` in parts of the first leg, `depth` the
/// optical depth up to the bound.
struct Drawn {
    Medium medium;
    TimeBudget budget = outOf(0.4, 1.0, 1.9, 0.1);
    CandidateDraw draw;

    Drawn(bool grey, float depth, float surface, float kink, float h = 0.6f) {
        draw.latest = budget.latest(h);
        draw.firstLeg = draw.latest.firstLeg();
        draw.bound = draw.firstLeg * std::min(surface, 1.0f);
        draw.kink = draw.firstLeg * kink;
        draw.gateWidth = budget.width;
        draw.overlap = true;
        draw.throughput = {0.5f, 1.0f, 0.8f};
        draw.escape = &budget.escape;
        draw.direction = directionAbout(budget.axis, h, 0.3f);
        const float s = 0.8f * depth / draw.bound, a = 0.2f * depth / draw.bound;
        medium = grey ? Medium{{a, a, a}, {s, s, s}, 0.2f} : Medium{{a, 0, 2 * a}, {0.3f * s, s, 1.7f * s}, 0.2f};
        draw.medium = &medium;
    }
    Drawn(const Drawn&) = delete;
    Drawn& operator=(const Drawn&) = delete;

    LogLinearDistance distance(Shape shape, bool scalar = false) const {
        return {draw, LogLinearDistance::logImportance(shape, medium.isGrey(), scalar)};
    }
};

template <typename Use>
void forEveryDraw(const Use& use) {
    for (const Shape shape : Shapes)
        for (const bool grey : {true, false})
            for (const float depth : {1e-6f, 0.2f, 1.0f, 30.0f, 1e4f})
                for (const float surface : {0.4f, 1.0f})
                    for (const float kink : {0.0f, 0.5f, 0.999f, 0.9999f}) {
                        if (surface < 1.0f && kink > 0.6f) continue; // beyond the bound
                        SCOPED_TRACE(testing::Message() << "shape " << int(shape) << " grey " << grey << " depth "
                                                        << depth << " surface " << surface << " kink " << kink);
                        Drawn drawn(grey, depth, surface, kink);
                        drawn.draw.power = shape == Shape::FirstPassage ? 0.5f : 1.0f;
                        use(drawn, shape);
                    }
}

/// Fine where flights are short, and towards the bound, where importance falls.
std::vector<double> edgesUpTo(double bound) {
    auto edges = tungsten::test::ratioEdges(bound * 1e-6, bound * 0.5, 60);
    const auto back = tungsten::test::ratioEdges(bound * 1e-5, bound * 0.5, 40);
    edges.insert(edges.begin(), 0.0);
    for (size_t i = back.size() - 1; i-- > 0;) edges.push_back(bound - back[i]);
    edges.push_back(bound);
    return edges;
}

TEST(LogLinearDistance, SamplesFollowTheDensityWhichIntegratesToOne) {
    forEveryDraw([](const Drawn& drawn, Shape shape) {
        const LogLinearDistance distance = drawn.distance(shape);
        const double bound = drawn.draw.bound;
        const auto density = [&](double d) { return double(distance.pdf(float(d))); };
        auto edges = edgesUpTo(bound);
        double integral = 0.0;
        for (size_t i = 0; i + 1 < edges.size(); ++i)
            integral += tungsten::test::integrate<15>(density, edges[i], edges[i + 1], 8, 1e-7);
        EXPECT_NEAR(integral, 1.0, 2e-5);
        EXPECT_EQ(distance.pdf(float(bound)), 0.0f);
        EXPECT_EQ(distance.pdf(-1e-3f), 0.0f);
        // The last numbers there are lead nowhere that is less likely than they are.
        for (const float u : {BelowOne, 1.0f - 2 * 0x1p-24f, 1.0f - 3 * 0x1p-24f})
            EXPECT_GT(density(double(distance.sample(u).distance)) * bound, 5e-10) << u;
        edges.back() = bound * 1.000001;
        const double p = tungsten::test::chiSquareInterval(
            [&](Sampler& s) {
                const auto [d, pdf] = distance.sample(s.next1D());
                EXPECT_TRUE(d >= 0.0f && d < drawn.draw.bound) << d;
                EXPECT_GT(pdf, 0.0f) << d;
                EXPECT_NEAR(distance.pdf(d), pdf, 1e-3f * pdf) << d;
                return double(d);
            },
            density, edges, 13, 20000);
        EXPECT_GT(p, tungsten::test::SmallestPValue);
    });
}

/// Over a free flight, up to a factor; but for the last interval, where importance falls to nothing.
TEST(LogLinearDistance, FollowsAPowerOfImportance) {
    forEveryDraw([](const Drawn& drawn, Shape shape) {
        const float sigmaT = mean(drawn.medium.sigmaT());
        if (sigmaT * drawn.draw.bound > 100.0f) return; // logarithms as low as are kept
        const auto importance = LogLinearDistance::logImportance(shape, drawn.medium.isGrey());
        CandidateDraw draw = drawn.draw;
        draw.power = 1.0f;
        const LogLinearDistance full(draw, importance);
        draw.power = 0.5f;
        const LogLinearDistance root(draw, importance);
        const auto difference = [&](float d) {
            return std::log(root.pdf(d)) - 0.5f * std::log(full.pdf(d)) + 0.5f * sigmaT * d;
        };
        for (const float d : {0.1f, 0.3f, 0.5f}) {
            const float at = d * drawn.draw.bound;
            EXPECT_NEAR(difference(at), difference(0.0f), 2e-4f) << at;
        }
    });
}

TEST(LogLinearDistance, RegistersAndSingleNodesAgree) {
    forEveryDraw([](const Drawn& drawn, Shape shape) {
        const LogLinearDistance wide = drawn.distance(shape), single = drawn.distance(shape, true);
        for (int i = 0; i < 100; ++i) {
            const float u = (float(i) + 0.5f) / 100.0f, d = single.sample(u).distance;
            // Of exponents up to 57: importance in registers is right to 3e-3 for bodies, else to a few 1e-6.
            const float bound = shape == Shape::FirstPassage ? 6e-3f : 3e-4f;
            EXPECT_NEAR(wide.pdf(d) / single.pdf(d), 1.0f, bound) << d;
        }
    });
}

/// Without a gate to narrow it, what is bounded by time alone is a free flight that is cut off.
TEST(LogLinearDistance, ByTimeAloneIsTheTruncatedExponential) {
    for (const float depth : {1e-6f, 0.2f, 1.0f, 30.0f, 1e4f})
        for (const float surface : {0.4f, 1.0f}) {
            Drawn drawn(true, depth, surface, 0.5f);
            drawn.draw.overlap = drawn.draw.falls = false;
            const LogLinearDistance distance = drawn.distance(Shape::TimeBound);
            const double bound = drawn.draw.bound, sigmaT = mean(drawn.medium.sigmaT()),
                         all = -std::expm1(-sigmaT * bound);
            for (int i = 0; i < 200; ++i) {
                const double u = (i + 0.5) / 200.0, d = -std::log1p(-u * all) / sigmaT;
                EXPECT_NEAR(double(distance.sample(float(u)).distance) / d, 1.0, 2e-5) << depth << " " << u;
                EXPECT_NEAR(double(distance.pdf(float(d))) * all / (sigmaT * std::exp(-sigmaT * d)), 1.0, 2e-5)
                    << depth << " " << d;
            }
        }
}

/// Plain flights with bounds in time: every draw has the same weight.
TEST(LogLinearDistance, OfPlainFlightsHasNoNoise) {
    const Medium medium{{0.2f, 0.2f, 0.2f}, {1.8f, 1.8f, 1.8f}, 0.0f};
    const DistanceSampler sampler(plainFlights(best(Mode::Path, 0.0f)), medium);
    const TimeBudget budget = TimeBudget::of({0, 0, 1}, {1.4, 1.5});
    const float end = budget.latest(0.4f).firstLeg();
    for (int i = 0; i < 100; ++i) {
        const DistanceSample sample =
            sampler.sample(budget, {{}, 0.4f}, INFINITY, {1, 1, 1}, {0.5f, 0.5f, float(i) / 100.0f, 0.5f});
        EXPECT_NEAR(sample.transmittanceOverPdf.x, -std::expm1(-2.0f * end) / 2.0f, 1e-5f);
    }
}

/// CandidateImportance includes the part of the gate that is left: S - d - rho of the latest arrival over the gate, at
/// most 1.
TEST(LogLinearDistance, NodesKnowThePartOfTheGateStillInReach) {
    for (const Shape shape : {Shape::TimeBound, Shape::Diffusion, Shape::Causal}) {
        Drawn drawn(true, 1.0f, 1.0f, 0.0f);
        alignas(64) std::array<float, LogLinearDistance::Nodes> at{}, with{}, without{};
        for (size_t j = 0; j < at.size(); ++j) at[j] = drawn.draw.firstLeg * (1.0f - std::exp2(-float(j)));
        const auto importance = LogLinearDistance::logImportance(shape, true);
        importance(drawn.draw, at.data(), with.data());
        drawn.draw.overlap = false;
        importance(drawn.draw, at.data(), without.data());
        const Ellipse<double> e{drawn.draw.latest.C, drawn.draw.latest.delta, drawn.draw.latest.h};
        for (size_t j = 0; j < at.size(); ++j) {
            const double left = e.length() - double(at[j]) - e.distanceToTarget(double(at[j]));
            EXPECT_NEAR(double(with[j] - without[j]), std::log(std::min(left / double(drawn.draw.gateWidth), 1.0)),
                        1e-4)
                << j;
        }
    }
}

/// The nodes are the target's own: where it is log-linear between them, so is the density in proportion to it.
TEST(LogLinearDistance, IsInProportionToUsefulnessAtItsNodes) {
    for (const Shape shape : Shapes)
        for (const float depth : {1.0f, 30.0f}) {
            const Drawn drawn(true, depth, 0.4f, 0.0f);
            const LogLinearDistance distance = drawn.distance(shape);
            alignas(64) std::array<float, LogLinearDistance::Nodes> at{}, logs{};
            for (size_t j = 0; j < 3; ++j) {
                const float even = float(j + 1) / 4.0f, deep = -std::log1p(-even);
                at[j + 1] = deep * drawn.draw.bound / std::hypot(depth, deep / even);
            }
            LogLinearDistance::logImportance(shape, true)(drawn.draw, at.data(), logs.data());
            for (size_t j = 0; j < 4; ++j)
                EXPECT_NEAR(std::log(distance.pdf(at[j]) / distance.pdf(0.0f)), logs[j] - logs[0], 2e-4f)
                    << int(shape) << " " << depth << " " << j;
        }
}

} // namespace
} // namespace darts
