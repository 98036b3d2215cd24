#include "photon/view/CameraRecord.h"

#include "photon/view/CameraSubpath.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

void resize(MediumSegment& segment, size_t pixels) {
    segment.start.resize(pixels);
    segment.end.resize(pixels);
    segment.medium.resize(pixels, -1);
    segment.interactions.resize(pixels);
    segment.throughput.resize(pixels, Rgb(0.0f));
}

struct PixelSegment {
    uint32_t pixel;
    float start, end;
    int16_t medium;
    uint16_t interactions;
    Rgb throughput;
};

/// Visits the camera paths of one row.
struct Recorder {
    const Scene& scene;
    CameraRecordParts parts;
    std::vector<std::vector<PixelSegment>> mediumSegments; ///< by number along the ray
    std::vector<VisiblePoint> points;
    SegmentRow segments;
    uint32_t pixel = 0;
    size_t next = 0;
    float behind = 0.0f; ///< length of the straight ray so far

    void begin(uint32_t newPixel) {
        pixel = newPixel;
        next = 0;
        behind = 0.0f;
    }
    void end() { segments.ends.push_back(uint32_t(segments.segments.size())); }
    void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
        if (parts.segments) segments.segments.push_back({state, hit});
        if (state.redirected) return;
        const float length = hit ? hit->t : Infinity;
        const Medium* medium = scene.medium(state.region);
        if (medium && medium->scatters()) {
            if (mediumSegments.size() <= next) mediumSegments.emplace_back();
            mediumSegments[next++].push_back({pixel, behind, behind + length, int16_t(state.region.medium),
                                              uint16_t(state.interactions), state.throughput});
        }
        behind += length;
    }
    void surface(const CameraSubpath& state, const SurfaceInteraction& surface) {
        if (!parts.points || !receivesConnections(*surface.bsdf)) return;
        points.push_back({surface.hit, state.ray.direction, state.throughput * (1.0f / float(parts.samples)),
                          state.time + double(surface.hit.t) / double(state.region.speed), pixel, state.interactions,
                          state.region});
    }
    void escaped(const CameraSubpath&) {}
};

/// Frees what it appends.
void append(Recorder& row, size_t pixels, CameraRecord& record) {
    record.points.insert(record.points.end(), row.points.begin(), row.points.end());
    std::vector<VisiblePoint>().swap(row.points);
    record.segments.push_back(std::move(row.segments));
    for (size_t k = 0; k < row.mediumSegments.size(); ++k) {
        if (record.mediumSegments.size() <= k) resize(record.mediumSegments.emplace_back(), pixels);
        MediumSegment& segment = record.mediumSegments[k];
        for (const PixelSegment& p : row.mediumSegments[k]) {
            segment.start[p.pixel] = p.start;
            segment.end[p.pixel] = p.end;
            segment.medium[p.pixel] = p.medium;
            segment.interactions[p.pixel] = p.interactions;
            segment.throughput[p.pixel] = p.throughput;
        }
    }
}

} // namespace

CameraRecord recordCameraSubpaths(const Scene& scene, const CameraSubpathRules& rules, uint64_t seed, uint32_t sample,
                                  const CameraRecordParts& parts, Statistics& statistics, const ProgressToken& watch) {
    CameraRecord record;
    record.sample = sample;
    record.samples = parts.samples;
    record.width = scene.camera.resolution.x;
    record.height = scene.camera.resolution.y;
    record.origin = scene.camera.position();
    const size_t pixels = size_t(record.width) * size_t(record.height);
    for (auto* component : {&record.x, &record.y, &record.z}) component->resize(pixels);
    if (!scene.camera.hasSinglePosition()) record.origins.resize(pixels);
    std::vector<Recorder> rows(size_t(record.height), Recorder{scene, parts, {}, {}, {}});
    watch.stage("camera paths", rows.size());
    tbb::parallel_for(size_t(0), rows.size(), [&](size_t y) {
        CameraSubpathCounters steps;
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
            steps += followCameraSubpath(scene, ray, rules, sampler, rows[y], watch);
            rows[y].end();
            const SurfaceVisitor recordPoint{[&](const CameraSubpath& state, const SurfaceInteraction& surface) {
                rows[y].surface(state, surface);
            }};
            for (uint32_t s = 1; s < parts.samples; ++s) {
                Sampler further = sampler.branch(RandomStream::VisiblePoint, s);
                const Vec2f uAgain = further.next2D(), uLensAgain = further.next2D();
                const Ray again = scene.camera.generateRay({x, int(y)}, uAgain, uLensAgain);
                steps += followCameraSubpath(scene, again, rules, further, recordPoint, watch);
            }
        }
        report(steps, statistics);
        watch.advance();
    });
    size_t points = 0;
    for (const Recorder& row : rows) points += row.points.size();
    record.points.reserve(points);
    record.segments.reserve(rows.size());
    for (Recorder& row : rows) append(row, pixels, record);
    return record;
}

} // namespace tungsten::photon
