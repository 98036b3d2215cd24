#include "tungsten/app/OptionValues.h"

#include "tungsten/core/Errors.h"
#include "tungsten/reader/Duration.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tungsten {

void requireNoEmptyValues(const CLI::App& app) {
    for (const CLI::Option* const option : app.get_options()) {
        if (option->get_items_expected_min() == 0) continue;
        for (const std::string& value : option->results())
            if (value.empty()) throw UsageError(option->get_name() + ": is empty; give it a value or leave it out");
    }
}

double durationOption(const std::string& option, const std::string& text) {
    const auto seconds = parseDuration(text);
    if (!seconds || !(*seconds > 0.0))
        throw UsageError(option + " " + text +
                         ": expected a duration above 0 such as 90s, 5m, \"1h 30m\"; no unit means minutes");
    return *seconds;
}

std::string resolutionOverride(const std::string& text) {
    const char *first = text.data(), *last = first + text.size();
    int width = 0, height = 0;
    const auto [cross, widthError] = std::from_chars(first, last, width);
    const bool crossed = widthError == std::errc() && cross != last && *cross == 'x';
    const auto [end, heightError] = std::from_chars(crossed ? cross + 1 : last, last, height);
    if (!crossed || heightError != std::errc() || end != last || width < 1 || height < 1)
        throw UsageError("--resolution " + text + ": expected WIDTHxHEIGHT, such as 320x240");
    return "camera.resolution=[" + std::to_string(width) + "," + std::to_string(height) + "]";
}

double sizeOption(const std::string& text) {
    static const std::string units = "KMGT";
    double bytes = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bytes);
    std::string unit(end, text.data() + text.size());
    if (unit.ends_with("iB")) unit.erase(unit.size() - 2);
    const size_t power = unit.empty() ? 0 : units.find(unit) + 1;
    const bool known = unit.empty() || (unit.size() == 1 && power > 0 && power <= units.size());
    if (error != std::errc() || !known || !(bytes > 0.0) || bytes > 1e15)
        throw UsageError("--memory-limit " + text + ": expected a size such as 512M, 16G or 16GiB");
    return bytes * std::pow(1024.0, double(power));
}

uint64_t seedOption(const std::string& text) {
    const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    const char *first = text.data() + (hexadecimal ? 2 : 0), *last = text.data() + text.size();
    uint64_t seed = 0;
    const auto [end, error] = std::from_chars(first, last, seed, hexadecimal ? 16 : 10);
    if (error != std::errc() || end != last || first == last)
        throw UsageError("--seed " + text + ": expected a whole number from 0 to 2^64 - 1, decimal or 0x...");
    return seed;
}

PassRange passesOption(const std::string& text) {
    const char *first = text.data(), *last = first + text.size();
    PassRange range;
    const auto [colon, firstError] = std::from_chars(first, last, range.first);
    const bool parted = firstError == std::errc() && colon != last && *colon == ':';
    const auto [end, endError] = std::from_chars(parted ? colon + 1 : last, last, range.end);
    if (!parted || endError != std::errc() || end != last || range.first >= range.end)
        throw UsageError("--passes " + text +
                         ": expected A:B for passes A to B - 1 of the render, such as 0:4 and 4:8");
    return range;
}

} // namespace tungsten
