#include "tungsten/reader/Duration.h"

#include <cctype>
#include <cmath>
#include <cstdlib>

namespace tungsten {

namespace {

std::optional<double> unitSeconds(const std::string& unit) {
    if (unit.empty()) return 60.0;
    if (unit.starts_with("ms") || unit.starts_with("mil")) return 1e-3;
    switch (unit[0]) {
    case 's':
        return 1.0;
    case 'm':
        return 60.0;
    case 'h':
        return 3600.0;
    case 'd':
        return 86400.0;
    default:
        return std::nullopt;
    }
}

} // namespace

std::optional<double> parseDuration(const std::string& text) {
    const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    const auto space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    double total = 0.0;
    bool any = false;
    for (size_t i = 0; i < text.size();) {
        if (space(text[i])) {
            ++i;
            continue;
        }
        char* end = nullptr;
        const double number = std::strtod(text.c_str() + i, &end);
        if (end == text.c_str() + i || !std::isfinite(number)) return std::nullopt;
        i = size_t(end - text.c_str());
        while (i < text.size() && space(text[i])) ++i;
        std::string unit;
        for (; i < text.size() && letter(text[i]); ++i) unit += char(std::tolower(static_cast<unsigned char>(text[i])));
        const auto seconds = unitSeconds(unit);
        if (!seconds) return std::nullopt;
        total += number * *seconds;
        any = true;
    }
    return any ? std::optional(total) : std::nullopt;
}

} // namespace tungsten
