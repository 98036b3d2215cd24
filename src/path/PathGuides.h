#pragma once
// How guided camera paths sample in each medium, and from surfaces before it.

#include "darts/Guide.h"
#include "darts/SamplingOptions.h"

#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/Scene.h"

#include <algorithm>
#include <vector>

namespace tungsten::path {

/// Sampling by medium.
struct PathGuides {
    /// `plan`: media that light is out of time in are not guided in.
    static PathGuides of(const Scene& scene, const darts::SamplingOptions& options, const SceneFacts& facts,
                         const ProgressToken& watch);

    std::vector<darts::Guide> media;  ///< for flights, and for leaving scatterers and surfaces into it
    std::vector<darts::Guide> glossy; ///< for leaving surfaces without diffuse lobes

    /// Number of tables of directions in use: one for every medium that has one.
    [[nodiscard]] size_t tables() const {
        return size_t(std::count_if(media.begin(), media.end(), [](const darts::Guide& guide) {
            return guide.settings().direction == darts::Direction::Eda;
        }));
    }
};

} // namespace tungsten::path
