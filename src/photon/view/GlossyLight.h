#pragma once
// Light that reaches glossy surfaces straight from the lights, where camera subpaths follow their lobes
// (CameraSubpathRules::glossy).

#include "photon/view/CameraSubpath.h"
#include "transport/GateBounds.h"
#include "transport/TimeSensor.h"
#include "transport/Vertex.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::photon {

struct ArrivedLight {
    Rgb radiance{0.0f}; ///< at the sensor
    double time = 0.0;  ///< of arrival
};

class GlossyLight {
  public:
    GlossyLight(const Scene& scene, const SceneFacts& facts);

    /// Connects to a point on a light, weighed against camera subpaths that hit the light. `state` is the path up to
    /// the glossy surface. None when nothing arrives, or outside the sensor's gate. Adds the rays traced to `rays`.
    [[nodiscard]] std::optional<ArrivedLight> connect(const transport::TimeSensor& sensor, const CameraSubpath& state,
                                                      const SurfaceInteraction& surface, Sampler& sampler,
                                                      uint64_t& rays) const;
    /// Weight of emission that a path hits behind a glossy surface: 0 in mirrors, which photons see to.
    [[nodiscard]] float emissionWeight(const CameraSubpath& state, const SurfaceInteraction& light) const;
    /// Highlights are finer than pixels, and a narrow gate leaves lines of them; the fog that a glossy surface shows is
    /// as fine near lights. Such pixels look for both along tuning::HighlightPaths paths, which gather nothing else.
    [[nodiscard]] bool oversampled(size_t pixel) const { return oversampled_[pixel] != 0; }

  private:
    const Scene& scene_;
    LightChoice lights_;
    transport::Connector connector_;
    transport::GateBounds bounds_;
    std::vector<uint8_t> oversampled_; ///< by pixel
};

} // namespace tungsten::photon
