#include "photon/AutoPrimitive.h"

#include "photon/Tuning.h"

#include "transport/Body.h"

#include "tungsten/integrator/SceneFacts.h"

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

/// What is in light's way, apart from boundaries that it passes straight on.
struct Obstacles {
    bool any = false;
    bool lenses = false; ///< some refract, with nothing inside that scatters
    bool others = false; ///< some reflect, scatter or shine, or refract light out of fog

    [[nodiscard]] bool onlyLenses() const { return lenses && !others; }
};
Obstacles obstaclesOf(const Scene& scene) {
    Obstacles found;
    for (const Primitive& primitive : scene.primitives) {
        const Medium* inside = primitive.boundsMedium ? scene.medium(primitive.inside) : nullptr;
        const bool hollow = !inside || !inside->scatters();
        for (const BsdfPtr& bsdf : primitive.bsdfs) {
            if (transport::passesStraight(*bsdf)) continue;
            found.any = true;
            (hollow && transport::refracts(*bsdf) ? found.lenses : found.others) = true;
        }
    }
    return found;
}

/// Pixels of the largest image for which slices beat beams. Their time is in proportion to it, as every record shows in
/// all of it; that of beams grows slowly. Among surfaces each pixel needs shadow rays besides, and beams are left what
/// scatters once after them: the more of the light scatters again, the longer slices are ahead.
double largestImage(const Scene& scene, const Obstacles& obstacles, double scatterings) {
    const bool unwarped = scene.transport.cameraUnwarped, delta = scene.transport.gate.delta;
    if (scene.primitives.empty()) return unwarped ? double(Infinity) : tuning::MostSlicedInOpenFog;
    if (!obstacles.any) return unwarped ? tuning::MostSlicedUnwarped : tuning::MostSlicedBehindBoundaries;
    if (!unwarped)
        return delta && !obstacles.lenses && scatterings <= tuning::MostScatteringsAmongSurfaces
                   ? tuning::MostSlicedAmongSurfaces
                   : 0.0;
    return std::min(scatterings, tuning::MostSharedScatterings) *
           (delta ? tuning::MostSlicedPerScattering : tuning::MostGatedPerScattering);
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
    const Obstacles obstacles = obstaclesOf(scene);
    const Vec2i& image = scene.camera.resolution;
    const double pixels = double(image.x) * double(image.y);
    const std::string size = std::to_string(image.x) + " x " + std::to_string(image.y) + " pixels";
    const bool gathered = transport.cameraUnwarped && !transport.gate.delta && obstacles.onlyLenses();
    if (hasRadius && gathered && pixels <= tuning::MostPlanedBehindLenses)
        return {Slices{SliceKind::Planes, {}}, "planes: light behind lenses, " + size};
    if (hasRadius && pixels > largestImage(scene, obstacles, scatterings.densest))
        return kernels(true, obstacles.any
                                 ? "surfaces are in the way, for which slices need shadow rays at all of " + size
                                 : "slices are drawn to all of " + size);
    const std::string what = many ? "light of many scatterings or in colours, " : "a time gate in fog, ";
    return {Slices{kind, {}}, std::string(sliceName(kind).type) + ": " + what + size};
}

} // namespace tungsten::photon
