#pragma once
// What integrators do with residual-time sampling beside sampling itself: which ways to find light they use.

#include "darts/SamplingOptions.h"

#include <string>

namespace tungsten::transport {

/// Whether the camera is always seen along one straight line: then control vertices alone are complete.
enum class DirectView { Auto, On, Off };

/// The `darts` block: how to sample, and the renderer's own switches. The paper's preset leaves out what is not in it.
struct Policy {
    darts::SamplingOptions sampling;
    DirectView directView = DirectView::Auto; ///< of photon maps
    std::optional<float> plainShare;          ///< of the time; none: by a pilot
    std::optional<bool> surfaceConnections, glossyCameraSubpaths, singleFrames, bodies, adaptiveSamples, weightWindows,
        lightsInView;

    [[nodiscard]] bool guides() const { return sampling.on; }
    /// Light paths also connect their vertices to visible surfaces, camera paths theirs to surfaces that light reaches
    /// first.
    [[nodiscard]] bool connectsSurfaces() const { return surfaceConnections.value_or(!sampling.published); }
    /// Camera subpaths of a photon map go on along the lobes of glossy surfaces, as they do along mirrors.
    [[nodiscard]] bool followsGlossy() const { return guides() && glossyCameraSubpaths.value_or(!sampling.published); }
    /// Every light path of a photon map aims at one frame of a sequence, in the paper's preset alone: otherwise at all
    /// of them as one gate, since a path that aims at one of n leaves nothing in the others.
    [[nodiscard]] bool aimsAtSingleFrames() const { return singleFrames.value_or(sampling.published); }
    /// Pixels of paths get more samples where they vary more.
    [[nodiscard]] bool allocatesSamples() const { return guides() && adaptiveSamples.value_or(!sampling.published); }
    /// Plain paths of a path tracer may split and end by what those of a pilot found.
    [[nodiscard]] bool usesWeightWindows() const { return guides() && weightWindows.value_or(!sampling.published); }
    /// Plain paths of a path tracer may add lights that they see through media in expectation.
    [[nodiscard]] bool expectsLightsInView() const { return guides() && lightsInView.value_or(!sampling.published); }
    /// Bodies of media end where their boundaries are, for sampling too; otherwise every medium is taken for infinite.
    [[nodiscard]] bool followsBodies() const { return guides() && bodies.value_or(!sampling.published); }
};

/// What a plan decides, and why.
struct Decision {
    bool on = false;
    std::string reason;
};

/// Reads an integrator's block as darts::readSamplingOptions does.
template <typename Block>
Policy readPolicy(const Block& block) {
    using darts::switches::flag;
    constexpr const char *WithBest = "true with best", *WithPublished = "true with published";
    Policy policy;
    policy.sampling = darts::readSamplingOptions(block, [&](const Block& object) {
        policy.directView = darts::switches::named<DirectView>(
                                object, "direct_view",
                                "photon maps: control vertices alone (on), ordinary photons beside them (off), which "
                                "is right in mirrors and behind refraction, or as the scene needs",
                                {{"auto", DirectView::Auto}, {"on", DirectView::On}, {"off", DirectView::Off}}, "auto")
                                .value_or(DirectView::Auto);
        policy.plainShare = darts::switches::fraction(
            object, "plain_share",
            "the share of time of plain paths beside guided ones, of the camera or of lights; by a pilot", 1.0);
        policy.surfaceConnections = flag(object, "surface_connections",
                                         "light paths connect to visible surfaces, camera paths to lit ones", WithBest);
        policy.glossyCameraSubpaths =
            flag(object, "glossy_sensor_paths", "photon maps: camera subpaths go on at glossy surfaces, as at mirrors",
                 WithBest);
        policy.singleFrames =
            flag(object, "single_frames",
                 "photon maps: a light path aims at one frame of a sequence, not at all as one gate", WithPublished);
        policy.adaptiveSamples =
            flag(object, "adaptive_samples", "paths: more samples of pixels that vary more", WithBest);
        policy.weightWindows =
            flag(object, "weight_windows", "paths: plain ones split and end by what those of a pilot found", WithBest);
        policy.lightsInView = flag(
            object, "lights_in_view",
            "paths: lights seen straight through media are added with their transmittance, in expectation", WithBest);
        policy.bodies = flag(object, "bodies", "media end at their boundaries for sampling too", WithBest);
    });
    return policy;
}

} // namespace tungsten::transport
