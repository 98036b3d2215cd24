#pragma once
// What a render does and does not do, in sentences with reasons: `--explain`, `--stats`, results.

#include "tungsten/integrator/Names.h"
#include "tungsten/integrator/SceneFacts.h"

#include <string>
#include <vector>

namespace tungsten {

/// One feature: whether it is on, why, what in the scene is behind it, and what tells its work.
struct Feature {
    std::string name;
    bool on = false;
    std::string reason;
    std::vector<std::string> elements = {}; ///< paths as problems have them, such as `primitives[3]`; none when off
    std::vector<std::string> counters = {}; ///< of Statistics; each is 0 after a render with the feature off
};

/// What is sampled how, in a line each.
struct SamplingSummary {
    std::string paths;    ///< which strategies run, and what share each has
    std::string vertices; ///< how distances and directions are drawn
    std::string ends;     ///< what a path ends at, or leaves
};

/// The whole plan of a render for readers.
struct Features {
    SamplingSummary sampling; ///< as integrators fill it in
    /// Every feature with its reason, integrators' own included, in order of description.
    std::vector<Feature> all;
    /// Light of the scene that the image will lack, each with a reason; empty where it will have all.
    std::vector<std::string> limitations;

    void describe(const std::string& name, bool on, const std::string& reason,
                  const std::vector<std::string>& elements = {}, const std::vector<std::string>& counters = {}) {
        all.push_back({name, on, reason, on ? elements : std::vector<std::string>{}, counters});
    }
    /// The image will lack this light.
    void limit(const std::string& light, const std::string& reason) {
        describe(light, false, reason);
        limitations.push_back(light + ": " + reason);
    }
    /// Counters by which an integrator tells the work of a feature that is described already.
    void count(const FeatureName& feature, const std::vector<std::string>& counters);
};

/// Those that a scene calls for, whatever the integrator.
Features featuresOf(const Scene& scene, const SceneFacts& facts);

/// Reason to decline what needs a medium's coefficients to be constant; empty if all reachable media are homogeneous.
std::string heterogeneity(const Scene& scene, const SceneFacts& facts);
/// Reason to do nothing for scattering in media; empty where something is done.
std::string whyNoScattering(const SceneFacts& facts);

/// "name", or "#index" for the nameless.
std::string nameOf(const std::string& name, size_t index);

} // namespace tungsten
