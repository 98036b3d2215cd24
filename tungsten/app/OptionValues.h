#pragma once
// Values of options as texts. Each throws UsageError, with what was expected, for what it cannot read.

#include "tungsten/session/PartialState.h"

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace tungsten {

/// Throws UsageError for an option that was given an empty text, such as that of a variable that is not set; flags and
/// options that may go without a value have none.
void requireNoEmptyValues(const CLI::App& app);

/// Seconds, above 0, of "90s", "5m", "1h 30m" or minutes.
double durationOption(const std::string& option, const std::string& text);
/// "WxH" as a scene override.
std::string resolutionOverride(const std::string& text);
/// "512M", "16G": bytes, in steps of 1024.
double sizeOption(const std::string& text);
/// Decimal, or hexadecimal after 0x.
uint64_t seedOption(const std::string& text);
/// "A:B": passes A to B - 1.
PassRange passesOption(const std::string& text);

} // namespace tungsten
