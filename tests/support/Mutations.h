#pragma once
// Deterministic damage to valid files: what a loader gets from a broken disk, a cut download or an enemy.

#include <cstdint>
#include <cstring>
#include <random>
#include <string>

namespace tungsten::test {

/// The `index`-th mutation of `original`; the same index always gives the same bytes.
inline std::string mutate(const std::string& original, unsigned index) {
    std::mt19937 random(index * 7919u + unsigned(original.size()));
    const auto below = [&](size_t bound) { return bound == 0 ? size_t(0) : size_t(random() % bound); };
    std::string bytes = original;
    switch (index % 6) {
    case 0: // cut off
        bytes.resize(below(bytes.size()));
        break;
    case 1: // a few bits
        for (size_t k = 0; k <= below(8); ++k) bytes[below(bytes.size())] ^= char(1u << below(8));
        break;
    case 2: { // a huge number over a field
        const uint64_t huge[] = {~uint64_t(0), uint64_t(1) << 63, 0x7fffffffffffffff, 0xffffffff,
                                 0x80000000,   0x7fffffff,        uint64_t(1) << 40,  0x10000000};
        const uint64_t value = huge[below(8)];
        const size_t width = below(2) ? 8 : 4, at = below(bytes.size() - std::min(bytes.size(), width));
        std::memcpy(bytes.data() + at, &value, std::min(width, bytes.size() - at));
        break;
    }
    case 3: // a range missing
        bytes.erase(below(bytes.size()), 1 + below(16));
        break;
    case 4: // bytes too many
        bytes.insert(below(bytes.size()), std::string(1 + below(16), char(below(256))));
        break;
    default: // digits of text turned into other ones, in headers mostly
        for (size_t k = 0, changed = 0; k < 4096 && changed < 3; ++k) {
            char& c = bytes[below(std::min<size_t>(bytes.size(), 400))];
            if (c < '0' || c > '9') continue;
            c = "0123456789-.e"[below(13)];
            ++changed;
        }
        break;
    }
    return bytes;
}

} // namespace tungsten::test
