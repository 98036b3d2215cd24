// Splatted photons and beams against gathered ones.

#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/beams/Beams.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/primitives/points/Points.h"
#include "photon/view/CameraRecord.h"

#include "tungsten/core/Warp.h"

#include "support/Render.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

struct SplatCase {
    const char* name;
    Vec2i resolution;
    float fov;
    bool steady, unwarped, radiusEach;
    size_t segments;
    int onlyMedium = -1; ///< of all rays, if any
    bool edges = false;  ///< kernels end at planes near them
};

/// Of a kernel that ends at one plane or between two; the planes pass the record within its radius.
KernelEdges randomEdges(Sampler& sampler, float radius, const Vec3f& direction) {
    const Vec3f normal = warp::squareToSphere(sampler.next2D());
    const float height = radius * sampler.next1D();
    // As seen from the record's position; a beam's plane is as high at the beam's base, and falls along it.
    KernelEdges edges{{normal, height + std::max(4.0f * normal.dot(direction), 0.0f)}, {}};
    if (sampler.next1D() < 0.5f)
        edges.opposite = {-normal, radius * sampler.next1D() + std::max(-4.0f * normal.dot(direction), 0.0f)};
    return edges;
}

/// Grey, coloured, Rayleigh and isotropic fog; a slanted camera.
Scene foggyScene(const SplatCase& c) {
    Scene scene;
    for (int i = 0; i < 4; ++i) {
        Medium fog;
        fog.model = Homogeneous{Rgb(0.2f), i == 1 ? Rgb(0.5f, 1.0f, 2.0f) : Rgb(0.7f)};
        if (i < 2) fog.phase.model = HenyeyGreenstein{i == 0 ? 0.4f : -0.6f};
        if (i == 2) fog.phase.model = Rayleigh{};
        scene.media.push_back(fog);
    }
    scene.transport.minBounces = 2;
    scene.transport.maxBounces = 6;
    scene.transport.cameraUnwarped = c.unwarped;
    scene.cameraRegion.speed = 0.8f;
    scene.camera.model = Pinhole{c.fov};
    scene.camera.resolution = c.resolution;
    const Frame frame(Vec3f(0.4f, -0.3f, 0.8f).normalized());
    scene.camera.toWorld = {frame.s, frame.t, frame.n, Vec3f(1.0f, 2.0f, 3.0f)};
    return scene;
}

/// Photons all around the camera and behind it, many right before the lens.
Store<Photon> photonsAround(const Vec3f& camera) {
    Sampler sampler(3, RandomStream::Test, 0, 0);
    Store<Photon> store;
    store.paths = 1;
    for (int i = 0; i < 8000; ++i) {
        const float reach = i % 4 == 0 ? 0.3f : 4.0f;
        const Vec3f position = camera + warp::squareToSphere(sampler.next2D()) * (reach * sampler.next1D());
        const Vec3f direction = warp::squareToSphere(sampler.next2D());
        const Rgb power(sampler.next1D(), sampler.next1D(), 1.0f);
        store.records.push_back(
            {double(3.0f * sampler.next1D()), position, direction, power, uint16_t(1 + i % 4), int16_t(i / 4 % 3)});
    }
    return store;
}

CameraRecord randomRecord(const Scene& scene, size_t segments) {
    Sampler sampler(4, RandomStream::Test, 0, 0);
    CameraRecord record;
    record.width = scene.camera.resolution.x;
    record.height = scene.camera.resolution.y;
    record.origin = scene.camera.position();
    record.mediumSegments.resize(segments);
    for (int y = 0; y < record.height; ++y)
        for (int x = 0; x < record.width; ++x) {
            const Ray ray = scene.camera.generateRay({x, y}, sampler.next2D(), sampler.next2D());
            record.x.push_back(ray.direction.x);
            record.y.push_back(ray.direction.y);
            record.z.push_back(ray.direction.z);
            float start = 0.0f;
            for (MediumSegment& segment : record.mediumSegments) {
                // Some pixels lack a segment; some never end.
                const bool none = sampler.next1D() < 0.2f;
                if (&segment != &record.mediumSegments.front()) start += 0.5f * sampler.next1D();
                const float end = sampler.next1D() < 0.2f ? Infinity : start + 2.0f * sampler.next1D();
                segment.start.push_back(none ? 0.0f : start);
                segment.end.push_back(none ? 0.0f : end);
                segment.medium.push_back(int16_t(sampler.nextBits() % 3));
                segment.interactions.push_back(uint16_t(sampler.nextBits() % 3));
                segment.throughput.emplace_back(sampler.next1D(), 0.5f, 1.0f);
                if (std::isfinite(end)) start = end;
            }
        }
    return record;
}

/// The same rays in one medium, with as many interactions everywhere. A first segment may begin a little behind the
/// camera.
void useOneMedium(CameraRecord& record, int medium, bool behindCamera) {
    for (MediumSegment& segment : record.mediumSegments) {
        std::fill(segment.medium.begin(), segment.medium.end(), int16_t(medium));
        std::fill(segment.interactions.begin(), segment.interactions.end(), uint16_t(1));
    }
    MediumSegment& first = record.mediumSegments.front();
    for (size_t i = 0; i < first.start.size() && behindCamera; ++i)
        if (first.end[i] > 0.0f) first.start[i] = 0.5f * std::min(first.end[i], 0.2f + 0.01f * float(i % 3));
}

/// Rays as the case wants them.
CameraRecord recordOf(const SplatCase& c, const Scene& scene) {
    CameraRecord record = randomRecord(scene, c.segments);
    // Beyond the first segment a gather takes a photon's time from the segment's start, which is a detour: no gate
    // there.
    if (c.onlyMedium >= 0) useOneMedium(record, c.onlyMedium, c.steady);
    return record;
}

/// A third of the photons or beams comes into the case's medium.
template <typename T>
std::vector<T> inMediumOf(const SplatCase& c, std::vector<T> all) {
    for (T& one : all)
        if (c.onlyMedium >= 0 && one.medium == 0) one.medium = int16_t(c.onlyMedium);
    return all;
}

/// Beams of all lengths around the camera: some run through it, some along its rays, every tenth is as good as endless.
std::vector<PhotonBeam> beamsAround(const Vec3f& camera, size_t count) {
    Sampler sampler(5, RandomStream::Test, 0, 0);
    std::vector<PhotonBeam> beams;
    for (size_t i = 0; i < count; ++i) {
        const float reach = i % 4 == 0 ? 0.3f : 4.0f;
        const Vec3f position = camera + warp::squareToSphere(sampler.next2D()) * (reach * sampler.next1D());
        const Vec3f towards = (camera - position).normalized(), anywhere = warp::squareToSphere(sampler.next2D());
        const Vec3f direction = i % 8 == 7 ? (towards + anywhere * 0.02f).normalized() : anywhere;
        const Rgb power(sampler.next1D(), sampler.next1D(), 1.0f);
        const float start = 0.3f * sampler.next1D(), length = i % 10 == 9 ? 60.0f : 2.0f * sampler.next1D();
        beams.push_back({double(3.0f * sampler.next1D()), position, direction, power, start, start + length,
                         uint16_t(i % 4), int16_t(i / 4 % 3)});
    }
    return beams;
}

/// What a PointGather or BeamGather finds along every recorded segment.
template <typename Gather>
uint64_t gatherRecord(const Gather& gather, const TimeGate& gate, const CameraRecord& record, Film& film) {
    uint64_t gathered = 0;
    for (const MediumSegment& segment : record.mediumSegments)
        for (size_t i = 0; i < record.x.size(); ++i) {
            if (!(segment.end[i] > segment.start[i])) continue;
            const Vec3f direction(record.x[i], record.y[i], record.z[i]);
            FrameSums sums(size_t(gate.frames), Vec3d(0.0));
            gathered += gather.gather({record.origin + direction * segment.start[i], direction,
                                       segment.end[i] - segment.start[i], double(segment.start[i] / 0.8f),
                                       1.0 / double(0.8f), segment.interactions[i], segment.medium[i]},
                                      sums);
            for (int frame = 0; frame < gate.frames; ++frame) {
                const Vec3d& sum = sums[size_t(frame)];
                film.add(frame, int(i) % record.width, int(i) / record.width,
                         Rgb(float(sum.x), float(sum.y), float(sum.z)) * segment.throughput[i]);
            }
        }
    return gathered;
}

class Splat : public testing::TestWithParam<SplatCase> {};

/// Frames, or steady state.
TimeGate gateOf(const SplatCase& c) {
    return c.steady ? TimeGate{} : TimeGate{false, false, 1.0, 0.7, 4};
}

/// The splatted image is `scale` times the gathered one, to `relative` of the larger; returns how many channels are
/// lit.
int expectScaled(Film& splatted, Film& gathered, int frames, float scale, float relative) {
    int lit = 0;
    for (int frame = 0; frame < frames; ++frame)
        for (int y = 0; y < splatted.height(); ++y)
            for (int x = 0; x < splatted.width(); ++x)
                for (int k = 0; k < 3; ++k) {
                    const float value = splatted.passPixel(frame, x, y)[k],
                                right = scale * gathered.passPixel(frame, x, y)[k];
                    EXPECT_NEAR(value, right, relative * right + 1e-4f) << x << ' ' << y << ' ' << frame;
                    if (right > 0.01f) ++lit;
                }
    return lit;
}

TEST_P(Splat, AddsWhatGatheringFinds) {
    const SplatCase& c = GetParam();
    const Scene scene = foggyScene(c);
    Store<Photon> store = photonsAround(scene.camera.position());
    store.records = inMediumOf(c, store.records);
    const CameraRecord record = recordOf(c, scene);
    std::vector<float> radii{0.15f};
    if (c.radiusEach)
        for (size_t i = 1; i < store.records.size(); ++i) radii.push_back(0.02f + 0.3f * float(i % 7) / 7.0f);
    std::vector<KernelEdges> edges;
    Sampler sampler(6, RandomStream::Test, 0, 0);
    for (size_t i = 0; c.edges && i < store.records.size(); ++i)
        edges.push_back(i % 3 == 0 ? KernelEdges{} : randomEdges(sampler, 0.15f, Vec3f(0.0f)));
    const TimeGate gate = gateOf(c);
    Film splatted(record.width, record.height, gate.frames), gathered = splatted;
    splatted.beginPass();
    gathered.beginPass();
    const Radii kernels(radii, edges);
    const uint64_t count = Points::splat(scene, gate, {&record}, {store.records, kernels}, 3.0, splatted);
    const uint64_t expected = gatherRecord(PointGather(scene, gate, store.records, kernels), gate, record, gathered);
    // At the kernel's edge rounding decides.
    EXPECT_NEAR(double(count), double(expected), 1e-4 * double(expected) + 2.0);
    EXPECT_GT(expected, 1000u);
    EXPECT_GT(expectScaled(splatted, gathered, gate.frames, 3.0f, 1e-4f), gate.frames * record.width * record.height);
}

/// Beam by beam, as a beam's edge is a step: where rounding puts a ray on the other side, the beam's image differs in
/// whole pixels, and is left out.
TEST_P(Splat, AddsTheBeamsThatGatheringFinds) {
    const SplatCase& c = GetParam();
    const Scene scene = foggyScene(c);
    const CameraRecord record = recordOf(c, scene);
    const TimeGate gate = gateOf(c);
    Film splatted(record.width, record.height, gate.frames), gathered = splatted;
    uint64_t total = 0;
    int lit = 0, compared = 0, different = 0;
    Sampler sampler(6, RandomStream::Test, 0, 0);
    for (const PhotonBeam& beam : inMediumOf(c, beamsAround(scene.camera.position(), 400))) {
        splatted.beginPass();
        gathered.beginPass();
        Radii kernel = 0.1f;
        if (c.edges) kernel = {{0.1f}, {randomEdges(sampler, 0.1f, beam.direction)}};
        const uint64_t count = Beams::splat(scene, gate, {&record}, {{beam}, kernel}, 3.0, splatted);
        const std::vector<PhotonBeam> single{beam};
        const uint64_t expected = gatherRecord(BeamGather(scene, gate, single, kernel), gate, record, gathered);
        EXPECT_NEAR(double(count), double(expected), 2.0);
        total += expected;
        if (count != expected)
            ++different;
        else if (++compared > 0)
            lit += expectScaled(splatted, gathered, gate.frames, 3.0f, 1e-4f);
    }
    EXPECT_GT(total, record.x.size() / 2);
    EXPECT_GT(lit, 100);
    EXPECT_LT(different, compared / 20);
}

/// Threads, bands and registers: all at once as one by one.
TEST_P(Splat, AddsUpBeams) {
    const SplatCase& c = GetParam();
    const Scene scene = foggyScene(c);
    const CameraRecord record = recordOf(c, scene);
    const TimeGate gate = gateOf(c);
    Film together(record.width, record.height, gate.frames), singly = together;
    together.beginPass();
    singly.beginPass();
    const auto beams = inMediumOf(c, beamsAround(scene.camera.position(), 2000));
    uint64_t count = 0;
    for (const PhotonBeam& beam : beams) count += Beams::splat(scene, gate, {&record}, {{beam}, 0.1f}, 1.0, singly);
    EXPECT_EQ(Beams::splat(scene, gate, {&record}, {beams, 0.1f}, 1.0, together), count);
    expectScaled(together, singly, gate.frames, 1.0f, 1e-5f);
}

// Beyond the first segment a gather takes a photon's time from the segment's start, which is a detour: no gate there.
INSTANTIATE_TEST_SUITE_P(Views, Splat,
                         testing::Values(SplatCase{"Frames", {37, 21}, 60.0f, false, false, false, 1},
                                         SplatCase{"UnwarpedFrames", {37, 21}, 60.0f, false, true, true, 1},
                                         SplatCase{"Pieces", {37, 21}, 60.0f, true, false, false, 3},
                                         SplatCase{"PiecesAndRadii", {16, 40}, 100.0f, true, false, true, 2},
                                         SplatCase{"Wide", {40, 24}, 160.0f, true, false, false, 1},
                                         SplatCase{"FewerPixelsThanARegister", {5, 3}, 90.0f, true, false, false, 2},
                                         SplatCase{"Tele", {48, 32}, 8.0f, true, false, true, 2},
                                         SplatCase{"IsotropicFrames", {37, 21}, 60.0f, false, false, false, 1, 3},
                                         SplatCase{"IsotropicPieces", {37, 21}, 60.0f, true, false, true, 2, 3},
                                         SplatCase{"OnlyColoured", {37, 21}, 60.0f, true, false, false, 2, 1},
                                         SplatCase{"OnlyRayleigh", {37, 21}, 60.0f, false, false, true, 1, 2},
                                         SplatCase{"Edges", {37, 21}, 60.0f, true, false, true, 2, -1, true},
                                         SplatCase{"EdgesInFrames", {37, 21}, 60.0f, false, false, false, 1, 3, true}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Pixels whose fog begins at slightly different distances see one photon, to rounding: just within the cubic's range.
TEST(PointSplat, AttenuatesFromTheStartOfEveryRay) {
    const Scene scene = foggyScene({"", {16, 16}, 3.0f, true, false, false, 1});
    CameraRecord record = randomRecord(scene, 1);
    useOneMedium(record, 3, false);
    MediumSegment& fog = record.mediumSegments.front();
    for (size_t i = 0; i < fog.start.size(); ++i) {
        fog.start[i] = 0.0035f * float(i % 16);
        fog.end[i] = Infinity;
    }
    const Vec3f offset = scene.camera.toWorld.rotation().n * 1.5f;
    Store<Photon> store;
    store.records.push_back({0.0, record.origin + offset, Vec3f(1.0f, 0.0f, 0.0f), Rgb(1.0f), 2, 3});
    Film film(16, 16, 1);
    film.beginPass();
    EXPECT_EQ(Points::splat(scene, TimeGate{}, {&record}, {store.records, 0.15f}, 1.0, film), 256u);
    for (size_t i = 0; i < fog.start.size(); ++i) {
        const Vec3f direction(record.x[i], record.y[i], record.z[i]);
        const float t = offset.dot(direction);
        const double attenuation = std::exp((double(fog.start[i]) - double(t)) * 0.9) * 0.25 * double(InvPi);
        const double value = double(biweight((offset - direction * t).length2(), sqr(0.15f))) * attenuation;
        EXPECT_NEAR(double(film.passPixel(0, int(i % 16), int(i / 16)).z), value, 2e-6 * value) << i;
    }
}

} // namespace
} // namespace tungsten::photon
