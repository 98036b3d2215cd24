#include "photon/PhotonIntegrator.h"

#include "photon/PrimitivePilot.h"
#include "photon/Tuning.h"
#include "photon/primitives/Primitive.h"
#include "photon/surface/PathReuse.h"
#include "transport/SharePilot.h"

#include "tungsten/integrator/EarliestArrival.h"
#include "tungsten/integrator/Names.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// Where stages end, about, for progress alone: of a pass, of what comes before its samples, and of one sample.
constexpr double ImagePart = 0.6, RecordPart = 0.1, PhotonPart = 0.8, SharingPart = 0.1, SplatPart = 0.5;

/// Camera paths per pixel that look for surface points. One leaves the noise of lines that a narrow gate lights; more
/// cost little in small images alone, and in large ones there are more points than clusters can keep.
uint32_t surfaceSamples(const Vec2i& resolution) {
    const size_t pixels = size_t(resolution.x) * size_t(resolution.y);
    return pixels > VisiblePointClusters::MostPoints
               ? 1
               : uint32_t(std::clamp(tuning::SurfacePoints / pixels, tuning::LeastSurfaceSamples,
                                     tuning::MostSurfaceSamples));
}

} // namespace

PhotonIntegrator::PhotonIntegrator(std::shared_ptr<const Scene> scene, const ObjectReader& settings, bool progressive)
    : scene_(std::move(scene)), settings_(readPhotonSettings(settings, *scene_, progressive)) {}

PhotonIntegrator::PhotonIntegrator(std::shared_ptr<const Scene> scene, PhotonSettings settings)
    : scene_(std::move(scene)), settings_(std::move(settings)) {}

void PhotonIntegrator::plan(SceneFacts& facts, Features& features) const {
    // The temporal kernel of a delta gate reaches beyond it, in the first pass the most.
    excludeLate(*scene_, lastTime(*scene_) + (scene_->transport.gate.delta ? settings_.temporalRadius : 0.0), facts,
                features);
    PhotonPlan::of(*scene_, settings_, facts).describe(*scene_, settings_, facts, features);
}

void PhotonIntegrator::prepare(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) {
    if (settings_.alternatives.size() > 1) choosePrimitive(facts, watch, statistics);
    plan_ = PhotonPlan::of(*scene_, settings_, facts);
    forwardBoundaries_ = facts.forwardBoundaries || facts.everything;
    if (plan_.detectorLight.on) detectorLight_.emplace(*scene_, facts, transport::BounceLimits(scene_->transport));
    photonPass_ = std::make_unique<PhotonPass>(*scene_, settings_, plan_, watch);
    if (plan_.edaTable.on) statistics.add(counter::DirectionTables, photonPass_->guidance()->tables());
    if (plan_.oneFramePerPath.on)
        statistics.add(counter::FramesAimedAt, uint64_t(photonPass_->guidance()->frames().frames));
    if (settings_.boundaryKernels && plan_.volume.on)
        nearSurfaces_ = std::visit(
            [&](const auto& p) { return std::unique_ptr<NearSurfaces>(new auto(p.nearSurfaces(settings_, *scene_))); },
            settings_.primitive);
    rules_ = {settings_.includeSurfaces, plan_.glossyPaths.on};
    if (rules_.glossy) glossy_ = std::make_unique<GlossyLight>(*scene_, facts);
    if (plan_.sideBySide.on) chooseShare(watch, statistics);
}

void PhotonIntegrator::choosePrimitive(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) {
    const StageTimer timer(statistics, "pilot of volume primitives");
    const MeasuredPrimitive measured = measurePrimitives(scene_, settings_, facts, watch);
    statistics.add("pilot passes of volume primitives", measured.passes);
    settings_.primitive = measured.primitive;
    settings_.primitiveReason = measured.reason;
    settings_.alternatives.clear();
}

void PhotonIntegrator::chooseShare(const ProgressToken& watch, Statistics& statistics) {
    const PassInfo pass{.seed = transport::PilotKey, .watch = watch};
    const transport::TimeSensor sensor = transport::TimeSensor::of(*scene_, gate(0));
    photonPass_->setGate(sensor.gate);
    std::optional<CameraRecord> seen;
    std::unique_ptr<SurfaceConnections> connections;
    if (plan_.connections.on) {
        Statistics ignored;
        seen = record(pass, 0, ignored);
        connections = std::make_unique<SurfaceConnections>(
            *scene_, sensor, *seen, pass, ConnectionBlur::of(settings_.gatherRadius, 1.0f), forwardBoundaries_);
    }
    const Store<Photon> none;
    const GatherStructures lights{none, sensor, true, settings_.includeSurfaces, rules_, glossy_.get()};
    photonPass_->chooseShare(watch, connections.get(), seen ? &*seen : nullptr,
                             varianceOfLightsInView(*scene_, lights, pass) / double(plan_.cameraPaths), statistics);
}

double PhotonIntegrator::memoryBytes() const {
    const bool ends = settings_.boundaryKernels && scene_->geometry->boundsMin() != scene_->geometry->boundsMax();
    // Stores are counted full. How many kernels end at surfaces is not known: as many as there are light paths.
    const auto ending = double(std::min(settings_.volumePhotonCount, settings_.photonCount));
    const auto ofVolume = [&]<typename Primitive>(const Primitive&) {
        constexpr size_t Record = sizeof(typename Primitive::Record), Kernel = sizeof(float) + sizeof(KernelEdges);
        constexpr size_t AtSurface = Primitive::PartsAtSurfaces * (Record + Kernel);
        return double(settings_.volumePhotonCount) * double(Record) + (ends ? ending * double(AtSurface) : 0.0);
    };
    const double surface = settings_.includeSurfaces ? double(settings_.photonCount) * double(sizeof(Photon)) : 0.0;
    double volume = std::visit(ofVolume, settings_.primitive);
    for (const VolumePrimitive& one : settings_.alternatives) volume = std::max(volume, std::visit(ofVolume, one));
    const bool scatters =
        std::any_of(scene_->media.begin(), scene_->media.end(), [](const Medium& medium) { return medium.scatters(); });
    return surface + (scatters ? volume : 0.0);
}

bool PhotonIntegrator::leavesBias(const SceneFacts& facts) const {
    const PhotonPlan plan = PhotonPlan::of(*scene_, settings_, facts);
    return plan.volume.on || plan.surfacePhotons.on || plan.connections.on;
}

double PhotonIntegrator::kernelWidth(uint32_t pass) const {
    const uint32_t at = settings_.progressive ? pass : 0;
    if (!plan_.volume.on) return double(surfaceRadiusFactor(at, settings_.alpha));
    return std::visit([&](const auto& p) { return p.kernelWidth(settings_, scene_->transport.gate.delta, at); },
                      settings_.primitive);
}

uint32_t PhotonIntegrator::step(const PassInfo& pass) const {
    // Parts of a pass that make a whole one in all have its radii.
    return settings_.progressive ? uint32_t(double(pass.index) * pass.share) : 0;
}

TimeGate PhotonIntegrator::gate(uint32_t step, float kernel) const {
    const TimeGate& gate = scene_->transport.gate;
    if (!gate.delta) return gate;
    const double tau = settings_.temporalRadius * deltaGateFactor(step, settings_.volumeAlpha) * double(kernel);
    return {false, false, gate.start - tau, 2.0 * tau, 1};
}

bool PhotonIntegrator::onDeltaGate() const {
    return plan_.meetsDeltaGate && std::visit([](const auto& p) { return p.AtVertices; }, settings_.primitive);
}

GatherRays PhotonIntegrator::gatherRays(const PassInfo& pass) const {
    const float uRedirected = Sampler(pass.seed, RandomStream::Folded, pass.index, 0).next1D();
    return {plan_.splats(), plan_.indirectView && settings_.includeSurfaces, glossy_ ? tuning::HighlightPaths : 0,
            uRedirected};
}

void PhotonIntegrator::gatherVolume(VolumeStore&& maps, const PassInfo& pass, GatherStructures& structures,
                                    Statistics& statistics) const {
    const StageTimer timer(statistics, "build");
    const GatherRays rays = gatherRays(pass);
    const auto build = [&]<typename Primitive>(const Primitive& primitive) {
        auto& store = std::get<Store<typename Primitive::Record>>(maps);
        if (store.records.empty()) return;
        Radii radii = primitive.radii(settings_, scene_->transport.gate.delta, store.records, step(pass), pass.watch);
        const auto endKernels = [this, random = Sampler(pass.seed, RandomStream::Folded, pass.index, 2),
                                 watch = pass.watch,
                                 &statistics](Selection<typename Primitive::Record>& seen, bool splatted) {
            if (!nearSurfaces_) return;
            KernelEnds ends{*scene_, *nearSurfaces_, random, std::nullopt, watch};
            if (splatted) ends.view.emplace(scene_->camera);
            Primitive::endAtSurfaces(ends, seen.records, seen.radii);
            statistics.add(counter::EndedKernels,
                           uint64_t(std::ranges::count_if(
                               seen.radii.edges(), [](const KernelEdges& edges) { return edges.nearest.exists(); })));
        };
        structures.volume.template emplace<VolumeGather<Primitive>>(*scene_, structures.sensor, photonPass_->culling(),
                                                                    std::move(store), std::move(radii), endKernels,
                                                                    rays, pass.bias != nullptr);
    };
    std::visit(build, settings_.primitive);
}

void PhotonIntegrator::splat(GatherStructures& structures, const CameraRecords& records, const PassInfo& pass,
                             Film& film, Statistics& statistics) const {
    const StageTimer timer(statistics, "splat");
    const TimeGate& gate = structures.sensor.gate;
    const double perSample = (gate.steadyState ? 1.0 : gate.frameWidth) * double(pass.samples);
    std::visit(Overloaded{[](std::monostate) {},
                          [&](auto& gather) {
                              const uint64_t met =
                                  gather.splat(records, double(gather.scale()) / perSample, film, pass.watch);
                              statistics.add(gather.GatheredCounter, met);
                              statistics.add(counter::SplattedRecords, met);
                          }},
               structures.volume);
}

CameraRecord PhotonIntegrator::record(const PassInfo& pass, uint32_t sample, Statistics& statistics) const {
    const StageTimer timer(statistics, "camera record");
    const bool points = plan_.connections.on && sample == 0;
    return recordCameraSubpaths(
        *scene_, rules_, pass.seed, uint32_t(pass.firstSample + sample),
        {points, points ? surfaceSamples(scene_->camera.resolution) : 1, plan_.gathersAfterSplat}, statistics,
        pass.watch);
}

void PhotonIntegrator::splatAndGather(GatherStructures& structures, const CameraRecords& records, const PassInfo& pass,
                                      Film& film, Statistics& statistics) const {
    const double splatted = !structures.splatted ? 0.0 : !records.empty() && !plan_.gathersAfterSplat ? 1.0 : SplatPart;
    if (structures.splatted) splat(structures, records, pass.part(0.0, splatted), film, statistics);
    if (!records.empty() && !plan_.gathersAfterSplat) return;
    const StageTimer timer(statistics, "camera pass");
    if (records.empty())
        return renderCameraPass(*scene_, structures, nullptr, pass.part(splatted, 1.0), film, statistics);
    const double each = (1.0 - splatted) / double(records.size());
    for (size_t i = 0; i < records.size(); ++i)
        renderCameraPass(*scene_, structures, records[i],
                         pass.part(splatted + double(i) * each, splatted + double(i + 1) * each), film, statistics);
}

void PhotonIntegrator::addDetectorLight(const transport::TimeSensor& sensor, const PassInfo& pass, Film& film,
                                        Statistics& statistics) const {
    const StageTimer timer(statistics, "lights at detectors");
    const double scale = 1.0 / (double(pass.samples) * (sensor.gate.steadyState ? 1.0 : sensor.gate.frameWidth));
    tbb::parallel_for(0, film.width(), [&](int column) {
        pass.watch.advance(0);
        FrameSums sums(size_t(sensor.gate.frames), Vec3d(0.0));
        uint64_t rays = 0, arrivals = 0;
        const auto put = [&](const Rgb& radiance, double time, const Emitter& emitter) {
            const Rgb seen = radiance * sensor.weight(time);
            ++arrivals;
            sensor.spread(time, emitter, [&](int frame, float share) {
                const Rgb part = seen * share;
                sums[size_t(frame)] += Vec3d(part);
            });
        };
        for (uint32_t i = 0; i < pass.samples; ++i) {
            const auto sample = uint32_t(pass.firstSample + i);
            Sampler sampler(pass.seed, RandomStream::DetectorLight, sample, uint64_t(column));
            detectorLight_->sample(size_t(column), sampler, pass.watch, rays, put);
        }
        for (int frame = 0; frame < sensor.gate.frames; ++frame) {
            const Vec3d value = sums[size_t(frame)] * scale;
            const Rgb pixel(value);
            if (isFinite(pixel)) film.add(frame, column, 0, pixel);
            if (!isFinite(pixel)) statistics.add(counter::NonFiniteSamples, 1);
        }
        statistics.add(counter::ShadowRays, rays);
        statistics.add(counter::ArrivalsAtDetectors, arrivals);
    });
}

void PhotonIntegrator::addPassImage(GatherStructures& structures, const PhotonMaps& maps, const CameraRecord* first,
                                    const PassInfo& pass, Film& film, Statistics& statistics) const {
    if (plan_.connections.on) {
        const StageTimer timer(statistics, "path reuse");
        const float factor = surfaceRadiusFactor(step(pass), settings_.alpha) * structures.kernel;
        auto kernel = ReuseKernel::of(settings_.gatherRadius, factor);
        if (scene_->transport.gate.delta) kernel.time = structures.kernel;
        const auto asTraced = transport::TimeSensor::of(*scene_, gate(step(pass)));
        reuseAcrossPixels(*scene_, asTraced, *first, maps.received, kernel, 1.0 / double(maps.paths), film, statistics,
                          pass.watch.part(0.0, SharingPart));
    }
    if (detectorLight_) addDetectorLight(structures.sensor, pass.part(0.0, 0.0), film, statistics);
    const double begin = plan_.connections.on ? SharingPart : 0.0;
    if (!first) return splatAndGather(structures, {}, pass.part(begin, 1.0), film, statistics);
    const double each = (1.0 - begin) / double(pass.samples);
    for (uint32_t s = 0; s < pass.samples; s += plan_.cameraPaths) {
        const PassInfo part = pass.part(begin + s * each, begin + (s + plan_.cameraPaths) * each);
        std::vector<CameraRecord> further;
        for (uint32_t k = s > 0 ? 0 : 1; k < plan_.cameraPaths; ++k) further.push_back(record(part, s + k, statistics));
        CameraRecords together;
        if (s == 0) together.push_back(first);
        for (const CameraRecord& one : further) together.push_back(&one);
        splatAndGather(structures, together, part, film, statistics);
    }
}

void PhotonIntegrator::estimateBias(GatherStructures& structures, const PhotonMaps& maps, const CameraRecord* first,
                                    const PassInfo& pass, Film& film, Statistics& statistics) const {
    const StageTimer timer(statistics, "bias");
    Statistics unreported; // the pass's figures are those of its image
    structures.kernel = tuning::NarrowKernel;
    if (!onDeltaGate()) structures.sensor.gate = gate(step(pass), structures.kernel);
    std::visit(Overloaded{[](std::monostate) {},
                          [&](auto& volume) { volume.narrow(structures.kernel, structures.sensor, gatherRays(pass)); }},
               structures.volume);
    Film& bias = *pass.bias;
    addPassImage(structures, maps, first, pass, bias, unreported);
    // The bias is as the square of the kernel's width.
    const float extrapolation = 1.0f / (1.0f - sqr(structures.kernel));
    tbb::parallel_for(0, film.height(), [&](int y) {
        pass.watch.advance(0);
        for (int frame = 0; frame < film.frames(); ++frame)
            for (int x = 0; x < film.width(); ++x) {
                const Rgb narrow = bias.passPixel(frame, x, y);
                bias.set(frame, x, y, (film.passPixel(frame, x, y) - narrow) * extrapolation);
            }
    });
}

void PhotonIntegrator::renderPass(const PassInfo& asked, Film& film, Statistics& statistics) {
    // Camera paths beyond those asked for are numbered as if there were more samples.
    PassInfo pass = asked;
    pass.firstSample *= plan_.cameraPaths;
    pass.samples *= plan_.cameraPaths;
    const transport::TimeSensor sensor = transport::TimeSensor::of(*scene_, gate(step(pass)));
    const float surfaceFactor = surfaceRadiusFactor(step(pass), settings_.alpha);
    std::optional<CameraRecord> first;
    const double begin = 1.0 / double(1 + pass.samples);
    const PassInfo image = pass.part(0.0, pass.bias ? ImagePart : 1.0), before = image.part(0.0, begin);
    if (plan_.records()) first = record(before.part(0.0, RecordPart), 0, statistics);
    std::unique_ptr<SurfaceConnections> connections;
    if (plan_.connections.on) {
        const auto spread = ConnectionBlur::of(settings_.gatherRadius, surfaceFactor);
        connections = std::make_unique<SurfaceConnections>(*scene_, sensor, *first, pass, spread, forwardBoundaries_);
    }
    PhotonMaps maps;
    {
        const StageTimer timer(statistics, "photon pass");
        photonPass_->setGate(sensor.gate);
        maps = photonPass_->trace(before.part(RecordPart, PhotonPart), connections.get(), statistics);
    }
    GatherStructures structures{
        maps.surface, sensor,        plan_.splats(),        settings_.includeSurfaces,
        rules_,       glossy_.get(), settings_.gatherCount, settings_.gatherRadius * surfaceFactor};
    gatherVolume(std::move(maps.volume), before.part(PhotonPart, 1.0), structures, statistics);
    if (!maps.surface.records.empty()) {
        const StageTimer timer(statistics, "build");
        structures.surfaces = std::make_unique<NearestPhotons>(maps.surface.records);
    }
    const CameraRecord* recorded = first ? &*first : nullptr;
    addPassImage(structures, maps, recorded, image.part(begin, 1.0), film, statistics);
    if (pass.bias) estimateBias(structures, maps, recorded, pass.part(ImagePart, 1.0), film, statistics);
}

} // namespace tungsten::photon
