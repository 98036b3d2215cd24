// Slices drawn into the image against slices gathered ray by ray; edges where their linear systems degenerate.

#include "photon/primitives/sliced/SliceGather.h"
#include "photon/primitives/sliced/SliceSplat.h"

#include "tungsten/core/Warp.h"
#include "tungsten/film/Film.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

struct SplatCase {
    const char* name;
    bool unwarped, orthographic;
};

/// Forward scattering, isotropic and coloured fog at a delta gate; a slanted camera.
Scene fogAtDeltaGate(const SplatCase& c) {
    Scene scene;
    for (int i = 0; i < 3; ++i) {
        Medium fog;
        fog.model = Homogeneous{Rgb(0.2f), i == 2 ? Rgb(0.5f, 1.0f, 2.0f) : Rgb(0.7f)};
        if (i != 1) fog.phase.model = HenyeyGreenstein{i == 0 ? 0.4f : -0.6f};
        scene.media.push_back(fog);
    }
    scene.emitters.push_back({"lamp", PointEmitter{Vec3f(1.0f, 2.5f, 3.5f), Rgb(3.0f, 2.0f, 1.0f)}});
    scene.transport.minBounces = 2;
    scene.transport.maxBounces = 7;
    scene.transport.cameraUnwarped = c.unwarped;
    scene.transport.gate = {false, true, 2.5, 0.0, 1};
    if (c.orthographic) scene.camera.model = Orthographic{1.5f};
    scene.camera.resolution = {37, 21};
    const Frame frame(Vec3f(0.4f, -0.3f, 0.8f).normalized());
    scene.camera.toWorld = {frame.s, frame.t, frame.n, Vec3f(1.0f, 2.0f, 3.0f)};
    return scene;
}
transport::Sensor kernelOf(const Scene& scene) {
    return TimeGate{false, false, scene.transport.gate.start - 0.05, 0.1, 1};
}

std::vector<CollapsedFlights> randomRecords(const Scene& scene, int count) {
    Sampler sampler(3, RandomStream::Test, 0, 0);
    std::vector<CollapsedFlights> records;
    for (int i = 0; i < count; ++i) {
        CollapsedFlights r{};
        r.shape = FlightShape(i % 5);
        r.time = double(2.0f * sampler.next1D());
        r.base = scene.camera.position() + warp::squareToSphere(sampler.next2D()) * (2.5f * sampler.next1D());
        for (Vec3f& direction : r.directions) direction = warp::squareToSphere(sampler.next2D());
        r.power = Rgb(sampler.next1D(), sampler.next1D(), 1.0f);
        r.reach = Infinity;
        r.random = {uint16_t(sampler.nextBits()), uint16_t(sampler.nextBits())};
        r.lengths = {sampler.next1D(), sampler.next1D()};
        r.bounce = uint16_t(i / 5 % 3);
        r.medium = int16_t(i / 5 % 3);
        r.emitter = i % 25 == 0 ? 0 : -1;
        r.shared = r.emitter < 0 && (r.shape == FlightShape::Ball || (i % 2 == 0 && r.shape == FlightShape::Volume));
        records.push_back(r);
    }
    return records;
}

SensorRecord randomView(const Scene& scene) {
    Sampler sampler(4, RandomStream::Test, 0, 0);
    SensorRecord record;
    record.width = scene.camera.resolution.x;
    record.height = scene.camera.resolution.y;
    record.origin = scene.camera.position();
    record.pieces.resize(2);
    for (int y = 0; y < record.height; ++y)
        for (int x = 0; x < record.width; ++x) {
            const Ray ray = scene.camera.generateRay({x, y}, sampler.next2D(), sampler.next2D());
            record.x.push_back(ray.direction.x);
            record.y.push_back(ray.direction.y);
            record.z.push_back(ray.direction.z);
            if (!scene.camera.hasSinglePosition()) record.origins.push_back(ray.origin);
            float start = 0.0f;
            for (StraightPiece& piece : record.pieces) {
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

/// Every piece of every ray by SliceGather.
std::vector<Vec3d> gathered(const Scene& scene, const transport::Sensor& sensor, const SensorRecord& record,
                            const std::vector<CollapsedFlights>& records, float radius) {
    const SliceGather gather(scene, sensor, records, radius);
    std::vector<Vec3d> image(record.x.size(), Vec3d(0.0));
    for (size_t pixel = 0; pixel < image.size(); ++pixel)
        for (const StraightPiece& piece : record.pieces) {
            if (!(piece.end[pixel] > piece.start[pixel])) continue;
            const Vec3f direction(record.x[pixel], record.y[pixel], record.z[pixel]);
            const Vec3f origin = record.origins.empty() ? record.origin : record.origins[pixel];
            const float start = piece.start[pixel];
            FrameSums sums(1, Vec3d(0.0));
            gather.gather({origin + direction * start, direction, piece.end[pixel] - start, double(start), 1.0,
                           piece.interactions[pixel], piece.medium[pixel]},
                          sums);
            const Rgb& t = piece.throughput[pixel];
            image[pixel] += sums[0] * Vec3d(double(t.x), double(t.y), double(t.z));
        }
    return image;
}

class SliceSplat : public testing::TestWithParam<SplatCase> {};

void expectSame(const Scene& scene, const std::vector<CollapsedFlights>& records, const SensorRecord& view) {
    const transport::Sensor sensor = kernelOf(scene);
    constexpr float Radius = 0.05f;
    const auto expected = gathered(scene, sensor, view, records, Radius);
    Film film(view.width, view.height, 1);
    film.beginPass();
    EXPECT_GT(splatSlices(scene, sensor, view, records, Radius, 1.0, film), 1000u);
    // Single slices have no bound: rays next to a singularity, and those where a float's rounding decides, differ.
    size_t far = 0, lit = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const Vec3d& exact = expected[size_t(y) * size_t(view.width) + size_t(x)];
            const Rgb found = film.passPixel(0, x, y);
            if (exact.z > 0.0) ++lit;
            bool differs = false;
            for (int k = 0; k < 3; ++k) {
                EXPECT_TRUE(std::isfinite(found[k]));
                differs = differs || std::abs(double(found[k]) - exact[k]) > 2e-3 * exact[k] + 1e-6;
            }
            far += differs;
        }
    EXPECT_GT(lit, expected.size() / 2);
    EXPECT_LE(far, expected.size() / 50) << "of " << expected.size();
}

TEST_P(SliceSplat, BringsWhatGathersBring) {
    const Scene scene = fogAtDeltaGate(GetParam());
    expectSame(scene, randomRecords(scene, 1500), randomView(scene));
}

/// Splats draw a point of the whole ray, gathers of the piece: the same where there is one piece.
TEST_P(SliceSplat, BringsBallsInTheTemporalKernel) {
    const Scene scene = fogAtDeltaGate(GetParam());
    auto records = randomRecords(scene, 1500);
    for (CollapsedFlights& r : records) {
        r.shape = FlightShape::Ball;
        r.emitter = -1;
        r.shared = false;
        r.bounce = 1;
        r.medium = 0;
        // No farther than the camera, so that no ray begins inside.
        r.base = scene.camera.position() + scene.camera.forward() * (3.0f + 0.1f * r.lengths[0]) + r.directions[0];
        r.time = scene.transport.gate.start - (scene.transport.cameraUnwarped ? 0.1 + 1.3 * double(r.lengths[1]) : 5.5);
    }
    SensorRecord view = randomView(scene);
    view.pieces.resize(1);
    StraightPiece& piece = view.pieces.front();
    std::fill(piece.start.begin(), piece.start.end(), 0.0f);
    std::fill(piece.end.begin(), piece.end.end(), Infinity);
    std::fill(piece.medium.begin(), piece.medium.end(), int16_t(0));
    std::fill(piece.interactions.begin(), piece.interactions.end(), uint16_t(1));
    expectSame(scene, records, view);
}

INSTANTIATE_TEST_SUITE_P(Cameras, SliceSplat,
                         testing::Values(SplatCase{"Warped", false, false}, SplatCase{"Unwarped", true, false},
                                         SplatCase{"UnwarpedOrthographic", true, true},
                                         SplatCase{"WarpedOrthographic", false, true}),
                         [](const auto& test) { return test.param.name; });

/// Parallel directions, a base in the camera, on its axis and behind the gate, in box and delta gates.
TEST(SliceEdges, EverythingStaysFinite) {
    for (const bool unwarped : {false, true})
        for (const bool delta : {false, true}) {
            Scene scene = fogAtDeltaGate({"", unwarped, false});
            if (!delta) scene.transport.gate = {false, false, 2.0, 0.25, 4};
            const transport::Sensor sensor = delta ? kernelOf(scene) : transport::Sensor(scene.transport.gate);
            auto records = randomRecords(scene, 3000);
            const Vec3f eye = scene.camera.position(), axis = scene.camera.forward();
            for (size_t i = 0; i < records.size(); ++i) {
                CollapsedFlights& r = records[i];
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
