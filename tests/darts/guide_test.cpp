// The pieces together: what a vertex's connections sum to, and the hard cases.

#include "darts/Guide.h"

#include "support/ChiSquare.h"
#include "support/LogUniform.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::logUniform;

/// From an isotropic vertex, all connections of one scattering with length in [low, high): the integral of
/// e^{-sigmaT S} ln((S + C) / (S - C)) / (C S) times sigmaS (the density g_1 of a walk of two flights, times 4 pi).
double onceScattered(double C, double low, double high, double sigmaS, double sigmaT) {
    return sigmaS * tungsten::test::integrate<61>(
                        [&](double S) { return std::exp(-sigmaT * S) * std::log((S + C) / (S - C)) / (C * S); },
                        std::max(low, C * (1.0 + 1e-12)), high, 20, 1e-10);
}

struct Geometry {
    double C, low, high;
};
const Geometry Geometries[] = {{1.0, 1.5, 1.6}, {1.0, 0.9, 1.1}, {2.0, 2.1, 2.1021}, {0.3, 5.0, 5.5}};

void expectOnceScattered(const Settings& settings, const Geometry& geometry, uint64_t seed) {
    const Medium medium{{0.2f, 0.2f, 0.2f}, {0.8f, 0.8f, 0.8f}, 0.0f};
    const Guide guide(settings, medium);
    const Vec3 target = directionAbout({0, 0, 1}, 0.7f, 0.2f) * float(geometry.C);
    const TimeBudget budget = TimeBudget::of(target, {geometry.low, geometry.high});
    double sum = 0.0, squares = 0.0;
    constexpr int Count = 60000;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler s(seed, RandomStream::Test, 0, i);
        const auto random = [&s] { return s.next1D(); };
        const HenyeyGreenstein isotropic{{1, 0, 0}, 0.0f};
        ConnectionSample connection = guide.sampleConnection(budget, s.next1D());
        const DirectionSample d = guide.sampleDirection(budget, connection, isotropic, random);
        if (!settings.lengthFirst) connection = guide.sampleConnectionAlong(budget, d.h, s.next1D());
        double value = 0.0;
        if (const auto v = guide.controlVertex(budget, connection, d.h, INFINITY)) {
            const double S = double(budget.C) + double(connection.excess), r = double(v->toTarget);
            value = 0.8 * std::exp(-S) * double(v->inversePdf) * double(d.inversePdf) / (4.0 * double(Pi) * r * r);
        }
        sum += value, squares += value * value;
    }
    const double mean = sum / Count, error = std::sqrt((squares / Count - mean * mean) / Count);
    EXPECT_NEAR(mean, onceScattered(geometry.C, geometry.low, geometry.high, 0.8, 1.0), 4.5 * error)
        << geometry.C << " " << geometry.low;
}

TEST(Guide, OnceScatteredLightMatchesItsClosedForm) {
    const auto table = EdaTable::shared(0.8f, 0.0f); // held for all the guides
    uint64_t seed = 40;
    for (const Geometry& geometry : Geometries)
        for (const Mode mode : {Mode::Path, Mode::Photon})
            for (const Direction direction : {Direction::Connection, Direction::Ris, Direction::Phase, Direction::Eda})
                for (const bool lengthFirst : {true, false}) {
                    // Phase-function directions have infinite variance where the range touches the straight line.
                    if (geometry.low < geometry.C && (direction == Direction::Phase || !lengthFirst)) continue;
                    Settings settings = best(mode, 0.0f);
                    settings.direction = direction;
                    settings.lengthFirst = lengthFirst;
                    expectOnceScattered(settings, geometry, ++seed);
                }
}

TEST(Guide, ControlVerticesFollowTheirDensityAlongTheRay) {
    const Guide guides[] = {Guide(best(Mode::Photon, 0.0f), Medium{{0.1f, 0, 0.4f}, {1, 1.5f, 1}, 0.0f}),
                            Guide(best(Mode::Path, 0.0f), Medium{{0, 0, 0}, {40, 40, 40}, 0.0f})};
    for (const Guide& guide : guides)
        for (const Geometry& geometry : Geometries)
            for (const float h : {1e-3f, 0.4f, 2.0f}) {
                const TimeBudget budget = TimeBudget::of({0, 0, float(geometry.C)}, {geometry.low, geometry.high});
                const double begin = Ellipse<double>{budget.C, budget.low, h}.firstLeg();
                const double end = double(budget.latest(h).firstLeg());
                const double p = tungsten::test::chiSquareInterval(
                    [&](Sampler& s) {
                        const auto connection = guide.sampleConnectionAlong(budget, h, s.next1D());
                        const auto vertex = guide.controlVertex(budget, connection, h, INFINITY);
                        return vertex ? double(vertex->distance) : -1.0;
                    },
                    [&](double t) { return double(guide.pdfControlVertex(budget, h, float(t))); },
                    tungsten::test::evenEdges(begin * 0.999999, end * 1.000001, 100));
                EXPECT_GT(p, tungsten::test::SmallestPValue) << geometry.C << " " << geometry.low << " " << h;
            }
}

TEST(Guide, LengthsBeforeASurfaceEndOnIt) {
    const Guide guide(published(Mode::Path), Medium{{0, 0, 0}, {1, 1, 1}, 0.0f});
    const TimeBudget budget = TimeBudget::of({0, 0, 1}, {1.2, 2.0});
    const float h = 0.6f;
    const float surface = Ellipse<float>{1.0f, 0.5f, h}.firstLeg(); // of S = 1.5
    const TimeBudget limited = Guide::beforeSurface(budget, h, surface);
    EXPECT_NEAR(limited.width, 0.3f, 1e-6f);
    const auto vertex =
        guide.controlVertex(limited, guide.sampleConnection(limited, 0.9999999f), h, surface * 1.00001f);
    ASSERT_TRUE(vertex);
    EXPECT_NEAR(vertex->distance, surface, 1e-5f);
    EXPECT_FALSE(Guide::beforeSurface(budget, h, 0.01f).alive());
    EXPECT_EQ(Guide::beforeSurface(budget, h, 100.0f).width, budget.width);
}

/// Directions suit the median of the lengths that are drawn, whichever was drawn.
TEST(Guide, LobesAreOfTheMedianLength) {
    for (const float g : {0.0f, 0.8f})
        for (const Geometry& geometry : Geometries) {
            const Medium medium{{0.2f, 0.2f, 0.2f}, {2.8f, 2.8f, 2.8f}, g};
            const Settings settings = best(Mode::Photon, g);
            const Guide guide(settings, medium);
            const TimeBudget budget = TimeBudget::of({0, 0, float(geometry.C)}, {geometry.low, geometry.high});
            std::vector<float> lengths;
            for (int i = 0; i < 2001; ++i)
                lengths.push_back(guide.sampleConnection(budget, (float(i) + 0.5f) / 2001.0f).excess);
            std::nth_element(lengths.begin(), lengths.begin() + 1000, lengths.end());
            const DirectionSampler directions(settings, medium);
            const HenyeyGreenstein phase{{0.6f, 0, 0.8f}, g};
            for (const float h : {1e-4f, 0.02f, 1.0f}) {
                const Vec3 direction = directionAbout(budget.axis, h, 0.3f);
                const auto drawn = guide.sampleConnection(budget, 0.9f);
                const float expected = directions.pdf(budget, lengths[1000], direction, phase);
                EXPECT_NEAR(guide.pdfDirection(budget, drawn, direction, phase) / expected, 1.0f, 0.02f)
                    << g << " " << geometry.C << " " << geometry.low << " " << h;
            }
        }
}

/// Random configurations of every size: floats against extended precision.
TEST(Guide, ControlVerticesStayExactAtTheHardCases) {
    uint64_t tested = 0;
    for (uint64_t i = 0; i < 200000; ++i) {
        Sampler s(6, RandomStream::Test, 0, i);
        const double scale = logUniform(s, 1e-4, 1e5), C = s.next1D() < 0.1f ? 0.0 : scale;
        const double high = C + scale * logUniform(s, 1e-6, 1e2), width = high * logUniform(s, 1e-7, 1.0);
        const double depth = logUniform(s, 1e-6, 1e4);
        const auto sigma = float(depth / high);
        const Guide guide(best(Mode::Photon, 0.0f), Medium{{0, 0, 0}, {sigma, sigma, sigma}, 0.0f});
        const TimeBudget budget = TimeBudget::of({0, float(C), 0}, {high - width, high});
        if (!budget.alive()) continue;
        const ConnectionSample connection = guide.sampleConnection(budget, s.next1D());
        ASSERT_TRUE(std::isfinite(connection.inversePdf) && connection.inversePdf >= 0.0f);
        ASSERT_TRUE(connection.excess >= budget.low && connection.excess <= budget.excess * 1.000001f);
        const float h = s.next1D() < 0.1f ? 0.0f : s.next1D() < 0.1f ? 2.0f : float(logUniform(s, 1e-12, 2.0));
        const auto vertex = guide.controlVertex(budget, connection, h, INFINITY);
        if (!vertex) continue;
        ++tested;
        const Ellipse<long double> exact{budget.C, connection.excess, h};
        const auto near = [](float value, long double expected) {
            return std::isfinite(value) && std::abs((long double)value - expected) <= 1e-5L * expected;
        };
        ASSERT_TRUE(near(vertex->distance, exact.firstLeg())) << C << " " << connection.excess << " " << h;
        ASSERT_TRUE(near(vertex->toTarget, exact.secondLeg())) << C << " " << connection.excess << " " << h;
        ASSERT_TRUE(near(vertex->inversePdf, exact.firstLegPerLength() * (long double)connection.inversePdf));
        const float useful = guide.logExpectedContribution(budget, 1.0f);
        ASSERT_TRUE(!std::isnan(useful) && useful < 1e30f) << C << " " << high;
        const float survival = guide.survival(budget.model, useful, useful + 3.0f);
        ASSERT_TRUE(survival >= 0.0f && survival <= 1.0f);
    }
    EXPECT_GT(tested, 100000u);
}

TEST(Guide, DirectionsStayFiniteAtTheHardCases) {
    for (uint64_t i = 0; i < 100000; ++i) {
        Sampler s(8, RandomStream::Test, 0, i);
        const double scale = logUniform(s, 1e-4, 1e5), C = s.next1D() < 0.1f ? 0.0 : scale;
        const float g = 0.99f * (2.0f * s.next1D() - 1.0f);
        const Guide guide(best(s.next1D() < 0.5f ? Mode::Path : Mode::Photon, g), Medium{{0, 0, 0}, {1, 1, 1}, g});
        const TimeBudget budget = TimeBudget::of({0, 0, float(C)}, {0.0, C + scale * logUniform(s, 1e-6, 1e2)});
        if (!budget.alive()) continue;
        const ConnectionSample connection = guide.sampleConnection(budget, s.next1D());
        const HenyeyGreenstein phase{{0, 1, 0}, g};
        const auto d = guide.sampleDirection(budget, connection, phase, [&s] { return s.next1D(); });
        ASSERT_TRUE(std::isfinite(d.inversePdf) && d.inversePdf >= 0.0f) << C << " " << g;
        ASSERT_NEAR(length(d.direction), 1.0f, 1e-4f);
        ASSERT_NEAR(d.inversePdf * guide.pdfDirection(budget, connection, d.direction, phase), 1.0f, 1e-3f);
        ASSERT_TRUE(d.h >= 0.0f && d.h <= 2.0f);
    }
}

} // namespace
} // namespace darts
