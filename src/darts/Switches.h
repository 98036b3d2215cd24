#pragma once
// Switches that leave to a preset what they do not set, read from any block of named fields.
//
// A `Block` has has, flag, number, integer, choice, isObject, block (an object in it), problem and warn, each by field
// name; the reading ones also take a field's {unit, meaning, default in words}. What is wrong is a problem(field,
// text), what has no effect a warn(field, text). declare() and describes() are for blocks that collect these: the
// host's ObjectReader is one.

#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace darts::switches {

/// The default of switches that the preset sets.
inline constexpr const char* ByPreset = "the preset's";

/// A field whose value names an enumerator; none when absent.
template <typename Enum, typename Block>
std::optional<Enum> named(const Block& block, const char* field, const char* meaning,
                          const std::vector<std::pair<std::string, Enum>>& names, const char* otherwise = ByPreset) {
    std::vector<std::string> accepted;
    for (const auto& [name, value] : names) accepted.push_back(name);
    const std::string chosen = block.choice(field, accepted.front(), accepted, {"none", meaning, otherwise});
    if (!block.has(field)) return std::nullopt;
    for (const auto& [name, value] : names)
        if (name == chosen) return value;
    return std::nullopt;
}

template <typename Block>
std::optional<float> fraction(const Block& block, const char* field, const char* meaning, double most) {
    std::ostringstream accepted; // 0.05, 1000000: no zeros, no exponent
    accepted << "a number from 0 to " << std::setprecision(10) << most;
    block.declare(field, accepted.str(), "", {"none", meaning, ByPreset});
    if (!block.has(field)) return std::nullopt;
    const double value = block.number(field, 0.0, {"none", meaning});
    if (value >= 0.0 && value <= most) return float(value);
    block.problem(field, "expected " + accepted.str());
    return std::nullopt;
}

template <typename Block>
std::optional<bool> flag(const Block& block, const char* field, const char* meaning, const char* otherwise = ByPreset) {
    const bool value = block.flag(field, false, {"none", meaning, otherwise});
    return block.has(field) ? std::optional<bool>(value) : std::nullopt;
}

} // namespace darts::switches
