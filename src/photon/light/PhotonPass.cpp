#include "photon/light/PhotonPass.h"

#include "photon/Tuning.h"
#include "photon/light/DepositVisitor.h"
#include "photon/light/RecordImportance.h"
#include "photon/store/Store.h"

#include "transport/SharePilot.h"
#include "transport/Tuning.h"

#include "tungsten/integrator/Names.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

using transport::PathCosts;
using transport::SharePilot;

/// What one task's light paths have left, and counted.
struct TracedPaths {
    explicit TracedPaths(const VolumePrimitive& primitive) : deposits(primitive) {}
    Deposits deposits;
    /// Counts by whose work it was: of plain paths, of what guided steps are asked about them, of guided paths.
    PhotonCounters plain, densities, guided;

    [[nodiscard]] uint64_t rays() const { return plain.rays + densities.rays + guided.rays; }
};

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

// ---- Pilots: a few light paths of their own, which store nothing, but tell how the pass is to be traced

namespace {

/// Pilot paths of a pass, which tell what connections and records bring. Variance x CPU of best points, cornell-fog,
/// the same: 0.0302, 0.0300 and 0.0298 at 32, 256 and 2048. Bench: study cbox-128
constexpr uint64_t PilotPaths = 256;

} // namespace

Deposits PhotonPass::tracePilots(const PhotonContext& context, const PassInfo& pass, uint64_t paths,
                                 Statistics& statistics) const {
    TracedPaths pilot(context.settings.primitive);
    PhotonTrail trail;
    for (uint64_t path = 0; path < paths; ++path) {
        pass.watch.advance(0);
        const Sampler sampler(pass.seed, RandomStream::Pilot, pass.index, path);
        tracePath(path, context, sampler, nullptr, trail, pilot);
    }
    statistics.add(counter::Rays, pilot.rays());
    return std::move(pilot.deposits);
}

void PhotonPass::setLightPerConnection(const PassInfo& pass, const PhotonSettings& settings,
                                       SurfaceConnections& connections, Statistics& statistics) const {
    const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 64, 16, PilotPaths);
    PhotonContext context = contextOf(pass, settings);
    context.storeVolume = storeVolume_;
    const uint64_t frames = guidance_->choosesFrames() ? uint64_t(guidance_->frames().frames) : 1;
    std::vector<TracedPaths> pilots(paths, TracedPaths(settings_.primitive));
    tbb::parallel_for(uint64_t(0), paths, [&](uint64_t path) {
        pass.watch.advance(0);
        const Sampler sampler(pass.seed, RandomStream::Pilot, pass.index, path);
        TracedPaths& pilot = pilots[path];
        const uint64_t aim = frames > paths ? path * frames / paths : path; // all over the sequence
        PhotonTrail trail;
        tracePath(aim, context, sampler, &connections, trail, pilot);
    });
    std::vector<float> expectedLight;
    for (const TracedPaths& pilot : pilots) {
        expectedLight.insert(expectedLight.end(), pilot.deposits.expectedLight.begin(),
                             pilot.deposits.expectedLight.end());
        statistics.add(counter::Rays, pilot.rays());
    }
    connections.setLightPerConnection(
        lightPerConnection(std::move(expectedLight), connectionEffort_ * tuning::ConnectionsPerPath * double(paths)));
}

std::unique_ptr<RecordBudget> PhotonPass::recordCounts(const PassInfo& pass, const PhotonSettings& settings,
                                                       Statistics& statistics) const {
    if (!guidance_ || plainAlone() || !storeVolume_) return nullptr; // paths' own directions do
    const auto countsOf = [&]<typename Primitive>(const Primitive& primitive) -> std::unique_ptr<RecordBudget> {
        if constexpr (!Primitive::LimitsRecords)
            return nullptr;
        else {
            auto counts = std::make_unique<RecordBudget>(scene_, culling_.gate());
            const uint64_t paths = std::clamp<uint64_t>(settings.photonCount / 64, 16, PilotPaths);
            PhotonContext context = contextOf(pass, settings);
            context.storeVolume = true;
            context.recordCounts = counts.get();
            const Deposits deposits = tracePilots(context, pass, paths, statistics);
            const auto& list = std::get<DepositList<typename Primitive::Record>>(deposits.volume);
            counts->measure(list.records, primitive.classes);
            return counts;
        }
    };
    return std::visit(countsOf, settings.primitive);
}

namespace {

/// Whatever costs time in proportion to paths, but for records and connections, in nanoseconds.
double cost(const PhotonCounters& counters, const tuning::Costs::Walk& each) {
    return each.path * double(counters.paths) + each.vertex * double(counters.mediumEvents + counters.surfaceEvents) +
           each.ray * double(counters.rays - counters.connectionRays) +
           each.controlVertex * double(counters.controlVertices);
}

/// Cost of a record of the primitive in use, in nanoseconds.
double recordCost(const VolumePrimitive& primitive) {
    return std::visit(
        [](const auto& p) {
            return p.AtVertices      ? tuning::Nanoseconds.point
                   : p.LimitsRecords ? tuning::Nanoseconds.slice
                                     : tuning::Nanoseconds.beam;
        },
        primitive);
}

/// A pilot of both strategies: of what connections to surfaces bring, and of the rest.
struct PhotonPilot {
    PhotonPilot(const VolumePrimitive& primitive, double noisePerPath)
        : brightnessKnown(!std::holds_alternative<Slices>(primitive)), rest(!brightnessKnown),
          connected(!brightnessKnown), traced(primitive), noise(brightnessKnown ? noisePerPath : 0.0) {}

    bool brightnessKnown; ///< that of slices is known up to a factor
    SharePilot rest, connected;
    TracedPaths traced;
    double noise; ///< variance that is not of light paths, as if it were of each of a pass's
    double plainRecords = 0.0, guidedRecords = 0.0;
    PathCosts costs, connections; ///< the latter of connections alone

    void begin(transport::Strategy strategy) {
        rest.begin(strategy);
        connected.begin(strategy);
    }
    /// Connections that would be best, over those that the pilot made: their variance is as 1 / n, their cost as n.
    [[nodiscard]] double effort(const transport::StrategyBalance& balance) const {
        if (!brightnessKnown) return 1.0;
        const double variance = connected.variance(balance), cost = connections.mean(balance);
        if (!(variance > 0.0) || !(cost > 0.0)) return 1.0;
        return std::clamp(std::sqrt(variance * costs.mean(balance) / std::max(ofRest(balance) * cost, 1e-300)),
                          tuning::LeastEffort, tuning::MostEffort);
    }
    /// Variance of what is not connected.
    [[nodiscard]] double ofRest(const transport::StrategyBalance& balance) const {
        return rest.variance(balance) + noise;
    }
    /// Variance x cost.
    [[nodiscard]] double score(const transport::StrategyBalance& balance) const {
        const double times = effort(balance);
        return (ofRest(balance) + connected.variance(balance) / times) *
               (costs.mean(balance) + times * connections.mean(balance));
    }
    /// Whether either strategy has found so many effective contributions, of either kind of which any have been found.
    [[nodiscard]] bool hasFound(double enough) const {
        const auto any = [](const SharePilot& pilot) { return pilot.effective(transport::Strategy::Alone) > 0.0; };
        const auto found = [&](const SharePilot& pilot) {
            return !any(pilot) || (pilot.effective(transport::Strategy::Plain) >= enough &&
                                   pilot.effective(transport::Strategy::Guided) >= enough);
        };
        return (any(rest) || any(connected)) && found(rest) && found(connected);
    }
    /// Plain's share of the time, judged by what is not connected, if there is anything. Where importance is a guess,
    /// the guarantee counts beside it, half as much: at a share of the time the score is at most plain paths' over it.
    [[nodiscard]] double choose(bool guess) const {
        const SharePilot& judge = rest.effective(transport::Strategy::Alone) > 0.0 ? rest : connected;
        return judge.choose(
            [&](double plainTime) { return score(costs.ofTime(plainTime)) / (guess ? std::sqrt(plainTime) : 1.0); });
    }
};

/// Adds what one path has left to the pilot.
void addRecords(PhotonPilot& pilot, const RecordImportance& importance, const Deposits& left, const CameraRecord* seen,
                transport::Strategy strategy, const transport::StrategyBalance& balance) {
    const auto add = [&](const Contribution& contribution, const Weighed& weighed, bool isConnected = false) {
        const float own = contribution.value / balance.weight(strategy, weighed.logRatio);
        if (!(own > 0.0f) || !std::isfinite(own)) return;
        (isConnected ? pilot.connected : pilot.rest).tell(own, contribution.cell, weighed.logRatio, weighed.found);
    };
    std::visit(
        [&](const auto& list) {
            for (size_t i = 0; i < list.records.size(); ++i)
                for (const Contribution& part : importance.of(list.records[i])) add(part, left.weighed->volume[i]);
        },
        left.volume);
    for (size_t i = 0; i < left.surface.records.size(); ++i)
        add(importance.onSurface(left.surface.records[i]), left.weighed->surface[i]);
    for (size_t i = 0; seen && i < left.received.size(); ++i)
        add(importance.ofConnection(left.received[i], seen->points[left.received[i].point]), left.weighed->received[i],
            true);
}

} // namespace

void PhotonPass::chooseShare(const ProgressToken& watch, SurfaceConnections* connections, const CameraRecord* seen,
                             double noise, Statistics& statistics) {
    const std::optional<float> asked = settings_.policy.plainShare;
    if (asked && *asked == 1.0f) {
        balance_ = {1.0f, 0.0f};
        return;
    }
    const StageTimer timer(statistics, "pilot of plain and guided light paths");
    watch.stage("pilot of plain and guided light paths", transport::tuning::MostPilotPaths);
    balance_ = {0.5f, 0.5f};
    const PassInfo pass{.seed = transport::PilotKey, .watch = watch};
    Statistics ignored;
    if (connections) setLightPerConnection(pass, settings_, *connections, ignored);
    const auto counts = recordCounts(pass, settings_, ignored);
    PhotonContext context = contextOf(pass, settings_);
    context.connects = connections != nullptr;
    context.densityPhotons = false; // they bring nothing
    context.glossyCameraSubpaths = glossyCameraSubpaths_;
    context.recordCounts = counts.get();
    context.storeVolume = storeVolume_;
    context.storeSurface = storeSurface_;
    const RecordImportance importance(scene_, settings_, transport::TimeSensor::of(scene_, culling_.gate()));
    PhotonPilot pilot(settings_.primitive, noise * double(settings_.photonCount));
    TracedPaths& traced = pilot.traced;
    PhotonTrail trail;
    const auto count = [&] {
        const double overhead = passOverhead();
        const double record = recordCost(settings_.primitive) + overhead / double(settings_.volumePhotonCount);
        pilot.costs = {cost(traced.plain, tuning::Nanoseconds.plain) + record * pilot.plainRecords,
                       tuning::Nanoseconds.trail * double(traced.plain.mediumEvents + traced.plain.surfaceEvents) +
                           tuning::Nanoseconds.density * double(traced.densities.densities) +
                           tuning::Nanoseconds.plain.ray * double(traced.densities.rays),
                       cost(traced.guided, tuning::Nanoseconds.guided) + record * pilot.guidedRecords,
                       overhead / double(settings_.photonCount) * double(traced.plain.paths)};
        pilot.connections = {tuning::Nanoseconds.connection * double(traced.plain.connectionRays), 0.0,
                             tuning::Nanoseconds.connection * double(traced.guided.connectionRays)};
    };
    uint64_t path = 0;
    while (path < transport::tuning::MostPilotPaths) {
        for (int i = 0; i < SharePilot::PathsOfPixel; ++i, ++path) {
            const bool guides = i % 2 == 1;
            const auto strategy = guides ? transport::Strategy::Guided : transport::Strategy::Plain;
            const Sampler sampler(pass.seed, RandomStream::Photon, 0, path);
            pilot.begin(strategy);
            traced.deposits = Deposits(settings_.primitive);
            traced.deposits.weighed.emplace();
            if (guides)
                traceGuidedPhotons(context, *guidance_, connections, sampler, path, traced.deposits, traced.guided);
            else
                tracePlainBesideGuided(context, *guidance_, connections, sampler, trail, traced.deposits, traced.plain,
                                       traced.densities);
            (guides ? pilot.guidedRecords : pilot.plainRecords) += double(traced.deposits.volumeRecords());
            addRecords(pilot, importance, traced.deposits, seen, strategy, balance_);
        }
        watch.advance();
        if (path < transport::tuning::LeastPilotPaths) continue;
        count();
        if (pilot.costs.sum() + pilot.connections.sum() > double(transport::tuning::MostPilotCost)) break;
        constexpr double Enough = 10.0 * transport::tuning::LeastEffective;
        if ((path & (path - 1)) == 0 && pilot.hasFound(Enough)) break;
    }
    balance_ =
        pilot.costs.ofTime(asked ? double(*asked) : pilot.choose(!importance.seesDirectly() && pilot.brightnessKnown));
    connectionEffort_ = pilot.effort(balance_);
    statistics.add(counter::PilotPaths, path);
    const auto thousandths = [](double part) { return uint64_t(std::lround(1000.0 * part)); };
    statistics.add("plain light paths, in thousandths", thousandths(double(balance_.plain)));
    statistics.add("connections over the pilot's, in thousandths", thousandths(connectionEffort_));
}

} // namespace tungsten::photon
