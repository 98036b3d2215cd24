#include "tungsten/scene/LightChoice.h"

namespace tungsten {

Distribution1D emitterDistribution(const Scene& scene, bool (*takesPart)(const Emitter&),
                                   const std::vector<bool>& leftOut) {
    std::vector<float> powers;
    float total = 0.0f, shining = 0.0f;
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        const bool left = !leftOut.empty() && leftOut[i];
        powers.push_back(!left && takesPart(emitter) ? meanComponent(emitterPower(emitter)) : 0.0f);
        total += powers.back();
        shining += powers.back() > 0.0f ? 1.0f : 0.0f;
    }
    for (float& power : powers)
        if (power > 0.0f) power = 0.5f * power / total + 0.5f / shining;
    return Distribution1D(powers);
}

LightChoice::LightChoice(const Scene& scene, const std::vector<bool>& leftOut)
    : scene_(scene), distribution_(emitterDistribution(
                         scene, [](const Emitter& e) { return e.isConnectable(); }, leftOut)) {}

std::optional<LightChoice::EmitterSample> LightChoice::sample(float u) const {
    if (!(distribution_.total() > 0.0)) return std::nullopt;
    const auto chosen = distribution_.sample(u);
    return EmitterSample{&scene_.emitters[chosen.index], chosen.probability};
}

} // namespace tungsten
