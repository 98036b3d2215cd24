#include "tungsten/render/Outputs.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/InsideFolder.h"
#include "tungsten/film/AtomicFile.h"
#include "tungsten/film/ImageIo.h"
#include "tungsten/render/ResultDescription.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <unistd.h>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> HdrExtensions{".exr", ".npz", ".h5", ".pfm", ".npy"};

fs::path withSuffix(const fs::path& file, const std::string& suffix) {
    return file.parent_path() / (file.stem().string() + suffix + file.extension().string());
}

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

/// Lower case, dot included.
std::string extensionOf(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

/// Files that hold all frames as arrays.
bool holdsArrays(const fs::path& file) {
    const std::string extension = extensionOf(file);
    return extension == ".npy" || extension == ".npz" || extension == ".h5";
}

/// One file of a film: the image of the whole gate (formats that hold several frames get all of them), one frame, all
/// frames as an array, or what is known about them.
struct PlannedImage {
    enum class Content { Whole, Frame, Cube, Metadata };
    fs::path file;
    Content content = Content::Whole;
    int frame = 0;
    bool linear = false; ///< not tone-mapped, where it is an 8-bit image
};

using Content = PlannedImage::Content;

/// Every image that is written, with a `suffix` (which goes before the extension: checkpoints) only the main ones.
std::vector<PlannedImage> plannedImages(const OutputFiles& outputs, int frames, const std::string& suffix) {
    std::vector<PlannedImage> images;
    const auto add = [&](const fs::path& file, Content content = Content::Whole, int frame = 0, bool linear = false) {
        if (file.empty()) return;
        images.push_back({file, content, frame, linear});
        if (extensionOf(file) == ".npy") images.push_back({file.string() + ".json", Content::Metadata, 0, false});
    };
    const auto series = [&](const fs::path& file) {
        for (int frame = 0; frame < frames && !file.empty(); ++frame)
            add(framePath(file, frame), Content::Frame, frame);
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
    if (outputs.series.empty()) {
        series(outputs.ldr);
        if (extensionOf(hdr) == ".pfm") series(hdr);
    }
    for (const OutputBuffer& buffer : outputs.series) {
        series(buffer.ldrFile);
        series(buffer.hdrFile);
    }
    return images;
}

/// Writes what it can: a file that fails does not keep the others from being written.
class ImageWriter {
  public:
    ImageWriter(const Film& film, const Film& bias, const Scene& scene, const std::string& metadata)
        : film_(film), bias_(bias), scene_(scene), metadata_(metadata) {}

    void write(const PlannedImage& image) {
        try {
            makeFolderOf(image.file);
            writeContent(image);
            written_.push_back(image.file);
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
    void writeContent(const PlannedImage& image) const {
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
            writeExr(image.file, frame ? std::vector<ExrPart>{exrPart(image.frame)} : allFrames(), metadata_);
        else if (extension == ".pfm")
            writePfm(image.file, frame ? overFrame(film_.mean(image.frame)) : wholeImage());
        else
            writePng(image.file, frame ? overFrame(film_.mean(image.frame)) : wholeImage(),
                     image.linear ? ToneMap::Linear : scene_.toneMap);
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
    [[nodiscard]] std::vector<ExrPart> allFrames() const {
        std::vector<ExrPart> parts;
        for (int frame = 0; frame < film_.frames(); ++frame) parts.push_back(exrPart(frame));
        return parts;
    }
    void writeCube(const fs::path& file) const {
        std::vector<Image> frames;
        for (int frame = 0; frame < film_.frames(); ++frame) frames.push_back(overFrame(film_.mean(frame)));
        writeNpy(file, frames);
    }

    const Film &film_, &bias_;
    const Scene& scene_;
    const std::string& metadata_;
    std::vector<fs::path> written_;
    std::vector<Problem> problems_;
};

void checkExtension(const fs::path& file, const std::vector<std::string>& accepted) {
    if (file.empty() || std::find(accepted.begin(), accepted.end(), extensionOf(file)) != accepted.end()) return;
    throw InputError(file.string(),
                     "unknown image type '" + file.extension().string() + "'; accepted: " + listOf(accepted));
}

/// Names a file whatever links lead to it; it need not exist.
fs::path identityOf(const fs::path& file) {
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::absolute(file).parent_path(), error);
    return folder / file.filename();
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
    return files;
}

} // namespace

fs::path OutputFiles::partialState(uint32_t first, uint32_t end) const {
    const std::string name = ldr.stem().string() + "_passes_" + std::to_string(first) + "-" + std::to_string(end);
    return ldr.parent_path() / (name + ".state");
}

Image inOutputUnits(Image average, const Scene& scene, int frames) {
    const TimeGate& gate = scene.transport.gate;
    if (!scene.transport.integrateOverGate || gate.steadyState || gate.delta) return average;
    const float width = float(gate.frameWidth * frames);
    for (Rgb& pixel : average.pixels) pixel *= width;
    return average;
}

OutputFiles resolveOutputs(const RendererSettings& renderer, const fs::path& sceneFile,
                           const OutputOverrides& overrides) {
    // -d rebases every name; otherwise relative names are below the scene's output directory.
    const fs::path base =
        overrides.directory ? *overrides.directory : sceneFile.parent_path() / renderer.outputDirectory;
    const auto commandLine = [&](const fs::path& file) {
        return overrides.directory ? *overrides.directory / file : file;
    };
    const fs::path top = overrides.directory ? *overrides.directory : sceneFile.parent_path();
    const auto rebase = [&](const std::string& name) {
        const fs::path file = name.empty() ? fs::path() : (base / name).lexically_normal();
        if (!overrides.allowOutside && !name.empty() && !isInside(file, top))
            throw InputError(file.string(), "lies outside the output folder '" + top.string() +
                                                "'; -d chooses another, and if you trust the scene, --allow-outside "
                                                "lets it write anywhere");
        return file;
    };
    OutputFiles outputs;
    outputs.ldr = overrides.ldr ? commandLine(*overrides.ldr) : rebase(renderer.outputFile);
    outputs.hdr = overrides.hdr ? commandLine(*overrides.hdr) : rebase(renderer.hdrOutputFile);
    if (overrides.statistics) outputs.statistics = *overrides.statistics;
    if (overrides.page) outputs.page = *overrides.page;
    if (outputs.ldr.empty()) outputs.ldr = rebase("TungstenRender.png");
    // Scenes of one command have different images, and so different states.
    outputs.state = rebase(renderer.resumeFile.value_or(outputs.ldr.stem().string() + "State.dat"));
    if (!renderer.overwriteOutputFiles && !overrides.ldr) outputs.ldr = freeName(outputs.ldr);
    if (!renderer.overwriteOutputFiles && !overrides.hdr && !outputs.hdr.empty()) outputs.hdr = freeName(outputs.hdr);
    const auto resolved = [&](const OutputBuffer& buffer) {
        return OutputBuffer{rebase(buffer.ldrFile).string(), rebase(buffer.hdrFile).string()};
    };
    for (const OutputBuffer& buffer : renderer.colors) outputs.colors.push_back(resolved(buffer));
    for (const OutputBuffer& buffer : renderer.transients) outputs.series.push_back(resolved(buffer));
    return outputs;
}

void makeFolderOf(const fs::path& file) {
    const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder, error))
        throw InputError(file.string(), "cannot be written: the folder '" + folder.string() +
                                            "' cannot be created or written to; choose another with -d DIRECTORY");
}

void checkWritable(const fs::path& file) {
    makeFolderOf(file);
    const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
    if (::access(folder.c_str(), W_OK) != 0)
        throw InputError(file.string(), "cannot be written: the folder '" + folder.string() +
                                            "' cannot be created or written to; choose another with -d DIRECTORY");
    requireReplaceable(file);
    const long longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
    const size_t length = file.filename().string().size();
    if (length == 0 || (longest > 0 && length > size_t(longest)))
        throw InputError(file.string(), "cannot be written: the name has " + std::to_string(length) +
                                            " bytes, the folder takes 1 to " + std::to_string(longest) +
                                            "; choose another with -o or -e");
}

void checkOutputs(const OutputFiles& outputs, const OutputPlan& plan) {
    checkExtension(outputs.ldr, {".png"});
    checkExtension(outputs.hdr, HdrExtensions);
    checkExtension(outputs.page, {".html", ".htm"});
    const auto check = [](const OutputBuffer& buffer, const std::vector<std::string>& hdrExtensions) {
        checkExtension(buffer.ldrFile, {".png"});
        checkExtension(buffer.hdrFile, hdrExtensions);
    };
    for (const OutputBuffer& buffer : outputs.colors) check(buffer, HdrExtensions);
    for (const OutputBuffer& buffer : outputs.series) check(buffer, {".exr", ".pfm"});
    if (plan.state && outputs.state.empty())
        throw InputError("", "the resume state has no name: renderer.resume_render_file is empty");
    std::set<fs::path> folders, inputs, taken;
    for (const fs::path& input : plan.inputs) inputs.insert(identityOf(input));
    for (const fs::path& file : plannedFiles(outputs, plan)) {
        checkWritable(file);
        folders.insert(file.parent_path());
        if (inputs.count(identityOf(file)) > 0)
            throw InputError(file.string(), "would be replaced by an output, but the scene reads it; choose another "
                                            "name with -d, -o, -e or --stats");
        if (!taken.insert(identityOf(file)).second)
            throw InputError(file.string(), "is the name of two outputs; choose another for one of them with -o, -e "
                                            "or --stats");
    }
    for (const fs::path& folder : folders) removeAbandonedFiles(folder.empty() ? "." : folder);
}

std::vector<fs::path> writeImages(const Film& film, const Film& bias, const Scene& scene, const OutputFiles& outputs,
                                  const std::string& metadata, const std::string& suffix) {
    ImageWriter writer(film, bias, scene, metadata);
    for (const PlannedImage& image : plannedImages(outputs, film.frames(), suffix)) writer.write(image);
    return writer.finish();
}

} // namespace tungsten
