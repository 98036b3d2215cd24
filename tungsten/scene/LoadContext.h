#pragma once
// What the readers of the scene's blocks share while a scene is loaded, and the readers themselves (one file each).

#include "tungsten/bsdf/BsdfReader.h"
#include "tungsten/scene/Scene.h"
#include "tungsten/scene/SceneLoader.h"

#include <map>
#include <string>
#include <vector>

namespace tungsten {

struct LoadContext {
    Scene& scene;
    Resources files = {};
    NamedBsdfs bsdfs = {};
    Bitmaps bitmaps = {};
    std::map<std::string, int> media = {};   ///< by name
    std::vector<ObjectReader> emitters = {}; ///< the objects of the scene's emitters

    /// What a model's object is read with.
    [[nodiscard]] BsdfReader fieldsOf(const ObjectReader& object) { return {{object, files, bitmaps}, bsdfs}; }
};

/// Warns about detectors of the camera that a wall covers; once the geometry is there.
void warnAboutBlindDetectors(const LoadContext& context, const ObjectReader& camera);

/// A context to describe types in: nothing is read from files, nothing is kept.
struct ScratchContext {
    Scene scene;
    LoadContext context{scene};
};

/// A medium by name or as an inline object; -1 and a problem if there is none of that name.
int readMediumReference(LoadContext& context, const ObjectReader& owner, const std::string& field,
                        const Meaning& meaning);
void readMedia(LoadContext& context, const ObjectReader& root);
void describeMedium(const std::shared_ptr<Description>& description);
void describePhaseFunction(const std::shared_ptr<Description>& description);
std::vector<std::string> mediumTypes();
std::vector<std::string> phaseFunctionTypes();

void readPrimitives(LoadContext& context, const ObjectReader& root);
void describePrimitive(const std::shared_ptr<Description>& description);
std::vector<std::string> primitiveTypes();
/// `reader` is the camera block.
void readCamera(LoadContext& context, const ObjectReader& root, const ObjectReader& reader);
void describeCamera(const std::shared_ptr<Description>& description);
/// `reader` is the renderer block.
RendererSettings readRenderer(const ObjectReader& reader);
/// `reader` is the film block.
FilmContents readFilm(const ObjectReader& reader);
/// Which integrator the block asks for.
std::string readIntegratorType(const ObjectReader& integrator);
/// The fields that every integrator's block shares (bounces, gate, speeds); `type` decides the defaults of the gate.
TransportSettings readTransport(const ObjectReader& integrator, DefaultGate defaultGate);

} // namespace tungsten
