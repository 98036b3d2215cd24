// Light from close by, spread over the surface: against the blur of its irradiance, integrated numerically.

#include "photon/SpreadArrival.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr float Spread = 0.1f;

/// On a floor through the origin, from a vertex of unit intensity at height `h`, `rho` aside.
double irradiance(float h, float rho, float spread, const Vec3f& normal = {0.0f, 1.0f, 0.0f}) {
    const SpreadArrival light = spreadArrival({rho, h, 0.0f}, normal, spread);
    EXPECT_NEAR(light.from.length(), 1.0f, 1e-5f);
    return double(light.geometry) * double(light.from.y);
}

/// 2 P_r - P_2r, per area.
double kernel(double rho, double r) {
    const auto poisson = [rho](double height) {
        return height / (2.0 * double(Pi) * std::pow(height * height + rho * rho, 1.5));
    };
    return 2.0 * poisson(r) - poisson(2.0 * r);
}

/// The exact irradiance h / d^3 in the plane, blurred; polar coordinates about the vertex's foot, rho = h tan(theta).
double blurred(double h, double rho, double spread) {
    constexpr int Rings = 4000, Sectors = 200;
    double sum = 0.0;
    for (int i = 0; i < Rings; ++i) {
        // 1 - cos(theta) = t^2 is even in the flux, which is 2 pi in all.
        const double t = (i + 0.5) / Rings, cosine = 1.0 - t * t, ring = h * std::sqrt(1.0 / (cosine * cosine) - 1.0);
        for (int j = 0; j < Sectors; ++j) {
            const double angle = 2.0 * double(Pi) * (j + 0.5) / Sectors;
            sum += 2.0 * t * kernel(std::hypot(ring * std::cos(angle) - rho, ring * std::sin(angle)), spread);
        }
    }
    return sum * 2.0 * double(Pi) / (double(Rings) * Sectors);
}

TEST(SpreadArrival, IsTheBlurOfTheIrradiance) {
    for (const float h : {0.01f, 0.05f, 0.1f, 0.4f, 2.0f})
        for (const float rho : {0.0f, 0.03f, 0.1f, 0.5f}) {
            const double expected = blurred(double(h), double(rho), double(Spread));
            EXPECT_NEAR(irradiance(h, rho, Spread), expected, 2e-3 * expected) << h << ", " << rho;
        }
}

TEST(SpreadArrival, KeepsTheLight) {
    for (const float h : {1e-6f, 0.01f, 0.1f, 1.0f}) {
        // rho = s tan(theta), s about the width.
        constexpr int Steps = 200000;
        const double width = double(h + Spread);
        double flux = 0.0;
        for (int i = 0; i < Steps; ++i) {
            const double theta = 0.5 * double(Pi) * (i + 0.5) / Steps, tangent = std::tan(theta);
            const double rho = width * tangent, step = width * (1.0 + tangent * tangent) * 0.5 * double(Pi) / Steps;
            if (rho > 1e6 * width) break;
            flux += 2.0 * double(Pi) * rho * irradiance(h, float(rho), Spread) * step;
        }
        EXPECT_NEAR(flux, 2.0 * double(Pi), 2e-3) << h;
    }
}

TEST(SpreadArrival, IsBounded) {
    for (const float h : {0.0f, 1e-7f, 1e-3f})
        for (const float rho : {0.0f, 1e-7f, 1e-3f, 0.1f}) {
            const float geometry = spreadArrival({rho, h, 0.0f}, {0.0f, 1.0f, 0.0f}, Spread).geometry;
            EXPECT_GT(geometry, 0.0f);
            EXPECT_LT(geometry, 2.0f / (Spread * Spread));
        }
}

/// The error is of second order in spread / distance.
TEST(SpreadArrival, LeavesFarLightAlone) {
    for (const float distance : {2.0f, 20.0f})
        for (const float cosine : {0.2f, 0.6f, 1.0f}) {
            const float h = distance * cosine, rho = distance * std::sqrt(1.0f - cosine * cosine);
            const double exact = double(cosine) / double(distance * distance), relative = double(Spread / distance);
            EXPECT_NEAR(irradiance(h, rho, Spread), exact, 10.0 * relative * relative * exact + 1e-6 * exact);
        }
}

TEST(SpreadArrival, OfNothingIsTheInverseSquare) {
    const Vec3f toVertex(0.3f, 0.2f, -0.1f), normal(0.0f, 0.6f, 0.8f);
    const SpreadArrival light = spreadArrival(toVertex, normal, 0.0f);
    EXPECT_FLOAT_EQ(light.geometry, 1.0f / toVertex.length2());
    EXPECT_NEAR((light.from - toVertex.normalized()).length(), 0.0f, 1e-6f);
    EXPECT_EQ(spreadArrival(Vec3f(0.0f), normal, 0.0f).geometry, 0.0f);
}

TEST(SpreadArrival, DoesNotCareForTheNormalsSide) {
    for (const float h : {-0.2f, 0.2f}) {
        const Vec3f toVertex(0.1f, h, 0.05f), up(0.0f, 1.0f, 0.0f);
        const SpreadArrival a = spreadArrival(toVertex, up, Spread), b = spreadArrival(toVertex, -up, Spread);
        EXPECT_EQ(a.geometry, b.geometry);
        EXPECT_NEAR((a.from - b.from).length(), 0.0f, 1e-6f);
        EXPECT_GT(a.from.y * h, 0.0f); // light stays on its side
    }
}

} // namespace
} // namespace tungsten::photon
