#pragma once
// The files that a scene names.

#include "tungsten/core/LoadWatch.h"

#include <filesystem>
#include <optional>
#include <string>

namespace tungsten {

struct Resources {
    std::filesystem::path folder;
    bool allowOutside = false; ///< they may lie outside that folder
    LoadWatch watch = {};      ///< polled by what takes long

    /// Relative names are the folder's. Throws InputError if it lies outside and must not.
    [[nodiscard]] std::filesystem::path find(const std::string& name) const;
    /// Where files that these name must lie; none: anywhere.
    [[nodiscard]] std::optional<std::filesystem::path> allowedFolder() const {
        return allowOutside ? std::nullopt : std::optional(folder);
    }
};

} // namespace tungsten
