// Planes, volumes, balls and hypervolumes as pure geometry: verified vectors, in both precisions.

#include "photon/sliced/directions.h"

#include "photon/primitives/sliced/Ball.h"
#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/Volume.h"
#include "photon/primitives/sliced/VolumeBallMis.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// Floats keep about six digits, and lose one or two to determinants.
template <typename Real>
constexpr double Tolerance = sizeof(Real) == sizeof(float) ? 3e-5 : 2e-10;

template <typename Real>
const Vector<Real> Base{Real(1.2), Real(0.5), Real(2)};

template <typename Real>
class VerifiedVectors : public testing::Test {
  protected:
    static void expectNear(Real found, double expected) { EXPECT_NEAR(double(found), expected, Tolerance<Real>); }
};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(VerifiedVectors, Reals);

TYPED_TEST(VerifiedVectors, VolumeSlices) {
    using Real = TypeParam;
    const double expected[2][5] = {{0.7094263374, 1.5943202018, 0.6962534609, 1.9518895528, 1.7306272690},
                                   {0.7154028180, 1.6184738606, 0.7264332086, 1.9396901129, 1.3805572480}};
    for (const bool warped : {false, true}) {
        const auto w = volumeDirections<Real>();
        const auto sight = alongZ<Real>(warped);
        const auto slice = sliceVolume<Real>(Base<Real>, w, sight, warped ? 5 : 3);
        ASSERT_TRUE(slice);
        for (size_t i = 0; i < 3; ++i) this->expectNear(slice->lengths[i], expected[warped][i]);
        this->expectNear(slice->alongRay, expected[warped][3]);
        this->expectNear(slice->jacobian, expected[warped][4]);
        this->expectNear(volumeJacobian(w, sight.direction, warped), expected[warped][4]);
        // Beyond the ray's end, before its start.
        CameraRay<Real> part = sight;
        part.end = Real(1.9);
        EXPECT_FALSE(sliceVolume<Real>(Base<Real>, w, part, warped ? 5 : 3));
        part = sight;
        part.start = 2;
        EXPECT_FALSE(sliceVolume<Real>(Base<Real>, w, part, warped ? 5 : 3));
    }
}

TYPED_TEST(VerifiedVectors, VolumeChord) {
    using Real = TypeParam;
    const auto w = volumeDirections<Real>();
    this->expectNear(determinant(w[0], w[1], w[2]), -0.3500700210);
    const auto chord = volumeChord<Real>(Base<Real>, w, alongZ<Real>(false));
    ASSERT_TRUE(chord);
    this->expectNear(chord->jacobian, 0.3500700210);
    this->expectNear(chord->slopeSum(), -4.9436603112);
    this->expectNear(chord->slopeSum() + 1, -3.9436603112);
}

TYPED_TEST(VerifiedVectors, BallsAndTheirShareWithVolumes) {
    using Real = TypeParam;
    const double jacobians[] = {0.2351474475, 0.2717305823}, ratios[] = {6.4811721130, 4.5557238802};
    for (const bool warped : {false, true}) {
        const auto w = volumeDirections<Real>();
        const auto sight = alongZ<Real>(warped);
        const auto slice = sliceVolume<Real>(Base<Real>, w, sight, warped ? 5 : 3);
        ASSERT_TRUE(slice);
        const auto& t = slice->lengths;
        const Real before = t[0] + t[1], residual = (warped ? Real(5) : Real(3)) - before;
        const auto balls = sliceBall<Real>(Base<Real> + w[0] * t[0] + w[1] * t[1], sight, residual);
        bool found = false;
        for (int i = 0; i < balls.count; ++i) {
            const BallHit<Real>& reach = balls.hits[size_t(i)];
            if (std::abs(double(reach.alongRay - slice->alongRay)) > 1e-4) continue;
            found = true;
            this->expectNear(reach.jacobian, jacobians[warped]);
            this->expectNear(reach.length, double(t[2]));
        }
        EXPECT_TRUE(found);
        constexpr double SigmaT = 0.6;
        const Real pdfs = Real(SigmaT * SigmaT * std::exp(-SigmaT * double(before)));
        const SharedPath<Real> path{w, t[2], Real(0.25 / M_PI), pdfs};
        const Real ratio = path.ratio(sight.direction, warped);
        EXPECT_NEAR(double(ratio) / ratios[warped], 1.0, 2.0 * Tolerance<Real>);
        this->expectNear(volumeWeight(ratio) + ballWeight(ratio), 1.0);
    }
    const Vector<Real> centre(Real(0.7), Real(-0.4), Real(1.5));
    const auto ellipsoid = sliceBall<Real>(centre, alongZ<Real>(true), Real(3.1));
    ASSERT_EQ(ellipsoid.count, 1);
    this->expectNear(ellipsoid.hits[0].alongRay, 2.096875);
    this->expectNear(ellipsoid.hits[0].length, 1.003125);
    this->expectNear(ellipsoid.hits[0].jacobian, 1.605);
    const auto sphere = sliceBall<Real>(centre, alongZ<Real>(false), Real(1.2));
    ASSERT_EQ(sphere.count, 2);
    this->expectNear(sphere.hits[0].alongRay, 0.6111805583);
    this->expectNear(sphere.hits[1].alongRay, 2.3888194417);
    for (const auto& reach : sphere.hits) this->expectNear(reach.jacobian, 1.0665833301);
}

TYPED_TEST(VerifiedVectors, Plane) {
    using Real = TypeParam;
    const auto crossing =
        crossPlane<Real>(Base<Real>, {unit<Real>(-1, 0, -1), unit<Real>(-1, -1, 1)}, alongZ<Real>(true));
    ASSERT_TRUE(crossing);
    this->expectNear(crossing->lengths[0], 0.9899494937);
    this->expectNear(crossing->lengths[1], 0.8660254038);
    this->expectNear(crossing->alongRay, 1.8);
    this->expectNear(crossing->jacobian, 0.4082482905);
}

TYPED_TEST(VerifiedVectors, HypervolumeSlices) {
    using Real = TypeParam;
    const auto w = hypervolumeDirections<Real>();
    this->expectNear(hypervolumeJacobian(w), 1.1969234251);
    const double starts[] = {1.7860614947, 1.6948711459};
    for (const bool warped : {false, true}) {
        const auto chord = sliceHypervolume<Real>(Base<Real>, w, alongZ<Real>(warped), warped ? 6 : 4);
        ASSERT_TRUE(chord);
        this->expectNear(chord->jacobian, 1.1969234251);
        this->expectNear(chord->start, starts[warped]);
        this->expectNear(chord->end, 2.5);
        this->expectNear(chord->slopeSum() + (warped ? 1 : 0), 0.0);
    }
}

} // namespace
} // namespace tungsten::photon
