#include "tungsten/session/Progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace tungsten {

namespace {

std::string clockText(double seconds) {
    const long total = std::lround(std::min(std::max(seconds, 0.0), 9e8));
    char text[48];
    if (total >= 3600)
        std::snprintf(text, sizeof text, "%ldh%02ldm", total / 3600, total / 60 % 60);
    else
        std::snprintf(text, sizeof text, "%ldm%02lds", total / 60, total % 60);
    return text;
}

/// "bias 0.5 % (below 0.8 %)".
std::string figureText(const std::string& name, double relative, double bound) {
    if (std::isnan(relative)) return name + " not known yet";
    char text[64];
    if (std::isnan(bound))
        std::snprintf(text, sizeof text, " %.3g %%", 100.0 * relative);
    else
        std::snprintf(text, sizeof text, " %.3g %% (below %.3g %%)", 100.0 * relative, 100.0 * bound);
    return name + text;
}

/// "radii 42 %, ".
std::string stageText(const PassProgress& pass) {
    if (pass.stage.empty()) return "";
    return pass.stage + " " + std::to_string(int(100.0 * pass.ofStage)) + " %, ";
}

} // namespace

std::string errorText(double relative, double bound, const RelativeBias& bias) {
    const std::string noise = figureText("standard error", relative, bound);
    return bias.bound == 0.0 ? noise : noise + ", " + figureText("bias", bias.estimate, bias.bound);
}

double progressFraction(const ProgressState& state) {
    const int64_t remaining = state.totalSamples - state.resumedSamples;
    const double done = double(state.samples - state.resumedSamples) + state.pass.ofPass * state.samplesOfPass;
    double fraction = remaining > 0 ? done / double(remaining) : 1.0;
    if (state.timeoutSeconds > 0.0) fraction = std::max(fraction, state.elapsedSeconds / state.timeoutSeconds);
    // The error falls with the square root of the work.
    const double bound = std::hypot(state.errorBound, state.bias.bound);
    if (state.targetError > 0.0 && bound > 0.0) fraction = std::max(fraction, std::pow(state.targetError / bound, 2.0));
    return std::clamp(fraction, 0.0, 1.0);
}

std::string progressLine(const ProgressState& state) {
    constexpr int Width = 24;
    const double fraction = progressFraction(state);
    const int filled = int(fraction * Width);
    std::string line = "[" + std::string(size_t(filled), '#') + std::string(size_t(Width - filled), '.') + "] ";
    const double left = fraction > 0.0 ? state.elapsedSeconds * (1.0 - fraction) / fraction : 0.0;
    line += "pass " + std::to_string(state.passes) + "/" + std::to_string(state.totalPasses) + ", " +
            stageText(state.pass) + std::to_string(state.samples) + "/" + std::to_string(state.totalSamples) +
            " spp, " + clockText(state.elapsedSeconds) + " elapsed, " + clockText(left) + " left, " +
            errorText(state.relativeError, state.errorBound, state.bias);
    return line;
}

ProgressReporter::ProgressReporter(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0) {}

ProgressReporter::~ProgressReporter() {
    if (drawn_ && terminal_) std::fputc('\n', stderr);
}

void ProgressReporter::show(const ProgressState& state, bool last) {
    if (quiet_ || (!last && !due())) return;
    next_ = std::chrono::steady_clock::now() +
            (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000));
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", progressLine(state).c_str());
    std::fflush(stderr);
    drawn_ = true;
}

} // namespace tungsten
