#include "photon/light/PhotonPass.h"

#include "photon/Tuning.h"
#include "photon/light/GuidedPhotonWalk.h"
#include "photon/light/PhotonWalk.h"
#include "photon/store/StoreFilling.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// Light paths traced by one task, which takes milliseconds, and tasks whose deposits wait to be appended in order: few
/// beside the stores.
constexpr uint64_t PathsPerBatch = 256, BatchesPerWave = 16;

struct Batch {
    explicit Batch(const VolumePrimitive& primitive) : deposits(primitive) {}
    Deposits deposits;
    WalkCounters counters;
};

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

size_t countOf(const VolumeDeposits& deposits) {
    return std::visit([](const auto& list) { return list.records.size(); }, deposits);
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

void append(PhotonMaps& maps, const Deposits& d, const PhotonSettings& settings, Sampler& sampler) {
    appendPaths(maps.surface, d.surface, settings.photonCount, sampler);
    withVolume(maps.volume, d.volume,
               [&](auto& store, const auto& list) { appendPaths(store, list, settings.volumePhotonCount, sampler); });
    maps.received.insert(maps.received.end(), d.received.begin(), d.received.end());
}

/// Room for what the first wave lets expect, so that growing does not hold the photons twice.
void reserveStores(PhotonMaps& maps, const std::vector<Batch>& wave, const PhotonSettings& settings) {
    uint64_t surface = 0, volume = 0, paths = 0;
    for (const Batch& batch : wave) {
        surface += batch.deposits.surface.records.size();
        volume += countOf(batch.deposits.volume);
        paths += batch.deposits.surface.pathEnds.size();
    }
    constexpr double Margin = 1.02;
    const double scale = Margin * double(settings.photonCount) / double(std::max<uint64_t>(paths, 1));
    maps.surface.records.reserve(std::min(settings.photonCount, uint64_t(double(surface) * scale)));
    const auto room = std::min(settings.volumePhotonCount, uint64_t(double(volume) * scale));
    std::visit([&](auto& store) { store.records.reserve(room); }, maps.volume);
}

/// A few paths of their own, one after the other, from which a pass learns: it must not depend on the paths that it is
/// for.
Deposits tracePilots(const WalkContext& context, const PhotonGuidance& guidance, const PassInfo& pass, uint64_t paths,
                     Statistics& statistics) {
    Batch pilot(context.settings.primitive);
    for (uint64_t path = 0; path < paths; ++path) {
        pass.watch.poll(0);
        const Sampler sampler(pass.seed, RandomStream::Pilot, pass.index, path);
        GuidedPhotonWalk(context, guidance, nullptr, sampler, path, pilot.deposits, pilot.counters).run();
    }
    statistics.add("rays", pilot.counters.rays);
    return std::move(pilot.deposits);
}

void report(const WalkCounters& counters, Statistics& statistics) {
    transport::reportSteps(counters, statistics);
    statistics.add("rays", counters.rays);
    statistics.add("control vertices", counters.controlVertices);
    statistics.add("non-finite samples", counters.nonFinite);
    statistics.add("volume deposits", counters.volumeDeposits);
    statistics.add("volume deposits that may count", counters.countingDeposits);
}

void reportStored(const PhotonMaps& maps, const VolumePrimitive& primitive, Statistics& statistics) {
    statistics.add("surface connections", maps.received.size());
    statistics.add("photons", maps.paths);
    statistics.add("stored surface photons", maps.surface.records.size());
    forEachPrimitive(primitive, [&](const auto& p) {
        using Record = typename std::decay_t<decltype(p)>::Record;
        const auto* store = std::get_if<Store<Record>>(&maps.volume);
        statistics.add(p.Stored, store ? store->records.size() : 0);
    });
}

} // namespace

PhotonPass::PhotonPass(const Scene& scene, const PhotonSettings& settings, const PhotonPlan& plan,
                       const PassWatch& watch)
    : scene_(scene), settings_(settings), culling_(scene, {plan.folds, plan.oneSpeed, plan.highestSpeed}),
      guidance_(plan.guidance.on ? std::make_unique<PhotonGuidance>(scene, settings.policy, plan, watch) : nullptr),
      emitters_(powerDistribution(scene, plan.lateEmitters)), storeVolume_(plan.volume.on),
      storeSurface_(plan.surfacePhotons.on), glossySensorPaths_(plan.glossyPaths.on),
      densityPhotons_(needsPhotonsBesideConnections(scene, plan.glossyPaths.on)) {
    if (!guidance_ || !guidance_->choosesFrames()) return;
    for (int frame = guidance_->darkFrames(); frame < scene.transport.gate.frames; ++frame)
        frameCullings_.push_back(culling_.ofFrame(frame));
}

void PhotonPass::setGate(const TimeGate& gate) {
    culling_.setGate(gate);
    if (guidance_) guidance_->setGate(gate);
}

std::unique_ptr<FirstUsefulness> PhotonPass::firstUsefulness(const PassInfo& pass, const PhotonSettings& settings,
                                                             Statistics& statistics) const {
    if (!guidance_ || !guidance_->leavesBodies() || guidance_->choosesFrames()) return nullptr;
    auto first = std::make_unique<FirstUsefulness>(scene_.media.size());
    const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 16, 16, tuning::FirstPaths);
    WalkContext context = contextOf(settings, nullptr);
    context.measured = first.get();
    tracePilots(context, *guidance_, pass, paths, statistics);
    return first;
}

void PhotonPass::setLightPerConnection(const PassInfo& pass, const PhotonSettings& settings,
                                       const FirstUsefulness* first, SurfaceConnections& connections,
                                       Statistics& statistics) const {
    // Paths of their own: it must not depend on the paths that it is for.
    const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 64, 16, tuning::PilotPaths);
    WalkContext context = contextOf(settings, first);
    context.storeVolume = storeVolume_;
    const uint64_t frames = guidance_->choosesFrames() ? uint64_t(guidance_->frames().frames) : 1;
    std::vector<Batch> pilots(paths, Batch(settings_.primitive));
    tbb::parallel_for(uint64_t(0), paths, [&](uint64_t path) {
        pass.watch.poll(0);
        const Sampler sampler(pass.seed, RandomStream::Pilot, pass.index, path);
        Batch& pilot = pilots[path];
        const uint64_t aim = frames > paths ? path * frames / paths : path; // all over the sequence
        GuidedPhotonWalk(context, *guidance_, &connections, sampler, aim, pilot.deposits, pilot.counters).run();
    });
    std::vector<float> expectedLight;
    uint64_t deposits = 0;
    for (const Batch& pilot : pilots) {
        expectedLight.insert(expectedLight.end(), pilot.deposits.expectedLight.begin(),
                             pilot.deposits.expectedLight.end());
        deposits += countOf(pilot.deposits.volume);
        statistics.add("rays", pilot.counters.rays);
    }
    // Paths until the store of photons or beams is full.
    const double perDeposit = double(paths) / double(std::max<uint64_t>(deposits, 1));
    const double expected = std::min(double(settings.volumePhotonCount) * perDeposit, double(settings.photonCount));
    const double perPath =
        std::clamp(tuning::ConnectionsPerPass / std::max(expected, 1.0), tuning::LeastPerPath, tuning::MostPerPath);
    connections.setLightPerConnection(lightPerConnection(std::move(expectedLight), perPath * double(paths)));
}

std::unique_ptr<RecordCounts> PhotonPass::recordCounts(const PassInfo& pass, const PhotonSettings& settings,
                                                       const FirstUsefulness* first, Statistics& statistics) const {
    if (!guidance_ || !storeVolume_) return nullptr;
    const auto countsOf = [&]<typename Primitive>(const Primitive& primitive) -> std::unique_ptr<RecordCounts> {
        if constexpr (!Primitive::CountsRecords)
            return nullptr;
        else {
            auto counts = std::make_unique<RecordCounts>(scene_, culling_.gate());
            const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 64, 16, tuning::PilotPaths);
            WalkContext context = contextOf(settings, first);
            context.storeVolume = true;
            context.recordCounts = counts.get();
            const Deposits deposits = tracePilots(context, *guidance_, pass, paths, statistics);
            const auto& list = std::get<DepositList<typename Primitive::Record>>(deposits.volume);
            counts->measure(list.records, primitive.classes);
            return counts;
        }
    };
    return std::visit(countsOf, settings.primitive);
}

PhotonSettings PhotonPass::settingsOf(const PassInfo& pass) const {
    PhotonSettings settings = settings_.ofShare(pass.share);
    if (!scene_.transport.gate.delta) return settings;
    const auto narrowed = float(culling_.gate().frameWidth / (2.0 * settings.temporalRadius));
    std::visit([&](auto& primitive) { primitive.narrow(narrowed); }, settings.primitive);
    return settings;
}

WalkContext PhotonPass::contextOf(const PhotonSettings& settings, const FirstUsefulness* first) const {
    return {.scene = scene_,
            .settings = settings,
            .culling = culling_,
            .frameCullings = frameCullings_,
            .emitters = emitters_,
            .first = first};
}

void PhotonPass::tracePaths(uint64_t first, uint64_t last, const WalkContext& context, const PassInfo& pass,
                            const SurfaceConnections* connections, Deposits& deposits, WalkCounters& counters) const {
    for (uint64_t path = first; path < last; ++path) {
        pass.watch.pollWithin(1, path);
        const Sampler sampler(pass.seed, RandomStream::Photon, pass.index, path);
        if (guidance_)
            GuidedPhotonWalk(context, *guidance_, connections, sampler, path, deposits, counters).run();
        else
            PhotonWalk(context, sampler, deposits, counters).run();
        deposits.endPath();
    }
    pass.watch.poll(last - first);
}

PhotonMaps PhotonPass::trace(const PassInfo& pass, SurfaceConnections* connections, Statistics& statistics) const {
    const PhotonSettings settings = settingsOf(pass);
    const auto usefulAtFirst = firstUsefulness(pass, settings, statistics);
    if (connections) setLightPerConnection(pass, settings, usefulAtFirst.get(), *connections, statistics);
    const auto counts = recordCounts(pass, settings, usefulAtFirst.get(), statistics);
    PhotonMaps maps;
    maps.surface.full = !storeSurface_;
    maps.volume = storeOf(settings_.primitive);
    std::visit([&](auto& store) { store.full = !storeVolume_; }, maps.volume);
    const auto volumeFull = [&] { return std::visit([](const auto& store) { return store.full; }, maps.volume); };
    uint64_t traced = 0;
    const uint64_t least = connections
                               ? std::min(tuning::ConnectionsPerPoint * connections->points(), tuning::MostLeast) /
                                     uint64_t(tuning::MostPerPath)
                               : 0;
    Sampler thinning(pass.seed, RandomStream::Folded, pass.index, 1);
    WalkContext context = contextOf(settings, usefulAtFirst.get());
    context.frameShift = Sampler(pass.seed, RandomStream::Frame, pass.index, 0).next1D();
    context.connects = connections != nullptr;
    context.densityPhotons = densityPhotons_;
    context.glossySensorPaths = glossySensorPaths_;
    context.recordCounts = counts.get();
    const auto finished = [&] { return volumeFull() && (connections ? traced >= least : maps.surface.full); };
    pass.watch.stage("photons", settings.photonCount);
    while (traced < settings.photonCount && !finished()) {
        const uint64_t wave = std::min(settings.photonCount - traced, PathsPerBatch * BatchesPerWave);
        std::vector<Batch> batches((wave + PathsPerBatch - 1) / PathsPerBatch, Batch(settings_.primitive));
        context.storeSurface = !maps.surface.full;
        context.storeVolume = !volumeFull();
        tbb::parallel_for(size_t(0), batches.size(), [&](size_t b) {
            const uint64_t first = traced + b * PathsPerBatch, last = std::min(first + PathsPerBatch, traced + wave);
            tracePaths(first, last, context, pass, connections, batches[b].deposits, batches[b].counters);
        });
        if (traced == 0) reserveStores(maps, batches, settings);
        for (const Batch& batch : batches) {
            append(maps, batch.deposits, settings, thinning);
            report(batch.counters, statistics);
        }
        traced += wave;
    }
    maps.paths = traced;
    reportStored(maps, settings_.primitive, statistics);
    return maps;
}

} // namespace tungsten::photon
