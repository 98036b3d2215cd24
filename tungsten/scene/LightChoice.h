#pragma once
// Which emitter a vertex connects to, and how to weigh that against finding the emitter by chance.

#include "tungsten/scene/Scene.h"

#include <optional>

namespace tungsten {

/// Power heuristic with exponent 2 (Veach 1997).
inline float powerHeuristic(float a, float b) {
    const float aa = a * a, bb = b * b;
    return aa + bb > 0.0f ? aa / (aa + bb) : 0.0f;
}

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
