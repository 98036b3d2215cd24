#pragma once
// Which effects a scene calls for, each with a reason. Integrators build only what the plan says.

#include "tungsten/scene/Scene.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace tungsten {

/// One effect and why it is on or off.
struct Effect {
    std::string name;
    bool on = false;
    std::string reason;
};

struct EffectPlan {
    bool timeResolved = false; ///< gated or frames
    bool multipleFrames = false;
    bool mediumScattering = false;    ///< some medium a path can reach scatters
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

    /// Why nothing may take a medium's coefficients for constant; empty where it may.
    [[nodiscard]] std::string heterogeneity() const {
        return heterogeneousMedia.empty() ? "" : "coefficients vary from place to place in " + heterogeneousMedia;
    }

    /// Every effect with its reason, integrators' own included, in order of description.
    std::vector<Effect> effects;
    /// Light of the scene that the image will lack, each with a reason; empty where it will have all.
    std::vector<std::string> lacks;

    void describe(const std::string& name, bool on, const std::string& reason) {
        effects.push_back({name, on, reason});
    }
    void lack(const std::string& light, const std::string& reason) {
        describe(light, false, reason);
        lacks.push_back(light + ": " + reason);
    }
};

EffectPlan analyseScene(const Scene& scene);
/// The plan as text, for `--explain`.
void printPlan(const EffectPlan& plan, std::ostream& out);

} // namespace tungsten
