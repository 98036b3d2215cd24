#pragma once
// The photon-map integrators: a photon pass, structures over its photons, a sensor pass.

#include "photon/PhotonPlan.h"
#include "photon/SensorPass.h"
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
    [[nodiscard]] double memoryBytes() const override;
    [[nodiscard]] bool leavesBias(const SceneFacts& facts) const override;
    /// Of the volume's kernels, where there are any, else of surfaces'.
    [[nodiscard]] bool cutsLightPaths() const override { return true; }
    [[nodiscard]] double kernelWidth(uint32_t pass) const override;
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override;
    /// Nanoseconds of a pass that do not grow with its light paths; after prepare().
    [[nodiscard]] double passOverhead() const { return photonPass_->passOverhead(); }

  private:
    /// Of `alternatives`, and with it the plan.
    void choosePrimitive(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics);
    /// Of plain and guided light paths.
    void chooseShare(const ProgressToken& watch, Statistics& statistics);
    /// Of the radii's schedule. Without progression radii stay as they are. New photons come all the same: passes that
    /// shared them would share their error, which no spread of passes tells.
    [[nodiscard]] uint32_t step(const PassInfo& pass) const;
    /// The scene's gate; for a delta gate the box that the pass's temporal kernel is, `kernel` times as wide.
    [[nodiscard]] TimeGate gate(uint32_t step, float kernel = 1.0f) const;
    /// Of this sample of the pass; the first one's holds the surface points, too.
    [[nodiscard]] SensorRecord record(const PassInfo& pass, uint32_t sample, Statistics& statistics) const;
    /// Control vertices are all that volumes store, and lie on the delta gate itself: no kernel in time.
    [[nodiscard]] bool onDeltaGate() const;
    [[nodiscard]] SensorRays sensorRays(const PassInfo& pass) const;
    /// Structures over the pass's volume records.
    void gatherVolume(VolumeStore&& maps, const PassInfo& pass, GatherStructures& structures,
                      Statistics& statistics) const;
    /// Adds what all samples of the pass see of its photons; `first` is the record of the first, if there are any.
    void see(GatherStructures& structures, const PhotonMaps& maps, const SensorRecord* first, const PassInfo& pass,
             Film& film, Statistics& statistics) const;
    /// Looks at the pass's photons again with narrower kernels, and says by how much the film's pass image is wrong.
    void estimateBias(GatherStructures& structures, const PhotonMaps& maps, const SensorRecord* first,
                      const PassInfo& pass, Film& film, Statistics& statistics) const;
    /// Adds what recorded samples see; without records, what all the pass's samples see.
    void look(GatherStructures& structures, const SensorRecords& records, const PassInfo& pass, Film& film,
              Statistics& statistics) const;
    void splat(GatherStructures& structures, const SensorRecords& records, const PassInfo& pass, Film& film,
               Statistics& statistics) const;

    /// What detectors get from lights that no ray meets.
    void addDetectorLight(const transport::Sensor& sensor, const PassInfo& pass, Film& film,
                          Statistics& statistics) const;

    std::shared_ptr<const Scene> scene_;
    PhotonSettings settings_;
    PhotonPlan plan_;
    bool forwardBoundaries_ = true; ///< connections must look through index-matched surfaces
    std::unique_ptr<PhotonPass> photonPass_;
    std::unique_ptr<NearSurfaces> nearSurfaces_; ///< with settings_.boundaryKernels
    SensorPathRules rules_;
    std::unique_ptr<GlossyLight> glossy_;                   ///< with rules_.glossy
    std::optional<transport::DetectorLight> detectorLight_; ///< where plan_.detectorLight is on
};

} // namespace tungsten::photon
