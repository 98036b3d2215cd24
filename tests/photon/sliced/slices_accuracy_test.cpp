// Planes, volumes, balls and hypervolumes in double against 50 digits: directions that are almost one, sizes from 1e-3
// to 1e3, gates of 1e-6 of the length. Errors of lengths are relative to the longest of them over the determinant.

#include "photon/sliced/exact_slices.h"

#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/RaySliceQuery.h"
#include "photon/primitives/sliced/VolumeBallMis.h"

namespace tungsten::photon {
namespace {

using test::ExactPi;
using test::LargestError;
using test::logUniform;

template <size_t K>
CameraRay<double> sightOf(const MeetingFlights<double, K>& met) {
    return {met.toOrigin, met.ray, 0.0, std::numeric_limits<double>::infinity(), met.warped};
}
template <size_t K>
Coefficients<double> fogFor(const MeetingFlights<double, K>& met) {
    return {0.8 / met.size, 1.1 / met.size};
}

/// Lengths, Jacobian and weight of what the primitive found.
template <size_t K, typename Slice>
void compare(const MeetingFlights<double, K>& met, const Slice& slice, LargestError& lengths, LargestError& jacobian,
             LargestError& weight) {
    Exact determinant;
    const auto exact = met.point(determinant);
    const Exact scale = met.size / determinant;
    Exact sum = 0;
    for (size_t k = 0; k < K; ++k) {
        lengths.add(slice.lengths[k], exact[k], scale);
        sum += exact[k];
    }
    lengths.add(slice.alongRay, exact[K], scale);
    jacobian.add(slice.jacobian, determinant, Exact(1));
    const auto fog = fogFor(met);
    const Exact value = pow(Exact(fog.sigmaS), int(K)) / determinant * exp(-fog.sigmaT * (sum + exact[K]));
    weight.add(slice.weight(fog), value, value / determinant);
}

TEST(SlicesAccuracy, PlanesAndVolumes) {
    LargestError plane[3] = {LargestError("plane_lengths"), LargestError("plane_jacobian"),
                             LargestError("plane_weight")};
    LargestError volume[3] = {LargestError("volume_lengths"), LargestError("volume_jacobian"),
                              LargestError("volume_weight")};
    for (uint64_t i = 0; i < 2000; ++i) {
        const auto two = someMeeting<double, 2>(81, i, 1e-5);
        if (const auto met = crossPlane<double>(Vec3d(0.0), two.directions, sightOf(two)))
            compare(two, *met, plane[0], plane[1], plane[2]);
        const auto three = someMeeting<double, 3>(82, i, 1e-5);
        if (const auto met = sliceVolume<double>(Vec3d(0.0), three.directions, sightOf(three), three.residual))
            compare(three, *met, volume[0], volume[1], volume[2]);
    }
    for (const LargestError& error : plane) EXPECT_TRUE(error.within(1e-15, 1500));
    for (const LargestError& error : volume) EXPECT_TRUE(error.within(2e-15, 1500));
}

/// The lines of lengths; then, of those as they are, the part that is kept; then, of that, the integral.
template <size_t K>
void compare(const MeetingFlights<double, K>& met, Chord<double, K> chord, const ResidualGate<double>* gate,
             LargestError& lines, LargestError& ends, LargestError& weight) {
    std::array<Exact, K> offset, slope;
    Exact determinant;
    met.line(offset, slope, determinant);
    for (size_t k = 0; k < K; ++k) {
        lines.add(chord.offset[k], offset[k], met.size / (determinant * determinant));
        lines.add(chord.slope[k], slope[k], 1 / (determinant * determinant));
    }
    if (gate) chord.keepGate(*gate, met.warped ? 1.0 : 0.0);
    if (chord.empty()) return;
    Exact start = 0, end = std::numeric_limits<double>::infinity();
    const auto keep = [&](const Exact& p, const Exact& q, const Exact& least) { // p + q t >= least
        if (q > 0 && (least - p) / q > start) start = (least - p) / q;
        if (q < 0 && (least - p) / q < end) end = (least - p) / q;
    };
    Exact p = 0, q = 0;
    for (size_t k = 0; k < K; ++k) {
        keep(chord.offset[k], chord.slope[k], 0);
        p += chord.offset[k];
        q += chord.slope[k];
    }
    const auto fog = fogFor(met);
    const Exact rate = fog.sigmaT * (q + 1), length = Exact(chord.end) - chord.start;
    const Exact mean = rate == 0 ? length : Exact(-expm1(-rate * length) / rate);
    const Exact bright = fog.sigmaT * (p + (q + 1) * (rate > 0 ? chord.start : chord.end));
    const Exact value =
        pow(Exact(fog.sigmaS), int(K)) / chord.jacobian * mean * exp(-fog.sigmaT * (p + (q + 1) * chord.start));
    // What cancels in the sum of lengths.
    Exact terms = 1;
    for (size_t k = 0; k < K; ++k)
        terms += fog.sigmaT * (abs(chord.offset[k]) + abs(Exact(chord.slope[k])) * chord.end);
    if (bright < 300) weight.add(chordWeight(chord, fog), value, value * terms);
    Exact inGate = 1;
    if (gate) {
        const Exact rise = q + (met.warped ? 1 : 0);
        keep(p, rise, gate->least);
        keep(-p, -rise, -Exact(gate->most));
        inGate += (abs(p) + gate->most) / abs(rise) / met.size;
    }
    ends.add(chord.start, start, met.size * inGate);
    ends.add(chord.end, end, end * inGate);
}

TEST(SlicesAccuracy, ChordsOfVolumesAndHypervolumes) {
    LargestError volume[3] = {LargestError("volume_lines"), LargestError("volume_ends"),
                              LargestError("volume_integral")};
    LargestError hyper[3] = {LargestError("hypervolume_lines"), LargestError("hypervolume_ends"),
                             LargestError("hypervolume_integral")};
    for (uint64_t i = 0; i < 1500; ++i) {
        auto three = someMeeting<double, 3>(83, i, 1e-4);
        Sampler s(84, RandomStream::Test, 0, i);
        const double width = three.residual * logUniform(s, 1e-6, 1.0);
        const ResidualGate<double> gate{three.residual - width, three.residual + width};
        if (const auto chord = volumeChord<double>(Vec3d(0.0), three.directions, sightOf(three)))
            compare(three, *chord, &gate, volume[0], volume[1], volume[2]);
        const auto four = someMeeting<double, 4>(85, i, 1e-4);
        if (const auto chord = sliceHypervolume<double>(Vec3d(0.0), four.directions, sightOf(four), four.residual))
            compare(four, *chord, nullptr, hyper[0], hyper[1], hyper[2]);
    }
    for (const LargestError& error : volume) EXPECT_TRUE(error.within(8e-15, 800));
    for (const LargestError& error : hyper) EXPECT_TRUE(error.within(6e-15, 800));
}

/// A ball's centre and a ray: its foot, distances, and the lengths from the centre to a point of the ray.
struct ExactBall {
    Exact foot = 0, fromRay, fromOrigin;

    ExactBall(const Vec3d& centre, const CameraRay<double>& sight) {
        const Vec3d offset = centre - sight.origin;
        Exact squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            foot += Exact(offset[axis]) * sight.direction[axis];
            squared += Exact(offset[axis]) * offset[axis];
        }
        fromOrigin = sqrt(squared);
        fromRay = sqrt(squared - foot * foot);
    }
    [[nodiscard]] Exact reach(const Exact& t) const { return sqrt(fromRay * fromRay + (t - foot) * (t - foot)); }
    /// Square of the flight's length times the change of path length along the ray.
    [[nodiscard]] Exact jacobian(const Exact& t, bool warped) const {
        return reach(t) * abs(t - foot + (warped ? reach(t) : Exact(0)));
    }
    /// Where a path of this length turns.
    [[nodiscard]] Exact turn(const Exact& s) const {
        return s > fromOrigin ? Exact((s * s - fromOrigin * fromOrigin) / (2 * (s - foot))) : Exact(0);
    }
    [[nodiscard]] Exact halfChord(const Exact& radius) const {
        return radius > fromRay ? Exact(sqrt(radius * radius - fromRay * fromRay)) : Exact(0);
    }
    /// Of a point of the ray seen from the centre, from the foot on; none is behind the ray's origin.
    [[nodiscard]] Exact angle(const Exact& t) const { return atan(((t > 0 ? t : Exact(0)) - foot) / fromRay); }
    /// Under which the part of the ray is seen that paths of these lengths meet.
    [[nodiscard]] Exact angles(bool warped, const Exact& least, const Exact& most) const {
        if (warped) return angle(turn(most)) - angle(turn(least));
        const Exact inner = halfChord(least), outer = halfChord(most);
        return angle(foot - inner) - angle(foot - outer) + angle(foot + outer) - angle(foot + inner);
    }
};

TEST(SlicesAccuracy, Balls) {
    LargestError point("ball_point"), jacobian("ball_jacobian"), angles("ball_angles"), drawn("ball_drawn"),
        weight("ball_weight");
    for (uint64_t i = 0; i < 1000; ++i) {
        const auto one = someMeeting<double, 2>(86, i, 1e-5);
        Sampler s(87, RandomStream::Test, 0, i);
        const auto sight = sightOf(one);
        const Vec3d centre(0.0);
        const ExactBall exact(centre, sight);
        const double from = one.warped ? double(exact.fromOrigin) : double(exact.fromRay);
        const double length = from * (1.0 + logUniform(s, 1e-6, 10.0)),
                     late = length * (1.0 + logUniform(s, 1e-6, 1.0));
        const auto slice = sliceBall<double>(centre, sight, length);
        const Exact S(length), D = exact.fromOrigin, h = exact.fromRay, excess = (S - from) / S;
        for (int r = 0; r < slice.count; ++r) {
            const auto& reach = slice.hits[size_t(r)];
            const Exact half = exact.halfChord(S);
            const Exact t = one.warped                    ? exact.turn(S)
                            : reach.alongRay > exact.foot ? Exact(exact.foot + half)
                                                          : Exact(exact.foot - half);
            // A path that is hardly longer than the way knows its excess to as many digits as doubles leave it.
            point.add(reach.alongRay, t, (S + D) / excess);
            jacobian.add(reach.jacobian, exact.jacobian(t, one.warped), (S + D) * (S + D) / excess);
        }
        const auto lit = gateBall<double>(centre, sight, {length, late});
        angles.add(lit.angles(), exact.angles(one.warped, S, late), (1 + D / h) / excess);
        const double u = s.nextDouble();
        if (!(lit.angles() > 0)) continue;
        const auto reach = lit.sample(u);
        const size_t chosen = u * lit.angles() < lit.angle[0] ? 0 : 1;
        const Exact turned = u * Exact(lit.angles()) - (chosen == 1 ? lit.angle[0] : 0.0);
        drawn.add(double(exact.angle(reach.alongRay) - exact.angle(exact.foot + lit.start[chosen])), turned,
                  1 + Exact(sight.origin.length()) / h);
        const auto fog = fogFor(one);
        const Exact value =
            fog.sigmaS * lit.angles() / h * exp(-fog.sigmaT * (exact.reach(reach.alongRay) + reach.alongRay));
        weight.add(lit.weight(reach, fog), value, value * (1 + D / h));
    }
    EXPECT_TRUE(point.within(1e-15));
    EXPECT_TRUE(jacobian.within(3e-16));
    EXPECT_TRUE(angles.within(6e-16));
    EXPECT_TRUE(drawn.within(2.5e-15));
    EXPECT_TRUE(weight.within(7e-15));
}

/// (16) inside a gate: where on the ray a volume and a ball place their points.
TEST(SlicesAccuracy, SharesInsideGates) {
    LargestError ratio("ratio_in_gate");
    for (uint64_t i = 0; i < 600; ++i) {
        const auto met = someMeeting<double, 3>(89, i, 1e-2);
        const auto sight = sightOf(met);
        Exact determinant, J;
        const auto point = met.point(determinant);
        std::array<Exact, 3> offset, slope;
        met.line(offset, slope, J);
        const double first = double(point[0]), second = double(point[1]), along = double(point[3]);
        const double width = 0.3 * met.residual, sigma = 1.1 / met.size;
        const ResidualGate<double> gate{met.residual - width, met.residual + width};
        Exact start = 0, end = 1e30, p = 0, q = met.warped ? 1 : 0;
        const auto keep = [&](const Exact& from, const Exact& rise) { // from + rise t >= 0
            if (rise > 0 && -from / rise > start) start = -from / rise;
            if (rise < 0 && -from / rise < end) end = -from / rise;
        };
        for (size_t k = 0; k < 3; ++k) {
            keep(offset[k], slope[k]);
            p += offset[k];
            q += slope[k];
        }
        keep(p - gate.least, q);
        keep(gate.most - p, -q);
        if (!(end > start)) continue;
        const Exact rate = sigma * (q + (met.warped ? 0 : 1)), before = Exact(first) + second;
        const Exact integral = (exp(-rate * (start - along)) - exp(-rate * (end - along))) / rate;
        const ExactBall ball(met.directions[0] * first + met.directions[1] * second, sight);
        const Exact exact = Exact(0.3) * J * ball.angles(met.warped, gate.least - before, gate.most - before) /
                            (Exact(0.02) * ball.fromRay * integral);
        const SharedPath<double> path{met.directions, double(point[2]), 0.3, 0.02};
        ratio.add(path.ratioInGate(Vec3d(0.0), first, second, along, sight, gate, sigma), exact,
                  exact * (1 + met.size / ball.fromRay) * (1 + met.size / (end - start)) / J);
    }
    EXPECT_TRUE(ratio.within(1e-15, 400));
}

/// (16), and what short flights weigh: unended ones 1 / P(none has ended).
TEST(SlicesAccuracy, SharesAndShortFlights) {
    LargestError ratio("ratio"), unendedWeight("unended");
    Medium fog;
    fog.model = Homogeneous{Rgb(0.1f, 0.2f, 0.3f), Rgb(0.7f, 0.9f, 2.0f)};
    const Exact sigma = (Exact(fog.sigmaT().x) + fog.sigmaT().y + fog.sigmaT().z) / 3;
    for (uint64_t i = 0; i < 1500; ++i) {
        const auto met = someMeeting<double, 3>(88, i, 1e-4);
        Exact determinant;
        (void)met.point(determinant);
        const SharedPath<double> path{met.directions, met.size, 0.3, 0.02};
        Exact along = 0, squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Exact sum = Exact(met.directions[2][axis]) + met.ray[axis];
            squared += sum * sum;
            along += Exact(met.directions[2][axis]) * met.ray[axis];
        }
        const Exact perLength = met.warped ? Exact(squared / 2) : Exact(abs(along));
        const Exact exact = Exact(0.3) * determinant / (Exact(0.02) * Exact(met.size) * met.size * perLength);
        ratio.add(path.ratio(met.ray, met.warped), exact, exact / determinant + exact / perLength);
        SliceRecord flights{};
        flights.shortFlights = true;
        flights.random = {uint16_t(i * 41), uint16_t(i * 977)};
        const auto drawn = flightEnds(flights, fog);
        const std::array<double, 4> lengths{0.5 * drawn[0], 0.9 * drawn[1], 0.1 * drawn[2], drawn[3]};
        const Exact sum = Exact(lengths[0]) + lengths[1] + lengths[2] + lengths[3], weight = exp(sigma * sum);
        unendedWeight.add(unended(flights, fog, lengths.data(), 4), weight, weight * (1 + sigma * sum));
        const double beyond[] = {1.001 * drawn[0]};
        EXPECT_EQ(unended(flights, fog, beyond, 1), 0.0);
    }
    EXPECT_TRUE(ratio.within(1e-15));
    EXPECT_TRUE(unendedWeight.within(3e-8));
}

} // namespace
} // namespace tungsten::photon
