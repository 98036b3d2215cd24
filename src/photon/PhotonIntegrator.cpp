#include "photon/PhotonIntegrator.h"

#include "photon/ProgressiveSchedule.h"

namespace tungsten::photon {

namespace {

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

struct PhotonIntegrator::StraightStores {
    PhotonStore points;
    std::vector<float> radii;
    std::vector<PhotonBeam> beams;
};

void PhotonIntegrator::planVolume(EffectPlan& plan) const {
    const bool beams = settings_.primitive == VolumePrimitive::Beams;
    const std::string none = "no medium scatters: no volume photon is stored or gathered";
    if (!beams)
        return plan.describe("volume photon points", plan.mediumScattering,
                             plan.mediumScattering ? "a medium scatters" : none);
    plan.describe("photon beams", plan.mediumScattering,
                  plan.mediumScattering ? "a medium scatters, volume_photon_type is beams" : none);
    const bool delta = scene_->transport.gate.delta;
    plan.describe("temporal kernel", delta,
                  delta ? "delta gate: a box about it that narrows with the radius" : "the gate has a width, or none");
}

void PhotonIntegrator::plan(EffectPlan& plan) const {
    const bool surfaces = settings_.includeSurfaces && plan.surfaceScattering;
    planVolume(plan);
    plan.describe("surface photons", surfaces,
                  surfaces
                      ? "smooth surfaces are gathered"
                      : (settings_.includeSurfaces ? "no surface has a smooth lobe" : "include_surfaces is false"));
    const bool direct = ArrivalTest(*scene_, plan).directView();
    plan.describe(
        "exact arrival culling", direct && plan.timeResolved,
        !plan.timeResolved ? "steady state: every photon counts"
        : direct           ? "direct view: photons that arrive outside the gate are not stored"
                 : "sensor paths can fold, change speed or start at many points: photons are tested when gathered");
}

void PhotonIntegrator::prepare(const EffectPlan& plan, Statistics&) {
    photonPass_ = std::make_unique<PhotonPass>(*scene_, settings_, plan);
}

std::vector<float> PhotonIntegrator::volumeRadii(const PhotonStore& store, uint32_t pass) const {
    const float factor = pointRadiusFactor(pass, settings_.volumeAlpha);
    if (settings_.fixedVolumeRadius) return {settings_.volumeRadius * factor};
    std::vector<float> radii = adaptiveRadii(store.photons);
    // The schedule's cube root acts on the squared radius here (scene format, section 10.5).
    for (float& radius : radii) radius *= std::sqrt(factor);
    return radii;
}

TimeGate PhotonIntegrator::gate(uint32_t pass) const {
    const TimeGate& gate = scene_->transport.gate;
    if (!gate.delta) return gate;
    const double tau = settings_.temporalRadius * deltaGateFactor(pass, settings_.volumeAlpha);
    return {false, false, gate.start - tau, 2.0 * tau, 1};
}

void PhotonIntegrator::build(const PhotonMaps& maps, uint32_t pass, StraightStores& straight,
                             GatherStructures& structures) const {
    const ArrivalTest& arrival = photonPass_->arrival();
    if (!maps.volume.photons.empty()) {
        const std::vector<float> radii = volumeRadii(maps.volume, pass);
        structures.points = std::make_unique<PointGather>(*scene_, maps.volume, radii);
        selectStraight(arrival, maps.volume, radii, straight.points, straight.radii);
        if (straight.points.paths > 0)
            structures.straightPoints = std::make_unique<PointGather>(*scene_, straight.points, straight.radii);
    }
    if (!maps.beams.beams.empty()) {
        const float factor = scene_->transport.gate.delta ? float(deltaGateFactor(pass, settings_.volumeAlpha))
                                                          : beamRadiusFactor(pass, settings_.alpha);
        const float radius = settings_.volumeRadius * factor;
        structures.beams = std::make_unique<BeamGather>(*scene_, structures.gate, maps.beams.beams, radius);
        if (!arrival.directView() && arrival.straightTimesKnown()) {
            straight.beams = straightParts(*scene_, arrival, maps.beams.beams);
            structures.straightBeams = std::make_unique<BeamGather>(*scene_, structures.gate, straight.beams, radius);
        }
    }
    if (!maps.surface.photons.empty()) structures.surfaces = std::make_unique<NearestPhotons>(maps.surface.photons);
    structures.surfaceRadius = settings_.gatherRadius * surfaceRadiusFactor(pass, settings_.alpha);
}

void PhotonIntegrator::renderPass(const PassInfo& pass, Film& film, Statistics& statistics) {
    // Without progression every pass looks at the photons of the first.
    PassInfo photons = pass;
    if (!settings_.progressive) photons.index = 0;
    PhotonMaps maps;
    const TimeGate passGate = gate(photons.index);
    {
        const StageTimer timer(statistics, "photon pass");
        photonPass_->setGate(passGate);
        maps = photonPass_->trace(photons, statistics);
    }
    StraightStores straight;
    GatherStructures structures{
        maps,    nullptr, nullptr, nullptr, nullptr, nullptr, 0.0f, settings_.gatherCount, settings_.includeSurfaces,
        passGate};
    {
        const StageTimer timer(statistics, "build");
        build(maps, photons.index, straight, structures);
    }
    const StageTimer timer(statistics, "sensor pass");
    renderSensorPass(*scene_, structures, pass, film, statistics);
}

} // namespace tungsten::photon
