// Gathers through Embree against brute force.

#include "photon/primitives/points/PointGather.h"
#include "photon/store/NearestPhotons.h"

#include "support/FogScene.h"

#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

Photon randomPhoton(Sampler& sampler) {
    const Vec3f position(sampler.next1D(), sampler.next1D(), sampler.next1D());
    const Vec3f direction = warp::squareToSphere(sampler.next2D());
    return {double(sampler.next1D()), position, direction, Rgb(sampler.next1D(), sampler.next1D(), 1.0f), 1, 0};
}

Store<Photon> randomStore(size_t count) {
    Sampler sampler(3, RandomStream::Test, 0, 0);
    Store<Photon> store;
    store.paths = count;
    for (size_t i = 0; i < count; ++i) store.records.push_back(randomPhoton(sampler));
    return store;
}

Vec3d bruteForce(const Scene& scene, const Store<Photon>& store, float radius, const CameraSegment& segment,
                 uint64_t& count) {
    Vec3d sum(0.0);
    for (const Photon& photon : store.records) {
        const Vec3f offset = photon.position - segment.origin;
        const float t = offset.dot(segment.direction);
        const float kernel = biweight((offset - segment.direction * t).length2(), radius * radius);
        if (!(t > 0.0f) || t > segment.length || kernel <= 0.0f) continue;
        ++count;
        const Rgb value = photon.power * scene.media[0].transmittance(t) *
                          (kernel * scene.media[0].phase.eval(photon.direction, -segment.direction));
        sum += Vec3d(double(value.x), double(value.y), double(value.z));
    }
    return sum;
}

TEST(Biweight, IntegratesToOneOverItsDisc) {
    double sum = 0.0;
    constexpr int Steps = 20000;
    constexpr double Radius = 0.3;
    for (int i = 0; i < Steps; ++i) {
        const double d = (i + 0.5) / Steps * Radius;
        sum += double(biweight(float(d * d), float(Radius * Radius))) * 2.0 * 3.14159265358979 * d * Radius / Steps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(PointGather, LosesNoPhotonNotEvenAtTheOrigin) {
    const Scene scene = test::fogScene();
    const Store<Photon> store = randomStore(20000);
    constexpr float Radius = 0.05f;
    const PointGather gather(scene, scene.transport.gate, store.records, Radius);
    Sampler sampler(4, RandomStream::Test, 0, 0);
    uint64_t total = 0;
    for (int i = 0; i < 400; ++i) {
        // Origins inside the cloud, some exactly on a photon; segments of every length.
        const Vec3f origin = i % 3 == 0 ? store.records[size_t(i)].position
                                        : Vec3f(sampler.next1D(), sampler.next1D(), sampler.next1D());
        const CameraSegment segment{
            origin, warp::squareToSphere(sampler.next2D()), i % 5 == 0 ? Infinity : sampler.next1D(), 0.0, 1.0, 0, 0};
        FrameSums sums(1, Vec3d(0.0));
        uint64_t expectedCount = 0;
        const Vec3d expected = bruteForce(scene, store, Radius, segment, expectedCount);
        EXPECT_EQ(gather.gather(segment, sums), expectedCount);
        EXPECT_NEAR(sums[0].x, expected.x, 1e-9 * (expected.x + 1.0));
        EXPECT_NEAR(sums[0].z, expected.z, 1e-9 * (expected.z + 1.0));
        total += expectedCount;
    }
    EXPECT_GT(total, 10000u);
}

/// Beside the ray, time counts the way to the photon itself, 3.0265, not that along the ray.
TEST(PointGather, CountsTheWayToThePhotonItself) {
    Scene scene = test::fogScene();
    scene.transport.gate = {false, false, 3.995, 0.01, 5};
    const std::vector<Photon> photons{{1.0, {3.0f, 0.4f, 0.0f}, {0.0f, 1.0f, 0.0f}, Rgb(1.0f), 1, 0}};
    const PointGather gather(scene, scene.transport.gate, photons, 0.5f);
    FrameSums sums(5, Vec3d(0.0));
    EXPECT_EQ(gather.gather({{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, Infinity, 0.0, 1.0, 0, 0}, sums), 1u);
    for (size_t frame = 0; frame < sums.size(); ++frame) EXPECT_EQ(sums[frame].x > 0.0, frame == 3) << frame;
}

TEST(NearestPhotons, MatchBruteForce) {
    const Store<Photon> store = randomStore(5000);
    const NearestPhotons nearest(store.records);
    Sampler sampler(5, RandomStream::Test, 0, 0);
    std::vector<NearestPhotons::Neighbour> found;
    for (int i = 0; i < 300; ++i) {
        const Vec3f position(sampler.next1D() * 1.2f - 0.1f, sampler.next1D(), sampler.next1D());
        const float radius = i % 7 == 0 ? 1e30f : 0.02f + 0.3f * sampler.next1D();
        const uint32_t count = 1 + sampler.nextBits() % 40;
        std::vector<NearestPhotons::Neighbour> expected;
        for (uint32_t p = 0; p < store.records.size(); ++p) {
            const float squared = (store.records[p].position - position).length2();
            if (squared <= radius * radius) expected.push_back({squared, p});
        }
        std::sort(expected.begin(), expected.end());
        const bool all = expected.size() >= count;
        if (all) expected.resize(count);
        const float squared = nearest.find(position, radius, count, found);
        EXPECT_EQ(squared, all ? expected.back().squaredDistance : radius * radius);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
    }
}

TEST(NearestPhotons, EmptyAndSingleStores) {
    std::vector<NearestPhotons::Neighbour> found;
    const std::vector<Photon> none;
    EXPECT_EQ(NearestPhotons(none).find(Vec3f(0.0f), 2.0f, 5, found), 4.0f);
    EXPECT_TRUE(found.empty());
}

/// In clusters and alone, in no order: whatever a search starts from, it ends with the nearest.
TEST(AdaptiveRadii, FollowTheThirtiethNearest) {
    std::vector<Photon> photons(3000);
    for (size_t i = 0; i < photons.size(); ++i) {
        Sampler sampler(7, RandomStream::Test, 0, i);
        const float size = i % 3 == 0 ? 100.0f : i % 3 == 1 ? 1.0f : 1e-4f;
        for (int axis = 0; axis < 3; ++axis) photons[i].position[axis] = size * (sampler.next1D() - 0.5f);
    }
    const std::vector<float> radii = adaptiveRadii(photons);
    ASSERT_EQ(radii.size(), photons.size());
    for (size_t i = 0; i < photons.size(); i += 7) {
        std::vector<float> squared;
        for (const Photon& other : photons) squared.push_back((other.position - photons[i].position).length2());
        std::nth_element(squared.begin(), squared.begin() + 29, squared.end());
        EXPECT_FLOAT_EQ(radii[i], std::sqrt(squared[29] * 0.05f * std::sqrt(3000.0f) / 30.0f)) << i;
    }
    EXPECT_TRUE(adaptiveRadii({}).empty());
    EXPECT_GT(adaptiveRadii({Photon{}, Photon{}})[0], 0.0f) << "two in one place";
}

} // namespace
} // namespace tungsten::photon
