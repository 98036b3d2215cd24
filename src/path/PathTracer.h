#pragma once
// The integrator `path_tracer`: unbiased, steady state or time-resolved.

#include "path/ArrivalBound.h"
#include "path/LightChoice.h"
#include "path/PathSettings.h"

#include "tungsten/render/Integrator.h"

namespace tungsten::path {

class PathTracer : public Integrator {
  public:
    PathTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings);
    void plan(EffectPlan& plan) const override;
    void prepare(const EffectPlan& plan, Statistics& statistics) override;
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override;

  private:
    template <bool TimeResolved, bool Media>
    void renderTiles(const PassInfo& pass, Film& film, Statistics& statistics) const;

    std::shared_ptr<const Scene> scene_;
    PathSettings settings_;
    LightChoice lights_;
    ArrivalBound arrival_;
    bool timeResolved_ = false, media_ = false, forwardBoundaries_ = true;
};

} // namespace tungsten::path
