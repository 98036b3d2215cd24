#pragma once
// What a walk did on its way, counted by one worker: the work of the plan's effects.

#include "tungsten/bsdf/Bsdf.h"
#include "tungsten/integrator/Features.h"
#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/integrator/Statistics.h"
#include "tungsten/medium/Medium.h"

namespace tungsten::transport {

struct StepCounters {
    uint64_t mediumEvents = 0, anisotropicEvents = 0, colouredEvents = 0; ///< scatterings in media; of them
    uint64_t absorbing = 0;                                               ///< flights through media that only absorb
    uint64_t surfaceEvents = 0;                                           ///< surfaces met
    uint64_t scattered = 0, mirrored = 0, refracted = 0, straight = 0;    ///< and left by these lobes

    uint64_t rays = 0;   ///< of walks; connections count their own
    uint64_t steps = 0;  ///< of walks of this worker
    uint64_t points = 0; ///< of emitters, whose importance has been worked out

    StepCounters& operator+=(const StepCounters& other) {
        mediumEvents += other.mediumEvents;
        anisotropicEvents += other.anisotropicEvents;
        colouredEvents += other.colouredEvents;
        absorbing += other.absorbing;
        surfaceEvents += other.surfaceEvents;
        scattered += other.scattered;
        mirrored += other.mirrored;
        refracted += other.refracted;
        straight += other.straight;
        points += other.points;
        rays += other.rays;
        steps += other.steps;
        return *this;
    }
    /// A walk goes on: paths may have millions of vertices, and a pass must not wait for their ends to be broken off.
    void step(const ProgressToken& watch) {
        constexpr uint64_t StepsPerPoll = 64; // some microseconds each; guided ones tens of them
        watch.advanceWithin(StepsPerPoll, ++steps);
    }
    void scatter(const Medium& medium) {
        ++mediumEvents;
        if (!medium.phase.isIsotropic()) ++anisotropicEvents;
        if (!medium.isGrey()) ++colouredEvents;
    }
    void fly(const Medium& medium) {
        if (!medium.scatters() && !medium.isVacuum()) ++absorbing;
    }
    /// A surface is left by this lobe.
    void countLobe(LobeMask lobe) {
        if ((lobe & lobe::Smooth) != 0) ++scattered;
        if ((lobe & lobe::SpecularReflection) != 0) ++mirrored;
        if ((lobe & lobe::Transmissive) != 0) ++refracted;
        if ((lobe & lobe::Forward) != 0) ++straight;
    }
};

inline void reportSteps(const StepCounters& counters, Statistics& statistics) {
    statistics.add(counter::MediumEvents, counters.mediumEvents);
    statistics.add("scatterings with preferred directions", counters.anisotropicEvents);
    statistics.add("scatterings in coloured media", counters.colouredEvents);
    statistics.add("flights through absorbing media", counters.absorbing);
    statistics.add(counter::SurfaceEvents, counters.surfaceEvents);
    statistics.add("surface scatterings", counters.scattered);
    statistics.add("mirror reflections", counters.mirrored);
    statistics.add("refractions", counters.refracted);
    statistics.add("straight passages", counters.straight);
}

/// Names those counters in the plan.
inline void countSteps(Features& features) {
    features.count(feature::MediumScattering, {"medium events"});
    features.count(feature::AnisotropicScattering, {"scatterings with preferred directions"});
    features.count(feature::ColouredMedia, {"scatterings in coloured media"});
    features.count(feature::AbsorptionOnly, {"flights through absorbing media"});
    features.count(feature::SurfaceScattering, {"surface scatterings"});
    features.count(feature::SpecularCameraSubpaths, {"mirror reflections"});
    features.count(feature::Refraction, {"refractions"});
    features.count(feature::IndexMatchedBoundaries, {"straight passages"});
}

} // namespace tungsten::transport
