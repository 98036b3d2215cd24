#include "path/PathTracer.h"

#include "path/PathWalk.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

namespace tungsten::path {

namespace {

constexpr size_t TileSide = 8;

void report(const PathCounters& counters, Statistics& statistics) {
    statistics.add("camera paths", counters.paths);
    statistics.add("rays", counters.rays);
    statistics.add("shadow rays", counters.shadowRays);
    statistics.add("medium events", counters.mediumEvents);
    statistics.add("surface events", counters.surfaceEvents);
    statistics.add("non-finite samples", counters.nonFinite);
}

} // namespace

PathTracer::PathTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings)
    : scene_(std::move(scene)), settings_(readPathSettings(settings, *scene_)), lights_(*scene_), arrival_(*scene_) {}

void PathTracer::plan(EffectPlan& plan) const {
    plan.describe("Russian roulette", settings_.russianRoulette,
                  settings_.russianRoulette ? "enable_rr, or its default in steady state"
                                            : "off by default in time-resolved renders");
}

void PathTracer::prepare(const EffectPlan& plan, Statistics&) {
    timeResolved_ = plan.timeResolved;
    forwardBoundaries_ = plan.forwardBoundaries;
    // Absorption alone needs free flights too: they carry the transmittance.
    media_ = !scene_->media.empty();
}

void PathTracer::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    const StageTimer timer(statistics, "camera pass");
    if (timeResolved_)
        media_ ? renderTiles<true, true>(pass, film, statistics) : renderTiles<true, false>(pass, film, statistics);
    else
        media_ ? renderTiles<false, true>(pass, film, statistics) : renderTiles<false, false>(pass, film, statistics);
}

template <bool TimeResolved, bool Media>
void PathTracer::renderTiles(const PassInfo& pass, Film& film, Statistics& statistics) const {
    const WalkContext context{*scene_, settings_, lights_, arrival_, forwardBoundaries_};
    const Camera& camera = scene_->camera;
    const auto width = size_t(camera.resolution.x), height = size_t(camera.resolution.y);
    const auto renderPixel = [&](int x, int y, PathCounters& counters) {
        PixelSink sink(film, scene_->transport.gate, x, y, pass.samples, counters);
        for (uint32_t s = 0; s < pass.samples; ++s) {
            // Keyed by the absolute sample: the image does not depend on how samples are cut into passes.
            Sampler sampler(pass.seed, RandomStream::Camera, uint32_t(pass.firstSample + s),
                            size_t(y) * width + size_t(x));
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = camera.generateRay({x, y}, uFilter, uLens);
            PathWalk<TimeResolved, Media>(context, sink, counters, sampler).run(ray);
        }
    };
    tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
        PathCounters counters;
        for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y)
            for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x) renderPixel(int(x), int(y), counters);
        report(counters, statistics);
    });
}

} // namespace tungsten::path
