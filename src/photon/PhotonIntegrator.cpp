#include "photon/PhotonIntegrator.h"

#include "photon/primitives/ProgressiveSchedule.h"
#include "photon/surface/SharedArrivals.h"

namespace tungsten::photon {

namespace {

/// Camera paths per pixel that look for surface points. One leaves the noise of lines that a narrow gate lights; more
/// cost little in small images alone, and in large ones there are more points than can be listed.
uint32_t surfaceSamples(const Vec2i& resolution) {
    constexpr size_t Wanted = 1 << 16, Least = 2, Most = 4;
    const size_t pixels = size_t(resolution.x) * size_t(resolution.y);
    return pixels > SensorClusters::MostPoints ? 1 : uint32_t(std::clamp(Wanted / pixels, Least, Most));
}

} // namespace

PhotonIntegrator::PhotonIntegrator(std::shared_ptr<const Scene> scene, const ObjectReader& settings, bool progressive)
    : scene_(std::move(scene)), settings_(readPhotonSettings(settings, *scene_, progressive)) {}

void PhotonIntegrator::plan(EffectPlan& plan) const {
    PhotonPlan::of(*scene_, settings_, plan).describe(*scene_, settings_, plan);
}

void PhotonIntegrator::prepare(const EffectPlan& plan, Statistics&) {
    plan_ = PhotonPlan::of(*scene_, settings_, plan);
    photonPass_ = std::make_unique<PhotonPass>(*scene_, settings_, plan_);
    rules_ = {settings_.includeSurfaces, plan_.glossyPaths.on};
    if (rules_.glossy) glossy_ = std::make_unique<GlossyLight>(*scene_, plan);
}

uint32_t PhotonIntegrator::step(const PassInfo& pass) const {
    return settings_.progressive ? pass.index : 0;
}

TimeGate PhotonIntegrator::gate(uint32_t step) const {
    const TimeGate& gate = scene_->transport.gate;
    if (!gate.delta) return gate;
    const double tau = settings_.temporalRadius * deltaGateFactor(step, settings_.volumeAlpha);
    return {false, false, gate.start - tau, 2.0 * tau, 1};
}

template <typename Use>
void PhotonIntegrator::forEachSample(const SensorRecord& first, const PassInfo& pass, Statistics& statistics,
                                     const Use& use) const {
    use(first);
    for (uint32_t s = 1; s < pass.samples; ++s)
        use(recordSensorPaths(*scene_, false, rules_, {pass.index, pass.firstSample + s, 1, pass.seed}, 1, statistics));
}

void PhotonIntegrator::gatherVolume(VolumeStore&& maps, const PassInfo& pass, const SensorRecord& record,
                                    const SensorRays& rays, GatherStructures& structures, Film& film,
                                    Statistics& statistics) const {
    const auto build = [&]<typename Primitive>(const Primitive& primitive) {
        auto& store = std::get<Store<typename Primitive::Record>>(maps);
        if (store.records.empty()) return;
        const VolumeGather<Primitive>* gather = nullptr;
        {
            const StageTimer timer(statistics, "build");
            Radii radii = primitive.radii(settings_, scene_->transport.gate.delta, store.records, step(pass));
            gather = &structures.volume.template emplace<VolumeGather<Primitive>>(
                *scene_, structures.sensor, photonPass_->arrival(), std::move(store), std::move(radii), rays);
        }
        if (!rays.splatted) return;
        const StageTimer timer(statistics, "splat");
        const TimeGate& gate = structures.sensor.gate;
        const double scale =
            double(gather->scale()) / ((gate.steadyState ? 1.0 : gate.frameWidth) * double(pass.samples));
        forEachSample(record, pass, statistics, [&](const SensorRecord& sample) {
            statistics.add(primitive.Gathered, gather->splat(sample, scale, film));
        });
    };
    std::visit(build, settings_.primitive);
}

void PhotonIntegrator::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    const transport::Sensor sensor = transport::Sensor::of(*scene_, gate(step(pass)));
    const float surfaceFactor = surfaceRadiusFactor(step(pass), settings_.alpha);
    const bool splat = plan_.splats();
    const bool connect = plan_.connections.on;
    SensorRecord record;
    std::unique_ptr<SurfaceConnections> connections;
    if (splat || connect) {
        const StageTimer timer(statistics, "sensor record");
        record = recordSensorPaths(*scene_, connect, rules_, pass,
                                   connect ? surfaceSamples(scene_->camera.resolution) : 1, statistics);
        if (connect) {
            const auto spread = Spread::of(settings_.gatherRadius, surfaceFactor);
            connections = std::make_unique<SurfaceConnections>(*scene_, sensor, record, pass, spread);
        }
    }
    PhotonMaps maps;
    {
        const StageTimer timer(statistics, "photon pass");
        photonPass_->setGate(sensor.gate);
        maps = photonPass_->trace(pass, connections.get(), statistics);
    }
    GatherStructures structures{maps.surface,         sensor, splat, settings_.includeSurfaces, rules_, glossy_.get(),
                                settings_.gatherCount};
    const float uFolded = Sampler(pass.seed, RandomStream::Folded, pass.index, 0).next1D();
    const SensorRays rays{splat, plan_.folds && settings_.includeSurfaces, glossy_ ? GlossyLight::HighlightPaths : 0,
                          uFolded};
    gatherVolume(std::move(maps.volume), pass, record, rays, structures, film, statistics);
    {
        const StageTimer timer(statistics, "build");
        if (!maps.surface.records.empty()) structures.surfaces = std::make_unique<NearestPhotons>(maps.surface.records);
        structures.surfaceRadius = settings_.gatherRadius * surfaceFactor;
    }
    if (connect) {
        const StageTimer timer(statistics, "share arrivals");
        const auto kernel = SharingKernel::of(record.points.size() / record.samples, maps.arrivals.size(),
                                              settings_.gatherRadius, surfaceFactor);
        shareArrivals(*scene_, sensor, record, maps.arrivals, kernel, 1.0 / double(maps.paths), film, statistics);
    }
    const StageTimer timer(statistics, "sensor pass");
    renderSensorPass(*scene_, structures, pass, film, statistics);
}

} // namespace tungsten::photon
