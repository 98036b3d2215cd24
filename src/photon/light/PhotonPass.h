#pragma once
// The photon pass: light paths from the emitters, plain or guided, and what they deposit in the stores.

#include "photon/PhotonSettings.h"
#include "photon/light/PhotonGuidance.h"
#include "photon/primitives/VolumePrimitive.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/store/ArrivalCulling.h"
#include "photon/surface/SurfaceConnections.h"
#include "transport/Balance.h"

#include "tungsten/integrator/Integrator.h"

namespace tungsten::photon {

struct Deposits;
struct TracedPaths;
struct PhotonContext;
struct PhotonCounters;
class PhotonTrail;

/// The stores of one pass.
struct PhotonMaps {
    Store<Photon> surface;
    VolumeStore volume;
    /// What vertices sent to visible points, by all paths of the pass.
    std::vector<ConnectionRecord> received;
    uint64_t paths = 0;
};

class PhotonPass {
  public:
    PhotonPass(const Scene& scene, const PhotonSettings& settings, const PhotonPlan& plan,
               const ProgressToken& watch = {});

    /// Traces up to photonCount paths, fewer once every store in use is full. Deterministic for a (seed, pass),
    /// whatever the threads.
    /// `connections`: surface points that vertices connect to; may be null. With them, surfaces do not wait for
    /// photons: the pass ends when the volume store, if any is in use, is full and there were paths for connections.
    [[nodiscard]] PhotonMaps trace(const PassInfo& pass, SurfaceConnections* connections, Statistics& statistics) const;
    /// How many light paths are plain and how many guided, from what a few of both bring: before the first pass, by
    /// numbers of its own, so that every part of a render chooses alike. `seen`: what the connections' points are of;
    /// both may be null. `noise`: variance of every pass's image, summed over pixels and frames, that is not of light
    /// paths. Only where plain and guided paths are side by side.
    void chooseShare(const ProgressToken& watch, SurfaceConnections* connections, const CameraRecord* seen,
                     double noise, Statistics& statistics);
    [[nodiscard]] bool plainAlone() const { return balance_.guided == 0.0f; }
    /// The passes that follow keep what this gate can see (a delta gate's temporal kernel) instead of the scene's.
    void setGate(const TimeGate& gate);
    [[nodiscard]] const ArrivalCulling& culling() const { return culling_; }
    /// Null when light paths are sampled plainly.
    [[nodiscard]] const PhotonGuidance* guidance() const { return guidance_.get(); }
    /// What a pass costs however many its paths are, in counted nanoseconds.
    [[nodiscard]] double passOverhead() const;

  private:
    /// Settings for its part of a whole pass, and with its kernels.
    [[nodiscard]] PhotonSettings settingsOf(const PassInfo& pass) const;
    /// What every walk is told; nothing is stored and nothing connected to.
    [[nodiscard]] PhotonContext contextOf(const PassInfo& pass, const PhotonSettings& settings) const;

    // What a pass learns from a few paths of their own: it must not depend on the paths that it is
    // for.
    /// So many paths, one after the other.
    Deposits tracePilots(const PhotonContext& context, const PassInfo& pass, uint64_t paths,
                         Statistics& statistics) const;
    /// Tells connections what each of them is to bring, from what a few paths find.
    void setLightPerConnection(const PassInfo& pass, const PhotonSettings& settings, SurfaceConnections& connections,
                               Statistics& statistics) const;
    /// Guided slices: how many records a base leaves, from what a few paths find.
    [[nodiscard]] std::unique_ptr<RecordBudget> recordCounts(const PassInfo& pass, const PhotonSettings& settings,
                                                             Statistics& statistics) const;

    [[nodiscard]] PhotonMaps emptyMaps() const;
    /// Paths [first, last) in batches of consecutive ones.
    [[nodiscard]] std::vector<TracedPaths> traceWave(uint64_t first, uint64_t last, const PhotonContext& context,
                                                     const PassInfo& pass, const SurfaceConnections* connections) const;
    void tracePaths(uint64_t first, uint64_t last, const PhotonContext& context, const PassInfo& pass,
                    const SurfaceConnections* connections, TracedPaths& traced) const;
    /// One path, plain or guided as its own number says.
    void tracePath(uint64_t path, const PhotonContext& context, const Sampler& sampler,
                   const SurfaceConnections* connections, PhotonTrail& trail, TracedPaths& traced) const;

    const Scene& scene_;
    const PhotonSettings& settings_;
    ArrivalCulling culling_;
    std::unique_ptr<PhotonGuidance> guidance_;
    std::vector<ArrivalCulling> frameCullings_; ///< when light paths aim at single frames
    Distribution1D emitters_;                   ///< proportional to power
    bool storeVolume_, storeSurface_, glossyCameraSubpaths_, densityPhotons_;
    uint64_t cameraPaths_;               ///< of a sample of a pixel
    transport::StrategyBalance balance_; ///< of plain and guided paths
    double connectionEffort_ = 1.0;      ///< connections of a path to surfaces, over those of the pilot
};

} // namespace tungsten::photon
