// Planes, volumes, balls and hypervolumes as pure geometry: verified vectors, and delta gates as limits of boxes.

#include "photon/primitives/balls/BallSlice.h"
#include "photon/primitives/balls/VolumeOrBall.h"
#include "photon/primitives/hypervolumes/HypervolumeSlice.h"
#include "photon/primitives/planes/PlaneCrossing.h"
#include "photon/primitives/volumes/VolumeSlice.h"

#include "tungsten/core/Random.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// Floats keep about six digits, and lose one or two to determinants.
template <typename Real>
constexpr double Tolerance = sizeof(Real) == sizeof(float) ? 3e-5 : 2e-10;

template <typename Real>
Vector<Real> unit(double x, double y, double z) {
    const Vec3d d = Vec3d(x, y, z).normalized();
    return {Real(d.x), Real(d.y), Real(d.z)};
}
template <typename Real>
SightLine<Real> alongZ(bool warped) {
    return {Vector<Real>(0), Vector<Real>(0, 0, 1), 0, std::numeric_limits<Real>::infinity(), warped};
}
template <typename Real>
const Vector<Real> Base{Real(1.2), Real(0.5), Real(2)};
template <typename Real>
std::array<Vector<Real>, 3> volumeDirections() {
    return {unit<Real>(-2, 1, 1), unit<Real>(-1, -1, 0), unit<Real>(3, 2, -2)};
}
template <typename Real>
std::array<Vector<Real>, 4> hypervolumeDirections() {
    return {unit<Real>(0, 2, -2), unit<Real>(1, -1, 1), unit<Real>(-2, -1, 1), unit<Real>(2, 0, -2)};
}

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
        SightLine<Real> part = sight;
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
            const BallReach<Real>& reach = balls.reaches[size_t(i)];
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
        this->expectNear(volumeShare(ratio) + ballShare(ratio), 1.0);
    }
    const Vector<Real> centre(Real(0.7), Real(-0.4), Real(1.5));
    const auto ellipsoid = sliceBall<Real>(centre, alongZ<Real>(true), Real(3.1));
    ASSERT_EQ(ellipsoid.count, 1);
    this->expectNear(ellipsoid.reaches[0].alongRay, 2.096875);
    this->expectNear(ellipsoid.reaches[0].length, 1.003125);
    this->expectNear(ellipsoid.reaches[0].jacobian, 1.605);
    const auto sphere = sliceBall<Real>(centre, alongZ<Real>(false), Real(1.2));
    ASSERT_EQ(sphere.count, 2);
    this->expectNear(sphere.reaches[0].alongRay, 0.6111805583);
    this->expectNear(sphere.reaches[1].alongRay, 2.3888194417);
    for (const auto& reach : sphere.reaches) this->expectNear(reach.jacobian, 1.0665833301);
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

/// Sight lines and directions without a pattern.
struct RandomGeometry {
    Sampler sampler{5, RandomStream::Test, 0, 0};

    double next(double low, double high) { return low + (high - low) * double(sampler.next1D()); }
    Vec3d direction() {
        const double z = next(-1, 1), phi = next(0, 2 * M_PI), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    template <size_t K>
    std::array<Vec3d, K> directions() {
        std::array<Vec3d, K> w;
        for (Vec3d& d : w) d = direction();
        return w;
    }
    /// Its direction is near the base's, or primitives are rarely met.
    SightLine<double> sight(const Vec3d& base, bool warped) {
        const Vec3d origin(next(-1, 1), next(-1, 1), next(-1, 1));
        const Vec3d towards = (base + direction() * 0.5 - origin).normalized();
        return {origin, towards, 0, std::numeric_limits<double>::infinity(), warped};
    }
};
const Vec3d Centre(1.2, 0.5, 2.0);
constexpr Coefficients<double> Fog{0.5, 0.6};

/// A slice is the density of the volume's chord over lengths: the closed integral (10) is the integral of (7).
TEST(Volumes, ChordsIntegrateSlices) {
    RandomGeometry random;
    int met = 0;
    for (int k = 0; k < 4000; ++k) {
        const bool warped = k % 2 == 0;
        const auto w = random.directions<3>();
        const auto sight = random.sight(Centre, warped);
        const double low = random.next(1, 5), high = low + random.next(0.1, 2);
        for (const bool longFlights : {true, false}) {
            auto chord = volumeChord<double>(Centre, w, sight);
            if (!chord) continue;
            chord->keepGate({low, high}, sight.warp());
            const double whole = chord->empty() ? 0.0 : chordWeight(*chord, Fog, 0.0, longFlights);
            // In pieces: the slices' range of lengths may begin or end inside the gate.
            double sum = 0.0;
            if (!chord->empty()) {
                const double slope = chord->slopeSum() + sight.warp(),
                             atStart = chord->offsetSum() + slope * chord->start,
                             atEnd = chord->offsetSum() + slope * chord->end;
                const auto slice = [&](double residual) {
                    const auto found = sliceVolume<double>(Centre, w, sight, residual, 0.0);
                    return found ? found->weight(Fog, 0.0, longFlights) : 0.0;
                };
                sum = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(slice, std::min(atStart, atEnd),
                                                                                    std::max(atStart, atEnd), 4, 1e-10);
                EXPECT_GE(std::min(atStart, atEnd), low - 1e-9);
                EXPECT_LE(std::max(atStart, atEnd), high + 1e-9);
            }
            if (whole > 0.0) ++met;
            EXPECT_NEAR(sum, whole, 1e-6 * whole + 1e-12);
        }
    }
    EXPECT_GT(met, 100);
}

/// Outside its chord a volume has no slice inside the gate.
TEST(Volumes, SlicesLieOnTheChord) {
    RandomGeometry random;
    int met = 0;
    for (int k = 0; k < 20000; ++k) {
        const auto w = random.directions<3>();
        const auto sight = random.sight(Centre, k % 2 == 0);
        const double residual = random.next(1, 6);
        const auto slice = sliceVolume<double>(Centre, w, sight, residual);
        if (!slice) continue;
        ++met;
        const auto& t = slice->lengths;
        const Vec3d end = Centre + w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
        EXPECT_LT((end - sight.at(slice->alongRay)).length(), 1e-9 / slice->jacobian);
        EXPECT_NEAR(slice->flightLength() + sight.warp() * slice->alongRay, residual, 1e-9);
        const auto chord = volumeChord<double>(Centre, w, sight, 1e-12);
        ASSERT_TRUE(chord);
        EXPECT_GE(slice->alongRay, chord->start - 1e-6);
        EXPECT_LE(slice->alongRay, chord->end + 1e-6);
        for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(chord->length(i, slice->alongRay), t[i], 1e-6 / chord->jacobian);
    }
    EXPECT_GT(met, 200);
}

/// (13) over a gate is the integral of (11) over lengths.
TEST(Balls, GatesIntegrateSlices) {
    RandomGeometry random;
    int met = 0;
    for (int k = 0; k < 200; ++k) {
        const bool warped = k % 2 == 0;
        const auto sight = random.sight(Centre, warped);
        const ResidualGate<double> gate{random.next(0, 3), random.next(3, 6)};
        const auto lit = gateBall<double>(Centre, sight, gate);
        const double h = lit.view.distanceFromRay;
        if (!(lit.angles() > 0)) continue;
        ++met;
        const auto alongRay = [&](double t) {
            const double d = std::hypot(h, t - lit.view.toFoot);
            return Fog.sigmaS * std::exp(-Fog.sigmaT * (d + t)) / (d * d);
        };
        double exact = 0.0;
        for (size_t i = 0; i < 2; ++i)
            if (lit.angle[i] > 0)
                exact += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(alongRay, lit.start[i],
                                                                                       lit.end[i], 10, 1e-11);
        double sampled = 0.0;
        constexpr int Samples = 20000;
        for (int i = 0; i < Samples; ++i) {
            const auto reach = lit.sample((i + 0.5) / Samples);
            EXPECT_NEAR((sight.at(reach.alongRay) - Centre).length(), reach.length, 1e-9 * (1 + reach.length));
            const double length = reach.length + sight.warp() * reach.alongRay;
            EXPECT_GE(length, gate.least - 1e-9);
            EXPECT_LE(length, gate.most + 1e-9);
            sampled += lit.weight(reach, Fog) / Samples;
        }
        EXPECT_NEAR(sampled, exact, 4e-3 * exact);
        // Slices at midpoints.
        double sliced = 0.0;
        constexpr int Slices = 200000;
        for (int i = 0; i < Slices; ++i) {
            const auto slice = sliceBall<double>(Centre, sight, gate.least + gate.width() * (i + 0.5) / Slices);
            for (int r = 0; r < slice.count; ++r)
                sliced += slice.reaches[size_t(r)].weight(Fog) * gate.width() / Slices;
        }
        EXPECT_NEAR(sliced, exact, 0.05 * exact);
    }
    EXPECT_GT(met, 60);
}

/// Of the jacobian: lengths change by it per length along the ray.
TEST(Balls, JacobiansAreDerivatives) {
    RandomGeometry random;
    for (int k = 0; k < 1000; ++k) {
        const auto sight = random.sight(Centre, k % 2 == 0);
        const double residual = random.next(1, 6);
        const auto slice = sliceBall<double>(Centre, sight, residual);
        for (int i = 0; i < slice.count; ++i) {
            const auto& reach = slice.reaches[size_t(i)];
            const auto lengthAt = [&](double t) { return (sight.at(t) - Centre).length() + sight.warp() * t; };
            const double step = 1e-5,
                         slope = (lengthAt(reach.alongRay + step) - lengthAt(reach.alongRay - step)) / (2 * step);
            EXPECT_NEAR(reach.jacobian, reach.length * reach.length * std::abs(slope), 1e-6);
            EXPECT_NEAR(lengthAt(reach.alongRay), residual, 1e-9);
        }
    }
}

TEST(Hypervolumes, LengthsAddUpAndMeetTheRay) {
    RandomGeometry random;
    int met = 0;
    for (int k = 0; k < 20000; ++k) {
        const auto w = random.directions<4>();
        const auto sight = random.sight(Centre, k % 2 == 0);
        const double residual = random.next(2, 7);
        const auto chord = sliceHypervolume<double>(Centre, w, sight, residual, 1e-3);
        if (!chord) continue;
        ++met;
        const double t = chord->start + random.next(0, 1) * (chord->end - chord->start);
        Vec3d end = Centre;
        double length = sight.warp() * t;
        for (size_t i = 0; i < 4; ++i) {
            EXPECT_GE(chord->length(i, t), -1e-9);
            end += w[i] * chord->length(i, t);
            length += chord->length(i, t);
        }
        EXPECT_LT((end - sight.at(t)).length(), 1e-8);
        EXPECT_NEAR(length, residual, 1e-8);
        // Closed forms of (15).
        const double integral = sight.warped ? std::exp(-Fog.sigmaT * residual) * (chord->end - chord->start)
                                             : exponentialIntegral(Fog.sigmaT, residual, 1.0, chord->start, chord->end);
        EXPECT_NEAR(chordWeight(*chord, Fog), std::pow(Fog.sigmaS, 4) / chord->jacobian * integral, 1e-7);
    }
    EXPECT_GT(met, 200);
}

TEST(ExponentialIntegral, IsExactForEverySlope) {
    for (const double slope : {-3.0, -1e-3, -1e-9, 0.0, 1e-12, 1e-6, 0.5, 4.0}) {
        const auto f = [&](double t) { return std::exp(-0.6 * (1.3 + slope * t)); };
        const double exact = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, 0.2, 2.7, 8, 1e-13);
        EXPECT_NEAR(exponentialIntegral(0.6, 1.3, slope, 0.2, 2.7) / exact, 1.0, 1e-9) << slope;
    }
    EXPECT_NEAR(exponentialIntegral(0.6, 1.0, 2.0, 0.5, std::numeric_limits<double>::infinity()),
                std::exp(-0.6 * 2.0) / 1.2, 1e-12);
    EXPECT_EQ(exponentialIntegral(0.6, 1.0, 2.0, 0.5, 0.5), 0.0);
}

TEST(Slices, NothingComesBeforeItsTime) {
    const auto w = volumeDirections<double>();
    for (const double residual : {-1.0, 0.0}) {
        EXPECT_FALSE(sliceVolume<double>(Centre, w, alongZ<double>(false), residual));
        EXPECT_EQ(sliceBall<double>(Centre, alongZ<double>(false), residual).count, 0);
        EXPECT_FALSE(
            sliceHypervolume<double>(Centre, hypervolumeDirections<double>(), alongZ<double>(false), residual));
    }
    EXPECT_FALSE(sliceVolume<double>(Centre, w, alongZ<double>(true), 0.99 * Centre.length()));
    EXPECT_EQ(sliceBall<double>(Centre, alongZ<double>(true), 0.99 * Centre.length()).count, 0);
    EXPECT_EQ(gateBall<double>(Centre, alongZ<double>(true), {1.0, 2.0}).angles(), 0.0);
    EXPECT_EQ(gateBall<double>(Centre, alongZ<double>(false), {-2.0, -1.0}).angles(), 0.0);
}

TEST(Slices, ParallelDirectionsMakeNone) {
    const Vec3d d(0, 0, 1), other = Vec3d(1, 0, 1).normalized();
    EXPECT_FALSE(sliceVolume<double>(Centre, {d, d, d}, alongZ<double>(true), 6.0));
    EXPECT_FALSE(sliceVolume<double>(Centre, {d, other, other}, alongZ<double>(false), 6.0));
    EXPECT_FALSE(volumeChord<double>(Centre, {d, other, d}, alongZ<double>(false)));
    EXPECT_FALSE(crossPlane<double>(Centre, {other, other}, alongZ<double>(false)));
    EXPECT_FALSE(sliceHypervolume<double>(Centre, {d, other, d, other}, alongZ<double>(false), 6.0));
}

} // namespace
} // namespace tungsten::photon
