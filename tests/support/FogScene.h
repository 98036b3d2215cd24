#pragma once
// A scene of one medium and nothing else, for gathers.

#include "tungsten/scene/Scene.h"

namespace tungsten::test {

/// Coloured fog that scatters forward.
inline Scene fogScene() {
    Scene scene;
    Medium fog;
    fog.model = Homogeneous{Rgb(0.2f), Rgb(0.5f, 1.0f, 2.0f)};
    fog.phase.model = HenyeyGreenstein{0.4f};
    scene.media.push_back(fog);
    return scene;
}

} // namespace tungsten::test
