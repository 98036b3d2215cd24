// Time of one meeting of a camera ray and a sliced primitive: hit tests, and estimators ray by ray (in double) and a
// register of rays at a time; with and without the camera's leg, at delta and box gates.

#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/SliceEstimate.h"
#include "photon/primitives/sliced/SliceSplat.h"
#include "photon/primitives/sliced/Volume.h"

#include "tungsten/core/Warp.h"

#include <benchmark/benchmark.h>

namespace {

using namespace tungsten;
using namespace tungsten::photon;

constexpr size_t Records = 256, Rays = 64;

struct Gate {
    bool warped, delta;
};

/// Records about two units before the camera, in fog without occluders.
struct Setting {
    Scene scene;
    transport::TimeSensor sensor{TimeGate{}};
    std::vector<SliceRecord> records;
    std::vector<CameraSegment> rays;

    Setting(FlightShape shape, bool shared, const Gate& gate) {
        Medium fog;
        fog.model = Homogeneous{Rgb(0.1f), Rgb(0.5f)};
        fog.phase.model = HenyeyGreenstein{0.3f};
        scene.media.push_back(fog);
        scene.transport.cameraUnwarped = !gate.warped;
        const double time = gate.warped ? 5.5 : 2.2, width = 0.2;
        scene.transport.gate =
            gate.delta ? TimeGate{false, true, time, 0.0, 1} : TimeGate{false, false, time, width, 1};
        sensor.gate = gate.delta ? TimeGate{false, false, time - 0.5 * width, width, 1} : scene.transport.gate;
        scene.camera.model = Orthographic{{}, 1.0f}; // every record may be seen everywhere
        Sampler sampler(1, RandomStream::Test, 0, 0);
        for (size_t i = 0; i < Records; ++i) {
            SliceRecord r{};
            r.shape = shape;
            r.shared = shared;
            r.base = Vec3f(0, 0, 2) + warp::squareToSphere(sampler.next2D()) * sampler.next1D();
            for (Vec3f& direction : r.directions) direction = warp::squareToSphere(sampler.next2D());
            r.power = Rgb(1.0f);
            r.reach = r.shape == FlightShape::Ball ? 0.0f : Infinity;
            r.random = {uint16_t(sampler.nextBits()), uint16_t(sampler.nextBits())};
            r.lengths = {1.0f, 1.0f};
            r.bounce = 2;
            r.emitter = -1;
            records.push_back(r);
        }
        for (size_t i = 0; i < Rays; ++i) {
            const Vec3f direction = Vec3f(0.4f * sampler.next1D(), 0.4f * sampler.next1D(), 1.0f).normalized();
            rays.push_back({Vec3f(0.0f), direction, 10.0f, 0.0, 1.0, 0, 0});
        }
    }
};

/// Calls meet(record, ray) for all; the counter is the time of one.
template <typename Meet>
void everyPair(benchmark::State& state, const Setting& setting, const Meet& meet) {
    for (auto _ : state)
        for (const SliceRecord& record : setting.records)
            for (const CameraSegment& ray : setting.rays) meet(record, ray);
    state.counters["one"] = benchmark::Counter(double(Records * Rays), benchmark::Counter::kIsIterationInvariantRate |
                                                                           benchmark::Counter::kInvert);
}

void hit(benchmark::State& state, FlightShape shape, Gate gate) {
    const Setting setting(shape, false, gate);
    const double length = gate.warped ? 5.5 : 2.2;
    everyPair(state, setting, [&](const SliceRecord& record, const CameraSegment& ray) {
        const CameraRay<double> sight{Vec3d(ray.origin), Vec3d(ray.direction), 0.0, 10.0, gate.warped};
        std::array<Vec3d, 4> w;
        for (size_t i = 0; i < 4; ++i) w[i] = Vec3d(record.directions[i]);
        const Vec3d base = Vec3d(record.base);
        if (shape == FlightShape::Plane)
            benchmark::DoNotOptimize(crossPlane<double>(base, {w[0], w[1]}, sight));
        else if (shape == FlightShape::Volume && gate.delta)
            benchmark::DoNotOptimize(sliceVolume<double>(base, {w[0], w[1], w[2]}, sight, length));
        else if (shape == FlightShape::Volume)
            benchmark::DoNotOptimize(volumeChord<double>(base, {w[0], w[1], w[2]}, sight));
        else if (shape == FlightShape::Hypervolume)
            benchmark::DoNotOptimize(sliceHypervolume<double>(base, w, sight, length));
        else if (gate.delta)
            benchmark::DoNotOptimize(sliceBall<double>(base, sight, length));
        else
            benchmark::DoNotOptimize(gateBall<double>(base, sight, {length, length + 0.2}).sample(0.3));
    });
}

void scalar(benchmark::State& state, FlightShape shape, bool shared, Gate gate) {
    const Setting setting(shape, shared, gate);
    const SliceEstimate estimate(setting.scene, setting.sensor);
    FrameSums sums(1, Vec3d(0.0));
    everyPair(state, setting, [&](const SliceRecord& record, const CameraSegment& ray) {
        benchmark::DoNotOptimize(estimate.add(record, ray, sums));
    });
}

void lanes(benchmark::State& state, FlightShape shape, bool shared, Gate gate) {
    const Setting setting(shape, shared, gate);
    const SliceFootprints footprints(setting.scene, setting.sensor, 1.0);
    std::vector<ImageSlice> slices;
    for (const SliceRecord& record : setting.records)
        if (const auto slice = footprints.prepare(record, {})) slices.push_back(*slice);
    std::vector<float> x, y, z, rotation;
    for (const CameraSegment& ray : setting.rays) {
        x.push_back(ray.direction.x);
        y.push_back(ray.direction.y);
        z.push_back(ray.direction.z);
        rotation.push_back(float(rayRotation(ray.direction)));
    }
    for (auto _ : state)
        for (const ImageSlice& slice : slices)
            for (size_t i = 0; i < Rays; i += size_t(Lanes)) {
                const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
                const LaneRays asCast{Lanes3(-slice.record.flights->base),
                                      {load(x), load(y), load(z)},
                                      Batch(0.0f),
                                      Batch(10.0f),
                                      Batch(0.0f) < 1.0f,
                                      load(rotation)};
                const LaneRays rays = slice.record.placed(asCast);
                Batch sum(0.0f);
                const auto emit = [&](int, const LaneHit& reach) {
                    sum += xsimd::select(reach.met, reach.weight(slice.record.sigmaT.x, rays.start), Batch(0.0f));
                };
                std::visit([&](const auto& kernel) { kernel.intersect(slice.record, rays, emit); }, slice.kernel);
                benchmark::DoNotOptimize(sum);
            }
    state.counters["one"] = benchmark::Counter(
        double(slices.size() * Rays), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const bool registered = [] {
    struct Kind {
        const char* name;
        FlightShape shape;
        bool shared;
    };
    for (const Kind& kind :
         {Kind{"planes", FlightShape::Plane, false}, Kind{"volumes", FlightShape::Volume, false},
          Kind{"shared_volumes", FlightShape::Volume, true}, Kind{"balls", FlightShape::Ball, false},
          Kind{"shared_balls", FlightShape::Ball, true}, Kind{"hypervolumes", FlightShape::Hypervolume, false}})
        for (const Gate gate : {Gate{true, true}, Gate{true, false}, Gate{false, true}, Gate{false, false}}) {
            const std::string name =
                std::string(kind.name) + (gate.warped ? "/warped" : "/unwarped") + (gate.delta ? "/delta" : "/box");
            if (!kind.shared) benchmark::RegisterBenchmark(("slice/hit/" + name).c_str(), hit, kind.shape, gate);
            benchmark::RegisterBenchmark(("slice/scalar/" + name).c_str(), scalar, kind.shape, kind.shared, gate);
            benchmark::RegisterBenchmark(("slice/register/" + name).c_str(), lanes, kind.shape, kind.shared, gate);
        }
    return true;
}();

} // namespace
