#pragma once
// Surface points of camera subpaths, connected to points of lights.

#include "photon/view/CameraSubpath.h"
#include "transport/Vertex.h"
#include "transport/GateBounds.h"
#include "transport/TimeSensor.h"

#include "tungsten/emitter/Emitter.h"
#include "tungsten/scene/LightChoice.h"

namespace tungsten::photon {

struct ArrivedLight {
    Rgb radiance{0.0f}; ///< at the sensor
    double time = 0.0;  ///< of arrival
};

struct LightConnection {
    const Emitter* emitter;
    float probability; ///< of the light's choice
    DirectSample direct;
    ArrivedLight arrived; ///< not weighed against other ways to find this light
};

class LightConnector {
  public:
    LightConnector(const Scene& scene, const SceneFacts& facts);

    /// `state` is the path up to the surface. None when nothing arrives, or outside the sensor's gate. Adds the rays
    /// traced to `rays`.
    [[nodiscard]] std::optional<LightConnection> connect(const transport::TimeSensor& sensor,
                                                         const CameraSubpath& state, const SurfaceInteraction& surface,
                                                         Sampler& sampler, uint64_t& rays) const;
    [[nodiscard]] const LightChoice& lights() const { return lights_; }

  private:
    const Scene& scene_;
    LightChoice lights_;
    transport::Connector connector_;
    transport::GateBounds bounds_;
};

} // namespace tungsten::photon
