#pragma once
// What a photon-map integrator does for a scene, and why: decided once, read by --explain, preparation and passes.

#include "photon/PhotonSettings.h"

#include "tungsten/integrator/Features.h"

#include <string>

namespace tungsten::photon {

using transport::Decision;

struct PhotonPlan {
    /// `facts`: what the scene calls for (analyseScene). Builds nothing.
    static PhotonPlan of(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts);
    /// Adds every decision to the features.
    void describe(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts,
                  Features& features) const;

    Decision volume;          ///< records of the volume primitive are stored
    Decision temporalKernel;  ///< about a delta gate
    Decision glossyPaths;     ///< camera subpaths go on at surfaces that are glossy only, as at mirrors
    Decision surfacePhotons;  ///< stored and gathered
    Decision guidance;        ///< light paths are guided towards the camera
    Decision oneFramePerPath; ///< each light path aims at a single frame
    Decision sideBySide;      ///< plain light paths beside guided ones, weighed by how densely both leave their records
    Decision photonsWithControlVertices; ///< ordinary photons beside control vertices, by the balance heuristic
    Decision connections;                ///< guided light paths connect to visible surface points
    Decision exactCulling;               ///< what arrives outside the gate is known and not stored
    Decision edaTable;                   ///< directions come from tables of media
    Decision detectorLight;              ///< places of detectors are connected to lights that no ray meets
    Decision extraCameraPaths;           ///< several camera subpaths for each sample of a pixel (`cameraPaths`)

    std::vector<bool> excludedEmitters; ///< SceneFacts::excludedEmitters
    std::vector<bool> excludedMedia;    ///< SceneFacts::excludedMedia
    int emptyFrames = 0;                ///< SceneFacts::emptyFrames

    float highestSpeed = 1.0f; ///< of light, wherever a path can get
    bool oneSpeed = true;
    bool homogeneous = true;   ///< coefficients are constant in every medium: splats and records of flights count on it
    bool straightRays = false; ///< from one point at one speed: records can be splatted, surfaces connected
    bool indirectView = false; ///< mirrors, refraction or followed glossy surfaces can be seen
    /// Every camera subpath is one straight chain at one speed, or shall be taken for one: control vertices alone do.
    bool directView = false;
    bool drawsByResponse = false; ///< connections by the sensor's response: a straight way tells the time of arrival
    bool meetsDeltaGate = false;  ///< control vertices lie on the delta gate itself, not in its kernel: likewise

    /// The primitive can be splatted for this camera (single origin, one speed, if it needs them).
    bool primitiveSplats = false;
    /// Recorded camera segments are visited again after the photon pass, because surfaces and redirected segments are
    /// gathered, not splatted.
    bool gathersAfterSplat = false;
    uint32_t cameraPaths = 1; ///< camera subpaths for each sample of a pixel

    [[nodiscard]] bool splats() const { return volume.on && homogeneous && primitiveSplats; }
    /// Camera subpaths are traced before the photons; else after them.
    [[nodiscard]] bool records() const { return splats() || connections.on; }

  private:
    [[nodiscard]] SamplingSummary summary(const Scene& scene, const PhotonSettings& settings,
                                          const SceneFacts& facts) const;
    void describeGuidance(const Scene& scene, const PhotonSettings& settings, Features& features) const;
    void describeVolume(const PhotonSettings& settings, Features& features) const;
    void describeKernels(const Scene& scene, const PhotonSettings& settings, Features& features) const;
    void describeSplatting(Features& features) const;
    void chooseGuidance(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts);
    void chooseStores(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts);
};

} // namespace tungsten::photon
