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

/// Its warnings, a line each.
inline std::string warningsOf(const std::string& json) {
    const SceneFile file(json);
    std::string text;
    const LoadedScene loaded = loadScene(file.path());
    for (const Problem& warning : loaded.diagnostics->warnings) text += warning.text() + "\n";
    return text;
}

} // namespace tungsten::test
