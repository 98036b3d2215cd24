#include "tungsten/io/Outputs.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/InsideFolder.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/Destination.h"
#include "tungsten/image/ToneMap.h"
#include "tungsten/io/ContactSheet.h"
#include "tungsten/io/Result.h"
#include "tungsten/io/Video.h"
#include "tungsten/io/Writers.h"

#include <algorithm>
#include <cctype>
#include <climits>
#include <set>

#include <unistd.h>

namespace tungsten {

namespace {

namespace fs = std::filesystem;
using Content = PlannedImage::Content;

const std::vector<std::string> HdrExtensions{".exr", ".npz", ".h5", ".pfm", ".npy"};

/// The name, or the name with 001, 002, ... before its extension, whichever is free first.
fs::path freeName(const fs::path& file) {
    fs::path candidate = file;
    for (int i = 1; fs::exists(candidate); ++i) {
        char number[16];
        std::snprintf(number, sizeof number, "%03d", i);
        candidate = withSuffix(file, number);
    }
    return candidate;
}

void checkExtension(const fs::path& file, const std::vector<std::string>& accepted) {
    if (file.empty() || std::find(accepted.begin(), accepted.end(), extensionOf(file)) != accepted.end()) return;
    throw InputError(file.string(),
                     "unknown image type '" + file.extension().string() + "'; accepted: " + listOf(accepted));
}

/// All files of a render.
std::vector<fs::path> plannedFiles(const OutputFiles& outputs, const OutputPlan& plan) {
    std::vector<fs::path> files;
    for (const PlannedImage& image : plannedImages(outputs, plan.frames, "")) files.push_back(image.file);
    if (plan.checkpoints)
        for (const PlannedImage& image : plannedImages(outputs, plan.frames, CheckpointSuffix))
            files.push_back(image.file);
    if (!outputs.statistics.empty()) files.push_back(outputs.statistics);
    if (!outputs.page.empty()) files.push_back(outputs.page);
    if (plan.state) files.push_back(outputs.state);
    files.insert(files.end(), plan.others.begin(), plan.others.end());
    return files;
}

InputError noFilesIn(const fs::path& folder, const fs::path& file) {
    return {file.string(), "cannot be written: the folder '" + folder.string() +
                               "' cannot be created or written to; choose another with -d DIRECTORY"};
}

void checkName(const fs::path& file) {
    requireReplaceable(file);
    const long longest = ::pathconf(folderOf(file).c_str(), _PC_NAME_MAX);
    const size_t length = file.filename().string().size();
    if (length == 0 || (longest > 0 && length > size_t(longest)))
        throw InputError(file.string(), "cannot be written: the name has " + std::to_string(length) +
                                            " bytes, the folder takes 1 to " + std::to_string(longest) +
                                            "; choose another with -o or -e");
}

/// Of a scene's name for an output, which stands at a place in it.
void requireInside(const fs::path& file, const fs::path& top, Problem place) {
    for (const fs::path& step : file)
        if (step.string().size() > NAME_MAX) {
            place.message = "a name of " + std::to_string(step.string().size()) + " bytes, folders take " +
                            std::to_string(NAME_MAX);
            throw InputError({place});
        }
    if (isInside(file, top)) return;
    const std::string folder = top.empty() ? "." : top.string();
    place.message = "'" + file.string() + "' lies outside the output folder '" + folder +
                    "'; -d chooses another, and if you trust the scene, --allow-outside lets it write anywhere";
    throw InputError({place});
}

/// Links in the folder that a scene writes to may be the scene's.
void requireNoWayOut(const fs::path& file, const std::optional<fs::path>& within) {
    if (!within) return;
    const fs::path end = destinationOf(file), top = within->empty() ? fs::path(".") : *within;
    if (end != file && isInside(folderOf(file), top) && !isInside(end, top))
        throw InputError(file.string(), "a link that leads out of the output folder '" + top.string() + "', to " +
                                            end.string() + "; if you trust it, --allow-outside lets it be written to");
}

/// Before any folder is made.
void requireOwnNames(const std::vector<fs::path>& files, const OutputPlan& plan) {
    std::set<fs::path> inputs, taken;
    for (const fs::path& input : plan.inputs) inputs.insert(identityOf(input));
    if (!plan.folder.empty()) taken.insert(identityOf(plan.folder));
    for (const fs::path& file : files) {
        if (!file.has_filename())
            throw InputError(file.string(), "cannot be written: this is the name of a folder, not of a file");
        if (inputs.count(identityOf(file)) > 0)
            throw InputError(file.string(), "would be replaced by an output, but the scene reads it; choose another "
                                            "name with -d, -o, -e or --stats");
        if (!taken.insert(identityOf(file)).second)
            throw InputError(file.string(), "is the name of two outputs; choose another for one of them with -o, -e, "
                                            "--stats or --trace");
    }
}

/// OpenEXR keeps a header of 28 KiB for every part, in memory and while it writes.
void requireFewFrames(const fs::path& file, int frames) {
    constexpr int MostParts = 10000;
    if (extensionOf(file) == ".exr" && frames > MostParts)
        throw InputError(file.string(), "cannot hold " + std::to_string(frames) + " frames; .exr takes " +
                                            std::to_string(MostParts) + ", .npz, .h5 and .npy any number of them");
}

/// Files that hold all frames as arrays.
bool holdsArrays(const fs::path& file) {
    const std::string extension = extensionOf(file);
    return extension == ".npy" || extension == ".npz" || extension == ".h5";
}

/// Writes what it can: a file that fails does not keep the others from being written.
class ImageWriter {
  public:
    ImageWriter(const Film& film, const Film& bias, const Scene& scene, const std::string& metadata,
                const std::optional<ExposureChoice>& exposure)
        : film_(film), bias_(bias), scene_(scene), metadata_(metadata),
          exposure_(exposure.value_or(ExposureChoice{!scene.transport.gate.steadyState, 0.0})) {}

    /// What an array holds is told (by the file that follows it) only where the array was written.
    void write(const PlannedImage& image) {
        if (image.content == Content::Metadata && lastFailed_) return;
        lastFailed_ = true;
        try {
            makeFolderOf(image.file);
            writeContent(image);
            written_.push_back(image.file);
            lastFailed_ = false;
        } catch (const InputError& error) {
            problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
        }
    }
    /// Throws if any file failed.
    [[nodiscard]] std::vector<fs::path> finish() const {
        if (!problems_.empty()) throw InputError(problems_);
        return written_;
    }

  private:
    void writeContent(const PlannedImage& image) {
        const bool frame = image.content == Content::Frame;
        const std::string extension = extensionOf(image.file);
        if (image.content == Content::Metadata)
            writeTextFile(image.file, metadata_);
        else if (image.content == Content::Cube || extension == ".npy")
            writeCube(image.file);
        else if (extension == ".npz")
            writeNpz(image.file, resultContent(film_, bias_, scene_, metadata_));
        else if (extension == ".h5")
            writeHdf5(image.file, resultContent(film_, bias_, scene_, metadata_));
        else if (extension == ".exr")
            writeExr(
                image.file, frame ? 1 : film_.frames(), [&](int i) { return exrPart(frame ? image.frame : i); },
                metadata_);
        else if (extension == ".pfm")
            writePfm(image.file, frame ? overFrame(film_.mean(image.frame)) : wholeImage());
        else
            writeShown(image);
    }
    /// 8-bit images of frames have one exposure, so that they can be compared; that of the whole gate has its own.
    void writeShown(const PlannedImage& image) {
        if (image.linear) return writePng(image.file, wholeImage(), ToneMap::Linear);
        const auto shown = [this](int frame) { return exposed(overFrame(film_.mean(frame)), framesFactor()); };
        if (image.content == Content::Video)
            writeVideo(image.file, {film_.width(), film_.height()}, film_.frames(),
                       [&](int frame) { return toneMapped(shown(frame), scene_.toneMap); });
        else if (image.content == Content::Sheet)
            writePng(image.file, contactSheet(sheetFrames(film_.frames()), shown), scene_.toneMap);
        else if (image.content == Content::Frame)
            writePng(image.file, shown(image.frame), scene_.toneMap);
        else
            writePng(image.file, exposed(wholeImage(), wholeFactor()), scene_.toneMap);
    }
    [[nodiscard]] static Image exposed(Image image, float factor) {
        for (Rgb& pixel : image.pixels) pixel *= factor;
        return image;
    }
    [[nodiscard]] float wholeFactor() const {
        if (!exposure_.automatic) return exposureFactor(exposure_.stops);
        const auto automatic = std::make_unique<AutomaticExposure>();
        automatic->include(wholeImage());
        return automatic->factor();
    }
    [[nodiscard]] float framesFactor() {
        if (!exposure_.automatic) return exposureFactor(exposure_.stops);
        if (!framesFactor_) {
            const auto automatic = std::make_unique<AutomaticExposure>();
            for (int frame = 0; frame < film_.frames(); ++frame) automatic->include(overFrame(film_.mean(frame)));
            framesFactor_ = automatic->factor();
        }
        return *framesFactor_;
    }
    [[nodiscard]] Image overFrame(Image average) const { return inOutputUnits(std::move(average), scene_, 1); }
    [[nodiscard]] Image wholeImage() const { return inOutputUnits(film_.meanOverFrames(), scene_, film_.frames()); }
    [[nodiscard]] ExrPart exrPart(int frame) const {
        const TimeGate& gate = scene_.transport.gate;
        char name[32];
        std::snprintf(name, sizeof name, "frame.%04d", frame);
        ExrPart part{.name = name,
                     .colour = overFrame(film_.mean(frame)),
                     .standardError = overFrame(film_.standardError(frame)),
                     .hasTime = !gate.steadyState,
                     .timeStart = gate.frameStart(frame),
                     .timeEnd = gate.frameStart(frame + 1)};
        if (frame >= bias_.frames()) return part;
        part.bias = overFrame(bias_.mean(frame));
        part.biasError = overFrame(bias_.standardError(frame));
        return part;
    }
    void writeCube(const fs::path& file) const {
        writeNpy(file, film_.frames(), [this](int frame) { return overFrame(film_.mean(frame)); });
    }

    const Film &film_, &bias_;
    const Scene& scene_;
    const std::string& metadata_;
    ExposureChoice exposure_;
    std::optional<float> framesFactor_; ///< once it is known
    bool lastFailed_ = false;
    std::vector<fs::path> written_;
    std::vector<Problem> problems_;
};

} // namespace

fs::path identityOf(const fs::path& file) {
    std::error_code error;
    fs::path end = file;
    try {
        end = destinationOf(file);
    } catch (const InputError&) { // told when the file is checked
    }
    const fs::path folder = fs::weakly_canonical(fs::absolute(end).parent_path(), error);
    return folder / end.filename();
}

fs::path OutputOverrides::placed(const fs::path& file) const {
    if (!directory || file.empty()) return file;
    std::error_code error;
    const fs::file_type type = fs::symlink_status(file, error).type();
    const bool leads = type != fs::file_type::none && type != fs::file_type::not_found &&
                       type != fs::file_type::regular && type != fs::file_type::directory;
    if (leads) return file;
    const fs::path folder = directory->lexically_normal() / "", name = file.lexically_normal();
    const auto parts = std::mismatch(folder.begin(), std::prev(folder.end()), name.begin(), name.end());
    const bool isThere = folder != "./" && folder != "/" && parts.first == std::prev(folder.end());
    return isThere ? file : *directory / file;
}

fs::path OutputFiles::partialState(uint32_t first, uint32_t end) const {
    const std::string name = ldr.stem().string() + "_passes_" + std::to_string(first) + "-" + std::to_string(end);
    return ldr.parent_path() / (name + ".state");
}

OutputFiles resolveOutputs(const RendererSettings& renderer, const fs::path& sceneFile,
                           const OutputOverrides& overrides) {
    // -d rebases every name; otherwise relative names are below the scene's output directory.
    const fs::path base =
        overrides.directory ? *overrides.directory : sceneFile.parent_path() / renderer.outputDirectory;
    const fs::path top = overrides.directory ? *overrides.directory : sceneFile.parent_path();
    const auto rebase = [&](const std::string& name, const std::string& field) {
        const fs::path file = name.empty() ? fs::path() : (base / name).lexically_normal();
        if (!overrides.allowOutside && !name.empty()) requireInside(file, top, {sceneFile, "renderer." + field, ""});
        return file;
    };
    OutputFiles outputs;
    if (!overrides.allowOutside) outputs.within = top;
    outputs.ldr = overrides.ldr ? overrides.placed(*overrides.ldr) : rebase(renderer.outputFile, "output_file");
    outputs.hdr = overrides.hdr ? overrides.placed(*overrides.hdr) : rebase(renderer.hdrOutputFile, "hdr_output_file");
    if (overrides.statistics) outputs.statistics = overrides.placed(*overrides.statistics);
    if (overrides.page) outputs.page = overrides.placed(*overrides.page);
    if (overrides.sheet) outputs.sheet = overrides.placed(*overrides.sheet);
    if (overrides.video) outputs.video = overrides.placed(*overrides.video);
    outputs.frames = !overrides.noFrames;
    outputs.exposure = overrides.exposure ? overrides.exposure : renderer.exposure;
    if (outputs.ldr.empty()) outputs.ldr = rebase("TungstenRender.png", "output_file");
    // Scenes of one command have different images, and so different states.
    outputs.state = renderer.resumeFile ? rebase(*renderer.resumeFile, "resume_render_file")
                                        : (base / (outputs.ldr.stem().string() + "State.dat")).lexically_normal();
    if (!renderer.overwriteOutputFiles && !overrides.ldr) outputs.ldr = freeName(outputs.ldr);
    if (!renderer.overwriteOutputFiles && !overrides.hdr && !outputs.hdr.empty()) outputs.hdr = freeName(outputs.hdr);
    const auto resolved = [&](const OutputBuffer& buffer) {
        return OutputBuffer{rebase(buffer.ldrFile, "output_buffers").string(),
                            rebase(buffer.hdrFile, "output_buffers").string()};
    };
    for (const OutputBuffer& buffer : renderer.colors) outputs.colors.push_back(resolved(buffer));
    for (const OutputBuffer& buffer : renderer.transients) outputs.series.push_back(resolved(buffer));
    return outputs;
}

void makeFolderOf(const fs::path& file) {
    const fs::path folder = folderOf(file);
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder, error)) throw noFilesIn(folder, file);
}

void checkWritable(const fs::path& named, const std::optional<fs::path>& within) {
    requireNoWayOut(named, within);
    if (descriptorNamed(named)) return requireReplaceable(named);
    const fs::path file = destinationOf(named);
    makeFolderOf(file);
    if (!takesFiles(folderOf(file))) throw noFilesIn(folderOf(file), file);
    checkName(file);
}

void checkOutputs(const OutputFiles& outputs, const OutputPlan& plan) {
    checkExtension(outputs.ldr, {".png"});
    checkExtension(outputs.hdr, HdrExtensions);
    checkExtension(outputs.page, {".html", ".htm"});
    checkExtension(outputs.sheet, {".png"});
    checkExtension(outputs.video, {".mp4", ".gif"});
    requireFewFrames(outputs.hdr, plan.frames);
    for (const OutputBuffer& buffer : outputs.colors) requireFewFrames(buffer.hdrFile, plan.frames);
    if (!outputs.video.empty()) requireFfmpeg(outputs.video);
    for (const fs::path& film : {outputs.sheet, outputs.video})
        if (!film.empty() && plan.frames <= 1)
            throw InputError(film.string(), "would show the frames of a sequence, but the scene has one image; give it "
                                            "an integrator.frame_num");
    const auto check = [](const OutputBuffer& buffer, const std::vector<std::string>& hdrExtensions) {
        checkExtension(buffer.ldrFile, {".png"});
        checkExtension(buffer.hdrFile, hdrExtensions);
    };
    for (const OutputBuffer& buffer : outputs.colors) check(buffer, HdrExtensions);
    for (const OutputBuffer& buffer : outputs.series) check(buffer, {".exr", ".pfm"});
    if (plan.state && outputs.state.empty())
        throw InputError("", "the resume state has no name: renderer.resume_render_file is empty");
    const std::vector<fs::path> files = plannedFiles(outputs, plan);
    requireOwnNames(files, plan);
    std::set<fs::path> folders;
    for (const fs::path& named : files) {
        const fs::path file = destinationOf(named);
        if (named != file || folders.insert(folderOf(file)).second)
            checkWritable(named, outputs.within);
        else
            checkName(file);
    }
    for (const fs::path& folder : folders) removeAbandonedFiles(folder);
}

fs::path withSuffix(const fs::path& file, const std::string& suffix) {
    return file.parent_path() / (file.stem().string() + suffix + file.extension().string());
}

std::string extensionOf(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::vector<PlannedImage> plannedImages(const OutputFiles& outputs, int frames, const std::string& suffix) {
    std::vector<PlannedImage> images;
    const auto add = [&](const fs::path& file, Content content = Content::Whole, int frame = 0, bool linear = false) {
        if (file.empty()) return;
        images.push_back({file, content, frame, linear});
        if (extensionOf(file) == ".npy") images.push_back({file.string() + ".json", Content::Metadata, 0, false});
    };
    const auto series = [&](const fs::path& file) {
        for (int frame = 0; frame < frames && !file.empty(); ++frame)
            add(framePath(file, frame, frames), Content::Frame, frame);
    };
    const fs::path hdr = outputs.hdr.empty() ? fs::path() : withSuffix(outputs.hdr, suffix);
    add(withSuffix(outputs.ldr, suffix));
    add(hdr);
    if (!suffix.empty()) return images;
    for (const OutputBuffer& buffer : outputs.colors) {
        add(buffer.ldrFile, Content::Whole, 0, true);
        add(buffer.hdrFile);
    }
    if (frames <= 1) return images;
    if (!hdr.empty() && !holdsArrays(hdr)) add(fs::path(hdr).replace_extension(".npy"), Content::Cube);
    add(outputs.sheet, Content::Sheet);
    add(outputs.video, Content::Video);
    if (outputs.series.empty()) {
        if (outputs.frames) series(outputs.ldr);
        if (extensionOf(hdr) == ".pfm") series(hdr);
    }
    for (const OutputBuffer& buffer : outputs.series) {
        series(buffer.ldrFile);
        series(buffer.hdrFile);
    }
    return images;
}

std::vector<fs::path> writeImages(const Film& film, const Film& bias, const Scene& scene, const OutputFiles& outputs,
                                  const std::string& metadata, const std::string& suffix) {
    ImageWriter writer(film, bias, scene, metadata, outputs.exposure);
    for (const PlannedImage& image : plannedImages(outputs, film.frames(), suffix)) writer.write(image);
    return writer.finish();
}

std::filesystem::path framePath(const std::filesystem::path& file, int frame, int frames) {
    const size_t digits = std::max<size_t>(std::to_string(std::max(frames - 1, 0)).size(), 2);
    const std::string number = std::to_string(frame);
    const std::string padded = std::string(digits - std::min(digits, number.size()), '0') + number;
    return file.parent_path() / (file.stem().string() + "_" + padded + file.extension().string());
}

} // namespace tungsten
