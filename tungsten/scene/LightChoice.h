#pragma once
// Which emitter a path starts at, or a vertex connects to.

#include "tungsten/scene/Scene.h"

#include <optional>

namespace tungsten {

/// Emitters that shine and for which `takesPart`, half by power and half uniformly: few paths are lost on weak ones,
/// and none is left out but those in `leftOut`, by emitter (empty: none). A total of 0: there are no such emitters.
Distribution1D emitterDistribution(const Scene& scene, bool (*takesPart)(const Emitter&),
                                   const std::vector<bool>& leftOut = {});

/// Emitters that can be connected to.
class LightChoice {
  public:
    /// `leftOut`: by emitter; empty: none.
    explicit LightChoice(const Scene& scene, const std::vector<bool>& leftOut = {});

    struct EmitterSample {
        const Emitter* emitter;
        float probability;
    };
    /// None when no emitter can be connected to.
    [[nodiscard]] std::optional<EmitterSample> sample(float u) const;
    /// Probability of choosing the emitter with this index (0 for those that cannot be connected to).
    [[nodiscard]] float probability(int emitter) const {
        return distribution_.total() > 0.0 ? distribution_.probability(size_t(emitter)) : 0.0f;
    }

  private:
    const Scene& scene_;
    Distribution1D distribution_;
};

} // namespace tungsten
