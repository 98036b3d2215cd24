#include "photon/light/PhotonPass.h"

#include "photon/Tuning.h"
#include "photon/light/DepositVisitor.h"
#include "photon/light/TracedPaths.h"
#include "photon/store/StoreFilling.h"

#include "tungsten/integrator/Names.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// Light paths traced by one task, which takes milliseconds, and tasks whose deposits wait to be appended in order: few
/// beside the stores.
constexpr uint64_t PathsPerBatch = 256, BatchesPerWave = 16;

/// use(store, list of deposits) of the volume primitive in use: both are variants of one kind.
template <typename Use>
void withVolume(VolumeStore& store, const VolumeDeposits& deposits, Use&& use) {
    std::visit(
        [&](auto& s) {
            using Record = typename std::decay_t<decltype(s)>::Record;
            use(s, std::get<DepositList<Record>>(deposits));
        },
        store);
}

Distribution1D powerDistribution(const Scene& scene, const std::vector<bool>& leftOut) {
    std::vector<float> powers;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const bool left = !leftOut.empty() && leftOut[i];
        powers.push_back(left ? 0.0f : meanComponent(emitterPower(scene.emitters[i])));
    }
    return Distribution1D(powers);
}

/// Whether surface photons may have to bring what connections cannot: light by way of mirrors or refraction, of a
/// single direction, or to surfaces that are glossy only.
bool needsPhotonsBesideConnections(const Scene& scene, bool glossyPaths) {
    constexpr LobeMask Unconnected = lobe::Specular | lobe::GlossyTransmission;
    const auto unconnected = [&](const BsdfPtr& bsdf) {
        return (bsdf->lobes() & Unconnected) != 0 || (!glossyPaths && isGlossyOnly(*bsdf));
    };
    return std::any_of(scene.emitters.begin(), scene.emitters.end(),
                       [](const Emitter& emitter) { return emitter.isDelta() || emitter.isInfinite(); }) ||
           std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
               return std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), unconnected);
           });
}

bool isFull(const VolumeStore& stores) {
    return std::visit([](const auto& store) { return store.full; }, stores);
}

void append(PhotonMaps& maps, const Deposits& d, const PhotonSettings& settings, Sampler& sampler) {
    appendPaths(maps.surface, d.surface, settings.photonCount, sampler);
    withVolume(maps.volume, d.volume,
               [&](auto& store, const auto& list) { appendPaths(store, list, settings.volumePhotonCount, sampler); });
    maps.received.insert(maps.received.end(), d.received.begin(), d.received.end());
}

/// Room for what the first wave lets expect, so that growing does not hold the photons twice.
void reserveStores(PhotonMaps& maps, const std::vector<TracedPaths>& wave, const PhotonSettings& settings) {
    uint64_t surface = 0, volume = 0, paths = 0;
    for (const TracedPaths& batch : wave) {
        surface += batch.deposits.surface.records.size();
        volume += batch.deposits.volumeRecords();
        paths += batch.deposits.surface.pathEnds.size();
    }
    constexpr double Margin = 1.02;
    const double scale = Margin * double(settings.photonCount) / double(std::max<uint64_t>(paths, 1));
    maps.surface.records.reserve(std::min(settings.photonCount, uint64_t(double(surface) * scale)));
    const auto room = std::min(settings.volumePhotonCount, uint64_t(double(volume) * scale));
    std::visit([&](auto& store) { store.records.reserve(room); }, maps.volume);
}

/// Light paths that surfaces are owed, however soon the volume's store is full.
uint64_t leastPathsFor(const SurfaceConnections& connections) {
    return std::min(tuning::ConnectionsPerPoint * connections.points(), tuning::MostLeast) /
           uint64_t(tuning::ConnectionsPerPath);
}

void report(const TracedPaths& traced, Statistics& statistics) {
    for (const PhotonCounters* counters : {&traced.plain, &traced.guided}) {
        transport::reportSteps(*counters, statistics);
        statistics.add(counter::ControlVertices, counters->controlVertices);
        statistics.add(counter::PlainBesideGuided, counters->plainPaths);
        statistics.add(counter::NonFiniteSamples, counters->nonFinite);
        statistics.add("volume deposits", counters->volumeDeposits);
        statistics.add("volume deposits that may count", counters->countingDeposits);
    }
    statistics.add(counter::Rays, traced.rays());
    statistics.add(counter::FlightDensities, traced.densities.densities);
}

void reportStored(const PhotonMaps& maps, const VolumePrimitive& primitive, Statistics& statistics) {
    statistics.add(counter::SurfaceConnections, maps.received.size());
    statistics.add(counter::Photons, maps.paths);
    statistics.add(counter::StoredSurfacePhotons, maps.surface.records.size());
    forEachPrimitive(primitive, [&](const auto& p) {
        using Record = typename std::decay_t<decltype(p)>::Record;
        const auto* store = std::get_if<Store<Record>>(&maps.volume);
        statistics.add(p.Stored, store ? store->records.size() : 0);
    });
}

} // namespace

PhotonPass::PhotonPass(const Scene& scene, const PhotonSettings& settings, const PhotonPlan& plan,
                       const ProgressToken& watch)
    : scene_(scene), settings_(settings), culling_(scene, {plan.indirectView, plan.oneSpeed, plan.highestSpeed}),
      guidance_(plan.guidance.on ? std::make_unique<PhotonGuidance>(scene, settings.policy, plan, watch) : nullptr),
      emitters_(powerDistribution(scene, plan.excludedEmitters)), storeVolume_(plan.volume.on),
      storeSurface_(plan.surfacePhotons.on), glossyCameraSubpaths_(plan.glossyPaths.on),
      densityPhotons_(needsPhotonsBesideConnections(scene, plan.glossyPaths.on)), cameraPaths_(plan.cameraPaths) {
    if (!guidance_ || !guidance_->choosesFrames()) return;
    for (int frame = guidance_->emptyFrames(); frame < scene.transport.gate.frames; ++frame)
        frameCullings_.push_back(culling_.ofFrame(frame));
}

void PhotonPass::setGate(const TimeGate& gate) {
    culling_.setGate(gate);
    if (guidance_) guidance_->setGate(gate);
}

PhotonSettings PhotonPass::settingsOf(const PassInfo& pass) const {
    PhotonSettings settings = settings_.ofShare(pass.share);
    if (!scene_.transport.gate.delta) return settings;
    const auto narrowed = float(culling_.gate().frameWidth / (2.0 * settings.temporalRadius));
    std::visit([&](auto& primitive) { primitive.narrow(narrowed); }, settings.primitive);
    return settings;
}

PhotonContext PhotonPass::contextOf(const PassInfo& pass, const PhotonSettings& settings) const {
    return {.scene = scene_,
            .settings = settings,
            .culling = culling_,
            .frameCullings = frameCullings_,
            .emitters = emitters_,
            .balance = balance_,
            .watch = pass.watch};
}

void PhotonPass::tracePath(uint64_t path, const PhotonContext& context, const Sampler& sampler,
                           const SurfaceConnections* connections, PhotonTrail& trail, TracedPaths& traced) const {
    if (!guidance_) return tracePlainPhotons(context, sampler, traced.deposits, traced.plain);
    const float plain = context.balance.plain;
    if (plain > 0.0f && sampler.branch(RandomStream::Strategy, 0).next1D() < plain)
        tracePlainBesideGuided(context, *guidance_, connections, sampler, trail, traced.deposits, traced.plain,
                               traced.densities);
    else
        traceGuidedPhotons(context, *guidance_, connections, sampler, path, traced.deposits, traced.guided);
}

void PhotonPass::tracePaths(uint64_t first, uint64_t last, const PhotonContext& context, const PassInfo& pass,
                            const SurfaceConnections* connections, TracedPaths& traced) const {
    PhotonTrail trail;
    for (uint64_t path = first; path < last; ++path) {
        pass.watch.advanceWithin(1, path);
        const Sampler sampler(pass.seed, RandomStream::Photon, pass.index, path);
        tracePath(path, context, sampler, connections, trail, traced);
        traced.deposits.endPath();
    }
    pass.watch.advance(last - first);
}

double PhotonPass::passOverhead() const {
    const Vec2i& resolution = scene_.camera.resolution;
    return tuning::Nanoseconds.pixel * double(cameraPaths_) * double(resolution.x) * double(resolution.y);
}

PhotonMaps PhotonPass::emptyMaps() const {
    PhotonMaps maps;
    maps.surface.full = !storeSurface_;
    maps.volume = storeOf(settings_.primitive);
    std::visit([&](auto& store) { store.full = !storeVolume_; }, maps.volume);
    return maps;
}

std::vector<TracedPaths> PhotonPass::traceWave(uint64_t first, uint64_t last, const PhotonContext& context,
                                               const PassInfo& pass, const SurfaceConnections* connections) const {
    std::vector<TracedPaths> batches((last - first + PathsPerBatch - 1) / PathsPerBatch,
                                     TracedPaths(settings_.primitive));
    tbb::parallel_for(size_t(0), batches.size(), [&](size_t b) {
        const uint64_t begin = first + b * PathsPerBatch, end = std::min(begin + PathsPerBatch, last);
        tracePaths(begin, end, context, pass, connections, batches[b]);
    });
    return batches;
}

PhotonMaps PhotonPass::trace(const PassInfo& pass, SurfaceConnections* connections, Statistics& statistics) const {
    const PhotonSettings settings = settingsOf(pass);
    // Pilots.
    if (connections) setLightPerConnection(pass, settings, *connections, statistics);
    const auto counts = recordCounts(pass, settings, statistics);

    PhotonContext context = contextOf(pass, settings);
    context.frameShift = Sampler(pass.seed, RandomStream::Frame, pass.index, 0).next1D();
    context.connects = connections != nullptr;
    context.densityPhotons = densityPhotons_;
    context.glossyCameraSubpaths = glossyCameraSubpaths_;
    context.recordCounts = counts.get();

    PhotonMaps maps = emptyMaps();
    const uint64_t least = connections ? leastPathsFor(*connections) : 0;
    const auto finished = [&] {
        return isFull(maps.volume) && (connections ? maps.paths >= least : maps.surface.full);
    };
    Sampler thinning(pass.seed, RandomStream::Folded, pass.index, 1);
    pass.watch.stage("photons", settings.photonCount);
    while (maps.paths < settings.photonCount && !finished()) {
        const uint64_t last = std::min(maps.paths + PathsPerBatch * BatchesPerWave, settings.photonCount);
        context.storeSurface = !maps.surface.full;
        context.storeVolume = !isFull(maps.volume);
        const std::vector<TracedPaths> wave = traceWave(maps.paths, last, context, pass, connections);
        if (maps.paths == 0) reserveStores(maps, wave, settings);
        for (const TracedPaths& batch : wave) {
            append(maps, batch.deposits, settings, thinning);
            report(batch, statistics);
        }
        maps.paths = last;
    }
    reportStored(maps, settings_.primitive, statistics);
    return maps;
}

} // namespace tungsten::photon
