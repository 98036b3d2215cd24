#include "photon/view/SensorRecord.h"

#include "photon/view/SensorPath.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

void resize(StraightPiece& piece, size_t pixels) {
    piece.start.resize(pixels);
    piece.end.resize(pixels);
    piece.medium.resize(pixels, -1);
    piece.interactions.resize(pixels);
    piece.throughput.resize(pixels, Rgb(0.0f));
}

struct Piece {
    uint32_t pixel;
    float start, end;
    int16_t medium;
    uint16_t interactions;
    Rgb throughput;
};

/// Visits the camera paths of one row.
struct Recorder {
    const Scene& scene;
    SensorWishes wishes;
    std::vector<std::vector<Piece>> pieces; ///< by number along the ray
    std::vector<SensorPoint> points;
    LegRow legs;
    uint32_t pixel = 0;
    size_t next = 0;
    float behind = 0.0f; ///< length of the straight ray so far

    void begin(uint32_t newPixel) {
        pixel = newPixel;
        next = 0;
        behind = 0.0f;
    }
    void end() { legs.ends.push_back(uint32_t(legs.legs.size())); }
    void segment(const SensorState& state, const std::optional<SurfaceHit>& hit) {
        if (wishes.legs) legs.legs.push_back({state, hit});
        if (state.folded) return;
        const float length = hit ? hit->t : Infinity;
        const Medium* medium = scene.medium(state.region);
        if (medium && medium->scatters()) {
            if (pieces.size() <= next) pieces.emplace_back();
            pieces[next++].push_back({pixel, behind, behind + length, int16_t(state.region.medium),
                                      uint16_t(state.interactions), state.throughput});
        }
        behind += length;
    }
    void surface(const SensorState& state, const SurfaceInteraction& surface) {
        if (!wishes.points || !receivesConnections(*surface.bsdf)) return;
        points.push_back({surface.hit, state.ray.direction, state.throughput * (1.0f / float(wishes.samples)),
                          state.time + double(surface.hit.t) / double(state.region.speed), pixel, state.interactions,
                          state.region});
    }
    void escaped(const SensorState&) {}
};

/// Frees what it appends.
void append(Recorder& row, size_t pixels, SensorRecord& record) {
    record.points.insert(record.points.end(), row.points.begin(), row.points.end());
    std::vector<SensorPoint>().swap(row.points);
    record.legs.push_back(std::move(row.legs));
    for (size_t k = 0; k < row.pieces.size(); ++k) {
        if (record.pieces.size() <= k) resize(record.pieces.emplace_back(), pixels);
        StraightPiece& piece = record.pieces[k];
        for (const Piece& p : row.pieces[k]) {
            piece.start[p.pixel] = p.start;
            piece.end[p.pixel] = p.end;
            piece.medium[p.pixel] = p.medium;
            piece.interactions[p.pixel] = p.interactions;
            piece.throughput[p.pixel] = p.throughput;
        }
    }
}

} // namespace

SensorRecord recordSensorPaths(const Scene& scene, const SensorPathRules& rules, uint64_t seed, uint32_t sample,
                               const SensorWishes& wishes, Statistics& statistics, const ProgressToken& watch) {
    SensorRecord record;
    record.sample = sample;
    record.samples = wishes.samples;
    record.width = scene.camera.resolution.x;
    record.height = scene.camera.resolution.y;
    record.origin = scene.camera.position();
    const size_t pixels = size_t(record.width) * size_t(record.height);
    for (auto* component : {&record.x, &record.y, &record.z}) component->resize(pixels);
    if (!scene.camera.hasSinglePosition()) record.origins.resize(pixels);
    std::vector<Recorder> rows(size_t(record.height), Recorder{scene, wishes, {}, {}, {}});
    watch.stage("camera paths", rows.size());
    tbb::parallel_for(size_t(0), rows.size(), [&](size_t y) {
        SensorSteps steps;
        for (int x = 0; x < record.width; ++x) {
            watch.advanceWithin(64, uint64_t(x));
            const size_t pixel = y * size_t(record.width) + size_t(x);
            Sampler sampler(seed, RandomStream::Camera, sample, pixel);
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = scene.camera.generateRay({x, int(y)}, uFilter, uLens);
            record.x[pixel] = ray.direction.x;
            record.y[pixel] = ray.direction.y;
            record.z[pixel] = ray.direction.z;
            if (!record.origins.empty()) record.origins[pixel] = ray.origin;
            rows[y].begin(uint32_t(pixel));
            steps += followSensorPath(scene, ray, rules, sampler, rows[y], watch);
            rows[y].end();
            const SurfaceLook recordPoint{
                [&](const SensorState& state, const SurfaceInteraction& surface) { rows[y].surface(state, surface); }};
            for (uint32_t s = 1; s < wishes.samples; ++s) {
                Sampler further = sampler.branch(RandomStream::SensorPoint, s);
                const Vec2f uAgain = further.next2D(), uLensAgain = further.next2D();
                const Ray again = scene.camera.generateRay({x, int(y)}, uAgain, uLensAgain);
                steps += followSensorPath(scene, again, rules, further, recordPoint, watch);
            }
        }
        report(steps, statistics);
        watch.advance();
    });
    size_t points = 0;
    for (const Recorder& row : rows) points += row.points.size();
    record.points.reserve(points);
    record.legs.reserve(rows.size());
    for (Recorder& row : rows) append(row, pixels, record);
    return record;
}

} // namespace tungsten::photon
