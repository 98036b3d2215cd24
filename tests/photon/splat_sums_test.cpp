// Sums of very many splats: what is added in single precision must not drift.

#include "photon/primitives/beams/Beams.h"
#include "photon/primitives/points/Points.h"
#include "photon/view/CameraRecord.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr int Pixels = 8, Photons = 200000;

/// Isotropic fog before a camera at the origin that looks along z.
Scene fogBeforeCamera() {
    Scene scene;
    Medium fog;
    fog.model = Homogeneous{Rgb(0.1f), Rgb(0.6f)};
    scene.media.push_back(fog);
    scene.transport.maxBounces = 8;
    scene.camera.model = Pinhole{30.0f};
    scene.camera.resolution = {Pixels, Pixels};
    return scene;
}

/// Rays through the pixels' centres, all of them in fog.
CameraRecord recordOf(const Scene& scene) {
    CameraRecord record;
    record.width = record.height = Pixels;
    record.origin = scene.camera.position();
    MediumSegment& fog = record.mediumSegments.emplace_back();
    for (int i = 0; i < Pixels * Pixels; ++i) {
        const Ray ray = scene.camera.generateRay({i % Pixels, i / Pixels}, {0.5f, 0.5f}, {0.5f, 0.5f});
        record.x.push_back(ray.direction.x);
        record.y.push_back(ray.direction.y);
        record.z.push_back(ray.direction.z);
        fog.start.push_back(0.0f);
        fog.end.push_back(Infinity);
        fog.medium.push_back(0);
        fog.interactions.push_back(0);
        fog.throughput.emplace_back(1.0f, 0.3f, 0.7f);
    }
    return record;
}

/// How far `all`, of `count` equal splats, is from that many times `one`, relative to it: the most of any pixel, and
/// the mean.
struct Drift {
    double most = 0.0, mean = 0.0;
    int lit = 0;
};
Drift driftOf(const Film& all, const Film& one, double count) {
    Drift drift;
    for (int i = 0; i < Pixels * Pixels; ++i)
        for (int k = 0; k < 3; ++k) {
            const double exact = count * double(one.passPixel(0, i % Pixels, i / Pixels)[k]);
            if (!(exact > 0.0)) continue;
            const double off = double(all.passPixel(0, i % Pixels, i / Pixels)[k]) / exact - 1.0;
            drift.most = std::max(drift.most, std::abs(off));
            drift.mean += off;
            ++drift.lit;
        }
    drift.mean /= std::max(drift.lit, 1);
    return drift;
}

/// What splat(count, film) draws, for one and for Photons.
template <typename Splat>
Drift driftOf(int frames, const Splat& splat) {
    Film one(Pixels, Pixels, frames), all = one;
    one.beginPass();
    all.beginPass();
    splat(1, one);
    splat(Photons, all);
    return driftOf(all, one, double(Photons));
}

TEST(SplatSums, OfEqualPhotonsDoNotDrift) {
    const Scene scene = fogBeforeCamera();
    const CameraRecord record = recordOf(scene);
    const Vec3f ahead = scene.camera.generateRay({Pixels / 2, Pixels / 2}, {0.0f, 0.0f}, {0.5f, 0.5f}).direction;
    const Drift drift = driftOf(1, [&](int count, Film& film) {
        const std::vector<Photon> photons(size_t(count), Photon{0.0, ahead * 2.0f, ahead, Rgb(0.3f, 0.7f, 1.1f), 1, 0});
        Points::splat(scene, TimeGate{}, {&record}, {photons, 0.5f}, 1e-3, film);
    });
    EXPECT_GT(drift.lit, 3 * 16);
    EXPECT_LT(drift.most, 5e-6);
}

/// By registers in one gate, pixel by pixel into the film of a sequence.
TEST(SplatSums, OfEqualBeamsDoNotDrift) {
    Scene scene = fogBeforeCamera();
    const CameraRecord record = recordOf(scene);
    const Vec3f ahead = scene.camera.generateRay({Pixels / 2, Pixels / 2}, {0.0f, 0.0f}, {0.5f, 0.5f}).direction;
    for (const int frames : {1, 2}) {
        const TimeGate gate = frames == 1 ? TimeGate{} : TimeGate{false, false, 0.0, 50.0, frames};
        const Drift drift = driftOf(frames, [&](int count, Film& film) {
            const PhotonBeam beam{0.0,
                                  ahead * 2.0f - Vec3f(1.0f, 0.0f, 0.0f),
                                  Vec3f(1.0f, 0.0f, 0.0f),
                                  Rgb(0.3f, 0.7f, 1.1f),
                                  0.0f,
                                  2.0f,
                                  0,
                                  0};
            Beams::splat(scene, gate, {&record}, {std::vector<PhotonBeam>(size_t(count), beam), 0.3f}, 1e-3, film);
        });
        EXPECT_GT(drift.lit, 3 * 8) << frames;
        EXPECT_LT(drift.most, frames == 1 ? 5e-6 : 5e-5) << frames << ": even rounding is off at random in one pass";
        EXPECT_LT(std::abs(drift.mean), 5e-6) << frames << ": and nowhere in the mean";
    }
}

} // namespace
} // namespace tungsten::photon
