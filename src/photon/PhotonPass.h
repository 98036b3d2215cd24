#pragma once
// The photon pass: light paths from the emitters, plain free flights and directions, deposits in the stores.

#include "photon/ArrivalTest.h"
#include "photon/PhotonBeam.h"
#include "photon/PhotonSettings.h"

#include "tungsten/render/Integrator.h"

namespace tungsten::photon {

/// The stores of one pass.
struct PhotonMaps {
    PhotonStore surface, volume;
    BeamStore beams;
};

class PhotonPass {
  public:
    PhotonPass(const Scene& scene, const PhotonSettings& settings, const EffectPlan& plan);

    /// Traces up to photonCount paths, fewer once every store in use is full. Deterministic for a (seed, pass),
    /// whatever the threads.
    [[nodiscard]] PhotonMaps trace(const PassInfo& pass, Statistics& statistics) const;
    /// The passes that follow keep what this gate can see (a delta gate's temporal kernel) instead of the scene's.
    void setGate(const TimeGate& gate) { arrival_.setGate(gate); }
    [[nodiscard]] const ArrivalTest& arrival() const { return arrival_; }
    [[nodiscard]] bool storesVolume() const { return storeVolume_; }
    [[nodiscard]] bool storesSurface() const { return storeSurface_; }

  private:
    const Scene& scene_;
    const PhotonSettings& settings_;
    ArrivalTest arrival_;
    Distribution1D emitters_; ///< proportional to power
    bool storeVolume_, storeBeams_, storeSurface_;
};

} // namespace tungsten::photon
