#pragma once
// Rendering small scenes with the photon maps, and with the path and light tracers that they are compared with.

#include "support/Render.h"

namespace tungsten::test {

/// Overrides: presets of guiding, guided light paths alone, and photon beams.
inline const std::string PublishedPreset = "integrator.darts=published", BestPreset = "integrator.darts=best",
                         GuidedAlone = R"(integrator.darts={"plain_share": 0})",
                         BeamMap = "integrator.volume_photon_type=beams";

std::unique_ptr<Rendered> renderPathFile(const std::filesystem::path& file, const RenderOptions& options);
std::unique_ptr<Rendered> renderPaths(const std::string& json, const RenderOptions& options);
/// The light tracer.
std::unique_ptr<Rendered> renderLightFile(const std::filesystem::path& file, const RenderOptions& options);
std::unique_ptr<Rendered> renderLight(const std::string& json, const RenderOptions& options);
std::unique_ptr<Rendered> renderPhotonFile(const std::filesystem::path& file, const RenderOptions& options,
                                           bool progressive = true);
std::unique_ptr<Rendered> renderPhotons(const std::string& json, const RenderOptions& options);
std::unique_ptr<Rendered> renderBeams(const std::string& json, RenderOptions options);

/// Block means of two renders, 8 x 8 pixels, each within its combined error and `bias`, relative to the image's mean.
/// Pixels of a pass share photons: their errors add up at worst.
void expectSameBlocks(const Rendered& a, const Rendered& b, int frame, double bias, double largestError);

} // namespace tungsten::test
