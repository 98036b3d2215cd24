#pragma once
// What a person sees while a render runs: passes, time left, standard error.

#include "tungsten/film/FilmErrors.h"
#include "tungsten/integrator/ProgressToken.h"

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>

namespace tungsten {

/// How far a render is.
struct ProgressState {
    uint32_t passes = 0, totalPasses = 0;
    int64_t samples = 0, totalSamples = 0; ///< per pixel
    double elapsedSeconds = 0.0;
    double timeoutSeconds = 0.0;                                     ///< 0: none
    double relativeError = std::numeric_limits<double>::quiet_NaN(); ///< NaN: not known yet
    double errorBound = std::numeric_limits<double>::quiet_NaN();    ///< what it does not exceed; NaN: not known yet
    RelativeBias bias{0.0, 0.0};                                     ///< 0: none is estimated
    double targetError = 0.0;                                        ///< 0: none
    int64_t resumedSamples = 0;                                      ///< taken before this run started
    PassProgress pass{};                                             ///< in progress; no stage: none is
    double samplesOfPass = 0.0;                                      ///< per pixel
};

/// Fraction of the render that is done, by whichever limit comes first.
double progressFraction(const ProgressState& state);
/// "standard error 1.2 % (below 1.4 %), bias 0.5 % (below 0.8 %)": of a film, with bounds that hold with a confidence
/// of 95 %; without the bias where it is 0 and sure to be.
std::string errorText(double relativeError, double errorBound, const RelativeBias& bias = {0.0, 0.0});
/// One line: a bar, passes, elapsed and remaining time, standard error.
std::string progressLine(const ProgressState& state);

/// Prints to stderr: a bar that redraws itself on a terminal, a line every few seconds elsewhere.
class ProgressReporter {
  public:
    explicit ProgressReporter(bool quiet);
    ~ProgressReporter();
    ProgressReporter(const ProgressReporter&) = delete;
    ProgressReporter& operator=(const ProgressReporter&) = delete;
    /// Whether it is time to show something again.
    [[nodiscard]] bool due() const { return !quiet_ && std::chrono::steady_clock::now() >= next_; }
    void show(const ProgressState& state, bool last);

  private:
    bool quiet_, terminal_, drawn_ = false;
    std::chrono::steady_clock::time_point next_{};
};

} // namespace tungsten
