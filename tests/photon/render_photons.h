#pragma once
// Rendering small scenes with the photon maps, and with the path tracer that they are compared with.

#include "path/PathTracer.h"
#include "photon/PhotonIntegrator.h"

#include "support/GroundTruthScenes.h"
#include "support/Render.h"

namespace tungsten::test {

using Overrides = std::vector<std::string>;

inline std::unique_ptr<Rendered> renderPhotonFile(const std::filesystem::path& file, const RenderOptions& options) {
    return render(file, options, [](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<photon::PhotonIntegrator>(std::move(scene), settings, true);
    });
}
inline std::unique_ptr<Rendered> renderPhotons(const std::string& json, const RenderOptions& options) {
    return renderPhotonFile(SceneFile(json).path(), options);
}
inline std::unique_ptr<Rendered> renderBeams(const std::string& json, RenderOptions options) {
    options.overrides.insert(options.overrides.begin(), "integrator.volume_photon_type=beams");
    return renderPhotons(json, options);
}

inline std::unique_ptr<Rendered> renderPathFile(const std::filesystem::path& file, RenderOptions options) {
    options.overrides.emplace_back("integrator.type=path_tracer");
    return render(file, options, [](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<path::PathTracer>(std::move(scene), settings);
    });
}
inline std::unique_ptr<Rendered> renderPaths(const std::string& json, const RenderOptions& options) {
    return renderPathFile(SceneFile(json).path(), options);
}

inline std::string setting(const std::string& name, double value) {
    return "integrator." + name + "=" + std::to_string(value);
}

/// A verified value (photon-primitives, section 6).
struct VerifiedValue {
    char configuration; ///< A, B or C
    int order;
    bool unwarped, delta;
    double radiance;
};

/// Test names such as A2UnwarpedDelta.
inline std::string nameOf(const VerifiedValue& v) {
    return v.configuration + std::to_string(v.order) + (v.unwarped ? "Unwarped" : "Warped") +
           (v.delta ? "Delta" : "Box");
}

/// Half-width of a delta gate's temporal kernel.
inline constexpr double VerifiedTau = 0.1;

/// The configuration's scene: A's with forward scattering in B, and with a laser instead of the point in C.
inline std::string sceneOf(const VerifiedValue& v) {
    const bool laser = v.configuration == 'C';
    std::string json = configurationA(v.order, v.unwarped, laser ? 0.3 : v.configuration == 'B' ? 0.6 : 0.0);
    if (!laser) return json;
    const std::string point =
        R"({"type": "point", "emission": 1, "ext_medium": "fog", "transform": {"position": [1.2, 0.5, 2]}})";
    return json.replace(json.find(point), point.size(), R"({"type": "collimated", "emission": 1, "ext_medium": "fog",
        "transform": {"position": [1.2, 0.5, 2], "look_at": [-0.8, 0, 3], "up": [0, 1, 0]}})");
}
inline Overrides gateOf(const VerifiedValue& v) {
    const double unwarpedCentre = v.configuration == 'C' ? 3.5 : v.delta ? 2.2 : 2.5;
    Overrides overrides{setting("transient_time_center", v.unwarped ? unwarpedCentre : 5.5)};
    if (v.delta) {
        overrides.emplace_back("integrator.delta_time_gate=true");
        overrides.push_back(setting("transient_time_width", 2.0 * VerifiedTau));
    }
    return overrides;
}

} // namespace tungsten::test
