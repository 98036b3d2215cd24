#include "photon/AutoPrimitive.h"

#include "photon/Tuning.h"

#include "tungsten/render/EffectPlan.h"

namespace tungsten::photon {

AutoPrimitive AutoPrimitive::of(const Scene& scene, bool hasRadius) {
    const EffectPlan facts = analyseScene(scene);
    if (!facts.heterogeneousMedia.empty()) return {Points{}, "points: " + facts.heterogeneity()};
    const TransportSettings& transport = scene.transport;
    const float mostPeak = transport.cameraUnwarped ? tuning::MostUnwarpedPeak : tuning::MostSlicedPeak;
    if (transport.gate.delta && largestPeak(scene) > mostPeak)
        return {Points{}, "points: the phase function's forward peak makes slices noisy"};
    if (transport.gate.delta) {
        constexpr SliceKind Kind = SliceKind::MisVolumesBalls;
        const SliceClasses classes = SliceClasses::of(Kind, false, true, false);
        const bool oneTime = !facts.speedsDiffer || transport.cameraUnwarped;
        if (oneTime && (hasRadius || !slicesNeedBeams(scene, classes)))
            return {Slices{Kind, {}}, "mis_volumes_balls: a delta gate, to which volumes and balls need no kernel"};
        const std::string reason =
            oneTime ? "slices need a volume_gather_radius here" : "a delta gate, but several speeds of light";
        return hasRadius ? AutoPrimitive{Beams{}, "beams: " + reason} : AutoPrimitive{Points{}, "points: " + reason};
    }
    if (hasRadius) return {Beams{}, "beams: in gates that last, slices take far longer for the same noise"};
    return {Points{}, "points: beams need a volume_gather_radius"};
}

} // namespace tungsten::photon
