// Refracted ways against 50 digits: depths and heights from 1e-4 to 1e4, ways that leave along the boundary, indices
// from 0.4 to 2.5.

#include "path/techniques/RefractedView.h"

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Random.h"

namespace tungsten::path {
namespace {

using test::Exact;
using test::LargestError;
using test::logUniform;

/// Sine of the angle inside.
Exact sineInside(const Exact& depth, const Exact& height, const Exact& lateral, const Exact& index) {
    // By the larger of both tangents: the other sine is far from 1.
    const bool denser = index >= 1;
    const Exact m = denser ? index : Exact(1 / index), wide = denser ? height : depth, narrow = denser ? depth : height;
    Exact t = lateral / (wide + narrow / m);
    for (int i = 0; i < 200; ++i) { // Newton's steps from below
        const Exact squared = m * m + (m * m - 1) * t * t, root = sqrt(squared);
        const Exact step = (lateral - wide * t - narrow * t / root) / (wide + narrow * m * m / (squared * root));
        t += step;
        if (abs(step) <= t * Exact(1e-40)) break;
    }
    const Exact sine = t / sqrt(1 + t * t);
    return denser ? Exact(sine / m) : sine;
}

TEST(RefractionAccuracy, WaysThroughAPlane) {
    LargestError inside("inside"), outside("outside"), area("area");
    for (uint64_t i = 0; i < 1500; ++i) {
        Sampler s(71, RandomStream::Test, 0, i);
        const auto depth = float(logUniform(s, 1e-4, 1e4)), height = float(double(depth) * logUniform(s, 1e-4, 1e4)),
                   lateral = i % 9 == 0 ? 0.0f : float(double(depth + height) * logUniform(s, 1e-4, 1e3)),
                   index = i % 7 == 0 ? 1.0f : float(logUniform(s, 0.4, 2.5));
        const auto way = refractedPath(depth, height, lateral, index);
        ASSERT_TRUE(way);
        const Exact sine = lateral > 0.0f ? sineInside(depth, height, lateral, index) : Exact(0);
        const Exact in = sqrt(1 - sine * sine), out = sqrt(1 - Exact(index) * index * sine * sine);
        inside.add(double(way->inside()), depth / in);
        outside.add(double(way->outside()), height / out);
        const Exact beyond = height * Exact(index) / out;
        area.add(double(way->areaPerSolidAngle(index)),
                 (depth / in + beyond) * (depth / (in * in) + beyond * in / (out * out)));
    }
    EXPECT_TRUE(inside.within(2.1e-7));
    EXPECT_TRUE(outside.within(2e-7));
    EXPECT_TRUE(area.within(8e-7));
}

/// Near total reflection the rounding of the direction itself is 1e-7 over the cosine outside.
TEST(RefractionAccuracy, DirectionsBeyondAPlane) {
    LargestError along("direction");
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(72, RandomStream::Test, 0, i);
        const auto index = float(logUniform(s, 0.4, 2.5));
        const double most = std::min(1.0, 1.0 / double(index)), sine = most * (1.0 - logUniform(s, 1e-6, 1.0));
        const float phi = 6.28f * s.next1D();
        const Vec3f direction(float(sine) * std::cos(phi), float(sine) * std::sin(phi),
                              float(std::sqrt(1.0 - sine * sine)));
        const auto out = refractedOut(direction, Vec3f(0, 0, 1), index);
        const Exact z(direction.z), tangent2 = Exact(direction.x) * direction.x + Exact(direction.y) * direction.y;
        const Exact squared = 1 - Exact(index) * index * tangent2 / (tangent2 + z * z);
        if (!out || !(squared > 0)) continue;
        const Exact cosine = sqrt(squared);
        along.add(double(out->z), cosine, 1 / cosine);
        along.add(double(out->x), index * Exact(direction.x) / sqrt(tangent2 + z * z), 1 / cosine);
    }
    EXPECT_TRUE(along.within(4e-7, 2000));
}

} // namespace
} // namespace tungsten::path
