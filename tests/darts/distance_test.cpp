// Distances against quadrature, resampled, whatever their target and proposals, or by a density that is known.

#include "darts/DistanceSampler.h"
#include "darts/GreensFunction.h"
#include "darts/Stratification.h"

#include "support/ChiSquare.h"
#include "support/LogUniform.h"
#include "support/Quadrature.h"

#include <gtest/gtest.h>

#include <set>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::logUniform;
constexpr double Infinite = std::numeric_limits<double>::infinity();

TEST(Stratification, EveryRowHasOneNumberInEveryStratumAndColumnsFillTheirs) {
    const auto& rows = Stratified<16>.rows;
    for (size_t column = 0; column < 16; ++column) {
        std::set<int> seen;
        for (const auto& row : rows) {
            EXPECT_EQ(int(row[column] * 16.0f), StratifiedTable<16>::stratum(int(column)));
            seen.insert(int(row[column] * 512.0f));
        }
        EXPECT_EQ(seen.size(), size_t(StratifiedRows)) << column; // a Sobol dimension: one point in every 32nd
    }
}

TEST(Stratification, EitherHalfOfARowIsStratifiedOverTheUnitInterval) {
    for (size_t half = 0; half < 2; ++half) {
        std::set<int> quarters, strata;
        for (size_t column = 4 * half; column < 4 * half + 4; ++column) {
            quarters.insert(int(Stratified<8>.rows[0][column] * 4.0f));
            strata.insert(int(Stratified<8>.rows[0][column] * 8.0f) % 2);
        }
        EXPECT_EQ(quarters.size(), 4u);
        EXPECT_EQ(strata, std::set<int>{int(half)});
    }
}

struct DistanceCase {
    const char* name;
    double C, S, h, surface;
    Medium medium;
};

const Medium Grey{{0.1f, 0.1f, 0.1f}, {1.2f, 1.2f, 1.2f}, 0.3f};
const Medium Coloured{{0.1f, 0.0f, 0.3f}, {0.4f, 1.6f, 0.9f}, 0.0f};
const DistanceCase DistanceCases[] = {
    {"bounded by time", 1.0, 1.5, 0.4, Infinite, Grey},
    {"bounded by a surface", 1.0, 3.0, 0.4, 0.6, Grey},
    {"near the front", 2.0, 2.02, 0.01, Infinite, Grey},
    {"away from the target", 1.0, 1.3, 1.9, 5.0, Grey},
    {"target at the vertex", 1e-6, 1.0, 1.0, Infinite, Grey},
    {"deep", 20.0, 60.0, 1.0, Infinite, Grey},
    {"thin", 1.0, 2.0, 0.2, Infinite, Medium{{1e-7f, 1e-7f, 1e-7f}, {1e-6f, 1e-6f, 1e-6f}, 0.0f}},
    {"coloured", 1.0, 2.5, 0.8, 0.9, Coloured},
    {"coloured, bounded by time", 2.0, 2.5, 0.3, Infinite, Coloured},
};

struct Sums {
    double sum = 0, squares = 0;
    uint64_t count = 0;
    void add(double x) { sum += x, squares += x * x, ++count; }
    [[nodiscard]] double mean() const { return sum / double(count); }
    [[nodiscard]] double error() const {
        return std::sqrt(std::max(squares / double(count) - mean() * mean(), 0.0) / double(count));
    }
};

TimeBudget residualOf(const DistanceCase& c) {
    return TimeBudget::of({0, 0, float(c.C)}, {0.98 * c.S, c.S});
}

/// E[transmittance / pdf F(d)] = the integral of e^{-sigmaT d} F(d) over what is in time, and the surface's share.
void expectUnbiased(const DistanceCase& c, const Settings& settings, bool scalar, uint64_t seed, double sigmas = 5.0) {
    const DistanceSampler sampler(settings, c.medium, scalar);
    const TimeBudget budget = residualOf(c);
    const double last = budget.latest(float(c.h)).firstLeg(), bound = std::min(last, c.surface);
    const auto shape = [&](double d) { return 1.0 + d / bound; };
    const Vec3 sigmaT = c.medium.sigmaT();
    Sums medium[3], surface[3];
    for (uint64_t i = 0; i < 20000; ++i) {
        Sampler s(seed, RandomStream::Test, 0, i);
        const DistanceSample sample = sampler.sample(budget, {{}, float(c.h)}, float(c.surface), {0.3f, 1.0f, 0.7f},
                                                     {s.next1D(), s.next1D(), s.next1D(), s.next1D()});
        for (int k = 0; k < 3; ++k) {
            const double weight = double(k == 0   ? sample.transmittanceOverPdf.x
                                         : k == 1 ? sample.transmittanceOverPdf.y
                                                  : sample.transmittanceOverPdf.z);
            ASSERT_TRUE(std::isfinite(weight) && weight >= 0.0);
            medium[k].add(sample.surface ? 0.0 : weight * shape(double(sample.distance)));
            surface[k].add(sample.surface ? weight : 0.0);
        }
    }
    for (int k = 0; k < 3; ++k) {
        const double sigma = double(k == 0 ? sigmaT.x : k == 1 ? sigmaT.y : sigmaT.z);
        const double expected = tungsten::test::integrate<61>([&](double d) { return std::exp(-sigma * d) * shape(d); },
                                                              0.0, bound, 10, 1e-10);
        EXPECT_NEAR(medium[k].mean(), expected, sigmas * medium[k].error() + 1e-5 * expected) << c.name << " " << k;
        if (c.surface < last) {
            EXPECT_NEAR(surface[k].mean(), std::exp(-sigma * c.surface), sigmas * surface[k].error() + 1e-6) << c.name;
        }
    }
}

/// The preset, but for distances resampled from candidates.
Settings resampling(Mode mode) {
    Settings settings = best(mode, 0.0f);
    settings.preset = Preset::Published;
    return settings;
}

TEST(DistanceSampler, MeansMatchQuadratureForEveryTargetProposalAndCount) {
    uint64_t seed = 100;
    for (const DistanceCase& c : DistanceCases)
        for (const Greens greens : {Greens::None, Greens::Diffusion, Greens::Causal})
            for (const Proposals proposals :
                 {Proposals::Exponential, Proposals::MixedUniform, Proposals::MixedQuarter, Proposals::Equiangular})
                for (const int candidates : {1, 4, 8, 16}) {
                    Settings settings = resampling(Mode::Path);
                    settings.greens = greens;
                    settings.proposals = proposals;
                    settings.candidates = candidates;
                    SCOPED_TRACE(testing::Message() << "greens " << int(greens) << " proposals " << int(proposals)
                                                    << " candidates " << candidates);
                    expectUnbiased(c, settings, false, ++seed);
                }
}

TEST(DistanceSampler, BestIsUnbiased) {
    uint64_t seed = 1500;
    for (const DistanceCase& c : DistanceCases) expectUnbiased(c, best(Mode::Path, 0.0f), false, ++seed);
}

/// All but a tenth choose by the light that a surface and the medium before it may bring in time.
TEST(DistanceSampler, SurfacesAreReachedByTheirImportance) {
    constexpr double C = 1.0, Gate = 0.1, Surface = 0.8;
    for (const double sigma : {0.3, 2.0})
        for (const double S : {1.5, 3.0})
            for (const double h : {0.1, 1.0, 1.9}) {
                const auto s = float(sigma);
                const DistanceSampler sampler(best(Mode::Path, 0.0f), Medium{{0, 0, 0}, {s, s, s}, 0.0f});
                const TimeBudget budget = TimeBudget::of({0, 0, float(C)}, {S - Gate, S});
                const Ellipse<double> e{C, S - C, h};
                if (e.firstLeg() < Surface) continue;
                const CausalGreensFunction<double> phi{0.0, sigma};
                const auto importance = [&](double d) {
                    const double rho = e.distanceToTarget(d), left = S - d;
                    return std::exp(-sigma * d + phi.log(1.0 - rho * rho / (left * left), left)) *
                           std::min(left - rho, Gate);
                };
                const double before = sigma * tungsten::test::integrate<61>(importance, 0.0, Surface, 10, 1e-9);
                const double expected =
                    0.1 * std::exp(-sigma * Surface) + 0.9 * importance(Surface) / (importance(Surface) + before);
                const float reached = sampler.density(budget, {{}, float(h)}, float(Surface), {1, 1, 1}).surface();
                EXPECT_NEAR(double(reached), expected, 0.02 * expected) << sigma << " " << S << " " << h;
            }
}

TEST(DistanceSampler, ThePublishedSamplerAndItsSwitchesAreUnbiased) {
    uint64_t seed = 900;
    for (const DistanceCase& c : DistanceCases) {
        if (c.S < 1.1 * c.C || c.medium.sigmaS.x < 1e-3f) continue; // nearly all its candidates are too late there
        for (const bool scalar : {false, true}) expectUnbiased(c, published(Mode::Path), scalar, ++seed);
    }
}

TEST(DistanceSampler, MeansMatchQuadratureByDensitiesThatAreKnown) {
    uint64_t seed = 2000;
    for (const DistanceCase& c : DistanceCases)
        for (const Greens greens : {Greens::None, Greens::Diffusion, Greens::Causal})
            for (const bool scalar : {false, true}) {
                Settings settings = best(Mode::Path, 0.0f);
                settings.greens = greens;
                SCOPED_TRACE(testing::Message() << "greens " << int(greens));
                expectUnbiased(c, settings, scalar, ++seed);
            }
}

/// What a draw says of itself is what anyone else would say of it.
TEST(DistanceSampler, DrawsKnowTheirDensity) {
    const Vec3 throughput{0.3f, 1.0f, 0.7f};
    for (const DistanceCase& c : DistanceCases)
        for (const Greens greens : {Greens::None, Greens::Diffusion, Greens::Causal}) {
            Settings settings = best(Mode::Path, 0.0f);
            settings.greens = greens;
            const DistanceSampler sampler(settings, c.medium);
            const TimeBudget budget = residualOf(c);
            const Heading ray{{}, float(c.h)};
            const DistanceDensity density = sampler.density(budget, ray, float(c.surface), throughput);
            for (uint64_t i = 0; i < 1000; ++i) {
                Sampler s(78, RandomStream::Test, 0, i);
                const DistanceSample sample = sampler.sample(budget, ray, float(c.surface), throughput,
                                                             {s.next1D(), s.next1D(), s.next1D(), s.next1D()});
                const float pdf = sample.surface ? density.surface() : density.pdf(sample.distance);
                ASSERT_NEAR(sample.pdf, pdf, 1e-5f * pdf) << c.name;
                const float through = sampler.transmittance(sample.distance).x;
                ASSERT_NEAR(sample.transmittanceOverPdf.x * sample.pdf, through, 1e-6f * through) << c.name;
            }
            const double bound = std::min(double(budget.latest(float(c.h)).firstLeg()), c.surface);
            double integral = double(density.surface());
            auto edges = tungsten::test::evenEdges(0.0, bound, 200);
            for (size_t i = 0; i + 1 < edges.size(); ++i)
                integral += tungsten::test::integrate<15>([&](double d) { return double(density.pdf(float(d))); },
                                                          edges[i], edges[i + 1], 8, 1e-7);
            EXPECT_NEAR(integral, 1.0, 2e-5) << c.name;
        }
}

TEST(DistanceSampler, ResampledDrawsKnowNoDensity) {
    const DistanceCase& c = DistanceCases[0];
    const DistanceSampler sampler(resampling(Mode::Path), c.medium);
    EXPECT_EQ(sampler.sample(residualOf(c), {{}, float(c.h)}, float(c.surface), {1, 1, 1}, {}).pdf, 0.0f);
}

void expectRegistersDrawTheSame(const Settings& settings) {
    for (const DistanceCase& c : DistanceCases) {
        const DistanceSampler simd(settings, c.medium), scalar(settings, c.medium, true);
        for (uint64_t i = 0; i < 500; ++i) {
            Sampler s(77, RandomStream::Test, 0, i);
            const DistanceRandom random{s.next1D(), s.next1D(), s.next1D(), s.next1D()};
            const TimeBudget budget = residualOf(c);
            const auto a = simd.sample(budget, {{}, float(c.h)}, float(c.surface), {1, 1, 1}, random);
            const auto b = scalar.sample(budget, {{}, float(c.h)}, float(c.surface), {1, 1, 1}, random);
            ASSERT_EQ(a.surface, b.surface);
            // A choice on the border of two candidates may fall to either.
            if (std::abs(a.distance - b.distance) > 1e-3f * float(c.S)) continue;
            EXPECT_NEAR(a.transmittanceOverPdf.x, b.transmittanceOverPdf.x, 2e-4f * b.transmittanceOverPdf.x) << c.name;
        }
    }
}

TEST(DistanceSampler, RegistersAndSingleCandidatesDrawTheSame) {
    expectRegistersDrawTheSame(resampling(Mode::Path));
    expectRegistersDrawTheSame(best(Mode::Path, 0.0f));
}

TEST(DistanceSampler, NothingScattersInAnAbsorber) {
    const DistanceSampler sampler(best(Mode::Photon, 0.0f), Medium{{1, 1, 1}, {0, 0, 0}, 0.0f});
    const TimeBudget budget = TimeBudget::of({0, 0, 1}, {2.0, 2.1});
    const DistanceSample sample = sampler.sample(budget, {{}, 1.0f}, 0.5f, {1, 1, 1}, {0.5f, 0.5f, 0.5f, 0.5f});
    EXPECT_TRUE(sample.surface);
    EXPECT_NEAR(sample.transmittanceOverPdf.x, std::exp(-0.5f), 1e-6f);
    EXPECT_EQ(sampler.sample(budget, {{}, 1.0f}, float(Infinite), {1, 1, 1}, {}).transmittanceOverPdf.x, 0.0f);
}

TEST(DistanceSampler, StaysFiniteAtTheHardCases) {
    for (uint64_t i = 0; i < 100000; ++i) {
        Sampler s(5, RandomStream::Test, 1, i);
        const double scale = logUniform(s, 1e-4, 1e5), C = s.next1D() < 0.1f ? 0.0 : scale;
        const double S = C + scale * logUniform(s, 1e-7, 10.0), depth = logUniform(s, 1e-6, 1e4) / S;
        const double albedo = double(int(s.next1D() * 3.0f)) * 0.5, g = 0.99 * (2.0 * s.nextDouble() - 1.0);
        const auto sigmaS = float(depth * albedo), sigmaA = float(depth * (1.0 - albedo));
        const Medium medium{{sigmaA, sigmaA, sigmaA}, {sigmaS, sigmaS, sigmaS}, float(g)};
        Settings settings = best(Mode::Path, float(g));
        settings.greens = s.next1D() < 0.5f ? Greens::Causal : Greens::Diffusion;
        if (s.next1D() < 0.2f) settings = published(Mode::Path);
        if (s.next1D() < 0.4f) settings.preset = Preset::Published;
        const DistanceSampler sampler(settings, medium);
        const TimeBudget budget = TimeBudget::of({0, 0, float(C)}, {S * (1.0 - 1e-7), S});
        const float h = s.next1D() < 0.1f ? 0.0f : s.next1D() < 0.1f ? 2.0f : float(logUniform(s, 1e-12, 2.0));
        const float surface = s.next1D() < 0.5f ? float(scale * logUniform(s, 1e-6, 10.0)) : float(Infinite);
        if (!budget.alive() || budget.latest(h).isDegenerate()) continue;
        const DistanceSample sample =
            sampler.sample(budget, {{}, h}, surface, {1, 1, 1}, {s.next1D(), s.next1D(), s.next1D(), s.next1D()});
        ASSERT_TRUE(sample.distance >= 0.0f && (std::isfinite(sample.distance))) << C << " " << S << " " << h;
        for (const float w : {sample.transmittanceOverPdf.x, sample.transmittanceOverPdf.y})
            ASSERT_TRUE(std::isfinite(w) && w >= 0.0f) << C << " " << S << " " << h << " " << depth << " " << w;
    }
}

} // namespace
} // namespace darts
