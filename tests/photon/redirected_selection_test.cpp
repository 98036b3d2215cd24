#include "photon/Tuning.h"
#include "photon/primitives/VolumePrimitive.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

TEST(RedirectedSelection, KeepsEveryElementEquallyOftenAndThePowerOnAverage) {
    constexpr size_t Count = 37;
    constexpr int Draws = 1000;
    constexpr double Share = 0.3;
    std::vector<Photon> photons(Count);
    for (size_t i = 0; i < Count; ++i) photons[i].power = Rgb(float(i + 1));
    std::vector<int> kept(Count, 0);
    double power = 0.0;
    for (int k = 0; k < Draws; ++k) {
        const float u = (float(k) + 0.5f) / float(Draws);
        chooseSystematically(Count, Share, u, [&](size_t i) { ++kept[i]; });
        for (const Photon& photon : systematicSubset(photons, Share, u)) power += double(photon.power.x);
    }
    for (const int times : kept) EXPECT_NEAR(times, Share * Draws, 2.0);
    EXPECT_NEAR(power / Draws, 0.5 * Count * (Count + 1), 0.002 * power / Draws);
    EXPECT_EQ(systematicSubset(photons, 1.0, 0.999f).size(), Count);
}

TEST(RedirectedSelection, DealsEveryElementToOneHand) {
    const std::vector<int> elements{0, 1, 2, 3, 4, 5, 6};
    const std::vector<std::vector<int>> expected{{0, 3, 6}, {1, 4}, {2, 5}};
    EXPECT_EQ(partitioned(elements, 3), expected);
    EXPECT_EQ(partitioned(elements, 1), std::vector<std::vector<int>>{elements});
    EXPECT_EQ(partitioned(std::vector<int>{1}, 3), (std::vector<std::vector<int>>{{1}, {}, {}}));
}

/// Discs or ribbons met by those of 4 000 random lines through a ball about everything that hit the box. `meets` tells
/// of element i and a line.
template <typename Meets>
double metByLines(size_t count, const Vec3f& low, const Vec3f& high, const Meets& meets) {
    Sampler sampler(7, RandomStream::Test, 0, 0);
    const Vec3f centre = (low + high) * 0.5f;
    const float radius = (high - low).length() * 0.5f;
    uint64_t met = 0, lines = 0;
    for (int k = 0; k < 4000; ++k) {
        const Vec3f direction = warp::squareToSphere(sampler.next2D());
        const Frame frame(direction);
        const float r = radius * std::sqrt(sampler.next1D()), phi = 2.0f * Pi * sampler.next1D();
        const Vec3f origin = centre + frame.toWorld({r * std::cos(phi), r * std::sin(phi), 0.0f}) - direction * radius;
        float from = 0.0f, to = Infinity;
        for (int axis = 0; axis < 3; ++axis) {
            const float a = (low[axis] - origin[axis]) / direction[axis],
                        b = (high[axis] - origin[axis]) / direction[axis];
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        if (!(from < to)) continue;
        ++lines;
        for (size_t i = 0; i < count; ++i) met += meets(i, origin, direction) ? 1 : 0;
    }
    return double(met) / double(lines);
}

TEST(RedirectedSelection, LinesMeetAsManyDiscsAsAreWanted) {
    constexpr float Radius = 0.4f;
    Sampler sampler(3, RandomStream::Test, 1, 0);
    std::vector<Photon> photons(3000);
    for (Photon& photon : photons) photon.position = {3.0f * sampler.next1D(), sampler.next1D(), sampler.next1D()};
    const double met = metByLines(photons.size(), Vec3f(-Radius), Vec3f(3.0f, 1.0f, 1.0f) + Vec3f(Radius),
                                  [&](size_t i, const Vec3f& origin, const Vec3f& direction) {
                                      const Vec3f offset = photons[i].position - origin;
                                      return offset.cross(direction).length2() < Radius * Radius;
                                  });
    EXPECT_GT(met, 1.5 * tuning::RedirectedHits);
    EXPECT_NEAR(Points::redirectedShare(photons, Radius) * met, tuning::RedirectedHits, 0.05 * tuning::RedirectedHits);
    EXPECT_EQ(Points::redirectedShare(photons, 0.1f * Radius), 1.0);
}

TEST(RedirectedSelection, LinesMeetAsManyBeamsAsAreWanted) {
    constexpr float Radius = 0.2f;
    Sampler sampler(3, RandomStream::Test, 2, 0);
    std::vector<PhotonBeam> beams(24000);
    for (PhotonBeam& beam : beams) {
        beam.base = {3.0f * sampler.next1D(), sampler.next1D(), sampler.next1D()};
        beam.direction = warp::squareToSphere(sampler.next2D());
        beam.tStart = 0.5f;
        beam.tEnd = 1.0f;
    }
    const double met =
        metByLines(beams.size(), Vec3f(-1.0f - Radius), Vec3f(4.0f, 2.0f, 2.0f) + Vec3f(Radius),
                   [&](size_t i, const Vec3f& origin, const Vec3f& direction) {
                       const PhotonBeam& beam = beams[i];
                       const Vec3f normal = beam.direction.cross(direction), offset = origin - beam.base;
                       const float squaredSine = normal.length2();
                       const float s = offset.cross(direction).dot(normal) / squaredSine;
                       return std::abs(offset.dot(normal)) < Radius * std::sqrt(squaredSine) && s > 0.5f && s < 1.0f;
                   });
    EXPECT_GT(met, 1.5 * tuning::RedirectedHits);
    EXPECT_NEAR(Beams::redirectedShare(beams, Radius) * met, tuning::RedirectedHits, 0.05 * tuning::RedirectedHits);
    beams.resize(100);
    EXPECT_EQ(Beams::redirectedShare(beams, Radius), 1.0);
}

} // namespace
} // namespace tungsten::photon
