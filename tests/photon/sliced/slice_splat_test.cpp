// Slices drawn into the image against slices gathered ray by ray; edges where their linear systems degenerate.

#include "photon/Tuning.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/primitives/sliced/SliceGather.h"
#include "photon/primitives/sliced/SliceSplat.h"

#include "tungsten/core/Warp.h"
#include "tungsten/film/Film.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/SceneFile.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

struct SplatCase {
    const char* name;
    bool unwarped, orthographic;
    int frames = 0;        ///< 0: a delta gate
    float speed = 1.0f;    ///< of light; all times are in proportion
    bool rayByRay = false; ///< the isotropic fog has a phase function that is not drawn in registers of rays
};

/// Forward scattering, isotropic and coloured fog; a slanted camera.
Scene fogAtGate(const SplatCase& c) {
    Scene scene;
    for (int i = 0; i < 3; ++i) {
        Medium fog;
        fog.model = Homogeneous{Rgb(0.2f), i == 2 ? Rgb(0.5f, 1.0f, 2.0f) : Rgb(0.7f)};
        if (i != 1) fog.phase.model = HenyeyGreenstein{i == 0 ? 0.4f : -0.6f};
        if (i == 1 && c.rayByRay) fog.phase.model = Rayleigh{};
        fog.speedOfLight = c.speed;
        scene.media.push_back(fog);
    }
    scene.cameraRegion.speed = c.speed;
    scene.emitters.push_back({"lamp", PointEmitter{{}, Vec3f(1.0f, 2.5f, 3.5f), Rgb(3.0f, 2.0f, 1.0f)}});
    static const Shape disk = Disk{Vec3f(0.0f), 1.0f, Frame(Vec3f(0.0f, 0.0f, 1.0f)), 0.2f};
    scene.emitters.push_back(
        {"panel", AreaEmitter{{}, &disk, 0, Texture(2.0f), std::make_shared<const AreaSampler>(disk)}});
    scene.transport.minBounces = 2;
    scene.transport.maxBounces = 7;
    scene.transport.cameraUnwarped = c.unwarped;
    scene.transport.gate = {false, true, 2.5, 0.0, 1};
    if (c.frames > 0) scene.transport.gate = {false, false, 1.75, 0.25, c.frames};
    scene.transport.gate.start /= double(c.speed);
    scene.transport.gate.frameWidth /= double(c.speed);
    if (c.orthographic) scene.camera.model = Orthographic{{}, 1.5f};
    scene.camera.resolution = {37, 21};
    const Frame frame(Vec3f(0.4f, -0.3f, 0.8f).normalized());
    scene.camera.toWorld = {frame.s, frame.t, frame.n, Vec3f(1.0f, 2.0f, 3.0f)};
    return scene;
}
transport::TimeSensor sensorOf(const Scene& scene) {
    if (!scene.transport.gate.delta) return scene.transport.gate;
    const auto speed = double(scene.cameraRegion.speed);
    return TimeGate{false, false, scene.transport.gate.start - 0.05 / speed, 0.1 / speed, 1};
}

std::vector<SliceRecord> randomRecords(const Scene& scene, int count) {
    Sampler sampler(3, RandomStream::Test, 0, 0);
    std::vector<SliceRecord> records;
    for (int i = 0; i < count; ++i) {
        SliceRecord r{};
        r.shape = FlightShape(i % 5);
        r.time = double(2.0f * sampler.next1D() / scene.cameraRegion.speed);
        r.base = scene.camera.position() + warp::squareToSphere(sampler.next2D()) * (2.5f * sampler.next1D());
        for (Vec3f& direction : r.directions) direction = warp::squareToSphere(sampler.next2D());
        r.power = Rgb(sampler.next1D(), sampler.next1D(), 1.0f);
        r.reach = Infinity;
        r.random = {uint16_t(sampler.nextBits()), uint16_t(sampler.nextBits())};
        r.lengths = {sampler.next1D(), sampler.next1D()};
        r.bounce = uint16_t(i / 5 % 3);
        r.medium = int16_t(i / 5 % 3);
        r.emitter = int16_t(i % 25 == 0 ? i / 25 % 2 : -1);
        r.shared = r.emitter < 0 && i % 2 == 0 && (r.shape == FlightShape::Ball || r.shape == FlightShape::Volume);
        if (r.shape == FlightShape::Ball) {
            const bool single = r.emitter < 0 && !r.shared;
            r.reach = single ? 0.3f * sampler.next1D() : 0.0f;
            r.onSurface = single && i % 3 == 0;
        }
        records.push_back(r);
    }
    return records;
}

CameraRecord randomView(const Scene& scene) {
    Sampler sampler(4, RandomStream::Test, 0, 0);
    CameraRecord record;
    record.width = scene.camera.resolution.x;
    record.height = scene.camera.resolution.y;
    record.origin = scene.camera.position();
    record.mediumSegments.resize(2);
    for (int y = 0; y < record.height; ++y)
        for (int x = 0; x < record.width; ++x) {
            const Ray ray = scene.camera.generateRay({x, y}, sampler.next2D(), sampler.next2D());
            record.x.push_back(ray.direction.x);
            record.y.push_back(ray.direction.y);
            record.z.push_back(ray.direction.z);
            if (!scene.camera.hasSinglePosition()) record.origins.push_back(ray.origin);
            float start = 0.0f;
            for (MediumSegment& piece : record.mediumSegments) {
                const float end = start + sampler.next1D();
                piece.start.push_back(start);
                piece.end.push_back(sampler.next1D() < 0.2f ? 0.0f : end);
                piece.medium.push_back(int16_t(sampler.nextBits() % 3));
                piece.interactions.push_back(uint16_t(sampler.nextBits() % 3));
                piece.throughput.emplace_back(sampler.next1D(), 0.5f, 1.0f);
                start = end;
            }
        }
    return record;
}

/// Every piece of every ray by SliceGather; every frame.
std::vector<FrameSums> gatheredByFrame(const Scene& scene, const transport::TimeSensor& sensor,
                                       const CameraRecord& record, const std::vector<SliceRecord>& records,
                                       float radius) {
    const SliceGather gather(scene, sensor, records, radius);
    const auto frames = size_t(sensor.gate.frames);
    std::vector<FrameSums> image(record.x.size(), FrameSums(frames, Vec3d(0.0)));
    for (size_t pixel = 0; pixel < image.size(); ++pixel)
        for (const MediumSegment& piece : record.mediumSegments) {
            if (!(piece.end[pixel] > piece.start[pixel])) continue;
            const Vec3f direction(record.x[pixel], record.y[pixel], record.z[pixel]);
            const Vec3f origin = record.origins.empty() ? record.origin : record.origins[pixel];
            const float start = piece.start[pixel];
            FrameSums sums(frames, Vec3d(0.0));
            const double inverseSpeed = 1.0 / double(scene.cameraRegion.speed);
            gather.gather({origin + direction * start, direction, piece.end[pixel] - start,
                           double(start) * inverseSpeed, inverseSpeed, piece.interactions[pixel], piece.medium[pixel]},
                          sums);
            const Rgb& t = piece.throughput[pixel];
            for (size_t frame = 0; frame < frames; ++frame)
                image[pixel][frame] += sums[frame] * Vec3d(double(t.x), double(t.y), double(t.z));
        }
    return image;
}

/// With the records that each frame draws.
std::vector<FrameSums> gathered(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                                const std::vector<SliceRecord>& records, float radius) {
    auto image = gatheredByFrame(scene, sensor, record, records, radius);
    if (sensor.gate.frames == 1) return image;
    const FrameRoulette shares(scene, sensor.gate, records);
    for (int frame = 0; frame < sensor.gate.frames; ++frame) {
        auto drawn = records;
        for (size_t i = 0; i < records.size(); ++i)
            if (drawn[i].shape != FlightShape::Beam) drawn[i].power = drawn[i].power * shares.of(i)[size_t(frame)];
        const auto of = gatheredByFrame(scene, sensor, record, drawn, radius);
        for (size_t pixel = 0; pixel < image.size(); ++pixel) image[pixel][size_t(frame)] = of[pixel][size_t(frame)];
    }
    return image;
}

class SliceSplat : public testing::TestWithParam<SplatCase> {};

TEST_P(SliceSplat, BringsWhatGathersBring) {
    const Scene scene = fogAtGate(GetParam());
    const auto records = randomRecords(scene, 1500);
    const CameraRecord view = randomView(scene);
    const transport::TimeSensor sensor = sensorOf(scene);
    constexpr float Radius = 0.05f;
    const auto expected = gathered(scene, sensor, view, records, Radius);
    Film film(view.width, view.height, sensor.gate.frames);
    film.beginPass();
    EXPECT_GT(splatSlices(scene, sensor, view, records, Radius, 1.0, film), 1000u);
    for (int frame = 0; frame < sensor.gate.frames; ++frame) {
        // Single slices have no bound: rays next to a singularity, and those where a float's rounding decides, differ.
        size_t far = 0, lit = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const Vec3d& exact = expected[size_t(y) * size_t(view.width) + size_t(x)][size_t(frame)];
                const Rgb found = film.passPixel(frame, x, y);
                if (exact.z > 0.0) ++lit;
                bool differs = false;
                for (int k = 0; k < 3; ++k) {
                    EXPECT_TRUE(std::isfinite(found[k]));
                    differs = differs || std::abs(double(found[k]) - exact[k]) > 2e-3 * exact[k] + 1e-6;
                }
                far += differs;
            }
        EXPECT_GT(lit, expected.size() / 2) << "frame " << frame;
        EXPECT_LE(far, expected.size() / 50) << "of " << expected.size() << ", frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cameras, SliceSplat,
    testing::Values(SplatCase{"Warped", false, false}, SplatCase{"Unwarped", true, false},
                    SplatCase{"UnwarpedOrthographic", true, true}, SplatCase{"WarpedOrthographic", false, true},
                    SplatCase{"WarpedFrames", false, false, 5}, SplatCase{"UnwarpedFrames", true, false, 5},
                    SplatCase{"UnwarpedOrthographicGate", true, true, 1},
                    SplatCase{"WarpedOrthographicGate", false, true, 1}, SplatCase{"WarpedFast", false, false, 0, 2.0f},
                    SplatCase{"UnwarpedSlowFrames", true, false, 5, 0.5f},
                    SplatCase{"WarpedFastFrames", false, false, 5, 2.0f},
                    SplatCase{"WarpedRayByRay", false, false, 1, 1.0f, true}),
    [](const auto& test) { return test.param.name; });

/// Alike records, the older ones much darker: drawn at random, and right on average.
TEST(FrameRoulette, MakeUpForWhatTheyLeaveOut) {
    const Scene scene = fogAtGate({"", true, false, 8});
    constexpr size_t Count = 20000;
    std::vector<SliceRecord> records(Count);
    Sampler sampler(5, RandomStream::Test, 0, 0);
    for (size_t i = 0; i < Count; ++i) {
        records[i].shape = FlightShape::Volume;
        records[i].time = i % 2 == 0 ? -6.0 : 1.0;
        records[i].power = Rgb(1.0f);
        records[i].random = {uint16_t(sampler.nextBits()), uint16_t(sampler.nextBits())};
    }
    const FrameRoulette shares(scene, scene.transport.gate, records);
    for (size_t frame = 0; frame < 8; ++frame)
        for (const size_t first : {size_t(0), size_t(1)}) {
            double sum = 0.0, squares = 0.0, drawn = 0.0;
            for (size_t i = first; i < Count; i += 2) {
                const auto factor = double(shares.of(i)[frame]);
                sum += factor;
                squares += factor * factor;
                drawn += factor > 0.0 ? 1.0 : 0.0;
            }
            const double n = 0.5 * double(Count), mean = sum / n;
            const double error = std::sqrt((squares / n - mean * mean) / n);
            EXPECT_NEAR(mean, 1.0, 5.0 * error + 1e-6) << "frame " << frame;
            if (first == 0)
                EXPECT_LT(drawn, 0.2 * n) << "frame " << frame;
            else
                EXPECT_EQ(drawn, n) << "frame " << frame;
        }
}

/// By guesses as far apart as can be, of what is left of a very long way in dense fog: any that can arrive is drawn now
/// and then, and right on average.
TEST(FrameRoulette, LeaveNothingOut) {
    Scene scene = fogAtGate({"", false, false, 8});
    for (const float speed : {1.0f, 1000.0f}) { // ways of a float's range of optical depths, and far beyond
        for (Medium& medium : scene.media) medium.speedOfLight = speed;
        constexpr size_t Count = 20000;
        std::vector<SliceRecord> records(Count);
        Sampler sampler(8, RandomStream::Test, 0, 0);
        for (SliceRecord& record : records) {
            record.shape = FlightShape::Volume;
            record.emitter = -1;
            record.time = -200.0 * double(sampler.next1D());
            record.base = warp::squareToSphere(sampler.next2D());
            record.power = Rgb(1.0f);
            record.random = {uint16_t(sampler.nextBits()), uint16_t(sampler.nextBits())};
        }
        const FrameRoulette shares(scene, scene.transport.gate, records);
        for (size_t frame = 0; frame < 8; ++frame) {
            double sum = 0.0, squares = 0.0, most = 0.0;
            for (size_t i = 0; i < Count; ++i) {
                const auto factor = double(shares.of(i)[frame]);
                sum += factor / double(Count);
                squares += factor * factor / double(Count);
                most = std::max(most, factor);
            }
            EXPECT_NEAR(sum, 1.0, 5.0 * std::sqrt((squares - sum * sum) / double(Count))) << "frame " << frame;
            EXPECT_LE(most, 1.001 / double(tuning::EvenInFrames)) << "frame " << frame;
        }
    }
}

/// As many records as their light calls for, also where all of it is below any float.
TEST(RecordBudget, TellFarRecordsApart) {
    Scene scene = fogAtGate({"", false, false, 1});
    for (Medium& medium : scene.media) medium.speedOfLight = 1.0f;
    std::vector<SliceRecord> records(2);
    for (SliceRecord& record : records) {
        record.shape = FlightShape::Volume;
        record.emitter = -1;
        record.power = Rgb(1.0f);
        record.time = -1e4;
    }
    RecordBudget counts(scene, scene.transport.gate);
    records[1].power = Rgb(3.0f);
    counts.measure(records, {});
    EXPECT_NEAR(counts.expected(records[0]), 0.5f, 1e-4f);
    EXPECT_NEAR(counts.expected(records[1]), 1.5f, 1e-4f);
    records[0].time = -1e5;
    EXPECT_EQ(counts.expected(records[0]), tuning::LeastPerBase);
    records[0].time = 1e4;
    EXPECT_NEAR(counts.expected(records[0]), tuning::MostPerBase, 1e-4f);
}

/// Light that meets a wall where it starts goes nowhere. (The wall itself lies elsewhere.)
TEST(SliceGather, EndsFirstFlightsAtWalls) {
    const test::SceneFile file(R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 0.5}],
        "primitives": [{"type": "sphere", "bsdf": {"type": "lambert"}, "transform": {"position": [0, 0, -90]}},
                       {"type": "point", "emission": 1, "transform": {"position": [0, 1, 0]}}],
        "camera": {"type": "pinhole", "medium": "fog", "resolution": 4,
                   "transform": {"position": [0, 0, 0], "look_at": [0, 0, 1]}},
        "integrator": {"type": "progressive_transient_photon_map", "start_time": 0, "transient_time_width": 6, "frame_num": 1}})");
    const LoadedScene loaded = loadScene(file.path(), {});
    const Scene& scene = *loaded.scene;
    const transport::TimeSensor sensor(scene.transport.gate);
    for (const FlightShape shape : {FlightShape::Plane, FlightShape::Volume, FlightShape::Hypervolume})
        for (const float reach : {Infinity, 0.0f}) {
            Sampler sampler(6, RandomStream::Test, 0, 0);
            std::vector<SliceRecord> records(2000);
            for (SliceRecord& r : records) {
                r.shape = shape;
                r.emitter = -1;
                r.base = Vec3f(0.0f, 0.0f, 1.5f) + warp::squareToSphere(sampler.next2D());
                for (Vec3f& direction : r.directions) direction = warp::squareToSphere(sampler.next2D());
                r.power = Rgb(1.0f);
                r.reach = reach;
            }
            const SliceGather gather(scene, sensor, records, 0.05f);
            FrameSums sums(1, Vec3d(0.0));
            const uint64_t met = gather.gather({Vec3f(0.0f), Vec3f(0, 0, 1), 3.0f, 0.0, 1.0, 0, 0}, sums);
            if (reach > 0.0f)
                EXPECT_GT(met, 50u) << int(shape);
            else
                EXPECT_EQ(met, 0u) << int(shape);
        }
}

/// Parallel directions, a base in the camera, on its axis and behind the gate, in box and delta gates.
TEST(SliceEdges, EverythingStaysFinite) {
    for (const bool unwarped : {false, true})
        for (const bool delta : {false, true}) {
            const Scene scene = fogAtGate({"", unwarped, false, delta ? 0 : 4});
            const transport::TimeSensor sensor = sensorOf(scene);
            auto records = randomRecords(scene, 3000);
            const Vec3f eye = scene.camera.position(), axis = scene.camera.forward();
            for (size_t i = 0; i < records.size(); ++i) {
                SliceRecord& r = records[i];
                if (i % 6 == 0) r.directions[1] = r.directions[0];
                if (i % 6 == 1) r.directions = {axis, axis, axis, axis};
                if (i % 6 == 2) r.directions = {-axis, -axis, r.directions[2], -axis};
                if (i % 7 == 0) r.base = eye;
                if (i % 7 == 1) r.base = eye + axis * 0.5f;
                if (i % 7 == 2) r.time = 1e3;
                if (i % 7 == 3) r.time = 2.5;
                if (i % 11 == 0) r.lengths = {1e30f, 0.0f};
            }
            const SliceGather gather(scene, sensor, records, 0.05f);
            for (const Vec3f& direction : {axis, -axis, Vec3f(0, 0, 1)})
                for (const float length : {0.0f, 1.0f, Infinity})
                    for (int medium = 0; medium < 3; ++medium) {
                        FrameSums sums(size_t(sensor.gate.frames), Vec3d(0.0));
                        gather.gather({eye, direction, length, 0.0, 1.0, 0, medium}, sums);
                        for (const Vec3d& sum : sums)
                            for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(sum[k]) && sum[k] >= 0.0);
                    }
        }
}

} // namespace
} // namespace tungsten::photon
