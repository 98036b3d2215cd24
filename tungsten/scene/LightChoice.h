#pragma once
// Which emitter a vertex connects to.

#include "tungsten/scene/Scene.h"

#include <optional>

namespace tungsten {

/// Emitters that can be connected to, chosen half by power and half uniformly.
class LightChoice {
  public:
    explicit LightChoice(const Scene& scene);

    struct Choice {
        const Emitter* emitter;
        float probability;
    };
    /// None when no emitter can be connected to.
    [[nodiscard]] std::optional<Choice> sample(float u) const;
    /// Probability of choosing the emitter with this index (0 for those that cannot be connected to).
    [[nodiscard]] float probability(int emitter) const { return probabilities_[size_t(emitter)]; }

  private:
    const Scene& scene_;
    Distribution1D distribution_;
    std::vector<float> probabilities_;
    bool any_ = false;
};

} // namespace tungsten
