#pragma once
// What is fuzzed: one function for each format that is read. Each takes any bytes; what is no input of the format must
// end in InputError (UsageError for overrides), which it catches. Anything else that is thrown, and any promise that is
// broken, ends the process.

#include <span>
#include <string>
#include <string_view>

namespace tungsten::fuzz {

struct Target {
    std::string_view name; ///< also of its corpus: tests/fuzz/corpus/NAME
    void (*run)(const std::string& bytes);
};

std::span<const Target> targets();

} // namespace tungsten::fuzz
