#pragma once
// Durations of the scene format and the command line.

#include <optional>
#include <string>

namespace tungsten {

/// Seconds of a sum of number[unit] tokens (ms, s, m, h, d; case-insensitive, by first letters; no unit: minutes), or
/// none if the text is not a duration.
std::optional<double> parseDuration(const std::string& text);

} // namespace tungsten
