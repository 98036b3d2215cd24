#include "photon/AutoPrimitive.h"

#include "photon/Tuning.h"

#include "transport/Body.h"

#include "tungsten/render/EffectPlan.h"

namespace tungsten::photon {

namespace {

/// Mean of the scatterings on the way to the gate, in the medium that scatters most, and only in what the camera is in.
struct Scatterings {
    double densest = 0.0, aroundCamera = 0.0;
};
Scatterings scatteringsOf(const Scene& scene) {
    double first = Infinity;
    for (const Emitter& emitter : scene.emitters) first = std::min(first, emitter.emissionTime);
    const auto of = [&](const Medium& medium) {
        const double length = (scene.transport.gate.start - first) * double(medium.speedOfLight);
        return medium.scatters() ? std::max(length, 0.0) * double(meanComponent(medium.sigmaS())) : 0.0;
    };
    Scatterings found;
    for (const Medium& medium : scene.media) found.densest = std::max(found.densest, of(medium));
    if (const Medium* medium = scene.medium(scene.cameraRegion)) found.aroundCamera = of(*medium);
    return found;
}

/// All surfaces let light through straight on.
bool passesLight(const Scene& scene) {
    const auto passes = [](const BsdfPtr& bsdf) { return transport::passesStraight(*bsdf); };
    return std::all_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
        return std::all_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), passes);
    });
}

/// Pixels of the largest image for which slices beat beams. Their time is in proportion to it, as every record shows in
/// all of it; that of beams grows slowly.
double largestImage(const Scene& scene) {
    const bool unwarped = scene.transport.cameraUnwarped;
    if (scene.primitives.empty()) return unwarped ? double(Infinity) : tuning::MostSlicedInOpenFog;
    return unwarped ? tuning::MostSlicedUnwarped : tuning::MostSlicedBehindBoundaries;
}

AutoPrimitive kernels(bool beams, const std::string& reason) {
    return beams ? AutoPrimitive{Beams{}, "beams: " + reason} : AutoPrimitive{Points{}, "points: " + reason};
}

} // namespace

AutoPrimitive AutoPrimitive::of(const Scene& scene, bool hasRadius) {
    const EffectPlan facts = analyseScene(scene);
    const TransportSettings& transport = scene.transport;
    if (!facts.heterogeneousMedia.empty()) return kernels(false, facts.heterogeneity());
    if (!facts.timeResolved) return kernels(hasRadius, "no time gate");
    const Scatterings scatterings = scatteringsOf(scene);
    if (scatterings.densest > tuning::MostSlicedScatterings)
        return kernels(false, "light that scatters dozens of times before the gate");
    if (facts.speedsDiffer && !transport.cameraUnwarped)
        return kernels(hasRadius, "several speeds of light keep slices from being drawn");
    if (largestPeak(scene) > (transport.cameraUnwarped ? tuning::MostUnwarpedPeak : tuning::MostSlicedPeak))
        return kernels(hasRadius && !transport.cameraUnwarped, "the phase function's forward peak makes slices noisy");
    const bool many = scatterings.aroundCamera > tuning::MostSharedScatterings || !facts.greyMedia;
    const SliceKind kind = many ? SliceKind::Hypervolumes : SliceKind::MisVolumesBalls;
    const bool needsBeams = slicesNeedBeams(scene, SliceClasses::of(kind, false, true, false));
    if (needsBeams && !hasRadius) return kernels(false, "slices and beams need a volume_gather_radius here");
    if (hasRadius && !passesLight(scene))
        return kernels(true, "surfaces are in the way, for which slices need shadow rays all over the image");
    const Vec2i& image = scene.camera.resolution;
    const std::string size = std::to_string(image.x) + " x " + std::to_string(image.y) + " pixels";
    if (hasRadius && double(image.x) * double(image.y) > largestImage(scene))
        return kernels(true, "slices are drawn to all of " + size);
    const std::string what = many ? "light of many scatterings or in colours, " : "a time gate in fog, ";
    return {Slices{kind, {}}, std::string(sliceName(kind).type) + ": " + what + size};
}

} // namespace tungsten::photon
