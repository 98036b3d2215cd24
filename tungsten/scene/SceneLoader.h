#pragma once
// Scene files in, typed scenes out.

#include "tungsten/image/Exposure.h"
#include "tungsten/reader/ObjectReader.h"
#include "tungsten/scene/Scene.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tungsten {

/// Of fields that name images. Which formats there are is not known here: whoever describes them adds it.
namespace meaning {
inline constexpr const char* ToneMappedImage = "tone-mapped image";
inline constexpr const char* EightBitImage = "8-bit image";
inline constexpr const char* LinearImage = "linear image";
} // namespace meaning

/// An entry of `output_buffers`.
struct OutputBuffer {
    std::string ldrFile, hdrFile; ///< empty: not written
};

/// The `renderer` block; file names as in the scene, not yet resolved.
struct RendererSettings {
    std::string outputDirectory;
    std::string outputFile = "TungstenRender.png";
    std::string hdrOutputFile;
    std::optional<ExposureChoice> exposure; ///< of 8-bit images; none: left to the gate
    std::optional<std::string> resumeFile;  ///< none: named after the image
    bool overwriteOutputFiles = true;
    bool enableResume = false;
    int64_t spp = 32;
    int64_t sppStep = 16;
    double checkpointSeconds = 0.0;       ///< 0: none
    double timeoutSeconds = 0.0;          ///< 0: none
    std::vector<OutputBuffer> colors;     ///< further files of the image
    std::vector<OutputBuffer> transients; ///< per-frame file series
};

/// Of the types that Tungsten names, where the integrators that there are do not say it.
DefaultGate defaultGateOf(const std::string& type);

struct LoadOptions {
    std::filesystem::path inputDirectory; ///< base of resources; empty: the scene's directory
    std::vector<std::string> overrides;   ///< "path.to.field=value", applied to the JSON in order
    bool allowOutside = false;            ///< resources may lie outside that directory
    std::optional<std::string> text = {}; ///< the scene itself: the file's name is then only told in messages
    LoadWatch watch = {};                 ///< what it throws ends the loading
    /// Reads the integrator's block, with the transport that is read from it, where a scene has problems: those of the
    /// block, which its integrator reads once there is a scene, are then told along.
    std::function<void(const ObjectReader& block, const std::string& type, const TransportSettings& transport)>
        readIntegrator = {};
    std::function<DefaultGate(const std::string& type)> defaultGate = defaultGateOf; ///< by type of integrator
};

struct LoadedScene {
    std::shared_ptr<const Scene> scene;
    RendererSettings renderer;
    std::string integratorType;
    ObjectReader integratorSettings; ///< the integrator block, for its plugin; warns about fields nobody reads
    std::shared_ptr<Diagnostics> diagnostics;
    std::vector<std::filesystem::path> inputs; ///< every file that was read, the scene's own first
    /// Of the scene without its renderer block, overrides included, and of the contents of all files that it names and
    /// that these name (buffers of glTF files); where they lie does not matter.
    uint64_t hash = 0;
    std::string text; ///< of the scene, overrides included: JSON in one line
};

/// The renderer block alone, with overrides; defaults where the file or the block cannot be read.
RendererSettings peekRenderer(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// Reads and checks a scene file. Throws InputError listing every problem found, UsageError for an override that names
/// nothing.
LoadedScene loadScene(const std::filesystem::path& file, const LoadOptions& options = {});

/// Every type name a scene can use, by kind ("media", "bsdfs", ...).
std::vector<std::pair<std::string, std::vector<std::string>>> sceneTypes();

/// The fields of every type of a kind, or of every block.
struct DescribedKind {
    std::string kind;
    std::vector<std::shared_ptr<Description>> types;
};
/// The blocks "scene" and "renderer", then the kinds of sceneTypes(); blocks within others hang on those.
std::vector<DescribedKind> describeScene();
/// The fields that every integrator's block shares, with its default gate.
void describeTransport(const ObjectReader& describing, DefaultGate gate);
/// A scene without surfaces, lit by the default light: enough for an integrator to say what it reads.
std::shared_ptr<const Scene> emptyScene(const TransportSettings& transport = {});

/// Throws InputError if any problem has been recorded.
void throwIfProblems(const Diagnostics& diagnostics);

} // namespace tungsten
