#pragma once
// Rendering small scenes with the path tracer.

#include "path/PathTracer.h"

#include "support/Render.h"

namespace tungsten::test {

inline std::unique_ptr<Rendered> renderWithPathTracer(const std::string& json, const RenderOptions& options) {
    const SceneFile file(json);
    return render(file.path(), options, [](std::shared_ptr<const Scene> scene, const ObjectReader& settings) {
        return std::make_unique<path::PathTracer>(std::move(scene), settings);
    });
}

/// One pixel that looks from `from` to `to` (JSON arrays) along a thin bundle of parallel rays.
inline std::string lookAlong(const std::string& from, const std::string& to, const std::string& up,
                             const std::string& medium = "") {
    return R"("camera": {"type": "orthographic", "orthographic_size": 0.0001, "resolution": [1, 1],
              "reconstruction_filter": "dirac", )" +
           (medium.empty() ? "" : R"("medium": ")" + medium + R"(", )") + R"("transform": {"position": )" + from +
           R"(, "look_at": )" + to + R"(, "up": )" + up + "}}";
}

} // namespace tungsten::test
