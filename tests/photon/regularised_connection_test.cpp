// Light from close by, spread over the surface: how much of it there is, and where.

#include "photon/surface/SurfaceConnections.h"

#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr float Length = 0.1f;

/// Of a vertex at height `h`, `rho` aside, on a floor.
template <typename Intensity>
double irradiance(float h, float rho, float spread, const Intensity& intensity) {
    const RegularisedConnection seen = regularisedConnection({rho, h, 0.0f}, {0.0f, 1.0f, 0.0f}, spread);
    EXPECT_NEAR(seen.from.length(), 1.0f, 1e-5f);
    return double(seen.light(intensity)) * double(seen.from.y);
}
float even(const Vec3f& /*direction*/) {
    return 1.0f;
}
double irradiance(float h, float rho, float spread) {
    return irradiance(h, rho, spread, even);
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
        const double width = double(std::max(h, Length)); // rho = width tan(theta)
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

TEST(RegularisedConnection, KeepsTheLight) {
    expectAllLight(even);
    expectAllLight([](const Vec3f& direction) { return std::max(-direction.y, 0.0f); }); // a ceiling
    for (const float g : {-0.5f, 0.5f, 0.9f})
        expectAllLight([g](const Vec3f& direction) {
            const float d = 1.0f + g * g + 2.0f * g * direction.y;
            return (1.0f - g * g) / (d * std::sqrt(d));
        });
}

/// Sharp lobes too: within what the vertex brings from one place at a distance of at least the spread.
TEST(RegularisedConnection, IsNeverNegativeAndBounded) {
    Sampler sampler(1, RandomStream::Test, 0, 0);
    for (const float g : {-0.9f, 0.0f, 0.9f, 0.99f})
        for (int i = 0; i < 20000; ++i) {
            const Vec3f axis = warp::squareToSphere(sampler.next2D());
            const float reach = 3.0f * Length * sampler.next1D();
            const Vec3f toVertex = warp::squareToSphere(sampler.next2D()) * reach;
            float sent = 0.0f;
            const RegularisedConnection seen = regularisedConnection(toVertex, {0.0f, 1.0f, 0.0f}, Length);
            const float light = seen.light([&](const Vec3f& direction) {
                const float squared = (direction - axis * g).length2();
                return sent = std::max(sent, (1.0f - g * g) / (squared * std::sqrt(squared)));
            });
            EXPECT_GE(light, 0.0f);
            EXPECT_LE(light, 1.001f * sent / (Length * Length));
        }
}

TEST(RegularisedConnection, LeavesLightFromFurtherAboveAlone) {
    for (const float h : {1.0f, 1.5f, 20.0f})
        for (const float rho : {0.0f, 0.1f, 3.0f}) {
            const double height = double(h * Length), squared = height * height + double(rho) * double(rho);
            const double exact = height / (squared * std::sqrt(squared));
            EXPECT_NEAR(irradiance(float(height), rho, Length), exact, 1e-5 * exact);
        }
}

/// Of vertices at all heights from 0 to 1, 2 aside.
TEST(RegularisedConnection, HasAnErrorOfSecondOrder) {
    const auto error = [](float spread) {
        constexpr int Steps = 100000;
        double sum = 0.0;
        for (int i = 0; i < Steps; ++i) {
            const float h = (float(i) + 0.5f) / float(Steps);
            sum += (irradiance(h, 2.0f, spread) - irradiance(h, 2.0f, 0.0f)) / Steps;
        }
        return sum;
    };
    for (const float spread : {0.2f, 0.1f, 0.05f}) {
        const double expected = 0.5 * double(spread * spread) / 8.0;
        EXPECT_NEAR(error(spread), expected, 0.04 * expected) << spread;
    }
}

TEST(RegularisedConnection, OfNothingIsTheInverseSquare) {
    const Vec3f toVertex(0.3f, 0.2f, -0.1f), normal(0.0f, 0.6f, 0.8f);
    const RegularisedConnection light = regularisedConnection(toVertex, normal, 0.0f);
    EXPECT_FLOAT_EQ(light.light(even), 1.0f / toVertex.length2());
    EXPECT_NEAR((light.from - toVertex.normalized()).length(), 0.0f, 1e-6f);
    EXPECT_EQ(regularisedConnection(Vec3f(0.0f), normal, 0.0f).light(even), 0.0f);
}

TEST(RegularisedConnection, DoesNotCareForTheNormalsSide) {
    for (const float h : {-0.2f, 0.2f}) {
        const Vec3f toVertex(0.1f, h, 0.05f), up(0.0f, 1.0f, 0.0f);
        const RegularisedConnection a = regularisedConnection(toVertex, up, Length),
                                    b = regularisedConnection(toVertex, -up, Length);
        EXPECT_EQ(a.light(even), b.light(even));
        EXPECT_NEAR((a.from - b.from).length(), 0.0f, 1e-6f);
        EXPECT_GT(a.from.y * h, 0.0f); // light stays on its side
    }
}

TEST(ConnectionBlur, ShrinksAsGatherRadiiDo) {
    const ConnectionBlur first = ConnectionBlur::of(0.2f, 1.0f), later = ConnectionBlur::of(0.2f, 0.25f);
    EXPECT_FLOAT_EQ(first.most, 0.2f);
    EXPECT_GT(first.pixels, 0.0f);
    EXPECT_FLOAT_EQ(later.most, 0.25f * first.most);
    EXPECT_FLOAT_EQ(later.pixels, 0.25f * first.pixels);
}

} // namespace
} // namespace tungsten::photon
