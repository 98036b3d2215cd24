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

} // namespace tungsten::path::tuning
