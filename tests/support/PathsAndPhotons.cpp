#include "support/PathsAndPhotons.h"

#include "path/PathTracer.h"
#include "path/light/LightTracer.h"
#include "photon/PhotonIntegrator.h"

namespace tungsten::test {

namespace {
template <typename Made>
std::unique_ptr<Rendered> renderBy(const std::filesystem::path& file, const RenderOptions& options) {
    return render(file, options, [](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<Made>(std::move(scene), settings);
    });
}
} // namespace

std::unique_ptr<Rendered> renderPathFile(const std::filesystem::path& file, const RenderOptions& options) {
    RenderOptions paths = options;
    paths.overrides.emplace_back("integrator.type=path_tracer");
    return renderBy<path::PathTracer>(file, paths);
}
std::unique_ptr<Rendered> renderPaths(const std::string& json, const RenderOptions& options) {
    return renderPathFile(SceneFile(json).path(), options);
}
std::unique_ptr<Rendered> renderLightFile(const std::filesystem::path& file, const RenderOptions& options) {
    return renderBy<path::LightTracer>(file, options);
}
std::unique_ptr<Rendered> renderLight(const std::string& json, const RenderOptions& options) {
    return renderLightFile(SceneFile(json).path(), options);
}

std::unique_ptr<Rendered> renderPhotonFile(const std::filesystem::path& file, const RenderOptions& options,
                                           bool progressive) {
    return render(file, options, [=](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<photon::PhotonIntegrator>(std::move(scene), settings, progressive);
    });
}
std::unique_ptr<Rendered> renderPhotons(const std::string& json, const RenderOptions& options) {
    return renderPhotonFile(SceneFile(json).path(), options);
}
std::unique_ptr<Rendered> renderBeams(const std::string& json, RenderOptions options) {
    const std::string beams = "integrator.volume_photon_type=beams";
    options.overrides.insert(options.overrides.begin(), beams);
    return renderPhotons(json, options);
}

} // namespace tungsten::test
