#pragma once
// What an error costs: a few passes all along a method's schedule, and what longer renders follow from them.

#include "tungsten/integrator/Integrator.h"

#include <atomic>
#include <optional>

namespace tungsten {

/// Of pass i, from 0: first (i + 1)^exponent.
struct PowerLaw {
    double first = 0.0, exponent = 0.0;

    [[nodiscard]] double at(uint32_t pass) const;
    /// Of passes 0 to n - 1; n >= 1 need not be whole.
    [[nodiscard]] double sum(double n) const;
};

/// Whole passes of one method. Errors are relative to the mean pixel value, rms over pixels and frames.
struct PassCosts {
    PowerLaw variance{}; ///< of the pass's image, relative to the squared mean
    PowerLaw bias{};     ///< what kernels leave in the pass's image; 0 where none or below its noise
    PowerLaw cpuSeconds{}, wallSeconds{};
    double prepareCpuSeconds = 0.0, prepareWallSeconds = 0.0;
    uint32_t passes = 0; ///< that were rendered to know this

    /// Of the mean of n passes: noise and bias together.
    [[nodiscard]] double error(double n) const;
    /// Passes until the error is at most this: whole ones, at least 1; none where it takes more than 10^9.
    [[nodiscard]] std::optional<double> passesFor(double error) const;
    [[nodiscard]] double cpuSecondsFor(double n) const { return prepareCpuSeconds + cpuSeconds.sum(n); }
    [[nodiscard]] double wallSecondsFor(double n) const { return prepareWallSeconds + wallSeconds.sum(n); }
};

struct PilotOptions {
    uint64_t seed = 0xBA5EBA11u;
    uint32_t samplesPerPass = 1;                    ///< per pixel
    double seconds = 3.0;                           ///< to prepare and to render passes for,
    double mostSeconds = 6.0;                       ///< and at most
    uint32_t rounds = 2;                            ///< so many of each index at least; 2 or more
    const std::atomic<bool>* interrupted = nullptr; ///< set by Ctrl-C: PassCancelled
};

/// Renders passes 0, 15 and 255, again and again with other random numbers: a pass depends on nothing but its index, so
/// that what late passes bring need not be guessed. Passes that are too long are cut as renders cut them (PassSizes),
/// and what they bring is taken to whole ones. `plan` is complete (Integrator::plan was called); the integrator is
/// prepared here. None where all is black. Throws PassCancelled when it is interrupted, InputError where even cut
/// passes take too long: it says how long.
std::optional<PassCosts> measurePasses(const Scene& scene, Integrator& integrator, const SceneFacts& facts,
                                       const PilotOptions& options);

} // namespace tungsten
