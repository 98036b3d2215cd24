#pragma once
// The command line of `tungsten`.

#include "tungsten/io/Outputs.h"
#include "tungsten/session/PartialState.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tungsten {

/// What --explain prints: what is sampled how; every effect with its reason; both as JSON.
enum class Explanation { Text, Effects, Json };

struct Options {
    std::vector<std::filesystem::path> scenes;
    std::vector<std::string> overrides; ///< --set, then what other options say about the scene
    std::filesystem::path inputDirectory;
    OutputOverrides outputs;
    std::string command;         ///< as a shell takes it
    std::filesystem::path trace; ///< empty: none
    std::optional<double> checkpointSeconds, timeoutSeconds;
    std::optional<int64_t> spp;
    std::optional<PassRange> passes; ///< --passes
    uint64_t seed = 0xBA5EBA11u;
    double targetError = 0.0;
    double memoryLimit = 0.0; ///< bytes; 0: what is available
    int threads = 0;          ///< 0: all
    bool restart = false, quiet = false;
    bool bias = false;
    bool everything = false;            ///< --effects all
    std::optional<Explanation> explain; ///< --explain
    bool list = false, planCost = false;
    std::optional<std::string> describe; ///< a type or kind; empty: all
    bool markdown = false;
};

/// Parses the command line. Throws UsageError for what it cannot accept. Returns none when the answer was printed
/// already
/// (--help, --version).
std::optional<Options> parseOptions(int argc, const char* const* argv);

} // namespace tungsten
