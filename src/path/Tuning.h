#pragma once
// Constants of path tracing that were tuned by measurement. To see what one brings, change
// it, build, and compare before and after by the bench named:
//   study NAME        benchmarks/study/study.py benchmarks/study/studies/NAME.json
//   infinite_medium   build/bin/infinite_medium
//   micro             build/bin/micro

#include <cstddef>
#include <cstdint>

namespace tungsten::path::tuning {

// --- Guided paths ----------------------------------------------------------------------------------------------------

/// Where nothing is diffuse guided directions hardly ever fall into the lobe; what they are given, a chain of glossy
/// reflections lacks once per reflection. (Dragon: 1.7 times less variance than 0.5.) Bench: study dragon-160
inline constexpr float GlossyAlpha = 5.0f;

// --- Plain and guided paths side by side -----------------------------------------------------------------------------

/// Pixels of a pilot, of four paths each, at least and at most; it ends where LeastEffective has been found ten times.
inline constexpr size_t LeastPilotPixels = 64, MostPilotPixels = 8192;
/// What paths cost, in nanoseconds: of plain and guided ones. Rays are dearer by so much for each doubling of the
/// number of triangles. Fitted to CPU seconds and counters of 15 scenes (statistics of renders at a plain_share of 0
/// and 1).
struct Rates {
    double vertex, ray, connection, controlVertex;
};
inline constexpr Rates PlainRates{95.0, 110.0, 20.0, 0.0}, GuidedRates{290.0, 210.0, 115.0, 400.0};
inline constexpr double RayCostByLog = 12.0;
/// And to keep a vertex of a plain path, and of its densities.
inline constexpr double TrailCost = 80.0, DensityCost = 550.0;

// --- Light paths -----------------------------------------------------------------------------------------------------

/// Light paths of a pass, a quarter of its guided paths within these, and no more than they are. Bench: study cbox-128
inline constexpr size_t FewestPaths = 4096, MostPaths = 32768;
/// Scenes with more lights have none of these: each would be reached by few. Variance x CPU with over without them, in
/// gates of 0.05 and 0.3: 0.92 and 0.73 under 1 light, 0.92 and 0.87 under 4, 0.94 and 1.13 under 8, 1.33 and 1.33
/// under 16, 1.85 and 1.59 under 64. Bench: study many-lights (both are the same above the limit: raise it first)
inline constexpr size_t MostEmitters = 8;
/// Candidates of a vertex among light vertices, and among ends of reflected light. Bench: study cbox-128
inline constexpr size_t Candidates = 64;
/// Light paths that tell how many of an emitter's reflect. Bench: study dragon-160
inline constexpr size_t PilotPaths = 32768;

// --- Light through walls that refract -----------------------------------------------------------------------------

/// Vertices of sealed bodies aim at lights through a face with so many times the transmittance of the way to it, at
/// most with probability 1; never from deeper than so many mean free paths. Variance x CPU of milk behind glass: 0.56
/// at 2, 0.41 at 1, 0.47 at 0.5. Bench: study bodies
inline constexpr float RefractedOdds = 1.0f, DeepestRefracted = 10.0f;
/// Towards where the way to a light leaves a sphere. Variance x CPU of a ball of milk, 8 seeds: 0.48 at 0, 0.45 at 1,
/// 0.38 at 2, 0.37 at 3, 0.44 at 8. Bench: milk of study bodies with primitives.jar.type=sphere and scale 0.5
inline constexpr int SphereSteps = 3;
/// Of candidates in time, at most, whose ways are worked out. (Milk behind glass 0.41 without this, 0.33; a box in a
/// long gate 0.31, 0.15.) Bench: study bodies
inline constexpr size_t RefractedCandidates = 8;
/// Between a way to the boundary and its normal: a guard, which no way reaches at indices above 1.02 (milk: the same
/// bits at 0.05 and 0.5).
inline constexpr float LeastRefractedCosine = 0.2f;
/// Points of a light in a pass; triangles of one at most: each is asked whether a direction meets it. Scenes with more
/// lights have none of these: a bound on the points of a pass, and on what a vertex looks through. Variance x CPU of
/// milk behind glass and of the ball: 0.121 and 0.33 at 64 points, 0.127 and 0.42 at 1024, 0.120 and 0.42 at 4096: no
/// difference beyond noise. Bench: study bodies
inline constexpr size_t LampPoints = 1024, MostLampTriangles = 64, MostLamps = 64;
/// Ways from under the boundary of a body that tell how late its light arrives through what else is in between, of
/// which so many quantiles are kept, and so many that hold them all, for rare ways; boundaries on one of them. Little
/// depends on them: variance x CPU of milk behind glass 0.096, 0.111, 0.100 with 256, 2048, 16384 ways, 0.116, 0.116,
/// 0.108 with 1, 4, 32 that hold all. Bench: study bodies
inline constexpr size_t DelayPilots = 2048, DelayQuantiles = 32, WholeDelays = 4;
inline constexpr int MostBoundaries = 16;

} // namespace tungsten::path::tuning
