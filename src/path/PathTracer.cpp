#include "path/PathTracer.h"

#include "path/PathVisitor.h"
#include "path/Tuning.h"

#include "tungsten/render/EarliestArrival.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace tungsten::path {

namespace {

constexpr size_t TileSide = 8;
constexpr uint32_t SamplesPerPoll = 16;
constexpr double LightPathsPart = 0.1; ///< of a pass

void report(const PathCounters& counters, Statistics& statistics) {
    statistics.add("camera paths", counters.paths);
    statistics.add("rays", counters.rays);
    statistics.add("shadow rays", counters.shadowRays);
    statistics.add("control vertices", counters.controlVertices);
    statistics.add("points of lights chosen anew", counters.pointsChosen);
    statistics.add("light vertex connections", counters.lightVertices);
    statistics.add("reflected light connections", counters.reflectedLight);
    statistics.add("ways through walls", counters.refracted);
    statistics.add("connections", counters.connections);
    statistics.add("arrivals from lights at detectors", counters.intoDetectors);
    statistics.add("arrivals while the sensor is open", counters.arrivals);
    statistics.add("arrivals inside the gate", counters.timed);
    statistics.add("arrivals in later frames", counters.laterFrames);
    statistics.add("arrivals weighed by the response", counters.weighed);
    transport::reportSteps(counters, statistics);
    statistics.add("non-finite samples", counters.nonFinite);
}

/// Base-2 radical inverse: any 2^k consecutive numbers spread evenly.
float radicalInverse(uint32_t index) {
    uint32_t bits = index;
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00FF00FFu) << 8) | ((bits & 0xFF00FF00u) >> 8);
    bits = ((bits & 0x0F0F0F0Fu) << 4) | ((bits & 0xF0F0F0F0u) >> 4);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xCCCCCCCCu) >> 2);
    bits = ((bits & 0x55555555u) << 1) | ((bits & 0xAAAAAAAAu) >> 1);
    return float(bits >> 8) * 0x1p-24f;
}

PathGuides makeGuides(const Scene& scene, const darts::Scheme& scheme, const EffectPlan& plan, const PassWatch& watch) {
    PathGuides guides;
    watch.stage("guides of media", scene.media.size());
    for (size_t i = 0; i < scene.media.size(); ++i) {
        watch.poll();
        const Medium& medium = scene.media[i];
        darts::Settings settings =
            scheme.settings(darts::Mode::Path, medium.phase.g(), medium.guided, medium.guidedPhase);
        // Directions are guided for the sake of control vertices.
        if (!medium.scatters() || plan.isOutOfTime(i) || (!settings.elliptical && !scheme.direction))
            settings.direction = darts::Direction::Phase;
        const darts::Medium coefficients{darts::vec3(medium.sigmaA()), darts::vec3(medium.sigmaS()), medium.phase.g()};
        guides.media.emplace_back(settings, coefficients);
        guides.plain.emplace_back(darts::timeBoundAlone(settings), coefficients);
        darts::Settings view = settings, surface = settings, glossy = settings;
        if (!scheme.published) {
            view.surfaceOdds = tuning::ViewSurfaceOdds;
            surface.alpha = std::max(surface.alpha, tuning::SurfaceAlpha);
            glossy.alpha = std::max(glossy.alpha, tuning::GlossyAlpha);
        }
        guides.view.emplace_back(view, coefficients);
        guides.surfaces.emplace_back(surface, coefficients);
        guides.glossy.emplace_back(glossy, coefficients);
    }
    return guides;
}

} // namespace

PathTracer::PathTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings)
    : scene_(std::move(scene)), settings_(readPathSettings(settings, *scene_)),
      sensor_(transport::Sensor::of(*scene_, scene_->transport.gate)) {
    if (!scene_->transport.gate.delta) return;
    const std::string problem = deltaGateProblem(*scene_, settings_, analyseScene(*scene_));
    if (!problem.empty()) settings.problem("delta_time_gate", problem);
}

void PathTracer::plan(EffectPlan& plan) const {
    leaveOutLate(*scene_, lastTime(*scene_), plan);
    PathPlan::of(*scene_, settings_, plan).describe(*scene_, settings_, plan);
}

void PathTracer::prepare(const EffectPlan& plan, const PassWatch& watch, Statistics& statistics) {
    plan_ = PathPlan::of(*scene_, settings_, plan);
    bound_.emplace(*scene_, plan);
    lights_.emplace(*scene_, plan.late);
    using Emitters = TargetChoice::Emitters;
    targets_.emplace(*scene_, plan_.guidance.on ? Emitters::All : Emitters::SingleDirections, plan.late);
    if (plan_.detectorLight.on) detectorLight_.emplace(*scene_, plan, settings_.limits);
    if (plan_.refracted.on) {
        const StageTimer timer(statistics, "light through walls");
        refracted_.emplace().prepare(*scene_, plan.late, watch);
    }
    if (!plan_.guidance.on) return;
    const StageTimer timer(statistics, "guide preparation");
    guides_ = makeGuides(*scene_, settings_.policy.sampling, plan, watch);
    if (plan_.edaTable.on) statistics.add("direction tables", uint64_t(guides_.tables()));
    waysOut_ = transport::WaysOut::make(*scene_, settings_.policy);
    if (plan_.lightVertices.on) lightPaths_.prepare(*scene_, *targets_, watch, statistics);
}

void PathTracer::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    if (plan_.lightVertices.on) {
        const StageTimer timer(statistics, "light paths");
        lightPaths_.trace(*scene_, *targets_, pass.part(0.0, LightPathsPart), statistics);
    }
    if (refracted_) refracted_->trace(pass.part(0.0, 0.0));
    const StageTimer timer(statistics, "camera pass");
    const PassInfo rest = pass.part(plan_.lightVertices.on ? LightPathsPart : 0.0, 1.0);
    if (plan_.guidance.on)
        renderGuided(rest, film, statistics);
    else if (plan_.timeResolved)
        plan_.media ? renderPlainly<true, true>(rest, film, statistics)
                    : renderPlainly<true, false>(rest, film, statistics);
    else
        plan_.media ? renderPlainly<false, true>(rest, film, statistics)
                    : renderPlainly<false, false>(rest, film, statistics);
}

void PathTracer::addDetectorLight(int column, float u, PixelSink& sink, const PassWatch& watch, PathCounters& counters,
                                  Sampler sampler) const {
    const auto put = [&](const Rgb& radiance, double time, const Emitter& emitter) {
        ++counters.intoDetectors;
        sink.add(radiance, time, emitter);
    };
    detectorLight_->sample(size_t(column), sampler, watch, counters.shadowRays, put);
    if (!plan_.lasers) return;
    Sampler light = sampler.branch(RandomStream::Target, 0);
    const auto source = targets_->sample(u, light, watch, counters);
    if (!source || source->index >= 0) return;
    if (settings_.limits.orderCounts(source->mediumScatters))
        detectorLight_->connect(size_t(column), *source, *source->emitter, source->start, source->interactions, light,
                                counters.shadowRays, put);
}

template <typename Trace>
void PathTracer::renderTiles(const PassInfo& pass, Film& film, Statistics& statistics, const Trace& trace) const {
    const Camera& camera = scene_->camera;
    const auto width = size_t(camera.resolution.x), height = size_t(camera.resolution.y);
    const auto renderPixel = [&](int x, int y, PathCounters& counters) {
        PixelSink sink(film, sensor_, x, y, pass.samples, counters);
        const uint64_t pixel = size_t(y) * width + size_t(x);
        // Consecutive samples of a pixel take the targets in turn.
        const float rotation =
            targets_->several() ? Sampler(pass.seed, RandomStream::Emitter, 0, pixel).next1D() : 0.0f;
        for (uint32_t s = 0; s < pass.samples; ++s) {
            // Keyed by the absolute sample: but for light vertices, each pass's own, the image does not depend on how
            // samples are cut into passes.
            const auto sample = uint32_t(pass.firstSample + s);
            Sampler sampler(pass.seed, RandomStream::Camera, sample, pixel);
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = camera.generateRay({x, y}, uFilter, uLens);
            float u = targets_->several() ? radicalInverse(sample) + rotation : 0.0f;
            u -= u >= 1.0f ? 1.0f : 0.0f;
            pass.watch.pollWithin(SamplesPerPoll, s + 1);
            trace(ray, sink, counters, sampler, u);
            if (detectorLight_)
                addDetectorLight(x, u, sink, pass.watch, counters,
                                 {pass.seed, RandomStream::DetectorLight, sample, pixel});
        }
    };
    pass.watch.stage("camera paths", width * height);
    tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
        PathCounters counters;
        for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y) {
            for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x) renderPixel(int(x), int(y), counters);
            pass.watch.poll(tile.cols().size());
        }
        report(counters, statistics);
    });
}

template <bool TimeResolved, bool Media>
void PathTracer::renderPlainly(const PassInfo& pass, Film& film, Statistics& statistics) const {
    const PathContext context{
        *scene_,   settings_, *lights_, *bound_, refracted_ ? &*refracted_ : nullptr, plan_.forwardBoundaries,
        pass.watch};
    const bool lasers = targets_->any();
    renderTiles(pass, film, statistics,
                [&](const Ray& ray, PixelSink& sink, PathCounters& counters, Sampler& sampler, float u) {
                    std::optional<PathTarget> source;
                    if (lasers) {
                        Sampler light = sampler.branch(RandomStream::Target, 0);
                        source = targets_->sample(u, light, pass.watch, counters);
                    }
                    tracePath<TimeResolved, Media>(context, sink, counters, sampler, source ? &*source : nullptr, ray);
                });
}

void PathTracer::renderGuided(const PassInfo& pass, Film& film, Statistics& statistics) const {
    const TargetChoice* targets = plan_.entryPoints.on ? &*targets_ : nullptr;
    const GuidedContext context{
        *scene_,   settings_, sensor_, guides_, targets, lightPaths_, *bound_, waysOut_.get(), plan_.forwardBoundaries,
        pass.watch};
    renderTiles(pass, film, statistics,
                [&](const Ray& ray, PixelSink& sink, PathCounters& counters, Sampler& sampler, float u) {
                    Sampler light = sampler.branch(RandomStream::Target, 0);
                    const std::optional<PathTarget> target = targets_->sample(u, light, pass.watch, counters);
                    if (target) traceGuidedPath(context, sink, counters, sampler, *target, ray);
                });
}

} // namespace tungsten::path
