#include "tungsten/core/Errors.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace tungsten {

namespace {

std::string joined(const std::vector<Problem>& problems) {
    std::string text;
    for (const Problem& problem : problems) {
        if (!text.empty()) text += '\n';
        text += problem.text();
    }
    return text;
}

std::string inLowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

/// Letters to insert, delete, replace, or swap with their neighbour.
size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> before, last, row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 1; i <= a.size(); ++i) {
        before = std::move(last);
        last = row;
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

} // namespace

std::string printable(std::string_view text) {
    constexpr size_t LongestShown = 4096;
    std::string shown;
    for (size_t i = 0; i < std::min(text.size(), LongestShown); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : ' ');
        const bool wide = byte == 0xC2 && next >= 0x80 && next < 0xA0; // U+0080 to U+009F
        if (byte >= 0x20 && byte != 0x7F && !wide) {
            shown += text[i];
            continue;
        }
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\x%02x", wide ? next : byte);
        shown += escaped;
        if (wide) ++i;
    }
    if (text.size() > LongestShown) shown += " ... (" + std::to_string(text.size()) + " bytes)";
    return shown;
}

std::string Problem::text() const {
    std::string out = file;
    if (!path.empty()) out += (out.empty() ? "" : ": ") + path;
    return printable(out.empty() ? message : out + ": " + message);
}

InputError::InputError(std::vector<Problem> problems, std::vector<Problem> warnings)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)), warnings_(std::move(warnings)) {}

InputError::InputError(std::string file, std::string message)
    : InputError(std::vector<Problem>{{std::move(file), "", std::move(message)}}) {}

std::string nearestName(std::string_view name, const std::vector<std::string>& candidates) {
    constexpr size_t LongestCompared = 64;
    if (name.size() > LongestCompared) return {};
    const std::string lower = inLowerCase(name);
    std::string best;
    size_t bestDistance = (name.size() + 1) / 4 + 1; // of a quarter of the letters another word is made
    for (const std::string& candidate : candidates) {
        const size_t distance = editDistance(lower, inLowerCase(candidate));
        if (distance < bestDistance) {
            bestDistance = distance;
            best = candidate;
        }
    }
    return best;
}

std::string listOf(const std::vector<std::string>& names) {
    std::string text;
    for (size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
        text += names[i];
    }
    return text;
}

} // namespace tungsten
