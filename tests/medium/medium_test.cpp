// Phase functions and free flights.

#include "support/ChiSquare.h"

#include "tungsten/medium/Medium.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

namespace tungsten {
namespace {

std::vector<PhaseFunction> phaseFunctions() {
    std::vector<PhaseFunction> all{{Isotropic{}}, {Rayleigh{}}};
    for (const float g : {-0.99f, -0.7f, -1e-4f, 0.0f, 1e-6f, 0.3f, 0.85f, 0.99f}) all.push_back({HenyeyGreenstein{g}});
    return all;
}

TEST(PhaseFunction, SamplesFollowTheDensity) {
    // The cosine maps to a uniform number through its cumulative distribution, here by quadrature.
    for (const PhaseFunction& phase : phaseFunctions()) {
        const Vec3f before = Vec3f(0.3f, -0.5f, 0.8f).normalized();
        constexpr int Samples = 40000;
        std::vector<double> observed(50, 0.0), expected(50, 0.0);
        // Bins fine near both poles: edges equally spaced in angle.
        const auto edge = [](int i) { return std::cos(3.14159265358979 * (50 - i) / 50.0); };
        for (int bin = 0; bin < 50; ++bin)
            expected[size_t(bin)] =
                Samples *
                boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
                    [&](double c) {
                        return 2.0 * 3.14159265358979 *
                               std::visit([&](const auto& p) { return double(p.eval(float(c))); }, phase.model);
                    },
                    edge(bin), edge(bin + 1), 10, 1e-9);
        for (uint64_t i = 0; i < Samples; ++i) {
            Sampler sampler(3, RandomStream::Test, 0, i);
            const double c = std::clamp(double(before.dot(phase.sample(before, sampler.next2D()))), -1.0, 1.0);
            observed[size_t(std::clamp(50 - int(std::ceil(std::acos(c) / 3.14159265358979 * 50.0)), 0, 49))] += 1.0;
        }
        EXPECT_GT(test::chiSquarePValue(observed, expected), test::SmallestPValue) << "g = " << phase.g();
    }
}

TEST(PhaseFunction, AgreesWithExtendedPrecision) {
    for (const float g : {-0.99f, -0.3f, 1e-6f, 0.5f, 0.99f})
        for (const float c : {-1.0f, -0.999f, 0.0f, 0.5f, 0.999f, 1.0f}) {
            const long double gl = g, cl = c;
            const long double expected =
                (1.0L - gl * gl) / (4.0L * 3.14159265358979323846L * std::pow(1.0L + gl * gl - 2.0L * gl * cl, 1.5L));
            EXPECT_NEAR(double(HenyeyGreenstein{g}.eval(c)), double(expected), 2e-5 * double(expected))
                << g << " " << c;
        }
}

Medium colouredFog() {
    Medium fog;
    fog.sigmaA = Rgb(0.1f, 0.0f, 0.3f);
    fog.sigmaS = Rgb(0.5f, 1.5f, 0.0f);
    return fog;
}

TEST(Medium, FlightsEstimateTheCollisionIntegralPerChannel) {
    const Medium fog = colouredFog();
    constexpr int Count = 400000;
    constexpr float Reach = 1.3f;
    Vec3d collided(0.0), squared(0.0), exited(0.0);
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler sampler(9, RandomStream::Test, 0, i);
        const FlightSample flight = sampleFlight(fog, Reach, sampler);
        const Vec3d weight(double(flight.weight.x), double(flight.weight.y), double(flight.weight.z));
        EXPECT_LE(flight.distance, Reach);
        if (flight.exited)
            exited += weight;
        else {
            collided += weight;
            squared += weight * weight;
        }
        EXPECT_NEAR(flight.pdf, flight.exited ? probabilityFlightExits(fog, Reach) : pdfFlight(fog, flight.distance),
                    1e-5f);
    }
    for (int c = 0; c < 3; ++c) {
        const double sigmaT = double(fog.sigmaT()[c]), sigmaS = double(fog.sigmaS[c]);
        const double expected = sigmaS / sigmaT * -std::expm1(-sigmaT * double(Reach));
        const double mean = collided[c] / Count, error = std::sqrt((squared[c] / Count - mean * mean) / Count);
        EXPECT_NEAR(mean, expected, 4.5 * error + 1e-12);
        EXPECT_NEAR(exited[c] / Count, std::exp(-sigmaT * double(Reach)), 0.01);
    }
}

TEST(Medium, FlightDistancesFollowTheirDensity) {
    Medium fog;
    fog.sigmaS = Rgb(2.0f);
    EXPECT_GT(test::chiSquareUniform(
                  [&](Sampler& s) { return -std::expm1(-2.0 * double(sampleFlight(fog, Infinity, s).distance)); }),
              test::SmallestPValue);
}

TEST(Medium, AbsorptionAloneAndEmptinessAreCrossedAnalytically) {
    Medium smoke;
    smoke.sigmaA = Rgb(0.7f);
    Sampler sampler(1, RandomStream::Test, 0, 0);
    const FlightSample flight = sampleFlight(smoke, 2.0f, sampler);
    EXPECT_TRUE(flight.exited);
    EXPECT_FLOAT_EQ(flight.weight.x, std::exp(-1.4f));
    EXPECT_EQ(smoke.transmittance(Infinity), Rgb(0.0f));
    EXPECT_EQ(Medium{}.transmittance(Infinity), Rgb(1.0f));
    Medium red;
    red.sigmaA = Rgb(1.0f, 0.0f, 0.0f);
    EXPECT_EQ(red.transmittance(Infinity), Rgb(0.0f));
    EXPECT_EQ(red.transmittance(2.0f).y, 1.0f);
}

TEST(Medium, OpticalDepthsFromTinyToHuge) {
    for (const float depth : {1e-6f, 1e-3f, 1.0f, 80.0f, 1e4f}) {
        Medium fog;
        fog.sigmaS = Rgb(depth);
        for (uint64_t i = 0; i < 2000; ++i) {
            Sampler sampler(2, RandomStream::Test, 0, i);
            const FlightSample flight = sampleFlight(fog, 1.0f, sampler);
            EXPECT_TRUE(isFinite(flight.weight)) << depth;
            EXPECT_GE(flight.weight.x, 0.0f);
        }
    }
}

} // namespace
} // namespace tungsten
