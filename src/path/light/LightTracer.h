#pragma once
// The integrators `light_tracer` and `transient_light_tracer`: plain paths from the lights, unbiased for what is seen
// straight on, steady state or time-resolved.

#include "path/light/CameraConnections.h"

#include "tungsten/integrator/Integrator.h"

namespace tungsten::path {

class LightTracer : public Integrator {
  public:
    LightTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings);
    void plan(SceneFacts& facts, Features& features) const override;
    void prepare(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) override;
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override;

  private:
    std::shared_ptr<const Scene> scene_;
    transport::BounceLimits limits_;
    bool russianRoulette_, forwardBoundaries_ = true, splits_ = false;
    transport::TimeSensor sensor_;
    transport::GateBounds bounds_;
    Distribution1D emitters_;
};

} // namespace tungsten::path
