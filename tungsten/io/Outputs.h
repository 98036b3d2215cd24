#pragma once
// Which files a render writes, and writing them.

#include "tungsten/film/Film.h"
#include "tungsten/image/Exposure.h"
#include "tungsten/io/Format.h"
#include "tungsten/scene/SceneLoader.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace tungsten {

/// Where results go; relative paths are relative to the process directory.
struct OutputFiles {
    std::filesystem::path ldr;        ///< output_use::Shown, always written
    std::filesystem::path hdr;        ///< output_use::Linear; empty: none
    std::vector<OutputBuffer> colors; ///< further files of the image, the LDR ones not tone-mapped (resolved names)
    std::vector<OutputBuffer> series; ///< per-frame files of sequences (resolved names)
    std::filesystem::path state;      ///< resume state
    std::filesystem::path statistics; ///< JSON; empty: none
    std::filesystem::path page;       ///< HTML; empty: none
    std::filesystem::path sheet{};    ///< output_use::Sheet, of all frames; empty: none
    std::filesystem::path video{};    ///< output_use::Video; empty: none
    bool frames = true;               ///< each as an 8-bit image, beside `ldr`
    std::optional<ExposureChoice> exposure{};      ///< of 8-bit images; none: automatic where there is a gate, else 0
    std::optional<std::filesystem::path> within{}; ///< the folder that links in it must not lead out of; none: any may

    /// Of --passes A:B, named after the main image: NAME_passes_A-B.state.
    [[nodiscard]] std::filesystem::path partialState(uint32_t first, uint32_t end) const;
};

/// What the command line says about files (-d, -o, -e, --stats, --html, --sheet, --video, --exposure, --no-frames).
struct OutputOverrides {
    std::optional<std::filesystem::path> directory, ldr, hdr, statistics, page, sheet, video;
    std::optional<ExposureChoice> exposure;
    bool noFrames = false;
    bool allowOutside = false; ///< a scene's names may lead out of the output folder

    /// What the command line calls a file or folder: relative names are below `directory`, if there is one. Those that
    /// begin with it stay, and so do those of links, devices and pipes that are there: they say where to.
    [[nodiscard]] std::filesystem::path placed(const std::filesystem::path& file) const;
};

/// File names of a scene: the renderer block's, resolved against its output directory, unless the command line says
/// otherwise. `overwrite_output_files` false picks names that are free. Names that the scene gives must lie in the
/// output folder (-d, or else the scene's own): InputError.
OutputFiles resolveOutputs(const RendererSettings& renderer, const std::filesystem::path& sceneFile,
                           const OutputOverrides& overrides);

/// What a render is going to write.
struct OutputPlan {
    int frames = 1;
    bool state = false, checkpoints = false;     ///< besides the images
    std::vector<std::filesystem::path> inputs{}; ///< files that must not be replaced
    std::vector<std::filesystem::path> others{}; ///< files that are written besides images, statistics and page
    std::filesystem::path folder{};              ///< whose name is taken, such as that of a trace; empty: none
};

/// Creates missing folders, removes temporary files that killed renders left there, and throws InputError if an output
/// could not be written: unknown extension, more frames than it can hold, no permission, a name that is too long, taken
/// by something that is no file, by an input or by another output.
void checkOutputs(const OutputFiles& outputs, const OutputPlan& plan);

/// The folder of an output, made again if it has gone. Throws InputError.
void makeFolderOf(const std::filesystem::path& file);

/// Before the extension of a checkpoint's images.
inline constexpr const char* CheckpointSuffix = "_checkpoint";

/// Creates missing folders; throws InputError where a file of this name could not be written, or is a link in the
/// folder `within` that leads out of it.
void checkWritable(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within);

/// Names a file whatever links lead to it; it need not exist.
std::filesystem::path identityOf(const std::filesystem::path& file);

/// Every image that is written, with a `suffix` (which goes before the extension: checkpoints) only the main ones.
std::vector<OutputImage> plannedImages(const OutputFiles& outputs, int frames, const std::string& suffix);

/// `NAME<suffix>.ext` for NAME.ext.
std::filesystem::path withSuffix(const std::filesystem::path& file, const std::string& suffix);
/// Writes every image of the film, and of its bias where `bias` has frames, and returns the files' names; with a
/// `suffix` (which goes before the extension: checkpoints) only the main ones. `metadata` (Result.h) goes
/// into the files that can hold it, and beside those that cannot. Throws InputError after trying all of them if any
/// failed.
std::vector<std::filesystem::path> writeImages(const Film& film, const Film& bias, const Scene& scene,
                                               const OutputFiles& outputs, const std::string& metadata,
                                               const std::string& suffix = "");

/// `<folder>/<base>_<frame><extension>`, of so many frames: padded with zeros to two digits, or as many as the last
/// frame has, so that names sort as frames do.
std::filesystem::path framePath(const std::filesystem::path& file, int frame, int frames);

} // namespace tungsten
