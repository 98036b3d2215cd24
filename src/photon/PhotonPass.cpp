#include "photon/PhotonPass.h"

#include "photon/GuidedPhotonWalk.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

constexpr uint64_t PathsPerBatch = 256;
constexpr uint64_t BatchesPerWave = 16; ///< traced in parallel, then appended in order

/// A pass goes on until vertices have connected so often to surfaces, on average over the points.
constexpr uint64_t ConnectionsPerPoint = 8;

/// What one batch of consecutive paths deposits, with each path's share.
struct Batch {
    DepositList surface, volume;
    std::vector<PixelContribution> contributions;
    WalkCounters counters;
};

Distribution1D powerDistribution(const Scene& scene) {
    std::vector<float> powers;
    for (const Emitter& emitter : scene.emitters) powers.push_back(meanComponent(emitterPower(emitter)));
    return Distribution1D(powers);
}

/// Appends the batch path by path until the store is full.
void append(PhotonStore& store, const DepositList& deposits, uint64_t capacity) {
    if (store.full) return;
    size_t start = 0;
    for (const uint32_t end : deposits.pathEnds) {
        if (store.photons.size() + (end - start) > capacity) {
            store.full = true;
            return;
        }
        store.photons.insert(store.photons.end(), deposits.photons.begin() + ptrdiff_t(start),
                             deposits.photons.begin() + ptrdiff_t(end));
        ++store.paths;
        start = end;
    }
}

/// Room for what the first wave lets expect, so that growing does not hold the photons twice.
void reserveStores(PhotonMaps& maps, const std::vector<Batch>& wave, const PhotonSettings& settings) {
    uint64_t surface = 0, volume = 0, paths = 0;
    for (const Batch& batch : wave) {
        surface += batch.surface.photons.size();
        volume += batch.volume.photons.size();
        paths += batch.surface.pathEnds.size();
    }
    constexpr double Margin = 1.02;
    const double scale = Margin * double(settings.photonCount) / double(std::max<uint64_t>(paths, 1));
    maps.surface.photons.reserve(std::min(settings.photonCount, uint64_t(double(surface) * scale)));
    maps.volume.photons.reserve(std::min(settings.volumePhotonCount, uint64_t(double(volume) * scale)));
}

} // namespace

PhotonPass::PhotonPass(const Scene& scene, const PhotonSettings& settings, const EffectPlan& plan)
    : scene_(scene), settings_(settings), arrival_(scene, plan),
      guidance_(PhotonGuidance::make(scene, settings.scheme, plan)), emitters_(powerDistribution(scene)),
      storeVolume_(plan.mediumScattering), storeSurface_(settings.includeSurfaces && plan.surfaceScattering) {
    if (!guidance_ || !guidance_->choosesFrames()) return;
    const TimeGate& gate = scene.transport.gate;
    for (int frame = 0; frame < gate.frames; ++frame) {
        frameArrivals_.push_back(arrival_);
        frameArrivals_.back().setGate({false, false, gate.frameStart(frame), gate.frameWidth, 1});
    }
}

PhotonMaps PhotonPass::trace(const PassInfo& pass, const SurfaceConnections* connections,
                             Statistics& statistics) const {
    PhotonMaps maps;
    maps.surface.full = !storeSurface_;
    maps.volume.full = !storeVolume_;
    uint64_t traced = 0;
    const uint64_t wanted = connections ? ConnectionsPerPoint * connections->points() : 0;
    const auto finished = [&] {
        return maps.volume.full && (connections ? maps.contributions.size() >= wanted : maps.surface.full);
    };
    while (traced < settings_.photonCount && !finished()) {
        const uint64_t wave = std::min(settings_.photonCount - traced, PathsPerBatch * BatchesPerWave);
        std::vector<Batch> batches((wave + PathsPerBatch - 1) / PathsPerBatch);
        const WalkContext context{
            scene_,    settings_,          arrival_,          frameArrivals_,
            emitters_, !maps.surface.full, !maps.volume.full, connections ? connections->nearField() : 0.0f};
        tbb::parallel_for(size_t(0), batches.size(), [&](size_t b) {
            const uint64_t first = traced + b * PathsPerBatch, last = std::min(first + PathsPerBatch, traced + wave);
            Batch& batch = batches[b];
            for (uint64_t path = first; path < last; ++path) {
                const Sampler sampler(pass.seed, RandomStream::Photon, pass.index, path);
                if (guidance_)
                    GuidedPhotonWalk(context, *guidance_, connections, sampler, path, batch.surface, batch.volume,
                                     batch.contributions, batch.counters)
                        .run();
                else
                    PhotonWalk(context, sampler, batch.surface, batch.volume, batch.counters).run();
                batch.surface.endPath();
                batch.volume.endPath();
            }
        });
        if (traced == 0) reserveStores(maps, batches, settings_);
        for (const Batch& batch : batches) {
            maps.contributions.insert(maps.contributions.end(), batch.contributions.begin(), batch.contributions.end());
            append(maps.surface, batch.surface, settings_.photonCount);
            append(maps.volume, batch.volume, settings_.volumePhotonCount);
            statistics.add("rays", batch.counters.rays);
            statistics.add("control vertices", batch.counters.controlVertices);
        }
        traced += wave;
    }
    maps.paths = traced;
    statistics.add("surface connections", maps.contributions.size());
    statistics.add("photons", traced);
    statistics.add("stored surface photons", maps.surface.photons.size());
    statistics.add("stored volume photons", maps.volume.photons.size());
    return maps;
}

} // namespace tungsten::photon
