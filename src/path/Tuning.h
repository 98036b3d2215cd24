#pragma once
// Constants of path tracing that were tuned by measurement. To see what one brings, change
// it, build, and compare before and after by the bench named:
//   study NAME        benchmarks/bench.py study NAME
//   infinite_medium   build/bin/infinite_medium
//   micro             build/bin/micro

#include <cstddef>
#include <cstdint>

namespace tungsten::path::tuning {

// --- Guided paths ----------------------------------------------------------------------------------------------------

/// Where nothing is diffuse guided directions hardly ever fall into the lobe; what they are given, a chain of glossy
/// reflections lacks once per reflection. (Dragon, 9 seeds x 12 s: twice the variance with 0.5.) Bench: study
/// dragon-160
inline constexpr float GlossyAlpha = 5.0f;

/// A guided path chooses among so many points of its emitter where it gets into a medium from outside. Variance x CPU
/// over 8, dense cubes 10, 60, 300 and layered tissue, least odds of 1/4: 16 points 1.1, 1.0, 1.1, 1.7, 32 points 1.3,
/// 0.85, 1.1, 1.5. Bench: study bodies
inline constexpr size_t EntryPoints = 8;

// --- Plain and guided paths side by side -----------------------------------------------------------------------------

/// What paths cost, in nanoseconds.
struct Costs {
    struct Walk {
        double vertex = 0.0, ray = 0.0, connection = 0.0, controlVertex = 0.0, point = 0.0;
    };
    Walk plain, guided;
    double sample;   ///< of a pixel, whatever becomes of its path
    double rayByLog; ///< so much dearer is a ray for each doubling of the number of triangles
    double trail;    ///< to keep a vertex of a plain path
    double density;  ///< of guided paths, at a vertex of a plain one
};
/// Fitted to CPU seconds and counters of 15 scenes: benchmarks/bench.py costs.
inline constexpr Costs Nanoseconds{.plain = {95.0, 110.0, 20.0},
                                   .guided = {290.0, 210.0, 115.0, 400.0, 400.0},
                                   .sample = 250.0,
                                   .rayByLog = 12.0,
                                   .trail = 80.0,
                                   .density = 550.0};

// --- Weight windows of plain paths -----------------------------------------------------------------------------------

/// Contributions that a state of weight windows must have, or would have if it were as others, to be told apart from
/// what is around it. Variance x CPU over plain paths of ten scenes at 30 and 100: 0.62 and 0.74; of slow-nested-glass
/// at 8 and 30: 1.5 and 1.1; of plastic-floor-fogcube at 20: 1.26 of 30. Bench: study unseen
inline constexpr double EnoughOfState = 30.0;

// --- Light paths -----------------------------------------------------------------------------------------------------

/// Light paths of a pass, a quarter of its guided paths within these, and no more than they are; the most also tell,
/// before the first pass, how many of an emitter's reflect. Bench: study cbox-128 and dragon-160
inline constexpr size_t FewestPaths = 4096, MostPaths = 32768;
/// Candidates of a vertex among light vertices, and among ends of reflected light. Bench: study cbox-128
inline constexpr size_t Candidates = 64;

// --- Light through walls that refract --------------------------------------------------------------------------------

/// Most candidates in time whose ways are worked out. (Three bodies of milk, with 64: 1.3 times the variance x CPU.)
/// Bench: study bodies
inline constexpr size_t RefractedCandidates = 8;

} // namespace tungsten::path::tuning
