#pragma once
// Constants that integrators share and that were tuned by measurement. To see what one brings, change it,
// build, and compare before and after by the bench named:
//   study NAME        benchmarks/bench.py study NAME
//   infinite_medium   build/bin/infinite_medium
//   micro             build/bin/micro

#include <cstdint>

namespace tungsten::transport::tuning {

// --- Roulette of plain walks -----------------------------------------------------------------------------------------

/// Ends walks whose throughput is below, from this interaction on. Bench: study cbox-128
inline constexpr float RouletteThreshold = 0.1f;
inline constexpr int RouletteFirstInteraction = 3;

// --- Splitting of guided walks ---------------------------------------------------------------------------------------

/// Upper bound on the expected number of walks that stem from one; it limits the time lost where importance is wrong.
/// Bench: a closed white box (docs/notebook.md), paths: standard errors of .021 at 64, .011 at 1e3, .008 here, .006 at
/// 1e6.
inline constexpr float MostCopies = 1e4f;

// --- Ways out of bodies. Bench: study bodies ----------------------------------------------------------------------

/// Light crosses fewer transport mean free paths than these as if nothing were there: bodies across which there are
/// fewer are taken for infinite, and faces deeper by fewer than these count beside the one that the straight way
/// leaves through. Variance x CPU of two rooms without it, paths 1.4, points 1.4, beams 1.3; with all faces of dense
/// cubes 60 and 300 paths 1.4, with those up to four times as deep paths 1.07 and 1.00.
inline constexpr float ThinDepth = 2.0f;

// --- Windows of sequences --------------------------------------------------------------------------------------------

/// Each is so many times as long as the one before. Bench: study transient
inline constexpr double WindowGrowth = 1.5;

// --- Plain and guided paths side by side -----------------------------------------------------------------------------

/// Contributions of a pilot of plain and guided paths, as many of one size as are worth them, by which a pilot may
/// choose.
inline constexpr double LeastEffective = 20.0;
/// Paths of a pilot, which ends where LeastEffective has been found ten times and the choice is sure
/// (SharePilot::isSure), and its counted cost in nanoseconds.
inline constexpr uint64_t LeastPilotPaths = 256, MostPilotPaths = 1 << 15, MostPilotCost = 100'000'000;

} // namespace tungsten::transport::tuning
