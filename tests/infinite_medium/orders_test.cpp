// Order by order against verified values: configurations A and B, an isotropic point source of intensity 1 and a camera
// ray along z, isotropic and forward scattering, light of path lengths in [5, 6).

#include "estimates.h"

#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace infinite_medium::test {
namespace {

const darts::Vec3 Source{1.2f, 0.5f, 2.0f}, Camera{0, 0, 0}, Along{0, 0, 1};
const darts::TimeGate Gate{5.0, 6.0};

darts::Medium medium(float g) {
    return {{0.1f, 0.1f, 0.1f}, {0.5f, 0.5f, 0.5f}, g};
}

/// Values of independent computations: exact ones for isotropic scattering.
struct Verified {
    float g;
    std::array<Estimate, Orders> orders;
};

/// Radiance per path length of single scattering is sigmaS f_p e^{-sigmaT S} r^-2 dt/dS.
double singleScattering(float g) {
    const double C = std::sqrt(1.44 + 0.25 + 4.0), h = 1 - 2.0 / C;
    return tungsten::test::integrate<31>(
        [&](double S) {
            const darts::Ellipse<double> e{C, S - C, h};
            const double t = e.firstLeg(), r = e.secondLeg();
            // Light comes from the source down to (0, 0, t) and leaves along -z.
            const double cosine = -(t - 2.0) / r, d = 1 + double(g) * double(g) - 2 * double(g) * cosine;
            const double phase = (1 - double(g) * double(g)) / (4 * 3.14159265358979323846 * d * std::sqrt(d));
            return 0.5 * phase * std::exp(-0.6 * S) / (r * r) * e.firstLegPerLength();
        },
        Gate.begin, Gate.end);
}

Verified configurationA() {
    return {0.0f, {{{}, {2.22436e-4, 0}, {5.97962e-4, 0}, {7.81135e-4, 0}}}};
}
Verified configurationB() {
    return {0.6f, {{{}, {singleScattering(0.6f), 0}, {1.28207e-4, 0.00072e-4}, {1.9005e-4, 0.001e-4}}}};
}

void expectOrders(const std::array<Estimate, Orders>& found, const Verified& verified, double bias, double precision) {
    for (size_t order = 1; order < Orders; ++order) {
        const Estimate& expected = verified.orders[order];
        const double tolerance = 4.5 * std::hypot(found[order].error, expected.error) + bias * expected.mean;
        EXPECT_NEAR(found[order].mean, expected.mean, tolerance) << "order " << order;
        EXPECT_LT(found[order].error, precision * expected.mean) << "order " << order << ": the test says nothing";
    }
}

TEST(Orders, SingleScatteringQuadratureGivesTheVerifiedValue) {
    EXPECT_NEAR(singleScattering(0.0f), 2.22436e-4, 1e-9);
}

TEST(Orders, PathModeMatchesVerifiedValues) {
    for (const Verified& verified : {configurationA(), configurationB()})
        for (const bool best : {true, false}) {
            darts::Settings settings =
                best ? darts::best(darts::Mode::Path, verified.g) : darts::published(darts::Mode::Path);
            settings.bounded = true;
            const Route route{Camera, Source, Gate, Orders - 1};
            SCOPED_TRACE(testing::Message() << "g = " << verified.g << (best ? ", best" : ", published, bounded"));
            expectOrders(radianceByOrder(settings, medium(verified.g), route, Along, best ? 900000 : 300000, 21),
                         verified, 0, best ? 0.01 : 0.02);
        }
}

TEST(Orders, PhotonModeMatchesVerifiedValues) {
    constexpr float KernelRadius = 0.15f; // bias well under 1 % here
    for (const Verified& verified : {configurationA(), configurationB()})
        for (const bool best : {true, false}) {
            darts::Settings settings =
                best ? darts::best(darts::Mode::Photon, verified.g) : darts::published(darts::Mode::Photon);
            settings.bounded = true;
            const Route route{Source, Camera, Gate, Orders - 1};
            SCOPED_TRACE(testing::Message() << "g = " << verified.g << (best ? ", best" : ", published, bounded"));
            expectOrders(
                gatheredByOrder(settings, medium(verified.g), route, KernelRadius, best ? 2000000 : 1000000, 22),
                verified, 0.01, best ? 0.05 : 0.2);
        }
}

} // namespace
} // namespace infinite_medium::test
