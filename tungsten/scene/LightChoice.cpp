#include "tungsten/scene/LightChoice.h"

namespace tungsten {

LightChoice::LightChoice(const Scene& scene) : scene_(scene), probabilities_(scene.emitters.size(), 0.0f) {
    std::vector<float> powers;
    float total = 0.0f, count = 0.0f;
    for (const Emitter& emitter : scene.emitters) {
        const bool connectable = emitter.isConnectable();
        powers.push_back(connectable ? meanComponent(emitterPower(emitter)) : 0.0f);
        total += powers.back();
        count += connectable ? 1.0f : 0.0f;
    }
    any_ = total > 0.0f;
    if (!any_) return;
    for (float& power : powers)
        if (power > 0.0f) power = 0.5f * power / total + 0.5f / count;
    distribution_ = Distribution1D(powers);
    for (size_t i = 0; i < powers.size(); ++i) probabilities_[i] = distribution_.probability(i);
}

std::optional<LightChoice::Choice> LightChoice::sample(float u) const {
    if (!any_) return std::nullopt;
    const auto chosen = distribution_.sample(u);
    return Choice{&scene_.emitters[chosen.index], chosen.probability};
}

} // namespace tungsten
