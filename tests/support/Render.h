#pragma once
// Rendering small scenes inside a test.

#include "support/SceneFile.h"

#include "tungsten/film/Film.h"
#include "tungsten/integrator/Statistics.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tungsten {
class Integrator;
class ObjectReader;
struct Scene;
} // namespace tungsten

namespace tungsten::test {

struct RenderOptions {
    std::vector<std::string> overrides;
    uint32_t passes = 16;
    uint32_t samplesPerPass = 1;
    uint64_t seed = 1;
    size_t threads = 2;
    bool bias = false; ///< estimate what kernels leave
};

struct Rendered {
    std::shared_ptr<const Scene> scene;
    Film film, bias;
    Statistics statistics;

    /// Mean over the image of one frame's channel average.
    [[nodiscard]] double mean(int frame = 0) const;
    /// Of a single-pixel image (pixels of one pass share photons, so larger images need their own estimate).
    [[nodiscard]] double pixelError(int frame = 0) const { return double(film.standardError(frame).at(0, 0).y); }
};

using MakeIntegrator = std::function<std::unique_ptr<Integrator>(std::shared_ptr<const Scene>, const ObjectReader&)>;
std::unique_ptr<Rendered> render(const std::filesystem::path& file, const RenderOptions& options,
                                 const MakeIntegrator& make);

} // namespace tungsten::test
