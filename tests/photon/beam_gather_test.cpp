// Beam-beam estimates through Embree against brute force, and the parts of flights that a gate can see.

#include "photon/primitives/beams/BeamGather.h"

#include "support/FogScene.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

PhotonBeam randomBeam(Sampler& sampler, float longest) {
    const Vec3f base(sampler.next1D(), sampler.next1D(), sampler.next1D());
    const Vec3f direction = warp::squareToSphere(sampler.next2D());
    const Rgb power(sampler.next1D(), sampler.next1D(), 1.0f);
    const float start = 0.1f * sampler.next1D();
    return {double(sampler.next1D()), base, direction, power, start, start + longest * sampler.next1D(), 1, 0};
}

std::vector<PhotonBeam> randomBeams(size_t count, float longest) {
    Sampler sampler(3, RandomStream::Test, 0, 0);
    std::vector<PhotonBeam> beams;
    for (size_t i = 0; i < count; ++i) beams.push_back(randomBeam(sampler, longest));
    return beams;
}

/// (4) by solving for the two distances directly, in double.
struct ExactApproach {
    double s, t, distance, sine;
    ExactApproach(const PhotonBeam& beam, const CameraSegment& segment) {
        const Vec3d d(beam.direction), c(segment.direction), r = Vec3d(beam.base) - Vec3d(segment.origin);
        const double b = d.dot(c), determinant = d.length2() * c.length2() - b * b;
        s = (b * r.dot(c) - c.length2() * r.dot(d)) / determinant;
        t = (d.length2() * r.dot(c) - b * r.dot(d)) / determinant;
        distance = (r + d * s - c * t).length();
        sine = d.cross(c).length();
    }
};

TEST(ClosestApproach, MatchesTheVerifiedVector) {
    const auto found =
        closestApproach(Vec3f(1.2f, 0.5f, 2.0f), Vec3f(-3, -1, 1).normalized(), Vec3f(0.0f), Vec3f(0, 0, 1));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->alongBeam, 1.3598161640, 2e-6);
    EXPECT_NEAR(found->alongCamera, 2.41, 2e-6);
    EXPECT_NEAR(found->sine, 0.9534625892, 2e-6);
    EXPECT_NEAR(found->distance(), 0.0948683298, 2e-6);
}

TEST(BeamGather, EvaluatesEveryBeamOnTheRayOnce) {
    const Scene scene = test::fogScene();
    constexpr float Radius = 0.03f;
    // Up to 100 radii long, so that most are cut in pieces.
    const std::vector<PhotonBeam> beams = randomBeams(3000, 3.0f);
    const BeamGather gather(scene, TimeGate{}, beams, Radius);
    Sampler sampler(4, RandomStream::Test, 0, 0);
    uint64_t total = 0, expectedTotal = 0;
    for (int i = 0; i < 400; ++i) {
        // Origins inside the cloud, some exactly on a beam; segments of every length.
        const PhotonBeam& some = beams[size_t(i)];
        const Vec3f origin = i % 3 == 0 ? some.base + some.direction * (0.5f * (some.tStart + some.tEnd))
                                        : Vec3f(sampler.next1D(), sampler.next1D(), sampler.next1D());
        const CameraSegment segment{
            origin, warp::squareToSphere(sampler.next2D()), i % 5 == 0 ? Infinity : sampler.next1D(), 0.0, 1.0, 0, 0};
        Vec3d expected(0.0);
        uint64_t count = 0;
        for (const PhotonBeam& beam : beams) {
            const ExactApproach a(beam, segment);
            if (a.s < double(beam.tStart) || a.s >= double(beam.tEnd) || a.t <= 0.0 || a.t > double(segment.length) ||
                a.distance >= double(Radius))
                continue;
            ++count;
            const Medium& fog = scene.media[0];
            const double weight =
                double(fog.phase.eval(beam.direction, -segment.direction)) / (2.0 * double(Radius) * a.sine);
            for (int k = 0; k < 3; ++k)
                expected[k] +=
                    weight * double(beam.power[k] * fog.sigmaS()[k]) * std::exp(-double(fog.sigmaT()[k]) * (a.s + a.t));
        }
        FrameSums sums(1, Vec3d(0.0));
        const uint64_t gathered = gather.gather(segment, sums);
        // At the edges of beams, segments and kernel float and double may decide differently.
        if (gathered == count) {
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(sums[0][k], expected[k], 2e-3 * expected[k] + 1e-9) << i;
        }
        EXPECT_NEAR(double(gathered), double(count), 1.0) << i;
        total += gathered;
        expectedTotal += count;
    }
    EXPECT_NEAR(double(total), double(expectedTotal), 5.0);
    EXPECT_GT(total, 5000u);
}

TEST(BeamGather, ParallelBeamsStayFinite) {
    const Scene scene = test::fogScene();
    const Vec3f along(0, 0, 1);
    std::vector<PhotonBeam> beams;
    for (const float tilt : {0.0f, 1e-7f, 1e-5f, 9e-5f, 2e-4f, 1e-3f, 1e-2f})
        for (const float sign : {-1.0f, 1.0f})
            beams.push_back({0.0, Vec3f(0.001f - 2.0f * tilt, 0.0f, sign > 0.0f ? 0.0f : 4.0f),
                             (Vec3f(tilt, 0.0f, sign)).normalized(), Rgb(1.0f), 0.0f, 20.0f, 0, 0});
    const BeamGather gather(scene, TimeGate{}, beams, 0.05f);
    FrameSums sums(1, Vec3d(0.0));
    const uint64_t gathered = gather.gather({Vec3f(0, 0, -1), along, 10.0f, 0.0, 1.0, 0, 0}, sums);
    EXPECT_GT(gathered, 0u) << "the steeper ones";
    EXPECT_LT(gathered, beams.size());
    EXPECT_TRUE(std::isfinite(sums[0].x) && std::isfinite(sums[0].y) && std::isfinite(sums[0].z));
    EXPECT_GT(sums[0].x, 0.0);
}

TEST(BeamGather, OnlyItsMediumItsOrdersAndItsFrames) {
    Scene scene = test::fogScene();
    scene.media.push_back(scene.media[0]);
    scene.transport.minBounces = 3;
    scene.transport.maxBounces = 5;
    // Crosses the segment at s = 1, t = 2: at time 10 + 1 + 2 + the camera path's 4.
    const std::vector<PhotonBeam> beams{{10.0, Vec3f(-1, 0, 2), Vec3f(1, 0, 0), Rgb(1.0f), 0.0f, 5.0f, 1, 0}};
    const TimeGate gate{false, false, 15.5, 1.0, 3};
    const BeamGather gather(scene, gate, beams, 0.1f);
    CameraSegment segment{Vec3f(0.0f), Vec3f(0, 0, 1), 5.0f, 4.0, 1.0, 1, 0};
    FrameSums sums(3, Vec3d(0.0));
    EXPECT_EQ(gather.gather(segment, sums), 1u) << "order 1 + 1 + 1";
    EXPECT_EQ(sums[0].x, 0.0);
    EXPECT_GT(sums[1].x, 0.0);
    EXPECT_EQ(sums[2].x, 0.0);
    segment.interactions = 3;
    EXPECT_EQ(gather.gather(segment, sums), 0u) << "order 5";
    segment.interactions = 0;
    EXPECT_EQ(gather.gather(segment, sums), 0u) << "order 2";
    segment.interactions = 1;
    segment.medium = 1;
    EXPECT_EQ(gather.gather(segment, sums), 0u);
    segment.medium = 0;
    segment.inverseSpeed = 2.0; // 10 + 4 + 2 (1 + 2) = 20
    EXPECT_EQ(gather.gather(segment, sums), 0u);
    scene.transport.cameraUnwarped = true; // 10 + 2
    EXPECT_EQ(gather.gather(segment, sums), 0u);
    segment.inverseSpeed = 6.0; // 10 + 6
    sums.assign(3, Vec3d(0.0));
    EXPECT_EQ(gather.gather(segment, sums), 1u);
    EXPECT_GT(sums[0].x, 0.0);
}

struct PartCase {
    const char* name;
    bool unwarped, indirectView;
    float flightSpeed;
};
class FlightParts : public testing::TestWithParam<PartCase> {};

TEST_P(FlightParts, AreWhereDepositsCount) {
    const PartCase& c = GetParam();
    Scene scene = test::fogScene();
    scene.media[0].speedOfLight = c.flightSpeed;
    scene.transport.gate = {false, false, 4.0, 0.5, 2};
    scene.transport.cameraUnwarped = c.unwarped;
    scene.camera.model = Pinhole{};
    scene.camera.toWorld.translation = Vec3f(0.5f, 0.2f, -1.0f);
    const ArrivalCulling arrival(scene, {c.indirectView, c.flightSpeed == 1.0f, std::max(c.flightSpeed, 1.0f)});
    Sampler sampler(5, RandomStream::Test, 0, 0);
    int inside = 0, outside = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3f position =
            Vec3f(0.5f, 0.2f, -1.0f) + warp::squareToSphere(sampler.next2D()) * (3.0f * sampler.next1D());
        // One in ten heads for the camera, where the arrival is the same all along the flight.
        const Vec3f direction =
            i % 10 == 0 ? (scene.camera.position() - position).normalized() : warp::squareToSphere(sampler.next2D());
        const double time = 4.0 * double(sampler.next1D());
        const FlightPart part = arrival.countingPart(position, direction, time, double(c.flightSpeed));
        for (int k = 0; k < 40; ++k) {
            const float s = 5.0f * sampler.next1D();
            const bool counts = arrival.mayCount(position + direction * s, time + double(s / c.flightSpeed));
            const bool held = double(s) >= part.start && double(s) <= part.end;
            EXPECT_TRUE(held || !counts) << "lost: " << i << " " << s << " of " << part.start << " .. " << part.end;
            // With one speed the part is no larger than it must be, but for its tolerance.
            const bool wellInside = double(s) > part.start + 1e-3 && double(s) < part.end - 1e-3;
            if (c.flightSpeed == 1.0f && i % 10 != 0) {
                EXPECT_TRUE(counts || !wellInside) << i << " " << s;
            }
            ++(held ? inside : outside);
        }
    }
    EXPECT_GT(inside, 3000);
    EXPECT_GT(outside, 3000);
}

INSTANTIATE_TEST_SUITE_P(Views, FlightParts,
                         testing::Values(PartCase{"Direct", false, false, 1.0f}, PartCase{"Folded", false, true, 1.0f},
                                         PartCase{"Unwarped", true, false, 1.0f}, PartCase{"Slow", false, false, 0.6f},
                                         PartCase{"UnwarpedSlow", true, true, 0.6f}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Frames as short as rounding makes a tolerance: each deposit inside the sequence counts for one of them, and the
/// parts of a flight follow each other.
TEST(ArrivalCulling, SharesTheSequenceOutAmongItsFrames) {
    Scene scene = test::fogScene();
    const TimeGate gate{false, false, 6.0, 3e-5, 8};
    scene.transport.gate = gate;
    scene.camera.model = Pinhole{};
    const ArrivalCulling whole(scene, {});
    std::vector<ArrivalCulling> frames;
    for (int frame = 0; frame < gate.frames; ++frame) frames.push_back(whole.ofFrame(frame));
    Sampler sampler(6, RandomStream::Test, 0, 0);
    for (int i = 0; i < 2000; ++i) {
        const Vec3f position = warp::squareToSphere(sampler.next2D()) * (3.0f * sampler.next1D());
        const Vec3f direction = warp::squareToSphere(sampler.next2D());
        const double arrival = gate.start + (gate.end() - gate.start) * double(sampler.next1D());
        const double time =
            arrival - std::hypot(double(position.x), double(position.y), double(position.z)); // of flight to the camera
        int counting = 0;
        for (const ArrivalCulling& frame : frames) counting += frame.mayCount(position, time) ? 1 : 0;
        EXPECT_EQ(counting, 1) << i;
        // From before the sequence to after it.
        const double early = time - 1e-3;
        double end = frames.front().countingPart(position, direction, early, 1.0).start;
        for (const ArrivalCulling& frame : frames) {
            const FlightPart part = frame.countingPart(position, direction, early, 1.0);
            EXPECT_DOUBLE_EQ(part.start, end) << i; // products and sums may be fused in one and not in the other
            end = part.end;
        }
    }
}

} // namespace
} // namespace tungsten::photon
