#include "tungsten/integrator/SceneElements.h"

#include <algorithm>

namespace tungsten {

namespace {

/// Some texture of the material, or of one that it consists of, varies over the surface.
bool varies(const Bsdf& bsdf) {
    const BsdfParts parts = bsdf.parts();
    return !bsdf.albedo.isConstant() || bsdf.bump ||
           std::any_of(parts.textures.begin(), parts.textures.end(),
                       [](const Texture& t) { return !t.isConstant(); }) ||
           std::any_of(parts.bsdfs.begin(), parts.bsdfs.end(), [](const BsdfPtr& part) { return varies(*part); });
}

/// Over a surface.
bool varies(const Emitter& emitter) {
    return emitter.surface() && !emitter.surface()->radiance.isConstant();
}

bool isTransparent(const Bsdf& bsdf) {
    if (std::holds_alternative<Transparency>(bsdf.model)) return true;
    const std::vector<BsdfPtr> parts = bsdf.parts().bsdfs;
    return std::any_of(parts.begin(), parts.end(), [](const BsdfPtr& part) { return isTransparent(*part); });
}

} // namespace

void SceneElements::add(const std::string& name, const std::string& path) {
    if (++count_ > MostListed) return;
    names_.push_back(name);
    if (!path.empty() && std::find(paths_.begin(), paths_.end(), path) == paths_.end()) paths_.push_back(path);
}

std::string SceneElements::names() const {
    std::string list;
    for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + name;
    return count_ > names_.size() ? list + " and " + std::to_string(count_ - names_.size()) + " more" : list;
}

std::string SceneElements::counted(const std::string& element, const std::string& what) const {
    return std::to_string(count_) + " " + element + (count_ == 1 ? " " : "s ") + what + ", first " + names_.front();
}

std::set<int> reachableMedia(const Scene& scene) {
    std::set<int> media{scene.cameraRegion.medium};
    for (const Emitter& emitter : scene.emitters) media.insert(emitter.medium);
    for (const Primitive& primitive : scene.primitives)
        if (primitive.boundsMedium) media.insert({primitive.inside.medium, primitive.outside.medium});
    media.erase(-1);
    return media;
}

Speeds reachableSpeeds(const Scene& scene) {
    std::set<float> speeds;
    SceneElements uses;
    const auto add = [&](const Region& region, const std::string& path) {
        if (speeds.insert(region.speed).second)
            uses.add("", region.medium >= 0 ? scene.media[size_t(region.medium)].path + ".speed_of_light" : path);
    };
    add(scene.cameraRegion, "camera");
    for (const Emitter& emitter : scene.emitters) add(scene.regionOf(emitter), emitter.path);
    for (const Primitive& primitive : scene.primitives)
        if (primitive.boundsRegion)
            for (const Region& side : {primitive.inside, primitive.outside}) add(side, primitive.path);
    return {speeds.size(), *speeds.begin(), *speeds.rbegin(), uses.paths()};
}

std::string pathOf(const Bsdf& bsdf, const Primitive& primitive) {
    return bsdf.name.empty() ? primitive.path + ".bsdf" : "bsdfs." + bsdf.name;
}

SceneElements elementsWithLobe(const Scene& scene, LobeMask mask) {
    return elementsWithBsdf(scene, [mask](const Bsdf& bsdf) { return (bsdf.lobes() & mask) != 0; });
}

SceneElements elementsWithTexture(const Scene& scene) {
    SceneElements uses = elementsWithBsdf(scene, [](const Bsdf& bsdf) { return varies(bsdf); });
    for (const Emitter& emitter : scene.emitters)
        if (varies(emitter)) uses.add("'" + emitter.name + "'", emitter.path);
    return uses;
}

SceneElements elementsWithTransparency(const Scene& scene) {
    return elementsWithBsdf(scene, [](const Bsdf& bsdf) { return isTransparent(bsdf); });
}

} // namespace tungsten
