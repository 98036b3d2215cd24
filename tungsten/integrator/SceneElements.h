#pragma once
// Which elements of a scene use something: by name for reasons, and by path.

#include "tungsten/scene/Scene.h"

#include <set>
#include <string>
#include <vector>

namespace tungsten {

/// Elements of a scene that have something in common.
class SceneElements {
  public:
    void add(const std::string& name, const std::string& path);
    [[nodiscard]] bool any() const { return count_ > 0; }
    [[nodiscard]] size_t count() const { return count_; }
    /// "'fog', 'smoke'": the first MostListed, then how many more.
    [[nodiscard]] std::string names() const;
    /// "3 surfaces that refract, first 'pane'".
    [[nodiscard]] std::string counted(const std::string& element, const std::string& what) const;
    /// Paths of the first MostListed, as problems have them.
    [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }

  private:
    static constexpr size_t MostListed = 16;
    size_t count_ = 0;
    std::vector<std::string> names_, paths_;
};

/// Media that some path can be in: the camera's, the lights', and those that surfaces bound.
std::set<int> reachableMedia(const Scene& scene);

/// Speeds of light wherever a path can get, and the elements that set them.
struct Speeds {
    size_t count = 0;
    float lowest = 1.0f, highest = 1.0f;
    std::vector<std::string> elements;
};
Speeds reachableSpeeds(const Scene& scene);

/// Surfaces with a lobe of `mask`, with textures, with an opacity.
SceneElements elementsWithLobe(const Scene& scene, LobeMask mask);
SceneElements elementsWithTexture(const Scene& scene);
SceneElements elementsWithTransparency(const Scene& scene);
/// Surfaces with a BSDF for which `has`.
template <typename Has>
SceneElements elementsWithBsdf(const Scene& scene, const Has& has);
/// Path of a BSDF: by name, or where the primitive has it.
std::string pathOf(const Bsdf& bsdf, const Primitive& primitive);

template <typename Has>
SceneElements elementsWithBsdf(const Scene& scene, const Has& has) {
    SceneElements uses;
    for (size_t i = 0; i < scene.primitives.size(); ++i) {
        const Primitive& primitive = scene.primitives[i];
        for (const BsdfPtr& bsdf : primitive.bsdfs) {
            if (!has(*bsdf)) continue;
            uses.add(primitive.name.empty() ? "#" + std::to_string(i) : "'" + primitive.name + "'",
                     pathOf(*bsdf, primitive));
            break;
        }
    }
    return uses;
}

} // namespace tungsten
