#pragma once
// The photon-map integrators: a photon pass, structures over its photons, a camera pass.

#include "photon/CameraPass.h"
#include "photon/PhotonPlan.h"
#include "photon/light/PhotonPass.h"
#include "transport/DetectorLight.h"

#include "tungsten/integrator/Integrator.h"

namespace tungsten::photon {

/// `photon_map`, `progressive_photon_map` and their transient forms. All trace new photons in every pass; the
/// progressive ones shrink the radii from pass to pass.
class PhotonIntegrator : public Integrator {
  public:
    PhotonIntegrator(std::shared_ptr<const Scene> scene, const ObjectReader& settings, bool progressive);
    PhotonIntegrator(std::shared_ptr<const Scene> scene, PhotonSettings settings);
    void plan(SceneFacts& facts, Features& features) const override;
    void prepare(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) override;
    /// Of a sample of a pixel.
    [[nodiscard]] uint32_t cameraPaths() const { return plan_.cameraPaths; }
    [[nodiscard]] double memoryBytes() const override;
    [[nodiscard]] bool leavesBias(const SceneFacts& facts) const override;
    [[nodiscard]] bool cutsLightPaths() const override { return true; }
    /// Width of the volume kernels over that of the first pass; of the surface kernels if no volume record is stored.
    [[nodiscard]] double kernelWidth(uint32_t pass) const override;
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override;
    /// Nanoseconds of a pass that do not grow with its light paths; after prepare().
    [[nodiscard]] double passOverhead() const { return photonPass_->passOverhead(); }

  private:
    /// Chooses one of `alternatives` by a pilot, and the plan with it.
    void choosePrimitive(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics);
    /// Chooses the shares of plain and guided light paths by a pilot.
    void chooseShare(const ProgressToken& watch, Statistics& statistics);
    /// Step of the radii's schedule. Without progression radii stay as they are. New photons come all the same: passes
    /// that shared them would share their error, which no spread of passes tells.
    [[nodiscard]] uint32_t step(const PassInfo& pass) const;
    /// The scene's gate; for a delta gate the box that the pass's temporal kernel is, `kernel` times as wide.
    [[nodiscard]] TimeGate gate(uint32_t step, float kernel = 1.0f) const;
    /// Records the camera subpaths of this sample of the pass; the first one's record holds the visible points, too.
    [[nodiscard]] CameraRecord record(const PassInfo& pass, uint32_t sample, Statistics& statistics) const;
    /// Control vertices are all that volumes store, and lie on the delta gate itself: no kernel in time.
    [[nodiscard]] bool onDeltaGate() const;
    [[nodiscard]] GatherRays gatherRays(const PassInfo& pass) const;
    /// Structures over the pass's volume records.
    void gatherVolume(VolumeStore&& maps, const PassInfo& pass, GatherStructures& structures,
                      Statistics& statistics) const;
    /// Adds the image of all samples of the pass, of its photons; `first` is the record of the first, if there are any.
    void addPassImage(GatherStructures& structures, const PhotonMaps& maps, const CameraRecord* first,
                      const PassInfo& pass, Film& film, Statistics& statistics) const;
    /// Gathers the pass's photons again with narrower kernels, and says by how much the film's pass image is wrong.
    void estimateBias(GatherStructures& structures, const PhotonMaps& maps, const CameraRecord* first,
                      const PassInfo& pass, Film& film, Statistics& statistics) const;
    /// Adds what the volume records and photons bring to recorded samples; without camera records, to all samples of
    /// the pass.
    void splatAndGather(GatherStructures& structures, const CameraRecords& records, const PassInfo& pass, Film& film,
                        Statistics& statistics) const;
    void splat(GatherStructures& structures, const CameraRecords& records, const PassInfo& pass, Film& film,
               Statistics& statistics) const;

    /// What detectors get from lights that no ray meets.
    void addDetectorLight(const transport::TimeSensor& sensor, const PassInfo& pass, Film& film,
                          Statistics& statistics) const;

    std::shared_ptr<const Scene> scene_;
    PhotonSettings settings_;
    PhotonPlan plan_;
    bool forwardBoundaries_ = true; ///< connections must look through index-matched surfaces
    std::unique_ptr<PhotonPass> photonPass_;
    std::unique_ptr<NearSurfaces> nearSurfaces_; ///< with settings_.boundaryKernels
    CameraSubpathRules rules_;
    std::unique_ptr<GlossyLight> glossy_;                   ///< with rules_.glossy
    std::optional<transport::DetectorLight> detectorLight_; ///< where plan_.detectorLight is on
};

} // namespace tungsten::photon
