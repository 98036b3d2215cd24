#pragma once
// Rendering small scenes with the photon maps, and with the path tracer that they are compared with.

#include "path/PathTracer.h"
#include "photon/PhotonIntegrator.h"

#include "support/Render.h"
#include "support/VerifiedValues.h"

namespace tungsten::test {

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

} // namespace tungsten::test
