#pragma once
// What the readers of the scene's blocks share while a scene is loaded, and the readers themselves (one file each).

#include "tungsten/reader/ObjectReader.h"
#include "tungsten/scene/Scene.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tungsten {

struct LoadContext {
    Scene& scene;
    std::filesystem::path resourceDirectory;
    bool allowOutside = false;                                         ///< resources may lie outside that directory
    std::map<std::string, BsdfPtr> bsdfs = {};                         ///< by name; the first definition wins
    std::map<std::string, int> media = {};                             ///< by name
    std::map<std::string, std::shared_ptr<const Bitmap>> bitmaps = {}; ///< by file and lookup settings
    std::vector<ObjectReader> emitters = {};                           ///< the objects of the scene's emitters
    LoadWatch watch = {};                                              ///< polled by what takes long

    /// Resolves against the scene's (or the input) directory. Throws InputError if it lies
    /// outside and must not.
    std::filesystem::path resource(const std::string& name);
    /// Where files that resources name must lie; none: anywhere.
    [[nodiscard]] std::optional<std::filesystem::path> allowedFolder() const {
        return allowOutside ? std::nullopt : std::optional(resourceDirectory);
    }
};

/// Warns about detectors of the camera that a wall covers; once the geometry is there.
void warnAboutBlindDetectors(const LoadContext& context, const ObjectReader& camera);

/// A context to describe types in: nothing is read from files, nothing is kept.
struct ScratchContext {
    Scene scene;
    LoadContext context{scene, {}};
};

/// "; did you mean 'x'?", or nothing: of the names in a map, while the problem will be listed at all.
template <typename Value>
std::string didYouMean(const std::string& name, const std::map<std::string, Value>& known, const ObjectReader& owner) {
    if (!owner.diagnostics()->listsMore()) return {};
    std::vector<std::string> names;
    for (const auto& [candidate, value] : known) names.push_back(candidate);
    const std::string near = nearestName(name, names);
    return near.empty() ? "" : "; did you mean '" + near + "'?";
}

inline constexpr Meaning NameMeaning{"none", "what the rest of the scene, and --set, call it"};
inline constexpr Meaning PlacementMeaning{"none", "from its own coordinates to the world's", "identity"};

/// A texture field: number or RGB (constant), path string (bitmap), or object. Constant values must lie in `range`.
Texture readTexture(LoadContext& context, const ObjectReader& owner, const std::string& field, const Texture& fallback,
                    const Meaning& meaning, Range range = {});
/// Describes the fields of one type, as the functions of this name for other kinds do.
void describeTexture(const std::shared_ptr<Description>& description);
std::vector<std::string> textureTypes();
/// One colour out of a texture field that may not vary (point emitters).
Rgb readConstantTexture(LoadContext& context, const ObjectReader& owner, const std::string& field,
                        const Meaning& meaning);

/// A medium by name or as an inline object; -1 and a problem if there is none of that name.
int readMediumReference(LoadContext& context, const ObjectReader& owner, const std::string& field,
                        const Meaning& meaning);
void readMedia(LoadContext& context, const ObjectReader& root);
void describeMedium(const std::shared_ptr<Description>& description);
void describePhaseFunction(const std::shared_ptr<Description>& description);
std::vector<std::string> mediumTypes();
std::vector<std::string> phaseFunctionTypes();

/// A BSDF by name or as an inline object.
BsdfPtr readBsdfReference(LoadContext& context, const ObjectReader& owner, const std::string& field,
                          const Meaning& meaning);
/// One BSDF, or an array indexed by the mesh's materials.
std::vector<BsdfPtr> readBsdfList(LoadContext& context, const ObjectReader& owner, const std::string& field,
                                  const Meaning& meaning);
void readBsdfs(LoadContext& context, const ObjectReader& root);
void describeBsdf(const std::shared_ptr<Description>& description);
std::vector<std::string> bsdfTypes();

void readPrimitives(LoadContext& context, const ObjectReader& root);
void describePrimitive(const std::shared_ptr<Description>& description);
std::vector<std::string> primitiveTypes();
/// `reader` is the camera block.
void readCamera(LoadContext& context, const ObjectReader& root, const ObjectReader& reader);
void describeCamera(const std::shared_ptr<Description>& description);
std::vector<std::string> cameraTypes();
/// `reader` is the renderer block.
RendererSettings readRenderer(const ObjectReader& reader);
/// `reader` is the film block.
FilmContents readFilm(const ObjectReader& reader);
/// Which integrator the block asks for.
std::string readIntegratorType(const ObjectReader& integrator);
/// The fields that every integrator's block shares (bounces, gate, speeds); `type` decides the defaults of the gate.
TransportSettings readTransport(const ObjectReader& integrator, DefaultGate defaultGate);

} // namespace tungsten
