// Light from close by, spread over the surface: against the blur of its irradiance, integrated numerically.

#include "photon/SpreadArrival.h"
#include "photon/SurfaceConnections.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr float Length = 0.1f;

/// Of a vertex at height `h`, `rho` aside, on a floor.
template <typename Intensity>
double irradiance(float h, float rho, float spread, const Intensity& intensity) {
    const SpreadArrival arrival = spreadArrival({rho, h, 0.0f}, {0.0f, 1.0f, 0.0f}, spread);
    EXPECT_NEAR(arrival.from.length(), 1.0f, 1e-5f);
    EXPECT_NEAR(arrival.fromFurther.length(), 1.0f, 1e-5f);
    return double(arrival.light(intensity)) * double(arrival.from.y);
}
float even(const Vec3f& /*direction*/) {
    return 1.0f;
}
double irradiance(float h, float rho, float spread) {
    return irradiance(h, rho, spread, even);
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
            const double expected = blurred(double(h), double(rho), double(Length));
            EXPECT_NEAR(irradiance(h, rho, Length), expected, 2e-3 * expected) << h << ", " << rho;
        }
}

/// Whatever the vertex sends where (downwards, as the test's intensities are about the vertical).
template <typename Intensity>
void expectAllLight(const Intensity& intensity) {
    constexpr int Steps = 200000;
    const double step = 0.5 * double(Pi) / Steps;
    double sent = 0.0;
    for (int i = 0; i < Steps; ++i) {
        const double theta = (i + 0.5) * step;
        const Vec3f direction(float(std::sin(theta)), -float(std::cos(theta)), 0.0f);
        sent += 2.0 * double(Pi) * std::sin(theta) * double(intensity(direction)) * step;
    }
    for (const float h : {1e-6f, 0.01f, 0.1f, 1.0f}) {
        const double width = double(h + Length); // rho = width tan(theta)
        double flux = 0.0;
        for (int i = 0; i < Steps; ++i) {
            const double tangent = std::tan((i + 0.5) * step), rho = width * tangent;
            if (rho > 1e6 * width) break;
            flux += 2.0 * double(Pi) * rho * irradiance(h, float(rho), Length, intensity) * width *
                    (1.0 + tangent * tangent) * step;
        }
        EXPECT_NEAR(flux, sent, 1e-3 * sent) << h;
    }
}

TEST(SpreadArrival, KeepsTheLight) {
    expectAllLight(even);
    expectAllLight([](const Vec3f& direction) { return std::max(-direction.y, 0.0f); }); // a ceiling
    for (const float g : {-0.5f, 0.5f, 0.9f})
        expectAllLight([g](const Vec3f& direction) {
            const float d = 1.0f + g * g + 2.0f * g * direction.y;
            return (1.0f - g * g) / (d * std::sqrt(d));
        });
}

TEST(SpreadArrival, IsBounded) {
    for (const float h : {0.0f, 1e-7f, 1e-3f})
        for (const float rho : {0.0f, 1e-7f, 1e-3f, 0.1f}) {
            const double light = irradiance(h, rho, Length);
            EXPECT_GT(light, 0.0);
            EXPECT_LT(light, 2.0 / double(Length * Length));
        }
}

/// The error is of second order in spread / distance.
TEST(SpreadArrival, LeavesFarLightAlone) {
    for (const float distance : {2.0f, 20.0f})
        for (const float cosine : {0.2f, 0.6f, 1.0f}) {
            const float h = distance * cosine, rho = distance * std::sqrt(1.0f - cosine * cosine);
            const double exact = double(cosine) / double(distance * distance), relative = double(Length / distance);
            EXPECT_NEAR(irradiance(h, rho, Length), exact, 10.0 * relative * relative * exact + 1e-6 * exact);
        }
}

TEST(SpreadArrival, OfNothingIsTheInverseSquare) {
    const Vec3f toVertex(0.3f, 0.2f, -0.1f), normal(0.0f, 0.6f, 0.8f);
    const SpreadArrival light = spreadArrival(toVertex, normal, 0.0f);
    EXPECT_FLOAT_EQ(light.light(even), 1.0f / toVertex.length2());
    EXPECT_NEAR((light.from - toVertex.normalized()).length(), 0.0f, 1e-6f);
    EXPECT_EQ(spreadArrival(Vec3f(0.0f), normal, 0.0f).light(even), 0.0f);
}

TEST(SpreadArrival, DoesNotCareForTheNormalsSide) {
    for (const float h : {-0.2f, 0.2f}) {
        const Vec3f toVertex(0.1f, h, 0.05f), up(0.0f, 1.0f, 0.0f);
        const SpreadArrival a = spreadArrival(toVertex, up, Length), b = spreadArrival(toVertex, -up, Length);
        EXPECT_EQ(a.light(even), b.light(even));
        EXPECT_NEAR((a.from - b.from).length(), 0.0f, 1e-6f);
        EXPECT_GT(a.from.y * h, 0.0f); // light stays on its side
    }
}

TEST(Spread, ShrinksAsGatherRadiiDo) {
    const Spread first = Spread::of(0.2f, 1.0f), later = Spread::of(0.2f, 0.25f);
    EXPECT_FLOAT_EQ(first.most, 0.2f);
    EXPECT_GT(first.pixels, 0.0f);
    EXPECT_FLOAT_EQ(later.most, 0.25f * first.most);
    EXPECT_FLOAT_EQ(later.pixels, 0.25f * first.pixels);
}

} // namespace
} // namespace tungsten::photon
