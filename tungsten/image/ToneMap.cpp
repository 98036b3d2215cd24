#include "tungsten/image/ToneMap.h"

#include <map>

namespace tungsten {

namespace {

const std::map<std::string, ToneMap>& toneMaps() {
    static const std::map<std::string, ToneMap> maps{{"linear", ToneMap::Linear},
                                                     {"gamma", ToneMap::Gamma},
                                                     {"reinhard", ToneMap::Reinhard},
                                                     {"filmic", ToneMap::Filmic},
                                                     {"pbrt", ToneMap::Pbrt}};
    return maps;
}

float curve(ToneMap toneMap, float c) {
    c = std::max(c, 0.0f);
    switch (toneMap) {
    case ToneMap::Linear:
        return c;
    case ToneMap::Gamma:
        return std::pow(c, 1.0f / 2.2f);
    case ToneMap::Reinhard:
        return std::pow(c / (1.0f + c), 1.0f / 2.2f);
    case ToneMap::Filmic: {
        const float x = std::max(0.0f, c - 0.004f);
        return x * (6.2f * x + 0.5f) / (x * (6.2f * x + 1.7f) + 0.06f);
    }
    case ToneMap::Pbrt:
        return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
    }
    return c;
}

} // namespace

std::optional<ToneMap> toneMapByName(const std::string& name) {
    const auto found = toneMaps().find(name);
    return found == toneMaps().end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> toneMapNames() {
    std::vector<std::string> names;
    for (const auto& [name, map] : toneMaps()) names.push_back(name);
    return names;
}

Rgb applyToneMap(ToneMap toneMap, const Rgb& c) {
    return {curve(toneMap, c.x), curve(toneMap, c.y), curve(toneMap, c.z)};
}

std::array<uint8_t, 3> toLdr(const Rgb& c) {
    const auto byte = [](float v) { return uint8_t(std::clamp(std::floor(255.0f * v), 0.0f, 255.0f)); };
    return {byte(c.x), byte(c.y), byte(c.z)};
}

std::vector<uint8_t> toneMapped(const Image& image, ToneMap toneMap) {
    std::vector<uint8_t> bytes;
    bytes.reserve(image.pixels.size() * 3);
    for (const Rgb& pixel : image.pixels)
        for (const uint8_t byte : toLdr(applyToneMap(toneMap, pixel))) bytes.push_back(byte);
    return bytes;
}

} // namespace tungsten
