// Kernels of points and beams, radii from pass to pass, and what records bring, against 50 digits: beams and rays that
// are parallel to 1e-4, a thousand radii from each other, 1e9 passes.

#include "photon/primitives/Primitive.h"
#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/primitives/sliced/SharedLanes.h"

#include "support/Exact.h"
#include "support/FogScene.h"
#include "support/LogUniform.h"

#include "tungsten/core/Warp.h"

#include <boost/math/special_functions/gamma.hpp>

namespace tungsten::photon {
namespace {

using test::Exact;
using test::ExactPi;
using test::LargestError;
using test::logUniform;

using Vector3 = std::array<Exact, 3>;
Vector3 exactly(const Vec3f& v) {
    return {Exact(v.x), Exact(v.y), Exact(v.z)};
}
Exact product(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector3 across(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Of lines as they are, whose directions are unit vectors but for rounding.
TEST(KernelsAccuracy, ClosestApproach) {
    LargestError sine("sine"), distance("distance"), alongBeam("along_beam"), alongRay("along_ray");
    for (uint64_t i = 0; i < 4000; ++i) {
        Sampler s(91, RandomStream::Test, 0, i);
        const Vec3f ray = warp::squareToSphere(s.next2D()), origin = warp::squareToSphere(s.next2D()),
                    turned = warp::squareToSphere(s.next2D()) * float(logUniform(s, 2e-4, 1.0)),
                    beam = i % 2 == 0 ? warp::squareToSphere(s.next2D()) : (ray + turned).normalized();
        const auto scale = float(logUniform(s, 1e-3, 1e3));
        const Vec3f base = origin + warp::squareToSphere(s.next2D()) * scale;
        const auto found = closestApproach(base, beam, origin, ray);
        if (!found) continue;
        const Vector3 b = exactly(beam), c = exactly(ray), from = exactly(base), to = exactly(origin),
                      offset{from[0] - to[0], from[1] - to[1], from[2] - to[2]}, normal = across(b, c);
        const Exact squared = product(normal, normal), apart = sqrt(product(offset, offset));
        sine.add(double(found->sine), sqrt(squared));
        const Exact exact = abs(product(offset, normal)) / sqrt(squared);
        distance.add(double(found->distance()), exact, apart);
        const Exact alongB = -product(across(offset, c), normal) / squared,
                    alongC = -product(across(offset, b), normal) / squared;
        alongBeam.add(double(found->alongBeam), alongB, abs(alongB) + apart);
        alongRay.add(double(found->alongCamera), alongC, abs(alongC) + apart);
    }
    EXPECT_TRUE(sine.within(5e-7, 3000));
    EXPECT_TRUE(distance.within(3e-7, 3000));
    EXPECT_TRUE(alongBeam.within(1.3e-6, 3000));
    EXPECT_TRUE(alongRay.within(1.3e-6, 3000));
}

TEST(KernelsAccuracy, PointsAndReach) {
    LargestError kernel("biweight"), reach("visible_reach");
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(92, RandomStream::Test, 0, i);
        const auto squaredRadius = float(logUniform(s, 1e-12, 1e12)), squared = squaredRadius * (1.2f * s.next1D());
        const Exact x = 1 - Exact(squared) / squaredRadius, peak = 3 / (ExactPi * Exact(squaredRadius));
        kernel.add(double(biweight(squared, squaredRadius)), x > 0 ? Exact(peak * x * x) : Exact(0), peak);
        Medium fog;
        fog.model = Homogeneous{Rgb(float(logUniform(s, 1e-6, 1e4))), Rgb(float(logUniform(s, 1e-6, 1e4)), 0.0f, 0.0f)};
        reach.add(double(visibleReach(fog)), 60 / Exact(fog.sigmaT().x));
    }
    EXPECT_TRUE(kernel.within(4e-7));
    EXPECT_TRUE(reach.within(1.2e-7));
}

/// gamma_i as the quotient of gamma functions; the product that it stands for is the same (photon_map_test.cpp).
TEST(KernelsAccuracy, RadiiFromPassToPass) {
    LargestError early("early"), late("late"), factors("factors");
    for (uint64_t i = 0; i < 120; ++i) {
        Sampler s(93, RandomStream::Test, 0, i);
        const auto pass = uint32_t(i < 20 ? double(i) : logUniform(s, 20.0, i % 2 == 0 ? 1e6 : 4e9));
        const float alpha = 0.05f + 0.95f * s.next1D();
        const Exact n(pass), a(alpha);
        const auto logGamma = [](const Exact& x) { return Exact(boost::math::lgamma(x)); };
        const Exact exact = exp(logGamma(n + 1 + a) - logGamma(1 + a) - logGamma(n + 2));
        (pass <= 1000000 ? early : late).add(radiusScale(pass, double(alpha)), exact);
        if (pass > 1000000) continue;
        factors.add(double(surfaceRadiusFactor(pass, alpha)), sqrt(exact));
        factors.add(double(pointRadiusFactor(pass, alpha)), cbrt(exact));
        factors.add(double(beamRadiusFactor(pass, alpha)), exact);
        factors.add(deltaGateFactor(pass, alpha), sqrt(exact));
    }
    EXPECT_TRUE(early.within(4e-9, 50));
    EXPECT_TRUE(late.within(3.5e-5, 10));
    EXPECT_TRUE(factors.within(1.1e-7));
}

float firstOf(const Batch& batch) {
    alignas(64) std::array<float, size_t(Lanes)> values{};
    batch.store_aligned(values.data());
    return values[0];
}

/// What registers of rays share.
TEST(KernelsAccuracy, Registers) {
    LargestError phase("henyey_greenstein"), fall("mean_of_fall"), dual("dual_pair"), perLength("length_per_length");
    for (uint64_t i = 0; i < 3000; ++i) {
        Sampler s(94, RandomStream::Test, 0, i);
        const float g = (i % 2 == 0 ? 1.0f : -1.0f) * (i % 5 == 0 ? 0.999f : s.next1D());
        const Vec3f before = warp::squareToSphere(s.next2D()), side = warp::squareToSphere(s.next2D());
        const Vec3f after =
            i % 3 == 0 ? (before * (g > 0.0f ? 1.0f : -1.0f) + side * float(logUniform(s, 1e-5, 1.0))).normalized()
                       : side;
        const Vector3 a = exactly(before), b = exactly(after);
        Exact off = 0, sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            const Exact difference = g > 0.0f ? Exact(a[k] - b[k]) : Exact(a[k] + b[k]);
            off += difference * difference;
            sum += (a[k] + b[k]) * (a[k] + b[k]);
        }
        const Exact strength = abs(Exact(g)), d = (1 - strength) * (1 - strength) + strength * off;
        phase.add(double(firstOf(henyeyGreenstein(g, Lanes3(before), Lanes3(after)))),
                  (1 - strength * strength) / (4 * ExactPi * d * sqrt(d)));
        const auto z = float(logUniform(s, 1e-6, 80.0));
        fall.add(double(firstOf(meanOfFall(Batch(z)))), -expm1(-Exact(z)) / z);
        perLength.add(double(firstOf(lengthPerLength(Lanes3(before), Lanes3(after), true))), sum / 2,
                      sum / 2 + Exact(1e-3));
        perLength.add(double(firstOf(lengthPerLength(Lanes3(before), Lanes3(after), false))), abs(product(a, b)),
                      Exact(1));
        // x a + y b, as the pair has it.
        const Vector3 normal = across(a, b);
        const Exact square = product(normal, normal);
        if (square < 1e-6) continue;
        const ReciprocalBasis2 pair(before, after);
        const Vector3 first = across(b, normal);
        for (size_t k = 0; k < 3; ++k) dual.add(double(pair.first[int(k)]), first[k] / square, 1 / square);
    }
    EXPECT_TRUE(phase.within(8e-7));
    EXPECT_TRUE(fall.within(3e-6));
    EXPECT_TRUE(perLength.within(3.5e-7));
    EXPECT_TRUE(dual.within(1.2e-7));
}

/// What records bring to a frame, by which they are drawn at random.
TEST(KernelsAccuracy, LightOfRecords) {
    LargestError light("slice_light");
    Scene scene = test::fogScene();
    const Exact sigma(meanComponent(scene.media[0].sigmaT()));
    for (uint64_t i = 0; i < 1500; ++i) {
        Sampler s(95, RandomStream::Test, 0, i);
        SliceRecord record{};
        record.emitter = -1;
        record.time = logUniform(s, 1e-3, 1e3);
        record.base = warp::squareToSphere(s.next2D()) * 2.0f;
        record.power = Rgb(s.next1D(), s.next1D(), 1.0f);
        record.shape = i % 2 == 0 ? FlightShape::Ball : FlightShape::Volume;
        const double time = record.time + logUniform(s, 1e-3, 50.0);
        const Exact power = (Exact(record.power.x) + record.power.y + record.power.z) / 3,
                    left = Exact(time) - record.time;
        const Vec3f away = scene.camera.position() - record.base;
        const Exact way = sqrt(product(exactly(away), exactly(away))), legs = left > way ? Exact(left - way) : Exact(0);
        const bool inFog = i % 4 < 2; // the camera
        scene.cameraRegion.medium = inFog ? 0 : -1;
        Exact exact = log(power) - sigma * (inFog ? left : legs);
        if (record.shape == FlightShape::Ball) exact -= log(1 + sigma * sigma * legs * legs);
        light.add(logSliceLight(scene, record, time), exact, 1 + sigma * left);
    }
    EXPECT_TRUE(light.within(3.2e-7));
}

} // namespace
} // namespace tungsten::photon
