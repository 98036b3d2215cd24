// Pilots of a photon pass: a few light paths of their own, which store nothing, but tell how the pass is to be traced.

#include "photon/Tuning.h"
#include "photon/light/DepositVisitor.h"
#include "photon/light/PhotonPass.h"
#include "photon/light/TracedPaths.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// One after the other.
Deposits tracePilots(const PhotonContext& context, const PhotonGuidance& guidance, const PassInfo& pass, uint64_t paths,
                     Statistics& statistics) {
    TracedPaths pilot(context.settings.primitive);
    for (uint64_t path = 0; path < paths; ++path) {
        pass.watch.poll(0);
        const Sampler sampler(pass.seed, RandomStream::Pilot, pass.index, path);
        traceGuidedPhotons(context, guidance, nullptr, sampler, path, pilot.deposits, pilot.counters);
    }
    statistics.add("rays", pilot.counters.rays);
    return std::move(pilot.deposits);
}

} // namespace

std::unique_ptr<FirstUsefulness> PhotonPass::firstUsefulness(const PassInfo& pass, const PhotonSettings& settings,
                                                             Statistics& statistics) const {
    if (!guidance_ || !guidance_->leavesBodies() || guidance_->choosesFrames()) return nullptr;
    auto first = std::make_unique<FirstUsefulness>(scene_.media.size());
    const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 16, 16, tuning::FirstPaths);
    PhotonContext context = contextOf(pass, settings, nullptr);
    context.measured = first.get();
    tracePilots(context, *guidance_, pass, paths, statistics);
    return first;
}

void PhotonPass::setLightPerConnection(const PassInfo& pass, const PhotonSettings& settings,
                                       const FirstUsefulness* first, SurfaceConnections& connections,
                                       Statistics& statistics) const {
    const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 64, 16, tuning::PilotPaths);
    PhotonContext context = contextOf(pass, settings, first);
    context.storeVolume = storeVolume_;
    const uint64_t frames = guidance_->choosesFrames() ? uint64_t(guidance_->frames().frames) : 1;
    std::vector<TracedPaths> pilots(paths, TracedPaths(settings_.primitive));
    tbb::parallel_for(uint64_t(0), paths, [&](uint64_t path) {
        pass.watch.poll(0);
        const Sampler sampler(pass.seed, RandomStream::Pilot, pass.index, path);
        TracedPaths& pilot = pilots[path];
        const uint64_t aim = frames > paths ? path * frames / paths : path; // all over the sequence
        traceGuidedPhotons(context, *guidance_, &connections, sampler, aim, pilot.deposits, pilot.counters);
    });
    std::vector<float> expectedLight;
    uint64_t deposits = 0;
    for (const TracedPaths& pilot : pilots) {
        expectedLight.insert(expectedLight.end(), pilot.deposits.expectedLight.begin(),
                             pilot.deposits.expectedLight.end());
        deposits += pilot.deposits.volumeRecords();
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
            PhotonContext context = contextOf(pass, settings, first);
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

} // namespace tungsten::photon
