#include "path/light/LightTracer.h"

#include "path/PathPlan.h"
#include "path/PathSettings.h"
#include "path/Tuning.h"

#include "transport/GuidancePlan.h"
#include "transport/SamplingSummary.h"

#include "tungsten/integrator/EarliestArrival.h"
#include "tungsten/integrator/Names.h"
#include "tungsten/scene/LightChoice.h"

#include <tbb/parallel_for.h>

namespace tungsten::path {

namespace {

constexpr uint64_t PathsPerPoll = 16;
/// Light paths traced by one task, which takes milliseconds, and tasks whose splats wait to be added in order: room for
/// those of 65 536 paths.
constexpr uint64_t PathsPerBatch = 1024, BatchesPerWave = 64;

/// The first surface that mirrors or refracts; null if there is none.
const Primitive* firstSpecular(const Scene& scene) {
    for (const Primitive& primitive : scene.primitives)
        for (const BsdfPtr& bsdf : primitive.bsdfs)
            if ((bsdf->lobes() & lobe::Specular) != 0) return &primitive;
    return nullptr;
}

void readRest(const ObjectReader& block, const Scene& scene) {
    acceptPhotonSettings(block);
    block.accept(
        {"enable_light_sampling", "enable_volume_light_sampling", "enable_guiding", "enable_elliptical", "darts"});
    // Read for its mistakes; nothing of it is this integrator's.
    if (!block.describes() && transport::readPolicy(block).guides())
        block.warn(block.has("darts")            ? "darts"
                   : block.has("enable_guiding") ? "enable_guiding"
                                                 : "enable_elliptical",
                   "does not guide the light tracer: its paths are plain");
    Diagnostics& diagnostics = *block.diagnostics();
    if (scene.transport.gate.delta)
        block.problem("delta_time_gate", "plain light paths meet a delta gate with probability zero; give the gate a "
                                         "width, or use path_tracer with \"darts\": \"best\"");
    if (scene.camera.filter.type() == FilterType::Dirac)
        diagnostics.problems.push_back({diagnostics.file, "camera.reconstruction_filter",
                                        "light paths meet single points of the image with probability zero; use "
                                        "\"box\" or another filter that has a width"});
    // Rays of light meet detectors.
    if (scene.camera.detectors()) return;
    if (const Primitive* specular = firstSpecular(scene)) {
        const std::string which = specular->name.empty() ? "" : "'" + specular->name + "' and other ";
        diagnostics.warnings.push_back({diagnostics.file, "primitives",
                                        "the light tracer does not show what is seen in or through " + which +
                                            "surfaces that mirror or refract; the path tracer does"});
    }
    if (!scene.infiniteEmitters.empty())
        diagnostics.warnings.push_back({diagnostics.file, "primitives",
                                        "the light tracer does not show the environment itself, only what it lights"});
}

/// Adds splats to the pass image, weighed by the filter's density about each pixel, in an order that does not depend on
/// the threads.
class SplatBuffer {
  public:
    SplatBuffer(Film& film, const ReconstructionFilter& filter, float scale)
        : film_(film), filter_(filter), scale_(scale) {}

    /// Order within a batch in which add() takes it; batches can be prepared in parallel.
    static void sortByRow(std::vector<Splat>& batch) {
        std::stable_sort(batch.begin(), batch.end(), [](const Splat& a, const Splat& b) {
            return std::floor(a.raster.y) < std::floor(b.raster.y);
        });
    }
    /// Batches in their order. Rows of the image are filled in parallel, each pixel by one thread.
    void add(const std::vector<std::vector<Splat>>& batches, const ProgressToken& watch) const {
        tbb::parallel_for(0, film_.height(), [&](int y) {
            watch.advance(0);
            for (const auto& batch : batches) addToRow(y, batch);
        });
    }

  private:
    void addToRow(int y, const std::vector<Splat>& batch) const {
        const float reach = filter_.reach(), first = std::floor(float(y) - reach), last = float(y) + reach;
        auto splat =
            std::partition_point(batch.begin(), batch.end(), [&](const Splat& s) { return s.raster.y < first; });
        for (; splat != batch.end() && std::floor(splat->raster.y) <= last; ++splat) {
            const float weight = filter_.pdf(splat->raster.y - float(y)) * scale_;
            if (!(weight > 0.0f)) continue;
            const int from = std::max(int(std::ceil(splat->raster.x - reach)), 0),
                      to = std::min(int(std::floor(splat->raster.x + reach)), film_.width() - 1);
            for (int x = from; x <= to; ++x)
                film_.add(splat->frame, x, y, splat->radiance * (weight * filter_.pdf(splat->raster.x - float(x))));
        }
    }

    Film& film_;
    const ReconstructionFilter& filter_;
    float scale_;
};

void report(const LightCounters& counters, Statistics& statistics) {
    statistics.add("rays", counters.rays);
    statistics.add(counter::ShadowRays, counters.shadowRays);
    transport::reportSteps(counters, statistics);
    statistics.add(counter::ArrivalsInGate, counters.timed);
    statistics.add(counter::ArrivalsInLaterFrames, counters.laterFrames);
    statistics.add(counter::ArrivalsByResponse, counters.weighed);
    statistics.add("connections", counters.connections);
    statistics.add(counter::NonFiniteSamples, counters.nonFinite);
}

} // namespace

LightTracer::LightTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings)
    : scene_(std::move(scene)), limits_(readBounceLimits(settings, *scene_)),
      russianRoulette_(readRussianRoulette(settings, !scene_->transport.gate.steadyState)),
      sensor_(transport::TimeSensor::of(*scene_, scene_->transport.gate)),
      emitters_(emitterDistribution(*scene_, [](const Emitter&) { return true; })) {
    readRest(settings, *scene_);
}

void LightTracer::plan(SceneFacts& facts, Features& features) const {
    excludeLate(*scene_, lastTime(*scene_), facts, features);
    countArrivals(features);
    const bool detectors = scene_->camera.detectors() != nullptr;
    const bool splits = detectors && facts.mediumScattering;
    features.sampling = {
        splits ? "plain light paths, split on their way to detectors by what diffusion would bring"
               : "plain light paths: there is no guidance for them",
        transport::PlainVertices + std::string(russianRoulette_ ? ", Russian roulette by throughput" : ""),
        detectors ? "connections to detectors, and directions that meet them" : "connections to the camera"};
    features.describe("light paths", emitters_.total() > 0.0,
                      emitters_.total() > 0.0
                          ? "one for every sample of a pixel, connected to the camera at each vertex"
                          : "nothing shines",
                      {"integrator.type"}, {counter::LightPaths});
    if (detectors)
        features.describe("splits towards detectors", splits,
                          splits ? "light paths go on in more copies the more diffusion brings to detectors from there"
                                 : "no medium scatters");
    features.describe("emission in view", facts.surfaceEmission,
                      facts.surfaceEmission ? "points of the lights are connected to the camera"
                                            : "no light has a surface");
    if (facts.environment && !detectors)
        features.limit("environment in view", "no light path starts on the way from the camera to infinity");
    if (facts.specularCameraSubpaths && !detectors)
        features.limit("mirrors and refraction in view",
                       "connections to the camera are straight: what is seen in mirrors or through refraction is "
                       "missing; caustics are found");
    features.describe("Russian roulette", russianRoulette_,
                      russianRoulette_ ? "enable_rr, or its default in steady state"
                                       : "off by default in time-resolved renders");
}

void LightTracer::prepare(const SceneFacts& facts, const ProgressToken&, Statistics&) {
    forwardBoundaries_ = facts.forwardBoundaries || facts.everything;
    emitters_ = emitterDistribution(
        *scene_, [](const Emitter&) { return true; }, facts.excludedEmitters);
    bounds_ = {scene_->transport.gate, facts};
    splits_ = scene_->camera.detectors() && facts.mediumScattering;
}

void LightTracer::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    const StageTimer timer(statistics, "light paths");
    const uint64_t pixels = uint64_t(film.width()) * uint64_t(film.height()), paths = pixels * pass.samples;
    if (!(emitters_.total() > 0.0)) return;
    const LightContext context{*scene_,          limits_, sensor_,   bounds_, emitters_, {*scene_, forwardBoundaries_},
                               russianRoulette_, splits_, pass.watch};
    pass.watch.stage("light paths", paths);
    const SplatBuffer splats(film, scene_->camera.filter, float(1.0 / double(paths)));
    for (uint64_t traced = 0; traced < paths; traced += PathsPerBatch * BatchesPerWave) {
        const uint64_t wave = std::min(paths - traced, PathsPerBatch * BatchesPerWave);
        std::vector<std::vector<Splat>> batches((wave + PathsPerBatch - 1) / PathsPerBatch);
        tbb::parallel_for(size_t(0), batches.size(), [&](size_t b) {
            const uint64_t first = traced + b * PathsPerBatch, last = std::min(first + PathsPerBatch, traced + wave);
            LightCounters counters;
            for (uint64_t path = first; path < last; ++path) {
                // As many paths as pixels make a sample: but for rounding the image does not depend on
                // how samples are cut into passes.
                pass.watch.advanceEvery(PathsPerPoll, path);
                const auto sample = uint32_t(pass.firstSample + path / pixels);
                traceLightPath(context, Sampler(pass.seed, RandomStream::Photon, sample, path % pixels), batches[b],
                               counters);
            }
            SplatBuffer::sortByRow(batches[b]);
            report(counters, statistics);
        });
        splats.add(batches, pass.watch);
    }
    statistics.add(counter::LightPaths, paths);
}

} // namespace tungsten::path
