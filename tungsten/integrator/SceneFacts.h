#pragma once
// Which effects a scene calls for, each with a reason. Integrators build only what the plan says.

#include "tungsten/scene/Scene.h"

#include <string>
#include <vector>

namespace tungsten {

/// One effect: whether it is on, why, what in the scene is behind it, and what tells its work.
struct Effect {
    std::string name;
    bool on = false;
    std::string reason;
    std::vector<std::string> causes = {};   ///< paths as problems have them, such as `primitives[3]`; none when off
    std::vector<std::string> counters = {}; ///< of Statistics; each is 0 after a render with the effect off
};

/// What is sampled how, in a line each.
struct SamplingSummary {
    std::string paths;    ///< which strategies run, and what share each has
    std::string vertices; ///< how distances and directions are drawn
    std::string ends;     ///< what a path ends at, or leaves
};

struct EffectPlan {
    bool timeResolved = false; ///< gated or frames
    bool multipleFrames = false;
    bool mediumScattering = false;    ///< some medium a path can reach, in time, scatters
    bool surfaceScattering = false;   ///< some surface has a smooth lobe
    bool specularSensorPaths = false; ///< mirrors or refraction exist: sensor paths can fold
    bool speedsDiffer = false;        ///< light travels at different speeds in different regions
    float highestSpeed = 1.0f;        ///< of light, in any region that a path can reach
    bool greyMedia = true;            ///< all media have equal coefficients in all channels
    std::string heterogeneousMedia;   ///< names of media that a path can reach and whose coefficients vary
    bool forwardBoundaries = false;   ///< index-matched boundaries: shadow rays must look through them
    bool surfaceEmission = false;     ///< emitters that camera rays can hit
    bool environment = false;
    bool textures = false;

    /// `--effects all`: stages run that the scene does not call for, and nothing is left out. The image is the same.
    bool everything = false;
    std::vector<bool> late;           ///< by emitter: its light arrives after the gate; empty: none is known to
    bool nothingArrives = false;      ///< all emitters are late: the image is black, and not rendered
    bool surfacesOutOfTime = false;   ///< whatever surfaces show arrives after the gate
    std::vector<bool> mediaOutOfTime; ///< by medium: what it scatters arrives after the gate; empty: none is known to
    int darkFrames = 0;               ///< so many frames end before any light can arrive

    /// Why nothing may take a medium's coefficients for constant; empty where it may.
    [[nodiscard]] std::string heterogeneity() const {
        return heterogeneousMedia.empty() ? "" : "coefficients vary from place to place in " + heterogeneousMedia;
    }

    /// Why nothing is done for scattering in media; empty where something is.
    [[nodiscard]] std::string noScattering() const {
        if (mediumScattering) return "";
        return mediaOutOfTime.empty() ? "no medium scatters"
                                      : "what scattering media show arrives after the sensor has closed";
    }
    [[nodiscard]] bool isOutOfTime(size_t medium) const { return !mediaOutOfTime.empty() && mediaOutOfTime[medium]; }

    SamplingSummary sampling; ///< as integrators fill it in
    /// Every effect with its reason, integrators' own included, in order of description.
    std::vector<Effect> effects;
    /// Light of the scene that the image will lack, each with a reason; empty where it will have all.
    std::vector<std::string> lacks;

    void describe(const std::string& name, bool on, const std::string& reason,
                  const std::vector<std::string>& causes = {}, const std::vector<std::string>& counters = {}) {
        effects.push_back({name, on, reason, on ? causes : std::vector<std::string>{}, counters});
    }
    void lack(const std::string& light, const std::string& reason) {
        describe(light, false, reason);
        lacks.push_back(light + ": " + reason);
    }
    /// Counters by which an integrator tells the work of an effect that is described already.
    void count(const std::string& effect, const std::vector<std::string>& counters);
};

/// What the scene calls for, whatever the integrator. `everything`: EffectPlan::everything.
EffectPlan analyseScene(const Scene& scene, bool everything = false);

/// "name", or "#index" for the nameless.
std::string nameOf(const std::string& name, size_t index);

} // namespace tungsten
