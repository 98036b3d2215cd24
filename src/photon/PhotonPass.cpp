#include "photon/PhotonPass.h"

#include "photon/PhotonWalk.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

constexpr uint64_t PathsPerBatch = 1024;
constexpr uint64_t BatchesPerWave = 32; ///< traced in parallel, then appended in order

/// What one batch of consecutive paths deposits, with each path's share.
struct Batch {
    DepositList surface, volume;
    BeamList beams;
    WalkCounters counters;
};

Distribution1D powerDistribution(const Scene& scene) {
    std::vector<float> powers;
    for (const Emitter& emitter : scene.emitters) powers.push_back(meanComponent(emitterPower(emitter)));
    return Distribution1D(powers);
}

/// Appends the deposits path by path until the store is full.
template <typename Record>
void append(StoreState& store, std::vector<Record>& records, const std::vector<Record>& deposits,
            const std::vector<uint32_t>& pathEnds, uint64_t capacity) {
    if (store.full) return;
    size_t start = 0;
    for (const uint32_t end : pathEnds) {
        if (records.size() + (end - start) > capacity) {
            store.full = true;
            return;
        }
        records.insert(records.end(), deposits.begin() + ptrdiff_t(start), deposits.begin() + ptrdiff_t(end));
        ++store.paths;
        start = end;
    }
}

void append(PhotonMaps& maps, const Batch& batch, const PhotonSettings& settings) {
    append(maps.surface, maps.surface.photons, batch.surface.photons, batch.surface.pathEnds, settings.photonCount);
    append(maps.volume, maps.volume.photons, batch.volume.photons, batch.volume.pathEnds, settings.volumePhotonCount);
    append(maps.beams, maps.beams.beams, batch.beams.beams, batch.beams.pathEnds, settings.volumePhotonCount);
}

/// Room for what the first wave lets expect, so that growing does not hold the photons twice.
void reserveStores(PhotonMaps& maps, const std::vector<Batch>& wave, const PhotonSettings& settings) {
    uint64_t surface = 0, volume = 0, beams = 0, paths = 0;
    for (const Batch& batch : wave) {
        surface += batch.surface.photons.size();
        volume += batch.volume.photons.size();
        beams += batch.beams.beams.size();
        paths += batch.surface.pathEnds.size();
    }
    constexpr double Margin = 1.02;
    const double scale = Margin * double(settings.photonCount) / double(std::max<uint64_t>(paths, 1));
    maps.surface.photons.reserve(std::min(settings.photonCount, uint64_t(double(surface) * scale)));
    maps.volume.photons.reserve(std::min(settings.volumePhotonCount, uint64_t(double(volume) * scale)));
    maps.beams.beams.reserve(std::min(settings.volumePhotonCount, uint64_t(double(beams) * scale)));
}

} // namespace

PhotonPass::PhotonPass(const Scene& scene, const PhotonSettings& settings, const EffectPlan& plan)
    : scene_(scene), settings_(settings), arrival_(scene, plan), emitters_(powerDistribution(scene)),
      storeVolume_(plan.mediumScattering && settings.primitive == VolumePrimitive::Points),
      storeBeams_(plan.mediumScattering && settings.primitive == VolumePrimitive::Beams),
      storeSurface_(settings.includeSurfaces && plan.surfaceScattering) {}

PhotonMaps PhotonPass::trace(const PassInfo& pass, Statistics& statistics) const {
    PhotonMaps maps;
    maps.surface.full = !storeSurface_;
    maps.volume.full = !storeVolume_;
    maps.beams.full = !storeBeams_;
    uint64_t traced = 0;
    while (traced < settings_.photonCount && !(maps.surface.full && maps.volume.full && maps.beams.full)) {
        const uint64_t wave = std::min(settings_.photonCount - traced, PathsPerBatch * BatchesPerWave);
        std::vector<Batch> batches((wave + PathsPerBatch - 1) / PathsPerBatch);
        const WalkContext context{
            scene_, settings_, arrival_, emitters_, !maps.surface.full, !maps.volume.full, !maps.beams.full};
        tbb::parallel_for(size_t(0), batches.size(), [&](size_t b) {
            const uint64_t first = traced + b * PathsPerBatch, last = std::min(first + PathsPerBatch, traced + wave);
            Batch& batch = batches[b];
            for (uint64_t path = first; path < last; ++path) {
                PhotonWalk(context, {pass.seed, RandomStream::Photon, pass.index, path}, batch.surface, batch.volume,
                           batch.beams, batch.counters)
                    .run();
                batch.surface.endPath();
                batch.volume.endPath();
                batch.beams.endPath();
            }
        });
        if (traced == 0) reserveStores(maps, batches, settings_);
        for (const Batch& batch : batches) {
            append(maps, batch, settings_);
            statistics.add("rays", batch.counters.rays);
        }
        traced += wave;
    }
    statistics.add("photons", traced);
    statistics.add("stored surface photons", maps.surface.photons.size());
    statistics.add("stored volume photons", maps.volume.photons.size());
    statistics.add("photon beams", maps.beams.beams.size());
    return maps;
}

} // namespace tungsten::photon
