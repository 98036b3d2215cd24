// Phase functions and free flights.

#include "support/ChiSquare.h"
#include "support/Quadrature.h"

#include "tungsten/medium/Medium.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

std::vector<PhaseFunction> phaseFunctions() {
    std::vector<PhaseFunction> all{{Isotropic{}}, {Rayleigh{}}};
    for (const float g : {-0.999f, -0.7f, -1e-4f, 0.0f, 1e-6f, 0.3f, 0.85f, 0.99f})
        all.push_back({HenyeyGreenstein{g}});
    return all;
}

TEST(PhaseFunction, SamplesFollowTheDensity) {
    // The angle maps to a uniform number through its cumulative distribution, here by quadrature.
    for (const PhaseFunction& phase : phaseFunctions()) {
        const Vec3f before = Vec3f(0.3f, -0.5f, 0.8f).normalized();
        const Frame frame(before);
        constexpr int Samples = 40000, Bins = 50;
        std::vector<double> observed(Bins, 0.0), expected(Bins, 0.0);
        for (int bin = 0; bin < Bins; ++bin)
            expected[size_t(bin)] =
                Samples * test::integrate<31>(
                              [&](double theta) {
                                  const double s = std::sin(theta);
                                  const Vec3f after = frame.toWorld({float(s), 0.0f, float(std::cos(theta))});
                                  return 2.0 * M_PI * s * double(phase.eval(before, after));
                              },
                              M_PI * bin / Bins, M_PI * (bin + 1) / Bins, 10, 1e-6);
        for (uint64_t i = 0; i < Samples; ++i) {
            Sampler sampler(3, RandomStream::Test, 0, i);
            const Vec3f after = phase.sample(before, sampler.next2D());
            const double theta = std::atan2(double(before.cross(after).length()), double(before.dot(after)));
            observed[size_t(std::clamp(int(theta / M_PI * Bins), 0, Bins - 1))] += 1.0;
        }
        EXPECT_GT(test::chiSquarePValue(observed, expected), test::SmallestPValue) << "g = " << phase.g();
    }
}

/// Of the directions as they are, down to angles far below the width of the narrowest peak.
TEST(PhaseFunction, IsIsotropicWhereNoDirectionIsPreferred) {
    for (const PhaseFunction& phase : {PhaseFunction{Isotropic{}}, PhaseFunction{HenyeyGreenstein{0.0f}},
                                       PhaseFunction{HenyeyGreenstein{-0.2f}}, PhaseFunction{Rayleigh{}}}) {
        const float along = phase.eval({0, 0, 1}, {0, 0, 1}), across = phase.eval({0, 0, 1}, {1, 0, 0});
        EXPECT_EQ(phase.isIsotropic(), std::abs(along - across) < 1e-6f) << along << " " << across;
    }
}

TEST(PhaseFunction, AgreesWithExtendedPrecision) {
    using Real = long double;
    const Vec3f before = Vec3f(0.3f, -0.5f, 0.8f).normalized();
    const Imath::Vec3<Real> w(before.x, before.y, before.z);
    for (const float g : {-0.999f, -0.995f, -0.3f, 1e-6f, 0.5f, 0.99f, 0.999f})
        for (const float angle : {0.0f, 1e-5f, 1e-4f, 1e-3f, 1e-2f, 0.3f, 2.0f, 3.13f, 3.1415f}) {
            const Vec3f after = Frame(before).toWorld({std::sin(angle), 0.0f, std::cos(angle)}).normalized();
            const Imath::Vec3<Real> a(after.x, after.y, after.z);
            const Real half = std::atan2(w.cross(a).length(), w.dot(a)) / 2, gl = g;
            const Real squared = (1 - gl) * (1 - gl) + 4 * gl * std::sin(half) * std::sin(half);
            const Real expected = (1 - gl * gl) / (4 * 3.14159265358979323846L * std::pow(squared, Real(1.5)));
            EXPECT_NEAR(double(PhaseFunction{HenyeyGreenstein{g}}.eval(before, after)), double(expected),
                        2e-5 * double(expected))
                << g << " " << angle;
        }
}

Medium colouredFog() {
    Medium fog;
    fog.model = Homogeneous{Rgb(0.1f, 0.0f, 0.3f), Rgb(0.5f, 1.5f, 0.0f)};
    return fog;
}

/// A path's first flight.
FlightSample draw(const Medium& medium, float tMax, Sampler& sampler) {
    return sampleFlight(medium, tMax, ChannelDensities(1.0f), sampler);
}

TEST(Medium, FlightsEstimateTheCollisionIntegralPerChannel) {
    const Medium fog = colouredFog();
    constexpr int Count = 400000;
    constexpr float Reach = 1.3f;
    const ChannelDensities before(0.4f, 1.7f, 0.9f);
    Vec3d collided(0.0), squared(0.0), exited(0.0);
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler sampler(9, RandomStream::Test, 0, i);
        const FlightSample flight = sampleFlight(fog, Reach, before, sampler);
        const Vec3d weight(double(flight.weight.x), double(flight.weight.y), double(flight.weight.z));
        EXPECT_LE(flight.distance, Reach);
        if (flight.exited)
            exited += weight;
        else {
            collided += weight;
            squared += weight * weight;
        }
        const float pdf =
            flight.exited ? probabilityFlightExits(fog, Reach, before) : pdfFlight(fog, flight.distance, before);
        EXPECT_NEAR(flight.pdf, pdf, 1e-5f);
        EXPECT_NEAR(meanComponent(flight.channels), 1.0f, 1e-5f);
    }
    for (int c = 0; c < 3; ++c) {
        const double sigmaT = double(fog.sigmaT()[c]), sigmaS = double(fog.sigmaS()[c]);
        const double expected = sigmaS / sigmaT * -std::expm1(-sigmaT * double(Reach));
        const double mean = collided[c] / Count, error = std::sqrt((squared[c] / Count - mean * mean) / Count);
        EXPECT_NEAR(mean, expected, 4.5 * error + 1e-12);
        EXPECT_NEAR(exited[c] / Count, std::exp(-sigmaT * double(Reach)), 0.01);
    }
}

TEST(Medium, FlightDistancesFollowTheirDensity) {
    Medium fog;
    fog.model = Homogeneous{Rgb(0.0f), Rgb(2.0f)};
    EXPECT_GT(
        test::chiSquareUniform([&](Sampler& s) { return -std::expm1(-2.0 * double(draw(fog, Infinity, s).distance)); }),
        test::SmallestPValue);
    // Of coloured media: the mixture that the densities of the channels call for.
    const Medium coloured = colouredFog();
    const ChannelDensities before(0.4f, 1.7f, 0.9f);
    const auto passed = [&](Sampler& s) {
        const float distance = sampleFlight(coloured, Infinity, before, s).distance;
        return 1.0 - double(probabilityFlightExits(coloured, distance, before));
    };
    EXPECT_GT(test::chiSquareUniform(passed), test::SmallestPValue);
}

/// Flights of a path are those of one channel, chosen at its start; weighed by all three, none of its contributions
/// exceeds three times what that channel alone would bring.
TEST(Medium, FlightsOfAPathAreWeighedByChannelsOverAllOfIt) {
    Medium fog;
    fog.model = Homogeneous{Rgb(0.5f, 0.0f, 0.1f), Rgb(5.0f, 10.0f, 20.0f)};
    constexpr int Paths = 20000, Flights = 40;
    constexpr float Reach = 0.3f;
    const Rgb sigma = fog.sigmaT(), albedo = fog.sigmaS() / sigma;
    Vec3d sum(0.0), squares(0.0);
    for (uint64_t i = 0; i < Paths; ++i) {
        Sampler sampler(10, RandomStream::Test, 0, i);
        ChannelDensities channels(1.0f);
        Vec3d throughput(1.0), own(1.0), densities(1.0);
        for (int k = 0; k < Flights; ++k) {
            const FlightSample flight = sampleFlight(fog, Reach, channels, sampler);
            channels = flight.channels;
            for (int c = 0; c < 3; ++c) {
                throughput[c] *= double(flight.weight[c]);
                own[c] *= flight.exited ? 1.0 : double(albedo[c]);
                densities[c] *=
                    std::exp(-double(sigma[c]) * double(flight.distance)) * (flight.exited ? 1.0 : double(sigma[c]));
            }
        }
        const double mean = (densities[0] + densities[1] + densities[2]) / 3.0;
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(double(channels[c]), densities[c] / mean, 1e-4) << c;
            ASSERT_NEAR(throughput[c], own[c] * densities[c] / mean, 1e-4) << c;
            ASSERT_LE(throughput[c], 3.0 * own[c] * 1.0001) << c;
        }
        sum += throughput;
        squares += throughput * throughput;
    }
    for (int c = 0; c < 3; ++c) {
        const double left = std::exp(-double(sigma[c]) * double(Reach)), a = double(albedo[c]);
        const double mean = sum[c] / Paths, error = std::sqrt((squares[c] / Paths - mean * mean) / Paths);
        EXPECT_NEAR(mean, std::pow(left + (1.0 - left) * a, Flights), 4.5 * error) << c;
    }
}

TEST(Medium, AbsorptionAloneAndEmptinessAreCrossedAnalytically) {
    Medium smoke;
    smoke.model = Homogeneous{Rgb(0.7f), Rgb(0.0f)};
    Sampler sampler(1, RandomStream::Test, 0, 0);
    const FlightSample flight = draw(smoke, 2.0f, sampler);
    EXPECT_TRUE(flight.exited);
    EXPECT_FLOAT_EQ(flight.weight.x, std::exp(-1.4f));
    EXPECT_EQ(smoke.transmittance(Infinity), Rgb(0.0f));
    EXPECT_EQ(Medium{}.transmittance(Infinity), Rgb(1.0f));
    Medium red;
    red.model = Homogeneous{Rgb(1.0f, 0.0f, 0.0f), Rgb(0.0f)};
    EXPECT_EQ(red.transmittance(Infinity), Rgb(0.0f));
    EXPECT_EQ(red.transmittance(2.0f).y, 1.0f);
}

TEST(Medium, OpticalDepthsFromTinyToHuge) {
    for (const float depth : {1e-6f, 1e-3f, 1.0f, 80.0f, 1e4f}) {
        Medium fog;
        fog.model = Homogeneous{Rgb(0.0f), Rgb(depth)};
        for (uint64_t i = 0; i < 2000; ++i) {
            Sampler sampler(2, RandomStream::Test, 0, i);
            const FlightSample flight = draw(fog, 1.0f, sampler);
            EXPECT_TRUE(isFinite(flight.weight)) << depth;
            EXPECT_GE(flight.weight.x, 0.0f);
        }
    }
}

} // namespace
} // namespace tungsten
