#include "photon/primitives/sliced/Slices.h"

#include "photon/PhotonSettings.h"
#include "photon/Tuning.h"
#include "photon/primitives/Primitive.h"
#include "photon/primitives/sliced/SliceSplat.h"

#include "tungsten/reader/Field.h"

namespace tungsten::photon {

SliceClasses SliceClasses::of(SliceKind kind, bool steadyState, bool lowOrders, bool onlyShared) {
    constexpr int Every = std::numeric_limits<int>::max();
    SliceClasses c;
    c.beams = true;
    // Planes need a temporal kernel at a delta gate, balls do not.
    const bool planes = kind == SliceKind::Planes || steadyState;
    c.lights = !planes;
    switch (kind) {
    case SliceKind::Planes:
        c.flights[2] = Bases::All;
        break;
    case SliceKind::Volumes:
    case SliceKind::VolumesBalls:
        c.flights[3] = Bases::All;
        if (planes) c.flights[2] = Bases::First;
        if (!planes) c.firstBall = c.lastBall = 1;
        break;
    case SliceKind::Balls:
        c.firstBall = 1;
        c.lastBall = Every;
        break;
    case SliceKind::MisVolumesBalls:
        c.flights[3] = Bases::All;
        c.firstBall = 1;
        c.lastBall = Every;
        c.shared = true;
        break;
    case SliceKind::Hypervolumes:
        c.flights[3] = Bases::First;
        c.flights[4] = Bases::All;
        c.firstBall = c.lastBall = 1;
        break;
    }
    if (!lowOrders || onlyShared) c.lights = c.beams = false;
    if (onlyShared) {
        c.firstBall = std::max(c.firstBall, 2);
        if (c.flights[2] == Bases::First) c.flights[2] = Bases::None;
    }
    return c;
}

// ---- The primitive

bool slicesNeedBeams(const Scene& scene, const SliceClasses& classes) {
    const auto fromBeams = [](const Emitter& emitter) { return emitter.isDelta() || emitter.isInfinite(); };
    return classes.beams && (!classes.lights || !scene.primitives.empty() ||
                             std::any_of(scene.emitters.begin(), scene.emitters.end(), fromBeams));
}

namespace {

/// |g| up to which slices show what paths do. A ball of 60 mean free paths before a lamp, light that has hardly turned,
/// kernels of 5 % of the ball, 12 s: slices 0.97 of plain paths at 0.9, 0.89 at 0.95; points 0.99 and 0.96.
constexpr float MostSlicedPeak = 0.9f;

} // namespace

float largestPeak(const Scene& scene) {
    float peak = 0.0f;
    for (const Medium& medium : scene.media)
        if (medium.scatters()) peak = std::max(peak, std::abs(medium.phase.g()));
    return peak;
}

void Slices::read(const ObjectReader& block, const Scene& scene, PhotonSettings& settings) {
    const std::string type = sliceName(kind).type;
    const bool steadyState = scene.transport.gate.steadyState;
    if (steadyState && !sliceName(kind).steadyState)
        block.problem("volume_photon_type", "'" + type +
                                                "' needs a time gate; in steady state there are points, beams, planes "
                                                "and volumes");
    classes = SliceClasses::of(kind, steadyState, settings.lowOrderScattering, settings.excludeNonMis);
    classes.shortFlights = settings.shortFlights;
    if (const float peak = largestPeak(scene); peak > MostSlicedPeak)
        block.warn("volume_photon_type", "'" + type +
                                             "' evaluates phase functions instead of drawing by them: with |g| of " +
                                             brief(peak) + " image and standard error may lack light; paths show it");
    if (!slicesNeedBeams(scene, classes)) return;
    classes.share = tuning::ShareBesideBeams;
    classes.sharedShare = tuning::SharedBesideBeams;
    settings.requireRadius(block, scene);
    if (scene.transport.gate.delta && classes.lights)
        classes.shortBeams = tuning::ShortBeamsInRadii * settings.volumeRadius;
}

std::string Slices::guidanceObstacle(const Scene& scene, bool speedsDiffer) {
    if (scene.transport.cameraUnwarped) return {}; // aimed at nothing, only bounded in time
    if (speedsDiffer) return "with several speeds of light guided slices take longer than they gain";
    if (largestPeak(scene) > tuning::MostGuidedPeak)
        return "the phase function's forward peak: guided slices are noisier than plain ones";
    return {};
}

double Slices::kernelWidth(const KernelSettings& settings, bool deltaGate, uint32_t step) {
    return flightRadiusFactor(settings, deltaGate, step);
}

Radii Slices::radii(const KernelSettings& settings, bool deltaGate, const std::vector<SliceRecord>&, uint32_t step,
                    const ProgressToken&) {
    // Radius of the beams among them.
    return settings.volumeRadius * float(flightRadiusFactor(settings, deltaGate, step));
}

uint64_t Slices::splat(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecords& records,
                       const Selection<SliceRecord>& slices, double scale, Film& film, const ProgressToken& watch) {
    uint64_t met = 0;
    for (const CameraRecord* record : records)
        met += splatSlices(scene, sensor, *record, slices.records, slices.radii, scale, film, watch);
    return met;
}

} // namespace tungsten::photon
