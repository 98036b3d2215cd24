#include "tungsten/render/BlackImage.h"

namespace tungsten {

std::optional<Problem> blackImage(const Scene& scene, const EffectPlan& plan, const SessionResult& result) {
    if (plan.nothingArrives || result.film.passes() == 0 || !(result.film.meanSquare() == 0.0)) return std::nullopt;
    const TransportSettings& transport = scene.transport;
    std::string text = "the image is black: no path found light";
    for (const std::string& lack : plan.lacks) text += "; it lacks " + lack;
    if (transport.minBounces >= transport.maxBounces)
        text += "; min_bounces and max_bounces leave no number of interactions between them";
    else if (!plan.timeResolved)
        text += "; look at where lights and camera stand, what lies between them, and at max_bounces";
    else
        text += "; look at the times of the gate (a film of many frames shows when light arrives)";
    if (plan.timeResolved && !transport.cameraUnwarped)
        text += "; they count the way to the camera, unless the scene says \"camera_unwarped\": true";
    return Problem{scene.file.string(), "integrator", text};
}

} // namespace tungsten
