#include "transport/GuidancePlan.h"

#include "transport/DetectorLight.h"

namespace tungsten::transport {

std::string guidanceObstacle(const Scene& scene, const Policy& policy, const SceneFacts& facts) {
    if (!policy.guides()) return "the scene does not ask for it";
    if (!facts.timeResolved) return "steady state: there is no gate to aim at";
    return facts.mediumScattering ? heterogeneity(scene, facts) : whyNoScattering(facts);
}

darts::Settings settingsIn(const Medium& medium, const Policy& policy, darts::Mode mode, bool aims) {
    darts::Settings settings = policy.sampling.settings(mode, medium.phase.g(), medium.guided, medium.guidedPhase);
    // Directions of camera paths are guided for the sake of control vertices.
    const bool connects = mode == darts::Mode::Photon || policy.sampling.elliptical || policy.sampling.direction;
    if (!aims || !connects) settings.direction = darts::Direction::Phase;
    if (!aims) settings.greens = darts::Greens::None;
    return settings;
}

Decision tablesOf(const Scene& scene, const Policy& policy, darts::Mode mode, const SceneFacts& facts, bool aims) {
    bool any = false;
    for (size_t i = 0; i < scene.media.size(); ++i)
        any = any || (scene.media[i].scatters() && !facts.isExcluded(i) &&
                      settingsIn(scene.media[i], policy, mode, aims).direction == darts::Direction::Eda);
    return {any, any ? "directions are drawn from the published table" : "directions come from closed forms"};
}

Decision balanceOf(const Scene& scene, const Policy& policy, darts::Mode mode, const Decision& guidance, bool meets) {
    if (!guidance.on) return guidance;
    const bool known = std::ranges::all_of(scene.media, [&](const Medium& medium) {
        return !medium.scatters() || settingsIn(medium, policy, mode).hasDensities();
    });
    const bool on = meets && known;
    return {on, on ? "plain paths beside guided ones, each weighed by how densely both find what it has found"
                   : "the published method, single switches, a delta gate or frames one by one, in which plain paths "
                     "have no part"};
}

Decision detectorLightOf(const Scene& scene, const SceneFacts& facts, bool shown) {
    const bool on = shown && DetectorLight::mayReach(scene, facts);
    return {on, on ? "places of detectors are connected to lights that no ray meets"
                   : "no detector, rays meet every light, or include_surfaces is false"};
}

} // namespace tungsten::transport
