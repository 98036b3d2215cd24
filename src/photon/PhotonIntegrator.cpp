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

void PhotonIntegrator::planVolume(EffectPlan& plan) const {
    std::visit(
        [&](const auto& p) {
            plan.describe(p.Effect, plan.mediumScattering,
                          plan.mediumScattering ? p.Reason
                                                : "no medium scatters: no volume photon is stored or gathered");
        },
        settings_.primitive);
    const bool delta = scene_->transport.gate.delta;
    const bool beams = std::holds_alternative<Beams>(settings_.primitive);
    const auto guidance = beams ? nullptr : PhotonGuidance::make(*scene_, settings_.scheme, plan);
    plan.describe(
        "temporal kernel", delta,
        !delta ? "the gate has a width, or none"
        : guidance && guidance->meetsDeltaGate()
            ? "delta gate: a box about it that narrows with the radius; control vertices lie on the gate itself"
            : "delta gate: a box about it that narrows with the radius");
}

void PhotonIntegrator::plan(EffectPlan& plan) const {
    const bool surfaces = settings_.includeSurfaces && plan.surfaceScattering;
    planVolume(plan);
    planGlossyPaths(plan);
    const bool connects =
        PhotonGuidance::obstacle(*scene_, settings_.scheme, plan).empty() && connectionObstacle(plan).empty();
    plan.describe("surface photons", surfaces,
                  !settings_.includeSurfaces ? "include_surfaces is false"
                  : !surfaces                ? "no surface has a smooth lobe"
                  : connects
                      ? "for what connections cannot bring: light by way of mirrors or refraction or of a single "
                        "direction, and to glossy surfaces"
                      : "smooth surfaces are gathered");
    describeGuidance(plan);
    const bool direct = ArrivalCulling(*scene_, plan).directView();
    plan.describe(
        "exact arrival culling", direct && plan.timeResolved,
        !plan.timeResolved ? "steady state: every photon counts"
        : direct           ? "direct view: photons that arrive outside the gate are not stored"
                 : "sensor paths can fold, change speed or start at many points: photons are tested when gathered");
}

void PhotonIntegrator::planGlossyPaths(EffectPlan& plan) const {
    if (!PhotonGuidance::obstacle(*scene_, settings_.scheme, plan).empty()) return;
    const auto glossy = [](const BsdfPtr& bsdf) { return isGlossyOnly(*bsdf); };
    const bool any = std::any_of(scene_->primitives.begin(), scene_->primitives.end(), [&](const Primitive& primitive) {
        return std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), glossy);
    });
    // Time without camera segments ends at the first surface that is no mirror.
    const bool unwarped = scene_->transport.cameraUnwarped;
    plan.glossySensorPaths = any && settings_.includeSurfaces && !unwarped && settings_.scheme.followsGlossy();
    plan.specularSensorPaths = plan.specularSensorPaths || plan.glossySensorPaths;
    plan.describe("glossy sensor paths", plan.glossySensorPaths,
                  !any                         ? "no surface is glossy without being diffuse"
                  : plan.glossySensorPaths     ? "sensor paths go on at surfaces that are glossy only, as at mirrors"
                  : !settings_.includeSurfaces ? "include_surfaces is false"
                  : unwarped ? "camera_unwarped: time stops at glossy surfaces, which are left to photons"
                             : "the preset or glossy_sensor_paths leaves glossy surfaces to photons");
}

void PhotonIntegrator::describeGuidance(EffectPlan& plan) const {
    const std::string obstacle = PhotonGuidance::obstacle(*scene_, settings_.scheme, plan);
    const auto guidance = PhotonGuidance::make(*scene_, settings_.scheme, plan);
    plan.describe("guided light paths", guidance != nullptr, guidance ? "the scene asks for DARTS" : obstacle);
    if (!guidance) return;
    if (!scene_->transport.cameraUnwarped) transport::WaysOut::plan(*scene_, settings_.scheme, false, plan);
    const size_t bodies = guidance->bodies().size();
    plan.describe("light towards bodies", bodies > 0,
                  bodies > 0 ? "half of what lamps outside fog send goes towards " + std::to_string(bodies) +
                                   (bodies > 1 ? " bodies" : " body") + " of it"
                             : "no body of fog in what does not scatter, or left alone");
    if (scene_->transport.gate.frames > 1)
        plan.describe("frames one by one", guidance->choosesFrames(),
                      guidance->choosesFrames() ? "each light path aims at one frame"
                                                : "light paths aim at the whole sequence as one gate");
    plan.describe("photons beside control vertices", !guidance->directView(),
                  guidance->directView() ? "direct view: control vertices alone are complete"
                                         : "mirrors, refraction or different speeds: both, by the balance heuristic");
    const std::string notConnected = connectionObstacle(plan);
    plan.describe("surface connections", notConnected.empty(),
                  notConnected.empty() ? "light paths connect to the surface points that the camera sees in time"
                                       : notConnected);
}

std::string PhotonIntegrator::connectionObstacle(const EffectPlan& plan) const {
    if (!settings_.includeSurfaces || !plan.surfaceScattering) return "no surface is gathered";
    if (!scene_->camera.hasSinglePosition() || plan.speedsDiffer) return "a thin lens, or different speeds of light";
    return settings_.scheme.connectsSurfaces() ? "" : "the preset or surface_connections leaves surfaces to photons";
}

void PhotonIntegrator::prepare(const EffectPlan& plan, Statistics&) {
    photonPass_ = std::make_unique<PhotonPass>(*scene_, settings_, plan);
    straightRays_ = scene_->camera.hasSinglePosition() && !plan.speedsDiffer;
    rules_ = {settings_.includeSurfaces, plan.glossySensorPaths};
    if (rules_.glossy) glossy_ = std::make_unique<GlossyLight>(*scene_, plan);
    foldedRays_ = plan.specularSensorPaths && settings_.includeSurfaces;
    connects_ = photonPass_->guidance() && connectionObstacle(plan).empty();
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
    const Sensor sensor = Sensor::of(*scene_, gate(step(pass)));
    const float surfaceFactor = surfaceRadiusFactor(step(pass), settings_.alpha);
    const bool splat = straightRays_ && photonPass_->storesVolume();
    const bool connect = straightRays_ && connects_;
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
    const SensorRays rays{splat, foldedRays_, glossy_ ? GlossyLight::HighlightPaths : 0, uFolded};
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
