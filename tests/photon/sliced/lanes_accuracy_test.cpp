// Registers of rays that meet sliced primitives, against 50 digits. Errors of lengths are relative to the longest of
// them over the determinant, those of weights to that of e^{-sigma length} over it.

#include "photon/sliced/exact_slices.h"

#include "photon/primitives/sliced/Ball.h"
#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/Volume.h"

namespace tungsten::photon {
namespace {

using test::ExactPi;
using test::LargestError;
using test::logUniform;

float laneOf(const Batch& batch) {
    alignas(64) std::array<float, size_t(Lanes)> values{};
    batch.store_aligned(values.data());
    return values[0];
}

/// A record in isotropic grey fog and a register of equal rays.
struct LaneMeeting {
    SliceRecord flights{};
    LaneRays rays;
    LaneRecord record{};
    float sigma;

    template <size_t K>
    explicit LaneMeeting(const MeetingFlights<float, K>& met, float first, float width)
        : rays{Lanes3(met.toOrigin), Lanes3(met.ray), Batch(0.0f), Batch(1e30f), Batch(1.0f) > 0.0f, Batch(0.25f)},
          sigma(1.1f / met.size) {
        for (size_t k = 0; k < K; ++k) flights.directions[k] = met.directions[k];
        flights.emitter = -1;
        record.flights = &flights;
        record.times = {first, width, 1};
        record.sigmaT = Rgb(sigma);
        record.grey = true;
        record.warped = met.warped;
        record.reach = Infinity;
    }
    LaneMeeting(const LaneMeeting&) = delete;
    LaneMeeting& operator=(const LaneMeeting&) = delete;
};

struct LaneErrors {
    LargestError lengths, weight;
    explicit LaneErrors(const std::string& name) : lengths(name + "_lengths"), weight(name + "_weight") {}
};

/// A point of the ray; its factor has the phase function.
template <typename Kernel, size_t K>
void compare(const MeetingFlights<float, K>& met, const LaneMeeting& at, LaneErrors& errors) {
    Exact determinant;
    const auto exact = met.point(determinant);
    Exact sum = 0;
    for (const Exact& length : exact) sum += length;
    Kernel(at.flights).intersect(at.record, at.rays, [&](int, const LaneHit& reach) {
        if (!xsimd::any(reach.met)) return;
        const Exact scale = met.size / determinant;
        for (size_t k = 0; k < K; ++k) errors.lengths.add(double(laneOf(reach.lengths[k])), exact[k], scale);
        errors.lengths.add(double(laneOf(reach.alongRay)), exact[K], scale);
        const Exact value = exp(-at.sigma * sum) / (4 * ExactPi * determinant);
        errors.weight.add(double(laneOf(reach.weight(at.sigma, Batch(0.0f)))), value, value / determinant);
    });
}

TEST(LanesAccuracy, PlanesAndVolumes) {
    LaneErrors plane("plane_lanes"), volume("volume_lanes");
    for (uint64_t i = 0; i < 2000; ++i) {
        const auto two = someMeeting<float, 2>(101, i, 1e-3);
        compare<PlaneLanes>(two, LaneMeeting(two, 0.0f, 1e30f), plane);
        const auto three = someMeeting<float, 3>(102, i, 1e-3);
        compare<VolumeSliceLanes>(three, LaneMeeting(three, three.residual, 0.0f), volume);
    }
    for (const LaneErrors* errors : {&plane, &volume}) {
        EXPECT_TRUE(errors->lengths.within(6e-7, 1500));
        EXPECT_TRUE(errors->weight.within(1.4e-6, 1000));
    }
}

/// Integrals over the part of the ray where all lengths are positive and times in the gate.
template <typename Kernel, size_t K>
void compareChord(const MeetingFlights<float, K>& met, const LaneMeeting& at, const Exact& late,
                  LargestError& integral) {
    std::array<Exact, K> offset, slope;
    Exact determinant, start = 0, end = 1e30, p = 0, q = 0;
    met.line(offset, slope, determinant);
    const auto keep = [&](const Exact& from, const Exact& rise) { // from + rise t >= 0
        if (rise > 0 && -from / rise > start) start = -from / rise;
        if (rise < 0 && -from / rise < end) end = -from / rise;
    };
    for (size_t k = 0; k < K; ++k) {
        keep(offset[k], slope[k]);
        p += offset[k];
        q += slope[k];
    }
    const Exact warp = met.warped ? 1 : 0;
    if (K == 3) keep(late - p, -q - warp);
    // Ends of chords that hardly change any length are anywhere.
    if (!(end > start * (1 + Exact(1e-3))) || end > 100 * met.size) return;
    const Exact rate = at.sigma * (q + 1), length = end - start;
    const Exact mean = abs(rate * length) < 1e-20 ? length : Exact(-expm1(-rate * length) / rate);
    const Exact value = exp(-at.sigma * (p + (q + 1) * start)) * mean / (4 * ExactPi * determinant);
    Kernel(at.flights).intersect(at.record, at.rays, [&](int, const LaneHit& reach) {
        const Exact loss = met.size / (determinant * length);
        integral.add(double(laneOf(reach.weight(at.sigma, Batch(0.0f)))), value, value * (1 + loss) / determinant);
    });
}

TEST(LanesAccuracy, Chords) {
    LargestError volume("volume_chord_lanes"), hyper("hypervolume_lanes");
    for (uint64_t i = 0; i < 2000; ++i) {
        auto three = someMeeting<float, 3>(103, i, 1e-2);
        const float late = 1.3f * three.residual;
        const LaneMeeting gated(three, 0.0f, late);
        three.residual = 0.0f;
        compareChord<VolumeChordLanes>(three, gated, Exact(late), volume);
        const auto four = someMeeting<float, 4>(104, i, 1e-2);
        compareChord<HypervolumeLanes>(four, LaneMeeting(four, four.residual, 0.0f), 0, hyper);
    }
    EXPECT_TRUE(volume.within(5e-7, 800));
    EXPECT_TRUE(hyper.within(8e-6, 800));
}

/// (16) of a volume's path.
TEST(LanesAccuracy, SharesOfVolumes) {
    LargestError share("volume_share");
    for (uint64_t i = 0; i < 1500; ++i) {
        const auto met = someMeeting<float, 3>(105, i, 1e-2);
        LaneMeeting at(met, met.residual, 0.0f);
        at.record.phasePdf = 0.3f;
        Exact determinant, along = 0, squared = 0;
        const auto exact = met.point(determinant);
        for (int axis = 0; axis < 3; ++axis) {
            const Exact sum = Exact(met.directions[2][axis]) + met.ray[axis];
            squared += sum * sum;
            along += Exact(met.directions[2][axis]) * met.ray[axis];
        }
        const Exact perLength = met.warped ? Exact(squared / 2) : Exact(abs(along)), sigma(at.sigma);
        const Exact ball = sigma * sigma * exp(-sigma * (exact[0] + exact[1])) * exact[2] * exact[2] * perLength,
                    volume = Exact(0.3f) * determinant;
        float alone = 0.0f;
        VolumeSliceLanes(at.flights).intersect(at.record, at.rays, [&](int, const LaneHit& reach) {
            alone = laneOf(reach.factor);
        });
        at.flights.shared = true;
        VolumeSliceLanes(at.flights).intersect(at.record, at.rays, [&](int, const LaneHit& reach) {
            if (!xsimd::any(reach.met)) return;
            share.add(double(laneOf(reach.factor)) / double(alone), volume / (volume + ball),
                      (1 + met.size / exact[2]) / determinant);
        });
    }
    EXPECT_TRUE(share.within(1.7e-7, 700));
}

TEST(LanesAccuracy, Balls) {
    LargestError point("ball_lanes_point"), jacobian("ball_lanes_jacobian"), drawn("ball_lanes_drawn"),
        weight("ball_lanes_weight");
    for (uint64_t i = 0; i < 2000; ++i) {
        const auto one = someMeeting<float, 2>(106, i, 1e-3);
        Sampler s(107, RandomStream::Test, 0, i);
        Exact foot = 0, squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            foot -= Exact(one.toOrigin[axis]) * one.ray[axis];
            squared += Exact(one.toOrigin[axis]) * one.toOrigin[axis];
        }
        const Exact h = sqrt(squared - foot * foot), from = one.warped ? Exact(sqrt(squared)) : h;
        const auto length = float(double(from) * (1.0 + logUniform(s, 1e-3, 10.0)));
        const LaneMeeting at(one, length, 0.0f);
        const Exact S(length), excess = (S - from) / S, half = sqrt(abs(S * S - h * h)), isotropic = 4 * ExactPi;
        // Across, rays that are far off know their distance badly.
        const Exact size = sqrt(squared), conditioned = (1 + size / h) / excess;
        BallSliceLanes().intersect(at.record, at.rays, [&](int, const LaneHit& reach) {
            const float along = laneOf(reach.alongRay);
            const Exact t = one.warped     ? Exact((S * S - squared) / (2 * (S - foot)))
                            : along > foot ? Exact(foot + half)
                                           : Exact(foot - half);
            point.add(double(along), t, (size + S) * conditioned);
            const Exact reached = sqrt(h * h + (t - foot) * (t - foot)),
                        J = reached * abs(t - foot + (one.warped ? reached : Exact(0)));
            jacobian.add(1.0 / double(laneOf(reach.factor)), J * isotropic * isotropic,
                         J * isotropic * isotropic * conditioned);
        });
        const float late = length * float(1.0 + logUniform(s, 1e-2, 1.0));
        const LaneMeeting gated(one, length, late - length);
        BallGateLanes().intersect(gated.record, gated.rays, [&](int, const LaneHit& reach) {
            const Exact along(laneOf(reach.alongRay)), reached = sqrt(h * h + (along - foot) * (along - foot));
            // Drawn with u = 0.25 + 2^-17; one interval or two.
            const auto turn = [&](const Exact& r) { return Exact((r * r - squared) / (2 * (r - foot))); };
            const auto angle = [&](Exact a, Exact b) {
                if (a < 0) a = 0;
                if (b < 0) b = 0;
                return Exact(atan((b - foot) / h) - atan((a - foot) / h));
            };
            const Exact outer = sqrt(Exact(late) * late - h * h);
            const Exact one0 = one.warped ? turn(S) : Exact(foot - outer),
                        one1 = one.warped ? turn(late) : Exact(foot - half);
            const Exact first = angle(one0, one1), second = one.warped ? Exact(0) : angle(foot + half, foot + outer);
            const Exact turned = (first + second) * (0.25 + std::ldexp(1.0, -17));
            const Exact begins = turned < first ? one0 : Exact(foot + half);
            drawn.add(double(angle(begins, along)), turned < first ? turned : Exact(turned - first), conditioned);
            const Exact value = (first + second) / h / (isotropic * isotropic) * exp(-gated.sigma * (reached + along));
            weight.add(double(laneOf(reach.weight(gated.sigma, Batch(0.0f)))), value,
                       value * conditioned * late / (Exact(late) - length));
        });
    }
    EXPECT_TRUE(point.within(9e-8));
    EXPECT_TRUE(jacobian.within(4.5e-6));
    EXPECT_TRUE(drawn.within(1e-6));
    EXPECT_TRUE(weight.within(8e-7));
}

} // namespace
} // namespace tungsten::photon
