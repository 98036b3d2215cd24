#pragma once
// What a photon-map integrator does for a scene, and why: decided once, read by --explain, preparation and passes.

#include "photon/PhotonSettings.h"

#include "tungsten/integrator/Features.h"

#include <string>

namespace tungsten::photon {

using transport::Choice;

struct PhotonPlan {
    /// `facts`: what the scene calls for (analyseScene). Builds nothing.
    static PhotonPlan of(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts);
    /// Adds every choice to the plan's effects.
    void describe(const Scene& scene, const PhotonSettings& settings, const SceneFacts& facts,
                  Features& features) const;

    Choice volume;          ///< records of the volume primitive are stored
    Choice temporalKernel;  ///< about a delta gate
    Choice glossyPaths;     ///< sensor paths go on at surfaces that are glossy only, as at mirrors
    Choice surfacePhotons;  ///< stored and gathered
    Choice guidance;        ///< light paths aim at the camera
    Choice framesOneByOne;  ///< each at a single frame
    Choice sideBySide;      ///< plain light paths beside guided ones, weighed by how densely both leave their records
    Choice ordinaryPhotons; ///< beside control vertices, by the balance heuristic
    Choice connections;     ///< guided light paths connect to visible surface points
    Choice exactCulling;    ///< what arrives outside the gate is known and not stored
    Choice edaTable;        ///< directions come from tables of media
    Choice detectorLight;   ///< places of detectors are connected to lights that no ray meets
    Choice moreCameraPaths; ///< through a pixel than its samples

    std::vector<bool> lateEmitters;   ///< SceneFacts::excludedEmitters
    std::vector<bool> mediaOutOfTime; ///< SceneFacts::excludedMedia
    int darkFrames = 0;               ///< SceneFacts::emptyFrames

    float highestSpeed = 1.0f; ///< of light, wherever a path can get
    bool oneSpeed = true;
    bool homogeneous = true;   ///< coefficients are constant in every medium: splats and records of flights count on it
    bool straightRays = false; ///< from one point at one speed: records can be splatted, surfaces connected
    bool folds = false;        ///< mirrors, refraction or followed glossy surfaces can be seen
    /// Every sensor path is one straight chain at one speed, or shall be taken for one: control vertices alone do.
    bool directView = false;
    bool drawsByResponse = false; ///< connections by the sensor's response: a straight way tells the time of arrival
    bool meetsDeltaGate = false;  ///< control vertices lie on the delta gate itself, not in its kernel: likewise

    bool primitiveSplats = false; ///< along the rays that this camera has
    bool looksAgain = false;      ///< at what sensor paths meet, when the photons are there: splats are not all
    uint32_t cameraPaths = 1;     ///< through a pixel for each of its samples

    [[nodiscard]] bool splats() const { return volume.on && homogeneous && primitiveSplats; }
    /// Sensor paths are traced before the photons; else after them.
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
