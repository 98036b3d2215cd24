#include "photon/PhotonIntegrator.h"

#include "photon/BeamSplat.h"
#include "photon/FoldedSelection.h"
#include "photon/PhotonSplat.h"
#include "photon/ProgressiveSchedule.h"
#include "photon/SharedArrivals.h"

namespace tungsten::photon {

namespace {

/// Camera paths per pixel that look for surface points. One leaves the noise of lines that a narrow gate lights; more
/// cost little in small images alone, and in large ones there are more points than can be listed.
uint32_t surfaceSamples(const Vec2i& resolution) {
    constexpr size_t Wanted = 1 << 16, Least = 2, Most = 4;
    const size_t pixels = size_t(resolution.x) * size_t(resolution.y);
    return pixels > SensorClusters::MostPoints ? 1 : uint32_t(std::clamp(Wanted / pixels, Least, Most));
}

/// Copies the photons that straight sensor paths see inside the gate. Leaves `straight` alone where that would be all
/// or unknown.
void selectStraight(const ArrivalTest& arrival, const PhotonStore& store, const std::vector<float>& radii,
                    PhotonStore& straight, std::vector<float>& straightRadii) {
    if (arrival.directView() || !arrival.straightTimesKnown()) return;
    straight.paths = store.paths;
    if (radii.size() == 1) straightRadii = radii;
    for (size_t i = 0; i < store.photons.size(); ++i) {
        if (!arrival.seenStraight(store.photons[i].position, store.photons[i].time)) continue;
        straight.photons.push_back(store.photons[i]);
        if (radii.size() > 1) straightRadii.push_back(radii[i]);
    }
}

} // namespace

PhotonIntegrator::PhotonIntegrator(std::shared_ptr<const Scene> scene, const ObjectReader& settings, bool progressive)
    : scene_(std::move(scene)), settings_(readPhotonSettings(settings, *scene_, progressive)) {}

struct PhotonIntegrator::StoreParts {
    PhotonStore straightPoints, foldedPoints;
    std::vector<float> straightRadii, foldedRadii;
    std::vector<PhotonBeam> straightBeams, foldedBeams;
    // Of what is folded, dealt to highlight paths.
    std::vector<PhotonStore> pointParts;
    std::vector<std::vector<float>> pointRadii;
    std::vector<std::vector<PhotonBeam>> beamParts;
    float uFolded = 0.0f; ///< chooses what folded rays gather

    void selectFolded(const PhotonStore& store, const std::vector<float>& radii) {
        const double share = foldedShare(store.photons, radii);
        foldedPoints.paths = store.paths;
        foldedPoints.photons = chosenEvenly(store.photons, share, uFolded);
        if (radii.size() == 1) foldedRadii = radii;
        if (radii.size() > 1)
            chooseEvenly(radii.size(), share, uFolded, [&](size_t i) { foldedRadii.push_back(radii[i]); });
    }
    void dealPoints(size_t count) {
        for (auto& photons : dealt(foldedPoints.photons, count))
            pointParts.push_back({{foldedPoints.paths, false}, std::move(photons)});
        pointRadii.assign(count, foldedRadii);
        if (foldedRadii.size() > 1) pointRadii = dealt(foldedRadii, count);
    }
};

void PhotonIntegrator::planVolume(EffectPlan& plan) const {
    const bool beams = settings_.primitive == VolumePrimitive::Beams;
    const std::string none = "no medium scatters: no volume photon is stored or gathered";
    plan.describe(beams ? "photon beams" : "volume photon points", plan.mediumScattering,
                  !plan.mediumScattering ? none
                  : beams                ? "a medium scatters, volume_photon_type is beams"
                                         : "a medium scatters");
    const bool delta = scene_->transport.gate.delta;
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
    const bool direct = ArrivalTest(*scene_, plan).directView();
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

std::vector<float> PhotonIntegrator::volumeRadii(const PhotonStore& store, uint32_t step) const {
    const float factor = pointRadiusFactor(step, settings_.volumeAlpha);
    if (settings_.fixedVolumeRadius) return {settings_.volumeRadius * factor};
    std::vector<float> radii = adaptiveRadii(store.photons);
    // The schedule's cube root acts on the squared radius here (docs/scene-format.md, section 10.5).
    for (float& radius : radii) radius *= std::sqrt(factor);
    return radii;
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

void PhotonIntegrator::gatherPoints(const PhotonMaps& maps, const PassInfo& pass, const SensorRecord& record,
                                    StoreParts& parts, GatherStructures& structures, Film& film,
                                    Statistics& statistics) const {
    std::vector<float> radii;
    {
        const StageTimer timer(statistics, "build");
        radii = volumeRadii(maps.volume, step(pass));
        selectStraight(photonPass_->arrival(), maps.volume, radii, parts.straightPoints, parts.straightRadii);
        const Sensor& sensor = structures.sensor;
        if (!structures.splatted) {
            structures.points = std::make_unique<PointGather>(*scene_, sensor, maps.volume, radii);
        } else if (foldedRays_) {
            parts.selectFolded(maps.volume, radii);
            structures.points = std::make_unique<PointGather>(*scene_, sensor, parts.foldedPoints, parts.foldedRadii);
            if (glossy_) parts.dealPoints(GlossyLight::HighlightPaths);
            for (size_t k = 0; k < parts.pointParts.size(); ++k)
                structures.pointParts.push_back(
                    std::make_unique<PointGather>(*scene_, sensor, parts.pointParts[k], parts.pointRadii[k]));
        }
        if (!structures.splatted && parts.straightPoints.paths > 0)
            structures.straightPoints =
                std::make_unique<PointGather>(*scene_, sensor, parts.straightPoints, parts.straightRadii);
    }
    if (!structures.splatted) return;
    const StageTimer timer(statistics, "splat");
    const bool all = parts.straightPoints.paths == 0;
    const double width = structures.sensor.gate.steadyState ? 1.0 : structures.sensor.gate.frameWidth;
    const double scale = double(maps.volume.scale()) / (width * double(pass.samples));
    forEachSample(record, pass, statistics, [&](const SensorRecord& sample) {
        statistics.add("gathered photons",
                       splatPhotons(*scene_, structures.sensor, sample, all ? maps.volume : parts.straightPoints,
                                    all ? radii : parts.straightRadii, scale, film));
    });
}

void PhotonIntegrator::gatherBeams(const PhotonMaps& maps, const PassInfo& pass, const SensorRecord& record,
                                   StoreParts& parts, GatherStructures& structures, Film& film,
                                   Statistics& statistics) const {
    const ArrivalTest& arrival = photonPass_->arrival();
    const float factor = scene_->transport.gate.delta ? float(deltaGateFactor(step(pass), settings_.volumeAlpha))
                                                      : beamRadiusFactor(step(pass), settings_.alpha);
    const float radius = settings_.volumeRadius * factor;
    const std::vector<PhotonBeam>& all = maps.beams.beams;
    const bool single = arrival.directView() || !arrival.straightTimesKnown();
    {
        const StageTimer timer(statistics, "build");
        if (!single) parts.straightBeams = straightParts(*scene_, arrival, all);
        if (!structures.splatted) {
            structures.beams = std::make_unique<BeamGather>(*scene_, structures.sensor, all, radius);
        } else if (foldedRays_) {
            parts.foldedBeams = chosenEvenly(all, foldedShare(all, radius), parts.uFolded);
            structures.beams =
                std::make_unique<BeamGather>(*scene_, structures.sensor, parts.foldedBeams, radius, true);
            if (glossy_) parts.beamParts = dealt(parts.foldedBeams, GlossyLight::HighlightPaths);
            for (const auto& beams : parts.beamParts)
                structures.beamParts.push_back(
                    std::make_unique<BeamGather>(*scene_, structures.sensor, beams, radius, true));
        }
        if (!structures.splatted && !single)
            structures.straightBeams =
                std::make_unique<BeamGather>(*scene_, structures.sensor, parts.straightBeams, radius);
    }
    if (!structures.splatted) return;
    const StageTimer timer(statistics, "splat");
    const double width = structures.sensor.gate.steadyState ? 1.0 : structures.sensor.gate.frameWidth;
    const double scale = double(maps.beams.scale()) / (width * double(pass.samples));
    forEachSample(record, pass, statistics, [&](const SensorRecord& sample) {
        statistics.add("gathered beams", splatBeams(*scene_, structures.sensor, sample,
                                                    single ? all : parts.straightBeams, radius, scale, film));
    });
}

void PhotonIntegrator::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    const Sensor sensor = Sensor::of(*scene_, gate(step(pass)));
    const float surfaceFactor = surfaceRadiusFactor(step(pass), settings_.alpha);
    const bool splat = straightRays_ && (photonPass_->storesVolume() || photonPass_->storesBeams());
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
    StoreParts parts{};
    parts.uFolded = Sampler(pass.seed, RandomStream::Folded, pass.index, 0).next1D();
    GatherStructures structures{
        maps, sensor, splat, settings_.includeSurfaces, rules_, glossy_.get(), settings_.gatherCount};
    if (!maps.volume.photons.empty()) gatherPoints(maps, pass, record, parts, structures, film, statistics);
    if (!maps.beams.beams.empty()) gatherBeams(maps, pass, record, parts, structures, film, statistics);
    {
        const StageTimer timer(statistics, "build");
        if (!maps.surface.photons.empty()) structures.surfaces = std::make_unique<NearestPhotons>(maps.surface.photons);
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
