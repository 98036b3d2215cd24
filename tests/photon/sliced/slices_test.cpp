// Planes, volumes, balls and hypervolumes as pure geometry: delta gates as limits of boxes.

#include "photon/sliced/directions.h"

#include "photon/primitives/sliced/Ball.h"
#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/Volume.h"
#include "photon/primitives/sliced/VolumeBallMis.h"

#include "tungsten/core/Random.h"

#include "support/Quadrature.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

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
    CameraRay<double> sight(const Vec3d& base, bool warped) {
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
            const double whole = chord->empty() ? 0.0 : chordWeight(*chord, Fog, longFlights);
            // In pieces: the slices' range of lengths may begin or end inside the gate.
            double sum = 0.0;
            if (!chord->empty()) {
                const double slope = chord->slopeSum() + sight.warp(),
                             atStart = chord->offsetSum() + slope * chord->start,
                             atEnd = chord->offsetSum() + slope * chord->end;
                const auto slice = [&](double residual) {
                    const auto found = sliceVolume<double>(Centre, w, sight, residual, 0.0);
                    return found ? found->weight(Fog, longFlights) : 0.0;
                };
                sum = test::integrate<31>(slice, std::min(atStart, atEnd), std::max(atStart, atEnd), 4, 1e-10);
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
        const auto alongRay = [&](double fromFoot) {
            const double d = std::hypot(h, fromFoot);
            return Fog.sigmaS * std::exp(-Fog.sigmaT * (d + lit.view.toFoot + fromFoot)) / (d * d);
        };
        double exact = 0.0;
        for (size_t i = 0; i < 2; ++i)
            if (lit.angle[i] > 0) exact += test::integrate<61>(alongRay, lit.start[i], lit.end[i], 10, 1e-11);
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
            for (int r = 0; r < slice.count; ++r) sliced += slice.hits[size_t(r)].weight(Fog) * gate.width() / Slices;
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
            const auto& reach = slice.hits[size_t(i)];
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
        const double exact = test::integrate<31>(f, 0.2, 2.7, 8, 1e-13);
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
