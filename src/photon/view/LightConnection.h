#pragma once
// Surface points of sensor paths, connected to points of lights.

#include "photon/view/Sensor.h"
#include "photon/view/SensorPath.h"

#include "tungsten/emitter/Emitter.h"
#include "tungsten/render/EffectPlan.h"
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
    LightConnector(const Scene& scene, const EffectPlan& plan);

    /// `state` is the path up to the surface. None when nothing arrives, or outside the sensor's gate. Adds the rays
    /// traced to `rays`.
    [[nodiscard]] std::optional<LightConnection> connect(const Sensor& sensor, const SensorState& state,
                                                         const SurfaceInteraction& surface, Sampler& sampler,
                                                         uint64_t& rays) const;
    [[nodiscard]] const LightChoice& lights() const { return lights_; }

  private:
    [[nodiscard]] bool mayArrive(const TimeGate& gate, double start, double distance) const;

    const Scene& scene_;
    LightChoice lights_;
    double highestSpeed_;
    bool oneSpeed_;
};

} // namespace tungsten::photon
