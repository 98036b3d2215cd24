#pragma once
// The photon-map integrators: a photon pass, structures over its photons, a sensor pass.

#include "photon/PhotonPass.h"
#include "photon/PhotonSettings.h"

#include "tungsten/render/Integrator.h"

namespace tungsten::photon {

/// `photon_map`, `progressive_photon_map` and their transient forms. The progressive ones trace new photons and shrink
/// the radii every pass; the others trace the same photons in every pass.
class PhotonIntegrator : public Integrator {
  public:
    PhotonIntegrator(std::shared_ptr<const Scene> scene, const ObjectReader& settings, bool progressive);
    void plan(EffectPlan& plan) const override;
    void prepare(const EffectPlan& plan, Statistics& statistics) override;
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override;

  private:
    void describeGuidance(EffectPlan& plan) const;
    [[nodiscard]] std::vector<float> volumeRadii(const PhotonStore& store, uint32_t pass) const;

    std::shared_ptr<const Scene> scene_;
    PhotonSettings settings_;
    std::unique_ptr<PhotonPass> photonPass_;
    bool straightRays_ = false; ///< of one origin and speed: volume photons can be splatted, surfaces connected
    bool foldedRays_ = false;   ///< mirrors or refraction can be seen
};

} // namespace tungsten::photon
