#pragma once
// The photon pass: light paths from the emitters, plain or guided, and what they deposit in the stores.

#include "photon/ArrivalTest.h"
#include "photon/PhotonGuidance.h"
#include "photon/PhotonSettings.h"
#include "photon/PhotonStore.h"

#include "tungsten/render/Integrator.h"

namespace tungsten::photon {

/// The stores of one pass.
struct PhotonMaps {
    PhotonStore surface, volume;
};

class PhotonPass {
  public:
    PhotonPass(const Scene& scene, const PhotonSettings& settings, const EffectPlan& plan);

    /// Traces up to photonCount paths, fewer once every store in use is full. Deterministic for a (seed, pass),
    /// whatever the threads.
    [[nodiscard]] PhotonMaps trace(const PassInfo& pass, Statistics& statistics) const;
    [[nodiscard]] const ArrivalTest& arrival() const { return arrival_; }
    /// Null when light paths are sampled plainly.
    [[nodiscard]] const PhotonGuidance* guidance() const { return guidance_.get(); }
    [[nodiscard]] bool storesVolume() const { return storeVolume_; }
    [[nodiscard]] bool storesSurface() const { return storeSurface_; }

  private:
    const Scene& scene_;
    const PhotonSettings& settings_;
    ArrivalTest arrival_;
    std::unique_ptr<PhotonGuidance> guidance_;
    std::vector<ArrivalTest> frameArrivals_; ///< when light paths aim at single frames
    Distribution1D emitters_;                ///< proportional to power
    bool storeVolume_, storeSurface_;
};

} // namespace tungsten::photon
