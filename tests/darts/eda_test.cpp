// The EDA table against its definition by adaptive quadrature in extended precision, and its samples against its
// density.

#include "support/ChiSquare.h"

#include "darts/EdaTable.h"
#include "darts/Ellipse.h"
#include "darts/GreensFunction.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <thread>

namespace darts {
namespace {

using boost::math::quadrature::gauss_kronrod;
using tungsten::RandomStream;
using tungsten::Sampler;
using Real = long double;

struct Scattering {
    float albedo, g;
};

/// log f by its definition, up to a constant: int_0^t e^{-tau} Phi(rho(tau), S - tau) dtau with sigmaT = 1.
Real definition(const Scattering& medium, Real C, Real delta, Real h) {
    const Real albedo = medium.albedo, g = medium.g;
    const DiffusionGreensFunction<Real> phi{1 - albedo, albedo, g};
    const Ellipse<Real> e{C, delta, h};
    const Real t = e.firstLeg(), r = e.secondLeg();
    const auto logIntegrand = [&](Real tau, Real rest) { // rest = t - tau
        return -tau + phi.log(std::min(e.distanceToTarget(tau), (r + rest) * (1 - 1e-18L)), r + rest);
    };
    // Panels shrink toward both ends: the integrand may change within a mean free path of the vertex, and within r of
    // the ellipse.
    constexpr int Panels = 16, Probes = 16;
    const auto edge = [&](int i) { return i == Panels ? Real(0) : t / 2 * std::pow(Real(0.25), Real(i)); };
    const auto nearVertex = [&](Real x) { return logIntegrand(x, t - x); };
    const auto nearEllipse = [&](Real x) { return logIntegrand(t - x, x); };
    const auto largest = [&](auto&& f, int panel) {
        Real result = -std::numeric_limits<Real>::infinity();
        for (int i = 0; i < Probes; ++i)
            result = std::max(result, f(std::lerp(edge(panel + 1), edge(panel), (i + 0.5L) / Probes)));
        return result;
    };
    Real maximum = -std::numeric_limits<Real>::infinity(), sum = 0;
    for (int i = 0; i < Panels; ++i) maximum = std::max({maximum, largest(nearVertex, i), largest(nearEllipse, i)});
    const auto integrate = [&](auto&& f, int panel) {
        if (largest(f, panel) < maximum - 25) return Real(0);
        return gauss_kronrod<Real, 31>::integrate([&](Real x) { return std::exp(f(x) - maximum); }, edge(panel + 1),
                                                  edge(panel), 6, 1e-5L);
    };
    for (int i = 0; i < Panels; ++i) sum += integrate(nearVertex, i) + integrate(nearEllipse, i);
    return maximum + std::log(sum);
}

TEST(EdaDensity, AgreesWithItsDefinitionInExtendedPrecision) {
    for (const Scattering medium : {Scattering{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 0.99f}, {0.9f, -0.99f}, {0.5f, 0.3f}})
        for (const double S : {1e-6, 1.0, 30.0, 1e4})
            for (const double excess : {1e-7, 1e-3, 0.3, 1.0}) {
                const double C = S * (1.0 - excess), delta = S * excess;
                const double back = edaLogDensity(medium.albedo, medium.g, C, delta, 2.0);
                const Real exactBack = definition(medium, C, delta, 2);
                for (const double h : {0.0, 1e-12, 1e-5, 0.05, 1.0}) {
                    const double value = edaLogDensity(medium.albedo, medium.g, C, delta, h) - back;
                    EXPECT_NEAR(value, double(definition(medium, C, delta, h) - exactBack), 2e-4)
                        << medium.albedo << " " << medium.g << ", S " << S << " excess " << excess << " h " << h;
                }
            }
}

/// int f dh over [from, to], relative to e^scale; over sqrt(h) because of the needle.
double integralOfDensity(const Scattering& m, double C, double delta, double from, double to, double scale) {
    return gauss_kronrod<double, 15>::integrate(
        [&](double root) { return 2.0 * root * std::exp(edaLogDensity(m.albedo, m.g, C, delta, root * root) - scale); },
        std::sqrt(from), std::sqrt(to), 8, 1e-6);
}

/// Every bin of the row at its own C = S - delta holds the density's integral, and so follows it.
void expectRowFollowsDensity(const EdaTable& table, double S, double excess) {
    const Scattering medium{table.albedo(), table.g()};
    const double delta = S * excess, C = S - delta, floor = table.resolution().floor;
    const auto logF = [&](double h) { return edaLogDensity(medium.albedo, medium.g, C, delta, h); };
    const EdaTable::Row row = table.row(float(C), float(delta), 1.0f);
    std::vector<double> integrals;
    for (int bin = 0; bin < row.bins(); ++bin)
        integrals.push_back(integralOfDensity(medium, C, delta, row.edge(bin), row.edge(bin + 1), logF(0.0)));
    const double total = std::accumulate(integrals.begin(), integrals.end(), 0.0);
    const Real exactBack = definition(medium, C, delta, 2);
    for (int bin = 0; bin < row.bins(); ++bin) {
        const double width = row.edge(bin + 1) - row.edge(bin);
        const double even = 0.5 * floor * (0.5 * width + 1.0 / row.bins());
        const double mass = (1.0 - floor) * integrals[size_t(bin)] / total + even;
        // The first bin holds the needle's tip, h < (delta / C)^2, which may slip between nodes.
        ASSERT_NEAR(row.mass(bin) / mass, 1.0, bin == 0 ? 0.05 : 5e-3) << S << " " << excess << " " << bin;
        if (bin % 3 != 1) continue; // the definition takes its time
        const double centre = row.edge(bin) + 0.5 * width;
        const double exact = std::exp(double(definition(medium, C, delta, centre) - exactBack) + logF(2.0) - logF(0.0));
        const double density = ((1.0 - floor) * exact / total + even / width) / 6.283185307;
        // A bin's average lies above a convex density's centre; where f falls exponentially, by several per cent.
        ASSERT_NEAR(row.pdf(float(centre)) / density, 1.0, 0.1) << S << " " << excess << " " << bin;
    }
}

TEST(EdaTable, BinsHoldTheDensitysIntegralsAndFollowItAtTheirCentres) {
    EdaResolution resolution;
    resolution.log2ExcessPerOctave = 0; // fewer rows to build
    for (const Scattering medium : {Scattering{0.9f, 0.0f}, {1.0f, 0.85f}, {0.5f, -0.5f}}) {
        const EdaTable table = EdaTable::build(medium.albedo, medium.g, resolution);
        for (const int excess : {0, 6, 13, 19})
            for (const int depth : {2, 14, 22, 30})
                expectRowFollowsDensity(table, resolution.depth().centre(depth), resolution.excess().centre(excess));
    }
}

/// The cumulative distribution that belongs to a density, by midpoints spaced evenly in log h.
class Cumulative {
  public:
    template <typename Density>
    explicit Cumulative(const Density& density) : sums_{0.0} {
        for (int i = 0; i < Points; ++i) {
            const double h = at(i + 0.5);
            sums_.push_back(sums_.back() + density(float(h)) * h * Step * 6.283185307179586);
        }
    }
    [[nodiscard]] double total() const { return sums_.back(); }
    [[nodiscard]] double operator()(double h) const {
        const double x = std::clamp((std::log(h) - std::log(Least)) / Step, 0.0, double(Points) - 1e-6);
        const auto i = size_t(x);
        return std::lerp(sums_[i], sums_[i + 1], x - double(i));
    }

  private:
    static constexpr int Points = 60000;
    static constexpr double Least = 1e-16;
    static inline const double Step = std::log(2.0 / Least) / Points;
    static double at(double i) { return Least * std::exp(i * Step); }
    std::vector<double> sums_;
};

constexpr std::array<float, 7> Excesses{1.0f, 0.7f, 0.1f, 0.01f, 1e-4f, 1e-6f, 1e-7f};
constexpr std::array<float, 6> Depths{1e-6f, 0.1f, 1.0f, 13.0f, 200.0f, 1e4f};

TEST(EdaTable, SamplesFollowTheDensityWhichIntegratesToOne) {
    for (const Scattering medium : {Scattering{0.9f, 0.0f}, {1.0f, 0.85f}, {0.5f, -0.5f}}) {
        const EdaTable table = EdaTable::build(medium.albedo, medium.g);
        for (const float excess : Excesses)
            for (const float depth : Depths) {
                const float sigmaT = 3.0f, S = depth / sigmaT, delta = S * excess, C = S - delta;
                const Cumulative cumulative([&](float h) { return table.pdf(C, delta, sigmaT, h); });
                EXPECT_NEAR(cumulative.total(), 1.0, 1e-3) << excess << " " << depth;
                const double p = tungsten::test::chiSquareUniform(
                    [&](Sampler& s) { return cumulative(table.sample(C, delta, sigmaT, s.next1D())); }, 12, 20000);
                EXPECT_GT(p, tungsten::test::SmallestPValue)
                    << medium.albedo << " " << medium.g << ", excess " << excess << " depth " << depth;
            }
    }
}

TEST(EdaTable, SamplesFillTheSphereAboutTheTargetsDirection) {
    const EdaTable table = EdaTable::build(0.9f, 0.3f);
    const double p = tungsten::test::chiSquareSphere(
        [&](Sampler& s) {
            const float cosTheta = 1.0f - table.sample(0.7f, 0.6f, 2.0f, s.next1D());
            const float sinTheta = std::sqrt(std::max(0.0f, 1.0f - cosTheta * cosTheta)), phi = 6.2831853f * s.next1D();
            return tungsten::Vec3f(sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta);
        },
        [&](const tungsten::Vec3f& w) { return table.pdf(0.7f, 0.6f, 2.0f, std::max(1.0f - w.z, 0.0f)); });
    EXPECT_GT(p, tungsten::test::SmallestPValue);
}

TEST(EdaTable, NearestRowsServeEverywhere) {
    // The second moment of f / p, 1 for a perfect table, at vertices between the bins' centres.
    for (const Scattering medium : {Scattering{0.9f, 0.0f}, {1.0f, 0.85f}, {0.9f, -0.5f}}) {
        const EdaTable table = EdaTable::build(medium.albedo, medium.g);
        for (uint64_t i = 0; i < 200; ++i) {
            Sampler s(3, RandomStream::Test, 0, i);
            const double S = std::exp2(-7.0 + 15.0 * s.nextDouble()), delta = S * std::exp2(-20.0 * s.nextDouble());
            const double C = S - delta, scale = edaLogDensity(medium.albedo, medium.g, C, delta, 0.0);
            const EdaTable::Row row = table.row(float(C), float(delta), 1.0f);
            double total = 0.0, second = 0.0;
            for (int bin = 0; bin < row.bins(); ++bin) {
                const double low = std::sqrt(double(row.edge(bin))), high = std::sqrt(double(row.edge(bin + 1)));
                const double density = row.mass(bin) / (high * high - low * low);
                for (int k = 0; k < 4; ++k) {
                    const double root = low + (high - low) * (k + 0.5) / 4.0, dh = 2.0 * root * (high - low) / 4.0;
                    const double f = std::exp(edaLogDensity(medium.albedo, medium.g, C, delta, root * root) - scale);
                    total += f * dh;
                    second += f * f / density * dh;
                }
            }
            EXPECT_LT(second / (total * total), 1.1)
                << medium.albedo << " " << medium.g << ", S " << S << " excess " << delta / S;
        }
    }
}

TEST(EdaTable, HardCasesAreFiniteAndPositive) {
    EdaResolution coarse;
    coarse.log2ExcessPerOctave = coarse.log2DepthPerOctave = 0;
    for (const float albedo : {0.0f, 0.5f, 1.0f})
        for (const float g : {-1.0f, -0.99f, 0.0f, 0.99f, 1.0f}) {
            const EdaTable table = EdaTable::build(albedo, g, coarse);
            for (const float scale : {1e-4f, 1.0f, 1e5f})
                for (const float excess : {1e-7f, 1e-3f, 0.5f, 1.0f})
                    for (const float depth : {0.0f, 1e-6f, 1.0f, 1e4f}) {
                        const float delta = scale * excess, C = scale - delta, sigmaT = depth / scale;
                        float last = -1.0f;
                        for (const float u : {0.0f, 1e-7f, 0.01f, 0.5f, 0.99f, 0x1.fffffep-1f}) {
                            const float h = table.sample(C, delta, sigmaT, u);
                            ASSERT_TRUE(h >= 0.0f && h <= 2.0f && h > last) << u;
                            last = h;
                        }
                        for (const float h : {0.0f, 1e-12f, 1e-5f, 0.3f, 2.0f, 2.0000005f}) {
                            const float pdf = table.pdf(C, delta, sigmaT, h);
                            ASSERT_TRUE(std::isfinite(pdf) && pdf > 1e-4f) << albedo << " " << g << " " << h;
                        }
                    }
            // No room for a target at all: a direction nevertheless.
            EXPECT_GT(table.pdf(0.0f, 0.0f, 1.0f, table.sample(0.0f, 0.0f, 1.0f, 0.5f)), 0.0f);
        }
}

TEST(EdaTable, TargetAtTheVertexIsNearlyUniform) {
    const EdaTable table = EdaTable::build(0.9f, 0.0f);
    for (const float h : {0.0f, 0.5f, 1.0f, 2.0f})
        EXPECT_NEAR(table.pdf(1e-6f, 1.0f, 3.0f, h) * 12.566371f, 1.0f, 0.15f) << h;
}

TEST(EdaTable, IsTheSameForAnyNumberOfThreads) {
    const EdaTable one = EdaTable::build(0.7f, 0.4f, {}, 1);
    EXPECT_TRUE(one == EdaTable::build(0.7f, 0.4f, {}, 2));
    EXPECT_TRUE(one == EdaTable::build(0.7f, 0.4f, {}, 5));
    EXPECT_FALSE(one == EdaTable::build(0.7f, 0.5f, {}, 2));
}

TEST(EdaTable, IsSharedWhileSomebodyHoldsIt) {
    auto table = EdaTable::shared(0.7f, 0.4f);
    EXPECT_TRUE(*table == EdaTable::build(0.7f, 0.4f));
    EXPECT_EQ(EdaTable::shared(0.7f, 0.4f), table);
    EXPECT_NE(EdaTable::shared(0.7f, 0.3f), table);
    EXPECT_NE(EdaTable::shared(0.6f, 0.4f), table);
    const std::weak_ptr<const EdaTable> observer = table;
    table.reset();
    EXPECT_TRUE(observer.expired());
    EXPECT_THROW((void)EdaTable::shared(NAN, 0.0f), std::invalid_argument);

    std::array<std::shared_ptr<const EdaTable>, 4> tables;
    std::vector<std::thread> threads;
    for (auto& mine : tables) threads.emplace_back([&mine] { mine = EdaTable::shared(0.7f, 0.4f); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& one : tables) EXPECT_EQ(one, tables.front());
}

TEST(EdaTable, RefusesParametersOutOfBounds) {
    for (const Scattering m :
         {Scattering{-0.1f, 0.0f}, {1.1f, 0.0f}, {0.5f, 1.1f}, {0.5f, -1.1f}, {NAN, 0.0f}, {0.5f, NAN}})
        EXPECT_THROW((void)EdaTable::build(m.albedo, m.g), std::invalid_argument);
    const auto refuses = [](auto member, auto value) {
        EdaResolution resolution;
        resolution.*member = value;
        EXPECT_THROW((void)EdaTable::build(0.5f, 0.0f, resolution), std::invalid_argument) << value;
    };
    for (const int value : {-1, 1000}) {
        refuses(&EdaResolution::excessOctaves, value);
        refuses(&EdaResolution::log2ExcessPerOctave, value);
        refuses(&EdaResolution::depthOctaves, value);
        refuses(&EdaResolution::log2DepthPerOctave, value);
    }
    refuses(&EdaResolution::lowestDepthLog2, -1000);
    refuses(&EdaResolution::lowestDepthLog2, 1000);
    refuses(&EdaResolution::floor, 0.0f);
    refuses(&EdaResolution::floor, NAN);
}

TEST(OctaveBins, EveryNumberLiesBetweenItsBinsEdges) {
    const OctaveBins bins(-3, 5, 2);
    EXPECT_EQ(bins.count(), 20);
    EXPECT_EQ(bins.edge(0), 0.125f);
    EXPECT_EQ(bins.edge(20), 4.0f);
    for (uint64_t i = 0; i < 1000; ++i) {
        Sampler s(4, RandomStream::Test, 0, i);
        const float x = std::exp2(-3.0f + 4.9999f * s.next1D());
        const int bin = bins.index(x);
        ASSERT_TRUE(bins.edge(bin) <= x && x < bins.edge(bin + 1)) << x;
        ASSERT_EQ(bins.index(bins.centre(bin)), bin);
    }
    for (const float x : {0.0f, -1.0f, 1e-30f}) EXPECT_EQ(bins.index(x), 0);
    for (const float x : {4.0f, 1e30f, std::numeric_limits<float>::infinity()}) EXPECT_EQ(bins.index(x), 19);
}

} // namespace
} // namespace darts
