// Pilots of a photon pass: a few light paths of their own, which store nothing, but tell how the pass is to be traced.

#include "photon/Tuning.h"
#include "photon/light/DepositVisitor.h"
#include "photon/light/PhotonPass.h"
#include "photon/light/RecordImportance.h"
#include "photon/light/TracedPaths.h"

#include "transport/SharePilot.h"
#include "transport/Tuning.h"

#include "tungsten/integrator/Names.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

using transport::PathCosts;
using transport::SharePilot;

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
    explicit PhotonPilot(const VolumePrimitive& primitive) : traced(primitive) {}

    SharePilot rest, connected;
    TracedPaths traced;
    double plainRecords = 0.0, guidedRecords = 0.0;
    PathCosts costs, connections; ///< the latter of connections alone

    void begin(transport::Strategy strategy) {
        rest.begin(strategy);
        connected.begin(strategy);
    }
    /// Connections that would be best, over those that the pilot made: their variance is as 1 / n, their cost as n.
    [[nodiscard]] double effort(const transport::StrategyBalance& balance) const {
        // How bright slices are is known up to a factor.
        if (std::holds_alternative<DepositList<SliceRecord>>(traced.deposits.volume)) return 1.0;
        const double variance = connected.variance(balance), cost = connections.mean(balance);
        if (!(variance > 0.0) || !(cost > 0.0)) return 1.0;
        return std::clamp(std::sqrt(variance * costs.mean(balance) / std::max(rest.variance(balance) * cost, 1e-300)),
                          tuning::LeastEffort, tuning::MostEffort);
    }
    /// Variance x cost.
    [[nodiscard]] double score(const transport::StrategyBalance& balance) const {
        const double times = effort(balance);
        return (rest.variance(balance) + connected.variance(balance) / times) *
               (costs.mean(balance) + times * connections.mean(balance));
    }
    /// Whether either strategy has found so many effective contributions, of either kind that there is.
    [[nodiscard]] bool hasFound(double enough) const {
        const auto found = [&](const SharePilot& pilot) {
            return pilot.effective(transport::Strategy::Alone) == 0.0 ||
                   (pilot.effective(transport::Strategy::Plain) >= enough &&
                    pilot.effective(transport::Strategy::Guided) >= enough);
        };
        return found(rest) && found(connected);
    }
    /// Plain's share of the time, judged by what is not connected, if there is anything.
    [[nodiscard]] double choose() const {
        const SharePilot& judge = rest.effective(transport::Strategy::Alone) > 0.0 ? rest : connected;
        return judge.choose(costs, [&](const transport::StrategyBalance& balance) { return score(balance); });
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
                             Statistics& statistics) {
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
    PhotonPilot pilot(settings_.primitive);
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
    balance_ = pilot.costs.ofTime(asked ? double(*asked) : pilot.choose());
    connectionEffort_ = pilot.effort(balance_);
    statistics.add(counter::PilotPaths, path);
    const auto thousandths = [](double part) { return uint64_t(std::lround(1000.0 * part)); };
    statistics.add("plain light paths, in thousandths", thousandths(double(balance_.plain)));
    statistics.add("connections over the pilot's, in thousandths", thousandths(connectionEffort_));
}

} // namespace tungsten::photon
