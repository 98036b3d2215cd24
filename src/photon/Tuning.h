#pragma once
// Constants of photon maps that were tuned by measurement. To see what one brings, change
// it, build, and compare before and after by the bench named:
//   study NAME        benchmarks/bench.py study NAME
//   infinite_medium   build/bin/infinite_medium
//   micro             build/bin/micro

#include <cstddef>
#include <cstdint>

namespace tungsten::photon::tuning {

// --- Camera subpaths
// ----------------------------------------------------------------------------------------------------

/// Camera paths per pixel that look for surface points to connect to: as many as give an image of this many, at least
/// and at most. One leaves the noise of lines that a narrow gate lights; more cost little in small images alone. Bench:
/// study cbox-128
inline constexpr size_t SurfacePoints = 1 << 16, LeastSurfaceSamples = 2, MostSurfaceSamples = 4;

/// Camera paths of a sample in small images: as many for each pixel as make so many in all, and no more than records,
/// at most. A pass of photons takes long beside one path for each pixel, which at the edges of doors and bodies sees
/// one side alone, and between and behind glass a few of the photons. Variance x CPU with 6 over with 1, best beams and
/// points: two rooms 0.32 and 0.30, several lights 0.24 and 0.55, milk behind glass 0.55 and 0.68, a glass ball in fog
/// 0.23 and 0.23; with 4: 0.42 to 0.50, 0.53 and 0.58, 0.59 and 0.63. Slices take longer to gather: twelve scenes 0.68
/// with 3, none above 1.01, and 0.66 with 6, up to 1.6. Bench: study bodies and unseen
inline constexpr uint64_t CameraPaths = 1 << 14, MostCameraPaths = 6, MostWithSlices = 3;

/// Photons or beams that a redirected ray meets, about, out of all. MSE x CPU of dragon at 160 x 160, before highlight
/// paths shared them: 0.25 with all photons, 0.17 with 64, 0.20 with 32 and 16. Bench: study dragon-160
inline constexpr double RedirectedHits = 48.0;

/// Paths of a pixel near glossy surfaces that look for lights. Bench: study dragon-160
inline constexpr uint32_t HighlightPaths = 16;

// --- Guided light paths ----------------------------------------------------------------------------------------------

/// Part of the directions from lamps outside fog that goes towards its bodies. What misses them costs little time, and
/// what gets there by way of mirrors or refraction is the brighter the fewer of its directions are left. Variance x CPU
/// at 0.5 and 0.2: milk behind glass, beams 3.6 and 1.7, points 0.63 and 0.38; dense cube 10, beams 0.20 and 0.21.
/// Bench: study bodies
inline constexpr float TowardsBodies = 0.2f;

/// Guided paths of slices, and what `auto` measures beside points, up to this |g| of phase functions. Variance x CPU,
/// guided against plain: 0.5 at 0, 0.8 at 0.5, 1.3 at 0.7, 7 at 0.9; without the leg 0.5 at 0 and 0.7, 1.1 at 0.9.
/// Bench: study liu-primitives
inline constexpr float MostGuidedPeak = 0.6f;

/// Where beams make the first order, the part of the other slices that is kept: beams want many light paths, and are
/// cheap; of what volumes and balls share, which is far less noisy, half as many. Variance / mean^2 x CPU seconds of 8
/// passes, plain and best, at 0.1 and 0.1, 0.1 and 0.03, 0.05 and 0.02: the published volumetric-caustic at 160 x 88
/// 0.086, 0.088, 0.079 and 0.076, 0.072, 0.057; simple-volumetric, at 0.1 and 0.1, 0.1 and 0.05, 0.05 and 0.02: 0.0034,
/// 0.0044, 0.0056 and 0.0032, 0.0031, 0.0041. Of the first pass of a delta gate: they shrink with the beams' radius,
/// which took the published volumetric-caustic from 0.100 and 0.091 to 0.077 and 0.068 in 20 s. Bench: study
/// liu-primitives
inline constexpr float ShareBesideBeams = 0.1f, SharedBesideBeams = 0.05f;

/// Single balls at delta gates vary as the inverse of their flight's length: up to so many radii of beams there are
/// beams in their place. The published volumetric-caustic, as above: 0.101 at 2, 0.095 at 4, 0.117 at 8; without balls
/// on surfaces, and balls of any length elsewhere, 0.154. Bench: study liu-primitives
inline constexpr float ShortBeamsInRadii = 4.0f;

/// Bounds on the expected number of a guided path's records for each base. Variance x CPU of mis_volumes_balls at a
/// delta gate without the brightest hundredth, 8 seeds: fogged-box 0.0148, 0.0149, 0.0151 with at most 1, 8, 64;
/// laser-in-fog, in thousandths, 0.73, 0.76, 0.79. The least bounds weights, as how bright a record is is a guess, in
/// bodies seen from outside a bad one: at least 0.001, 0.03 and 0.1, films of balls, error bound of a dense cube in 5 s
/// (mean of 0.55, 1 and 1) 15, 0.33 and 0.21; of fogged-box, warped, 10 frames, variance x CPU 0.032, 0.036, 0.046.
/// Bench: study liu-primitives
inline constexpr float MostPerBase = 8.0f, LeastPerBase = 0.03f;

/// Slices that bring less than their shape's mean to a frame of a sequence are drawn there at random. Variance / mean^2
/// x CPU seconds, mean over 50 frames, without and with: fogged-box 0.69, 0.60, warped volumes 0.66, 0.54,
/// simple-volumetric 0.070, 0.053; but the warped film's darkest tenth 0.08, 0.36. This part of the choice is even over
/// all records that can arrive, so that none weighs more than the inverse; costs 2 % of the time of such films of
/// fogged-box. Bench: study liu-stages
inline constexpr float EvenInFrames = 0.1f;

/// Shadow rays for what a ray gathers of slices behind occluders: each stands for a dose of light, so many to a ray.
/// volumetric-caustic: variance / mean^2 x CPU seconds 9.4 with a ray for each slice, 0.74 by doses. A
/// sequence's frames share them: 450 for 50 frames of fogged-box, 0.69 to 1.0. Bench: study liu-primitives
inline constexpr float ShadowRaysPerRay = 64.0f;

// --- Plain and guided light paths side by side -----------------------------------------------------------------------

/// What light paths cost, in nanoseconds.
struct Costs {
    struct Walk {
        double path, vertex, ray, controlVertex;
    };
    Walk plain, guided;
    double connection;         ///< a ray to a surface point
    double point, beam, slice; ///< a record, with what is built and splatted of it
    double trail;              ///< to keep a vertex of a plain path
    double density;            ///< of guided paths, for a flight of a plain one
    double pixel;              ///< a path of a pixel in a pass
};
/// Fitted to CPU seconds and counters of 37 scenes: benchmarks/bench.py costs --method points (beams,
/// mis_volumes_balls). A connection by the difference between few and many in six renders: 600 to 3200 ns. Of 700 and
/// 1300, 700 is better in six scenes: 0.85 and 0.90 of the variance x CPU at 200.
inline constexpr Costs Nanoseconds{.plain = {115.0, 120.0, 100.0, 0.0},
                                   .guided = {50.0, 200.0, 200.0, 500.0},
                                   .connection = 700.0,
                                   .point = 400.0,
                                   .beam = 1300.0,
                                   .slice = 3000.0,
                                   .trail = 60.0,
                                   .density = 650.0,
                                   .pixel = 400.0};

/// What whole passes cost in nanoseconds, as the pilot of volume primitives counts them: by path, ray and so on.
struct PassCosts {
    struct Record {
        double stored, ended;      ///< ended: kernels at surfaces
        double splatted, gathered; ///< for each that a ray meets
    };
    double path, ray, mediumEvent, surfaceEvent, controlVertex, connection, density;
    Record point, beam, slice;
};
/// Fitted to CPU seconds and counters of three primitives in 39 scenes: benchmarks/bench.py costs --method passes;
/// those of slices are of 11 scenes, a fit to 13 has 4500 and 137.
inline constexpr PassCosts PassNanoseconds{.path = 180.0,
                                           .ray = 140.0,
                                           .mediumEvent = 100.0,
                                           .surfaceEvent = 390.0,
                                           .controlVertex = 260.0,
                                           .connection = 730.0,
                                           .density = 11500.0,
                                           .point = {20.0, 410.0, 43.0, 1.0},
                                           .beam = {390.0, 780.0, 50.0, 50.0},
                                           .slice = {6000.0, 0.0, 120.0, 320.0}};
/// How many times as often as the pilot's paths those of a render may connect to surfaces: as their part of the
/// variance and of the cost asks for. Neighbours share light the more the fewer connections there are, so that the
/// model of one over their number is a rough one. Variance x CPU of cbox at 128 x 128, points and beams, at most 1 and
/// 4: 0.092 and 0.136, 0.108 and 0.064. Bench: study cbox-128
inline constexpr double LeastEffort = 1.0 / 16.0, MostEffort = 2.0;

// --- The volume primitive that is measured ---------------------------------------------------------------------------

/// Light paths of a pilot's pass, and the pass whose radii stand for all. What is worse than the best by 1 + FarWorse /
/// sqrt(passes) is dropped. The pilot has the budget of that of shares, SliceCost times as much where slices are ahead
/// and have yet to prove it. By measured errors of 37 scenes, the choice over the better of points and beams: 1.09,
/// without its worst scene 1.04. Bench: study unseen
inline constexpr double PathsOfPass = 256.0, MiddlePass = 15.0, FarWorse = 8.0, SliceCost = 6.0;
/// Passes of each primitive at least, and at most; passes until which slices must be ahead of kernels, were their
/// variance to grow in proportion. In fewer passes they look up to 100 times better than they are (thin-sheet). Bench:
/// study unseen
inline constexpr uint32_t LeastPasses = 16, MostPasses = 512, SlicePasses = 1024;

// --- Connections to surfaces -----------------------------------------------------------------------------------------

/// How often the vertices of a path try to connect, about; the pilot of plain and guided paths chooses how many times
/// as often. Variance x CPU of points and beams, 12 scenes, over 4 to 16, more in short passes: 0.98 and 0.96.
inline constexpr double ConnectionsPerPath = 4.0;
/// Least number of connection attempts of a pass: ConnectionsPerPoint for each visible point, at most MostLeast. It
/// does not depend on what arrives, or dark passes would take longer. Bench: study staircase-160
inline constexpr uint64_t ConnectionsPerPoint = 2, MostLeast = 1 << 14;

/// Light from close by is spread over so many square roots of the area that a pixel covers. cbox, MSE x CPU: 0.086 at
/// 0.25, 0.076 at 0.5 and at 1. Bench: study cbox-128
inline constexpr float SpreadPixels = 0.5f;

/// Radius in pixels within which neighbours share what connections bring. cbox at 128 x 128 without a bound on the
/// distance, MSE x CPU: 0.33 before sharing, 0.09 with 1.5 pixels, 0.08 with 2.5; then time grows. But without the
/// bound a small image's blocks are off by 4 % (cornell-fog, 64 x 64). Bench: study cbox-128
inline constexpr float SharedPixels = 2.5f;

// --- Kernels at surfaces ---------------------------------------------------------------------------------------------

/// Width of beams' kernels at surfaces, of their radius. Plain beams in six bodies of fog with a radius of 0.06, two
/// seconds, error^2 at 1 and at 0.5: ball of 12 a unit 0.296, 0.129 (off by 16 and 10 %), of a late lamp 0.045, 0.013
/// (3 and 2 %), small balls 0.090, 0.096, cylinder 0.036, 0.052, fast body 0.0038, 0.0026, touching cubes 0.0061,
/// 0.0075. Points, whose noise grows as the square, had 1.25 times the error at 0.5: they keep theirs. Bench:
/// benchmarks/bench.py kernels means
inline constexpr float WidthAtSurfaces = 0.5f;

/// Cells that keep what surfaces are about them: their edge in radii of kernels, and how many there are across a scene
/// at least; beams near a surface are cut into parts of so many radii at most. CPU time over that without ended
/// kernels, cells of 3 and of 6 radii: mirror box, beams 1.34 and 1.42, points 1.16 and 1.17; room of thin fog, beams
/// 1.71 and 1.81. Parts of 4, 8 and 16 radii there: CPU time 1.65, 1.70 and 1.68, variance 1.005, 1.009 and 1.020.
/// Bench: benchmarks/bench.py kernels cost
inline constexpr float CellInRadii = 3.0f, LeastCellsAcross = 32.0f, NearPartInRadii = 8.0f;

// --- Bias ------------------------------------------------------------------------------------------------------------

/// Width of the kernels that the bias is estimated with, of those that the image is made with. Narrower ones need no
/// photons but the pass's, and tell more where what they blur has edges: a slab seen from outside, estimate over true
/// bias 0.60 at 0.71 and 0.52 at 0.8, where the estimate's noise was taken off differently. Bench:
/// study bias
inline constexpr float NarrowKernel = 0.70710678f;

// --- Stores and structures -------------------------------------------------------------------------------------------

/// Photon beams are cut into pieces of so many radii, at most so many, for Embree. cbox/transient-beams.json, 20 000
/// beams at 128 x 128, gather and build against uncut beams: steady state with radius 0.1: 1.6 to 1.9 s, radius 0.01:
/// 0.9 to 1.2 s; a narrow gate's parts are not cut. Bench: micro
inline constexpr float PieceInRadii = 16.0f, MostPieces = 16.0f;

} // namespace tungsten::photon::tuning
