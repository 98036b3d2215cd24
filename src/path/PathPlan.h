#pragma once
// What a path tracer does for a scene, and why: decided once, read by --explain, preparation and passes.

#include "path/PathSettings.h"

#include "tungsten/integrator/Features.h"

namespace tungsten::path {

using transport::Decision;

struct PathPlan {
    /// `facts`: what the scene calls for (analyseScene). Builds nothing.
    static PathPlan of(const Scene& scene, const PathSettings& settings, const SceneFacts& facts);
    /// Adds every choice to the plan's effects.
    void describe(const Scene& scene, const PathSettings& settings, const SceneFacts& facts, Features& features) const;

    Decision firstScatteringInView; ///< of light of a single direction, which no camera path finds
    Decision detectorLight;         ///< places of detectors are connected to lights that no ray meets
    Decision roulette;              ///< of plain paths, by throughput
    Decision guidance;              ///< walks aim at emitters inside the gate
    Decision balance;               ///< beside plain ones
    Decision allocation;            ///< pixels get samples as their paths vary and cost
    Decision weightWindows;         ///< plain paths split and end by what those of a pilot found
    Decision lightsInView;          ///< plain paths see them through media in expectation
    Decision lightVertices;         ///< walks connect to surface points that light reaches first
    Decision reflectedLight;        ///< and to where glossy surfaces throw light
    Decision refracted;             ///< plain walks aim at emitters through the walls of sealed bodies
    Decision edaTable;              ///< directions come from tables of media

    bool lasers = false; ///< some light starts in a single direction
    bool timeResolved = false;
    bool media = false;             ///< any: absorption alone needs free flights too, they carry the transmittance
    bool indexMatched = false;      ///< some boundary is
    bool forwardBoundaries = false; ///< connections must look through index-matched surfaces

  private:
    [[nodiscard]] SamplingSummary summary(const Scene& scene, const PathSettings& settings,
                                          const SceneFacts& facts) const;
};

/// Why a delta gate cannot be rendered; empty if it can. Only control vertices arrive at one moment.
std::string deltaGateProblem(const Scene& scene, const PathSettings& settings, const SceneFacts& facts);

/// Names in the plan the counters of steps and arrivals that every integrator of this plugin keeps.
void countArrivals(Features& features);

} // namespace tungsten::path
