#include "path/PathTracer.h"

#include "path/PathVisitor.h"
#include "path/Tuning.h"

#include "transport/SharePilot.h"
#include "transport/Tuning.h"

#include "tungsten/integrator/EarliestArrival.h"
#include "tungsten/integrator/Names.h"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace tungsten::path {

namespace {

constexpr size_t TileSide = 8;
constexpr double PilotFrame = 10.0;            ///< nanoseconds for each frame of a path in that pilot
constexpr uint32_t MostSamplePairs = 1u << 16; ///< in a pilot of samples
/// Of the cost of a pilot of shares: those of windows, and of samples where it compares; that by which samples are
/// shared out. Variance x CPU with the latter at 0.35: two rooms 1.24, a gate of 0.02 1.51, dense cube 300 1.34, lamp
/// in fog 0.98.
constexpr double PilotPart = 0.35, AllocationPart = 1.0;
constexpr uint32_t SamplesPerPoll = 16;
constexpr double LightPathsPart = 0.1; ///< of a pass
/// Multiples of it, modulo 1, fill the unit interval evenly from any place on.
constexpr double GoldenRatio = 0.6180339887498949;

void report(const PathCounters& counters, Statistics& statistics) {
    statistics.add("camera paths", counters.paths);
    statistics.add("rays", counters.rays);
    statistics.add(counter::ShadowRays, counters.shadowRays);
    statistics.add(counter::ControlVertices, counters.controlVertices);
    statistics.add("plain paths beside guided ones", counters.plainPaths);
    statistics.add("points of emitters compared", counters.points);
    statistics.add("vertices with densities of guided paths", counters.densities);
    statistics.add(counter::LightVertexConnections, counters.lightVertices);
    statistics.add(counter::GlossyLightVertexConnections, counters.reflectedLight);
    statistics.add(counter::RefractiveConnections, counters.refracted);
    statistics.add("connections", counters.connections);
    statistics.add(counter::ArrivalsAtDetectors, counters.intoDetectors);
    statistics.add(counter::LightsInView, counters.inView);
    statistics.add("arrivals while the sensor is open", counters.arrivals);
    statistics.add(counter::ArrivalsInGate, counters.timed);
    statistics.add(counter::ArrivalsInLaterFrames, counters.laterFrames);
    statistics.add(counter::ArrivalsByResponse, counters.weighed);
    transport::reportSteps(counters, statistics);
    statistics.add(counter::NonFiniteSamples, counters.nonFinite);
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

/// Of the image, at a place in the unit square.
Vec2i pixelAt(const Camera& camera, const Vec2f& place) {
    const Vec2i size = camera.resolution;
    return {std::min(int(place.x * float(size.x)), size.x - 1), std::min(int(place.y * float(size.y)), size.y - 1)};
}

} // namespace

PathTracer::PathTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings)
    : scene_(std::move(scene)), settings_(readPathSettings(settings, *scene_)),
      sensor_(transport::TimeSensor::of(*scene_, scene_->transport.gate)) {
    if (!scene_->transport.gate.delta) return;
    const std::string problem = deltaGateProblem(*scene_, settings_, analyseScene(*scene_));
    if (!problem.empty()) settings.problem("delta_time_gate", problem);
}

void PathTracer::plan(SceneFacts& facts, Features& features) const {
    excludeLate(*scene_, lastTime(*scene_), facts, features);
    PathPlan::of(*scene_, settings_, facts).describe(*scene_, settings_, facts, features);
}

void PathTracer::prepare(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) {
    plan_ = PathPlan::of(*scene_, settings_, facts);
    looksThrough_ = plan_.indexMatched; // what pilots count does not depend on what else is looked for
    bound_.emplace(*scene_, facts);
    lights_.emplace(*scene_, facts.excludedEmitters);
    using Emitters = TargetChoice::Emitters;
    const bool beside = plan_.balance.on && settings_.policy.plainShare != 0.0f;
    if (plan_.guidance.on) targets_.emplace(*scene_, Emitters::All, facts.excludedEmitters, beside);
    sources_.emplace(*scene_, Emitters::SingleDirections, facts.excludedEmitters);
    if (plan_.detectorLight.on) detectorLight_.emplace(*scene_, facts, settings_.limits);
    if (plan_.refracted.on) {
        const StageTimer timer(statistics, "refractive connections");
        refracted_.emplace().prepare(*scene_, facts.excludedEmitters, watch);
    }
    if (plan_.guidance.on) prepareGuides(facts, watch, statistics);
    if (plan_.allocation.on || plan_.weightWindows.on || plan_.lightsInView.on) allocateSamples(watch, statistics);
    looksThrough_ = plan_.forwardBoundaries;
    if (plan_.balance.on)
        statistics.add("plain camera paths, in thousandths", uint64_t(std::lround(1000.0 * double(balance_.plain))));
}

void PathTracer::prepareGuides(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) {
    const StageTimer timer(statistics, "guide preparation");
    guides_ = PathGuides::of(*scene_, settings_.policy, facts, watch);
    if (plan_.edaTable.on) statistics.add(counter::DirectionTables, uint64_t(guides_.tables()));
    escapeModels_ = transport::EscapeModels::make(*scene_, settings_.policy);
    windows_ = plan_.balance.on ? transport::TimeWindows::ofSequence(*scene_, facts, sensor_.arrivals)
                                : transport::TimeWindows(sensor_.arrivals);
    if (plan_.lightVertices.on) lightCaches_.prepare(*scene_, *targets_, watch, statistics);
    if (plan_.balance.on) chooseShare(watch, statistics);
}

void PathTracer::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    const bool lightVertices = guides() && plan_.lightVertices.on;
    if (lightVertices) {
        const StageTimer timer(statistics, "light paths");
        const Vec2i resolution = scene_->camera.resolution;
        const double paths = double(resolution.x) * double(resolution.y) * double(pass.samples);
        lightCaches_.trace(*scene_, *targets_, size_t(std::ceil(paths * double(balance_.guided))),
                           pass.part(0.0, LightPathsPart), statistics);
    }
    if (refracted_) refracted_->trace(pass.part(0.0, 0.0));
    const StageTimer timer(statistics, "camera pass");
    const PassInfo rest = pass.part(lightVertices ? LightPathsPart : 0.0, 1.0);
    withPaths(rest.watch, [&](const auto& trace) { renderTiles(rest, film, statistics, trace); });
}

template <typename Use>
void PathTracer::withPaths(const ProgressToken& watch, const Use& use) const {
    if (guides())
        withGuidedPaths(watch, use);
    else
        withPlainPaths(plainContext(watch), use);
}

void PathTracer::addDetectorLight(int column, float u, PixelAccumulator& sink, const ProgressToken& watch,
                                  PathCounters& counters, Sampler sampler) const {
    sink.begin(Strategy::Alone, {});
    const auto put = [&](const Rgb& radiance, double time, const Emitter& emitter) {
        ++counters.intoDetectors;
        sink.add(radiance, time, emitter, 0.0f);
    };
    detectorLight_->sample(size_t(column), sampler, watch, counters.shadowRays, put);
    if (!plan_.lasers) return;
    Sampler light = sampler.branch(RandomStream::Target, 0);
    const auto source = targets().sample(u, light, watch, counters);
    if (!source || source->index >= 0) return;
    if (settings_.limits.orderCounts(source->mediumScatters))
        detectorLight_->connect(size_t(column), *source, *source->emitter, source->start, source->interactions, light,
                                counters.shadowRays, put);
}

template <typename Trace>
void PathTracer::renderTiles(const PassInfo& pass, Film& film, Statistics& statistics, const Trace& trace) const {
    const Camera& camera = scene_->camera;
    const auto width = size_t(camera.resolution.x), height = size_t(camera.resolution.y);
    const auto renderPixel = [&](int x, int y, StrategyCounters& counters) {
        const SampleAllocation::Samples samples = allocation_.of(x, y, pass.firstSample, pass.samples);
        PixelAccumulator sink(film, sensor_, x, y, samples.count, counters.plain);
        const uint64_t pixel = size_t(y) * width + size_t(x);
        // Consecutive samples of a pixel take the targets in turn, and strategies, as far as their shares allow.
        Sampler turns(pass.seed, RandomStream::Emitter, 0, pixel);
        const float rotation = targets().several() ? turns.next1D() : 0.0f;
        const double turn = balance_.both() || (windows_ && windows_->several()) ? turns.nextDouble() : 0.0;
        for (uint32_t s = 0; s < samples.count; ++s) {
            // Keyed by the absolute sample: but for light vertices, each pass's own, samples do not depend on how they
            // are cut into passes.
            const uint32_t sample = samples.first + s;
            Sampler sampler(pass.seed, RandomStream::Camera, sample, pixel);
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = camera.generateRay({x, y}, uFilter, uLens);
            float u = targets().several() ? radicalInverse(sample) + rotation : 0.0f;
            u -= u >= 1.0f ? 1.0f : 0.0f;
            pass.watch.advanceWithin(SamplesPerPoll, s + 1);
            const double place = turn + GoldenRatio * double(sample);
            trace(ray, sink, counters, sampler, u, float(place - std::floor(place)));
            if (detectorLight_)
                addDetectorLight(x, u, sink, pass.watch, counters.plain,
                                 {pass.seed, RandomStream::DetectorLight, sample, pixel});
        }
    };
    pass.watch.stage("camera paths", width * height);
    tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
        StrategyCounters counters;
        for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y) {
            for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x) renderPixel(int(x), int(y), counters);
            pass.watch.advance(tile.cols().size());
        }
        for (const PathCounters& of : {counters.plain, counters.densities, counters.guided}) report(of, statistics);
        if (weightWindows_.any()) statistics.add("camera paths with weight windows", counters.plain.paths);
        statistics.add("counted nanoseconds of camera paths", uint64_t(costs(counters).sum()));
    });
}

template <typename Use>
void PathTracer::withPlainPaths(const PathContext& context, const Use& use) const {
    const auto with = [&](auto trace) {
        use([&, trace](const Ray& ray, PixelAccumulator& sink, StrategyCounters& counters, Sampler& sampler, float u,
                       float) { (this->*trace)(context, ray, sink, counters.plain, sampler, u); });
    };
    if (plan_.timeResolved)
        with(plan_.media ? &PathTracer::tracePlain<true, true> : &PathTracer::tracePlain<true, false>);
    else
        with(plan_.media ? &PathTracer::tracePlain<false, true> : &PathTracer::tracePlain<false, false>);
}

template <bool TimeResolved, bool Media>
void PathTracer::tracePlain(const PathContext& context, const Ray& ray, PixelAccumulator& sink, PathCounters& counters,
                            Sampler& sampler, float u) const {
    std::optional<PathTarget> source;
    if (plan_.lasers && sources_->any()) {
        Sampler light = sampler.branch(RandomStream::Target, 0);
        source = sources_->sample(u, light, context.watch, counters);
    }
    tracePath<TimeResolved, Media>(context, sink, counters, sampler, source ? &*source : nullptr, ray);
}

GuidedContext PathTracer::guidedContext(const ProgressToken& watch) const {
    const TargetChoice* pointTargets = settings_.policy.sampling.published ? nullptr : &*targets_;
    return {*scene_, settings_,           sensor_,       *windows_, guides_,  lightCaches_,
            *bound_, escapeModels_.get(), looksThrough_, watch,     balance_, pointTargets};
}

PathContext PathTracer::plainContext(const ProgressToken& watch) const {
    return {*scene_,
            settings_,
            *lights_,
            *bound_,
            refracted_ ? &*refracted_ : nullptr,
            looksThrough_,
            watch,
            weightWindows_.any() ? &weightWindows_ : nullptr,
            nullptr,
            lightsInView_};
}

void PathTracer::traceGuided(const GuidedContext& guided, float uWindow, float uTarget, const Ray& ray,
                             PixelAccumulator& sink, PathCounters& counters, Sampler& sampler) const {
    const size_t window = windows_->choose(uWindow);
    sink.begin(balance_.both() ? Strategy::Guided : Strategy::Alone, balance_, (*windows_)[window]);
    Sampler light = sampler.branch(RandomStream::Target, 0);
    if (const auto target = targets_->sample(uTarget, light, guided.watch, counters))
        traceGuidedPath(guided, sink, counters, sampler, *target, ray, window);
}

template <typename Use>
void PathTracer::withGuidedPaths(const ProgressToken& watch, const Use& use) const {
    const GuidedContext guided = guidedContext(watch);
    const PathContext plain = plainContext(watch);
    tbb::enumerable_thread_specific<PlainTrail> trails;
    const auto trace = [&](const Ray& ray, PixelAccumulator& sink, StrategyCounters& counters, Sampler& sampler,
                           float u, float strategy) {
        if (!targets_->any()) return;
        if (!(strategy < balance_.plain))
            return traceGuided(guided, (strategy - balance_.plain) / balance_.guided, u, ray, sink, counters.guided,
                               sampler);
        ++counters.plain.plainPaths;
        sink.begin(Strategy::Plain, balance_);
        PlainTrail& trail = trails.local();
        trail.start(guided, *targets_, sink, counters.densities, sampler);
        tracePlainBesideGuided(plain, {&trail}, sink, counters.plain, sampler, ray);
    };
    use(trace);
}

WeightWindows PathTracer::learnWindows(const ProgressToken& watch, Statistics& statistics) const {
    const StageTimer timer(statistics, "pilot of weight windows");
    // Not those of the pilot of samples, which judges the windows.
    constexpr uint64_t Key = transport::PilotKey + 1;
    WeightWindows windows;
    PathContext context = plainContext(watch);
    StrategyCounters counters;
    Sampler places(Key, RandomStream::Pilot, 2, 0);
    uint32_t traced = 0;
    const auto tracePair = [&](const auto& trace) {
        const Vec2i pixel = pixelAt(scene_->camera, places.next2D());
        std::array<WeightWindows::Record, 2> pair;
        for (WeightWindows::Record& record : pair) {
            Sampler sampler(Key, RandomStream::Camera, traced++, 0);
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = scene_->camera.generateRay(pixel, uFilter, uLens);
            PixelAccumulator sink(record.pilot, sensor_, counters.plain);
            context.record = &record;
            trace(ray, sink, counters, sampler, places.next1D(), 0.0f);
        }
        windows.learn(pair);
    };
    watch.stage("pilot of weight windows", transport::tuning::MostPilotPaths);
    withPlainPaths(context, [&](const auto& trace) {
        while (traced < transport::tuning::MostPilotPaths &&
               costs(counters).sum() < PilotPart * double(transport::tuning::MostPilotCost)) {
            tracePair(trace);
            watch.advance(2);
        }
    });
    windows.finish();
    statistics.add(counter::WindowPilotPaths, traced);
    return windows;
}

void PathTracer::allocateSamples(const ProgressToken& watch, Statistics& statistics) {
    const PassInfo pass{.seed = transport::PilotKey, .watch = watch};
    if (plan_.lightVertices.on && guides()) {
        Statistics ignored;
        lightCaches_.trace(*scene_, *targets_, tuning::FewestPaths, pass, ignored);
    }
    if (refracted_) refracted_->trace(pass);
    if (plan_.weightWindows.on || plan_.lightsInView.on) improvePlainPaths(watch, statistics);
    if (plan_.allocation.on) allocation_ = measureSamples(watch, statistics, AllocationPart);
}

void PathTracer::improvePlainPaths(const ProgressToken& watch, Statistics& statistics) {
    const StrategyBalance chosen = std::exchange(balance_, {1.0f, 0.0f});
    lightsInView_ = plan_.lightsInView.on && seesLights(watch);
    WeightWindows windows = plan_.weightWindows.on ? learnWindows(watch, statistics) : WeightWindows();
    const bool inView = std::exchange(lightsInView_, false);
    const auto worth = [&](const SampleAllocation& allocation) {
        return plan_.allocation.on ? allocation.varianceTimesCost() : allocation.varianceTimesCostOfEven();
    };
    // Few bright paths have most of a variance: better is what is so by some standard errors.
    const auto beats = [&](const SampleAllocation& one, const SampleAllocation& other, double gainOfOther,
                           double errors) {
        const double ratio = worth(one) * gainOfOther / worth(other);
        return ratio * (1.0 + errors * std::hypot(one.relativeError(), other.relativeError())) < 1.0;
    };
    if (inView || windows.any()) {
        const SampleAllocation plain = measureSamples(watch, statistics, PilotPart);
        SampleAllocation best = plain;
        if (inView) {
            // The same paths without the randomness of their first flights: no doubt is needed.
            lightsInView_ = true;
            SampleAllocation viewed = measureSamples(watch, statistics, PilotPart);
            lightsInView_ = worth(viewed) < worth(plain);
            if (lightsInView_) best = std::move(viewed);
        }
        if (windows.any()) {
            weightWindows_ = std::move(windows);
            SampleAllocation windowed = measureSamples(watch, statistics, PilotPart);
            if (beats(windowed, best, 1.0, 1.0))
                best = std::move(windowed);
            else
                weightWindows_ = {};
        }
        const bool mixed = plan_.guidance.on && chosen.guided > 0.0f;
        if (!mixed || beats(best, plain, gainOfBalance_, 2.0)) return;
    }
    weightWindows_ = {};
    lightsInView_ = false;
    balance_ = chosen;
}

bool PathTracer::seesLights(const ProgressToken& watch) const {
    const PathContext context = plainContext(watch);
    Film probe(1, 1, sensor_.gate.frames, {.moments = false});
    PathCounters counters;
    for (uint32_t i = 0; i < transport::tuning::MostPilotPaths && counters.inView == 0; ++i) {
        Sampler sampler(transport::PilotKey, RandomStream::Pilot, 3, i);
        const Vec2f place = sampler.next2D(), uFilter = sampler.next2D(), uLens = sampler.next2D();
        const Vec2i pixel = pixelAt(scene_->camera, place);
        PixelAccumulator sink(probe, sensor_, 0, 0, 1, counters);
        const PathVisitor<true> visitor(context, sink, counters, nullptr);
        visitor.addLightsInView(PathState{.random = sampler,
                                          .ray = scene_->camera.generateRay(pixel, uFilter, uLens),
                                          .region = scene_->cameraRegion,
                                          .timed = !scene_->transport.cameraUnwarped});
    }
    return counters.inView > 0;
}

SampleAllocation PathTracer::measureSamples(const ProgressToken& watch, Statistics& statistics, double part) const {
    const StageTimer timer(statistics, "pilot of samples");
    constexpr uint64_t Key = transport::PilotKey;
    SampleAllocation allocation(scene_->camera.resolution);
    const int frames = sensor_.gate.frames;
    Film probe(1, 1, frames, {.moments = false});
    std::vector<Rgb> before(static_cast<size_t>(frames));
    Sampler places(Key, RandomStream::Pilot, 1, 0);
    double cost = 0.0;
    uint32_t traced = 0;
    const auto tracePair = [&](const auto& trace, size_t block) {
        const float u = places.next1D(), v = places.next1D();
        const Vec2i pixel = allocation.pixelOf(block, u, v);
        double variance = 0.0;
        StrategyCounters counters;
        for (int k = 0; k < 2; ++k, ++traced) {
            Sampler sampler(Key, RandomStream::Camera, traced, block);
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = scene_->camera.generateRay(pixel, uFilter, uLens);
            probe.beginPass();
            const float uTarget = places.next1D(), uStrategy = places.next1D();
            {
                PixelAccumulator sink(probe, sensor_, 0, 0, 1, counters.plain);
                trace(ray, sink, counters, sampler, uTarget, uStrategy);
            }
            for (int frame = 0; frame < frames; ++frame) {
                const Rgb value = probe.passPixel(frame, 0, 0);
                const Rgb difference = value - before[size_t(frame)];
                if (k == 1) variance += 0.5 * double(difference.dot(difference));
                before[size_t(frame)] = value;
            }
        }
        const double own = costs(counters).sum() + tuning::Nanoseconds.sample;
        allocation.tell(block, variance, own);
        cost += own + 2.0 * PilotFrame * double(frames);
    };
    const auto mostRounds = uint32_t(MostSamplePairs / allocation.blocks());
    watch.stage("pilot of samples", mostRounds);
    withPaths(watch, [&](const auto& trace) {
        for (uint32_t round = 0; round < mostRounds && cost < part * double(transport::tuning::MostPilotCost);
             ++round) {
            for (size_t block = 0; block < allocation.blocks(); ++block) {
                watch.advanceWithin(SamplesPerPoll, block + 1);
                tracePair(trace, block);
            }
            watch.advance();
        }
    });
    allocation.choose();
    statistics.add("pilot samples", traced);
    return allocation;
}

double PathTracer::cost(const PathCounters& counters, const tuning::Costs::Walk& each) const {
    // Whole numbers all: sums do not depend on how samples are cut into tiles and passes.
    const double ray = std::round(each.ray + tuning::Nanoseconds.rayByLog *
                                                 std::log2(1.0 + double(scene_->geometry->triangleCount())));
    return each.vertex * double(counters.mediumEvents + counters.surfaceEvents) +
           ray * double(counters.rays + counters.shadowRays) + each.connection * double(counters.connections) +
           each.controlVertex * double(counters.controlVertices) + each.point * double(counters.points);
}

PathCosts PathTracer::costs(const StrategyCounters& counters) const {
    const PathCounters& plain = counters.plain;
    const double kept =
        balance_.both() ? tuning::Nanoseconds.trail * double(plain.mediumEvents + plain.surfaceEvents) : 0.0;
    return {
        cost(plain, tuning::Nanoseconds.plain),
        kept + tuning::Nanoseconds.density * double(counters.densities.densities) +
            cost(counters.densities, {.ray = tuning::Nanoseconds.plain.ray, .point = tuning::Nanoseconds.guided.point}),
        cost(counters.guided, tuning::Nanoseconds.guided)};
}

void PathTracer::chooseShare(const ProgressToken& watch, Statistics& statistics) {
    const std::optional<float> asked = settings_.policy.plainShare;
    if (asked == 0.0f || asked == 1.0f) {
        balance_ = {*asked, 1.0f - *asked};
        return;
    }
    const StageTimer timer(statistics, "pilot of plain and guided paths");
    constexpr size_t MostPixels = transport::tuning::MostPilotPaths / SharePilot::PathsOfPixel;
    watch.stage("pilot of plain and guided paths", MostPixels);
    constexpr uint64_t Key = transport::PilotKey;
    balance_ = {0.5f, 0.5f};
    if (plan_.lightVertices.on) {
        Statistics ignored;
        constexpr size_t GuidedPaths = transport::tuning::MostPilotPaths / 2;
        lightCaches_.trace(*scene_, *targets_, GuidedPaths, PassInfo{.seed = Key, .watch = watch}, ignored);
    }
    if (!targets_->any()) return;
    const GuidedContext guided = guidedContext(watch);
    const PathContext plain = plainContext(watch);
    const auto width = uint64_t(scene_->camera.resolution.x), pixels = width * uint64_t(scene_->camera.resolution.y);
    SharePilot pilot, alone;
    PlainTrail trail;
    StrategyCounters counted, countedAlone;
    Sampler places(Key, RandomStream::Pilot, 0, 0);
    uint64_t traced = 0;
    PathCosts costs;
    const auto tracePlainAlone =
        plan_.media ? &PathTracer::tracePlain<true, true> : &PathTracer::tracePlain<true, false>;
    for (size_t group = 0; group < MostPixels; ++group) {
        const uint64_t pixel = std::min(uint64_t(places.nextDouble() * double(pixels)), pixels - 1);
        for (int i = 0; i < SharePilot::PathsOfPixel; ++i, ++traced) {
            const bool guides = i % 2 == 1;
            Sampler sampler(Key, RandomStream::Camera, uint32_t(traced), pixel);
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = scene_->camera.generateRay({int(pixel % width), int(pixel / width)}, uFilter, uLens);
            PathCounters& counters = guides ? counted.guided : counted.plain;
            PixelAccumulator sink(pilot, sensor_, counters);
            pilot.begin(guides ? Strategy::Guided : Strategy::Plain);
            if (guides) {
                const double place = GoldenRatio * double(traced / 2);
                traceGuided(guided, float(place - std::floor(place)), radicalInverse(uint32_t(traced / 2)), ray, sink,
                            counters, sampler);
            } else {
                trail.start(guided, *targets_, sink, counted.densities, sampler);
                tracePlainBesideGuided(plain, {&trail}, sink, counters, sampler, ray);
                PixelAccumulator own(alone, sensor_, countedAlone.plain);
                alone.begin(Strategy::Plain);
                (this->*tracePlainAlone)(plain, ray, own, countedAlone.plain, sampler,
                                         radicalInverse(uint32_t(traced / 2)));
                pilot.tellPairsOfAlone(alone.pairsOfLast());
            }
        }
        watch.advance();
        costs = this->costs(counted);
        if (traced < transport::tuning::LeastPilotPaths) continue;
        if (costs.sum() + this->costs(countedAlone).plain > double(transport::tuning::MostPilotCost)) break;
        if ((group & (group + 1)) == 0 &&
            pilot.effective(Strategy::Plain) >= 10.0 * transport::tuning::LeastEffective &&
            pilot.effective(Strategy::Guided) >= 10.0 * transport::tuning::LeastEffective && pilot.isSure(costs))
            break;
    }
    const auto score = [&](double plainTime) {
        const StrategyBalance balance = costs.ofTime(plainTime);
        return pilot.variance(balance) * costs.mean(balance);
    };
    const double time = asked ? double(*asked) : pilot.choose(costs);
    balance_ = costs.ofTime(time);
    // Where too little was found for a choice, both stay.
    const bool enough = pilot.effective(Strategy::Alone) >= transport::tuning::LeastEffective;
    gainOfBalance_ = time == 1.0 ? 1.0 : enough ? score(1.0) / score(time) : double(Infinity);
    statistics.add(counter::PilotPaths, traced);
}

} // namespace tungsten::path
