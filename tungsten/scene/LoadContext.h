#pragma once
// What the readers of the scene's blocks share while a scene is loaded, and the readers themselves (one file each).

#include "tungsten/scene/ObjectReader.h"
#include "tungsten/scene/Scene.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tungsten {

struct LoadContext {
    Scene& scene;
    std::filesystem::path resourceDirectory;
    std::map<std::string, BsdfPtr> bsdfs;                         ///< by name; the first definition wins
    std::map<std::string, int> media;                             ///< by name
    std::map<std::string, std::shared_ptr<const Bitmap>> bitmaps; ///< by file and lookup settings
    std::vector<std::filesystem::path> resources;                 ///< every file read, for the hash
    std::vector<ObjectReader> emitters;                           ///< the objects of the scene's emitters

    /// Resolves against the scene's (or the input) directory and remembers the file.
    std::filesystem::path resource(const std::string& name);
};

/// A texture field: number or RGB (constant), path string (bitmap), or object. Constant values must lie in `range`.
Texture readTexture(LoadContext& context, const ObjectReader& owner, const std::string& field, const Texture& fallback,
                    Range range = {});
std::vector<std::string> textureTypes();
/// One colour out of a texture field that may not vary (point emitters).
Rgb readConstantTexture(LoadContext& context, const ObjectReader& owner, const std::string& field);

/// A medium by name or as an inline object; -1 and a problem if there is none of that name.
int readMediumReference(LoadContext& context, const ObjectReader& owner, const std::string& field);
void readMedia(LoadContext& context, const ObjectReader& root);
std::vector<std::string> mediumTypes();
std::vector<std::string> phaseFunctionTypes();

/// A BSDF by name or as an inline object.
BsdfPtr readBsdfReference(LoadContext& context, const ObjectReader& owner, const std::string& field);
/// One BSDF, or an array indexed by the mesh's materials.
std::vector<BsdfPtr> readBsdfList(LoadContext& context, const ObjectReader& owner, const std::string& field);
void readBsdfs(LoadContext& context, const ObjectReader& root);
std::vector<std::string> bsdfTypes();

void readPrimitives(LoadContext& context, const ObjectReader& root);
std::vector<std::string> primitiveTypes();
void readCamera(LoadContext& context, const ObjectReader& root);
std::vector<std::string> cameraTypes();
RendererSettings readRenderer(const ObjectReader& root);
/// The fields that every integrator's block shares (bounces, gate, speeds); `type` decides the defaults of the gate.
TransportSettings readTransport(const ObjectReader& integrator, const std::string& type);

} // namespace tungsten
