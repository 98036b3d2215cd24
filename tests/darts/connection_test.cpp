// Elliptical connections, control vertices, lobes and Green's functions against extended precision and their own
// definitions.

#include "support/ChiSquare.h"
#include "support/Quadrature.h"

#include "darts/ConnectionLobe.h"
#include "darts/ControlVertex.h"
#include "darts/GreensFunction.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;

TEST(Ellipse, MatchesTheVerifiedVector) {
    // From (1.2, 0.5, 2) along (-1, 1, 1) toward the origin, total length 4.
    const double C = std::sqrt(1.44 + 0.25 + 4.0), cosC = (1.2 - 0.5 - 2.0) / std::sqrt(3.0);
    const Ellipse<double> e{C, 4.0 - C, 1.0 - cosC / C};
    EXPECT_NEAR(C, 2.3853720884, 1e-9);
    EXPECT_NEAR(e.firstLeg(), 1.0851362883, 1e-9);
    EXPECT_NEAR(e.secondLeg(), 2.9148637117, 1e-9);
    EXPECT_NEAR(controlVertexPdf(e, 1.0), 1.6297692859, 1e-9);
}

TEST(Ellipse, ExcessCarriedAlongAWalkKeepsItsDigits) {
    for (uint64_t i = 0; i < 2000; ++i) {
        Sampler s(2, RandomStream::Test, 0, i);
        Ellipse<float> e{1.0f, 1e-3f, 2.0f * s.next1D() * s.next1D()};
        Ellipse<long double> exact{e.C, e.delta, e.h};
        for (int step = 0; step < 20; ++step) {
            const float distance = e.firstLeg() * s.next1D();
            e = e.advance(distance);
            exact = exact.advance((long double)distance);
            ASSERT_GE(e.delta, 0.0f);
            if (exact.delta > 1e-5L * exact.C) {
                ASSERT_NEAR(double(e.delta / float(exact.delta)), 1.0, 0.02) << step;
            }
            if (!(e.delta > 1e-6f * e.C)) break;
            e.h = 2.0f * s.next1D();
            exact.h = e.h;
        }
    }
}

TEST(ConnectionLength, SamplesFollowTheDensity) {
    for (const double depth : {0.0, 1e-9, 0.3, 5.0, 1e4}) {
        const ConnectionLength<double> length{2.0, 0.5, depth / 0.5};
        const auto cumulative = [&](double x) {
            return depth < 1e-6 ? x / 0.5 : -std::expm1(-length.sigmaT * x) / -std::expm1(-depth);
        };
        EXPECT_GT(tungsten::test::chiSquareUniform(
                      [&](Sampler& s) { return cumulative(length.sample(s.nextDouble()).offset); }),
                  tungsten::test::SmallestPValue)
            << depth;
        const double scale = depth > 1.0 ? 0.5 / depth : 0.5;
        const double integral = tungsten::test::integrate<61>([&](double x) { return length.pdf(x); }, 0.0,
                                                              std::min(40.0 * scale, 0.5), 15, 1e-10);
        EXPECT_NEAR(integral, 1.0, 1e-6) << depth;
    }
}

TEST(LengthAlong, SamplesFollowTheDensity) {
    for (const double low : {0.0, 1e-4, 1.0, 100.0})
        for (const double a : {1e-4, 0.1, 3.0, 1e3})
            for (const double sigmaT : {0.0, 4.0}) {
                const LengthAlong<double> length{{low, 2.0, sigmaT}, a};
                // Evenly in the logarithm: half of the lengths may be within a of 0.
                const double first = std::log(1e-9), last = std::log(2.0);
                const auto cumulative = [&](double x) {
                    const auto integrand = [&](double y) { return length.pdf(std::exp(y)) * std::exp(y); };
                    return x > 1e-9 ? tungsten::test::integrate<61>(integrand, first, std::log(x), 12, 1e-9) : 0.0;
                };
                EXPECT_NEAR(cumulative(std::exp(last) * (1.0 - 1e-12)), 1.0, 2e-5) << low << " " << a << " " << sigmaT;
                const double p = tungsten::test::chiSquareUniform(
                    [&](Sampler& s) { return cumulative(length.sample(s.nextDouble()).offset); }, 12, 3000);
                EXPECT_GT(p, tungsten::test::SmallestPValue) << low << " " << a << " " << sigmaT;
            }
}

TEST(ConnectionLength, SamplesFollowTheDensityOfForwardPeaks) {
    for (const double low : {0.0, 0.1})
        for (const double needle : {1e-3, 0.3})
            for (const double sigmaT : {0.5, 20.0}) {
                const ConnectionLength<double> length{low, 2.0, sigmaT, needle};
                const auto cumulative = [&](double x) {
                    return tungsten::test::integrate<61>([&](double y) { return length.pdf(y); }, 0.0, x, 10, 1e-7);
                };
                EXPECT_NEAR(cumulative(2.0), 1.0, 1e-5) << low << " " << needle << " " << sigmaT;
                const auto sample = length.sample(0.73);
                EXPECT_NEAR(sample.inversePdf * length.pdf(sample.offset), 1.0, 1e-9);
                EXPECT_GT(tungsten::test::chiSquareInterval(
                              [&](Sampler& s) { return length.sample(s.nextDouble()).offset; },
                              [&](double x) { return length.pdf(x); }, tungsten::test::ratioEdges(1e-5, 2.0, 40)),
                          tungsten::test::SmallestPValue)
                    << low << " " << needle << " " << sigmaT;
            }
}

TEST(ConnectionLength, HalfOfThemAreShorterThanTheMedian) {
    for (const double low : {0.0, 0.1})
        for (const double needle : {0.0, 1e-5, 1e-3, 0.3})
            for (const double sigmaT : {0.0, 0.5, 20.0, 1e4}) {
                const ConnectionLength<double> length{low, 2.0, sigmaT, needle};
                const double median = length.median();
                EXPECT_EQ((ConnectionLength<float>{float(low), 2.0f, float(sigmaT), float(needle)}.median() > 0), true);
                int shorter = 0;
                for (int i = 0; i < 10000; ++i) shorter += length.sample((i + 0.5) / 10000).offset < median ? 1 : 0;
                EXPECT_NEAR(shorter, 5000, 40) << low << " " << needle << " " << sigmaT;
            }
}

using DoubleLobe = ConnectionLobe<double>;

template <typename Make>
void testLobe(const Make& make) {
    for (const double C : {1e-9, 0.5, 1.0, 1e4})
        for (const double delta : {1e-6, 1e-2, 1.0, 1e3}) {
            const auto lobe = make(C, delta);
            // Uniform after mapping by the density's own integral over h (2 pi per unit of h).
            const auto cumulative = [&](double h) {
                const auto integrand = [&](double x) { return TwoPi * lobe.pdf(std::exp(x)) * std::exp(x); };
                const double low = std::log(1e-32);
                return tungsten::test::integrate<61>(integrand, low, std::log(h), 12, 1e-9);
            };
            EXPECT_NEAR(cumulative(2.0), 1.0, 1e-6) << C << " " << delta;
            const double p = tungsten::test::chiSquareUniform(
                [&](Sampler& s) {
                    const double h = lobe.sample(s.nextDouble());
                    return h > 0.0 ? cumulative(h) : 0.0;
                },
                12, 3000);
            EXPECT_GT(p, tungsten::test::SmallestPValue) << C << " " << delta;
        }
}

TEST(ConnectionLobe, PathLobeSamplesItsDensity) {
    testLobe(DoubleLobe::path);
}
TEST(ConnectionLobe, PhotonLobeSamplesItsDensity) {
    testLobe(DoubleLobe::photon);
}

TEST(ConnectionLobe, LobesOfAllLengthsSampleTheirDensity) {
    for (const double low : {0.0, 0.1, 20.0}) {
        testLobe([low](double C, double delta) { return UniformLengthLobe<double>(C, low * delta, delta); });
        testLobe([low](double C, double delta) { return GateLobe<double>(C, low * delta, delta); });
    }
}

TEST(ConnectionLobe, ThatOfUniformLengthsIsTheMeanOfPathLobesWeights) {
    const double C = 1.3, width = 0.02;
    for (const double low : {0.0, 0.003, 0.02, 0.5}) {
        const double S = C + low + 0.5 * width;
        const UniformLengthLobe<double> lobe(C, low, width);
        double least = INFINITY, most = 0.0;
        for (const double h : {1e-10, 1e-7, 1e-5, 1e-4, 1e-3, 0.1, 2.0}) {
            const double a = std::sqrt(2.0 * S * C * h);
            const double weight = (std::atan((low + width) / a) - std::atan(low / a)) / a, ratio = lobe.pdf(h) / weight;
            least = std::min(least, ratio), most = std::max(most, ratio);
        }
        EXPECT_LT(most, 1.75 * least) << low;
    }
}

TEST(ConnectionLobe, PathLobeCancelsTheConnectionWeight) {
    // 1 / (r (delta + C h)) over the lobe's density does not depend on the direction.
    const double C = 1.3, delta = 0.01;
    const DoubleLobe lobe = DoubleLobe::path(C, delta);
    double first = 0.0;
    for (const double h : {1e-8, 1e-3, 0.4, 1.9}) {
        const Ellipse<double> e{C, delta, h};
        const double ratio = 1.0 / (e.secondLeg() * e.denominator()) / lobe.pdf(h);
        if (first == 0.0) first = ratio;
        EXPECT_NEAR(ratio / first, 1.0, 1e-9);
    }
}

TEST(GreensFunction, DiffusionIntegratesToTheSurvivingEnergy) {
    const DiffusionGreensFunction<double> phi{0.02, 3.0, 0.4};
    const double s = 40.0; // deep: the causal bound cuts off nothing that counts
    const double total = tungsten::test::integrate<61>(
        [&](double rho) { return 2.0 * TwoPi * rho * rho * std::exp(phi.log(rho, s)); }, 0.0, s, 15, 1e-10);
    EXPECT_NEAR(total, std::exp(-0.02 * s), 1e-6);
}

TEST(GreensFunction, CausalConservesEnergyWithinItsAccuracy) {
    const CausalGreensFunction<double> phi{0.0, 1.0};
    for (const double s : {1.0, 3.0, 10.0, 30.0}) {
        const double scattered = tungsten::test::integrate<61>(
            [&](double rho) { return 2.0 * TwoPi * rho * rho * std::exp(phi.log(1.0 - rho * rho / (s * s), s)); }, 0.0,
            s, 15, 1e-9);
        EXPECT_NEAR(scattered / -std::expm1(-s), 1.0, 0.05) << s;
    }
}

} // namespace
} // namespace darts
