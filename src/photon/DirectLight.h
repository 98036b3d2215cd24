#pragma once
// Light that reaches visible surfaces straight from the lights, found along camera paths of its own: a narrow gate
// shows it as lines finer than pixels, and no photon blurs them.

#include "photon/LightConnection.h"
#include "photon/SensorRecord.h"

#include "tungsten/film/Film.h"

namespace tungsten::photon {

class DirectLight {
  public:
    DirectLight(const Scene& scene, const SensorPathRules& rules)
        : scene_(scene), rules_(rules), lights_(scene, false) {}

    /// Adds to the pass image what lights with a position send to surfaces that receivesConnections(), where photons
    /// have the share nearField / (nearField + d^2), d the distance to the light.
    void add(const Sensor& sensor, const SensorRecord& record, float nearField, const PassInfo& pass, Film& film,
             Statistics& statistics) const;

  private:
    /// Camera paths per pixel: several where some of the recorded points are lit inside the gate.
    [[nodiscard]] uint32_t paths(const Sensor& sensor, const SensorRecord& record, const PassInfo& pass) const;
    [[nodiscard]] std::optional<ArrivedLight> connect(const Sensor& sensor, float nearField, const SensorState& state,
                                                      const SurfaceInteraction& surface, Sampler& sampler,
                                                      uint64_t& rays) const;

    const Scene& scene_;
    SensorPathRules rules_;
    LightConnector lights_;
};

} // namespace tungsten::photon
