#pragma once
// What is said against a scene.

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <string>
#include <vector>

namespace tungsten::test {

/// The problems of a scene, UsageErrors too; empty if it loads.
inline std::string problemsOf(const std::string& json, const std::vector<std::string>& overrides = {}) {
    const SceneFile file(json);
    try {
        loadScene(file.path(), {{}, overrides});
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

} // namespace tungsten::test
