#include "tungsten/io/Outputs.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/InsideFolder.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/Destination.h"

#include <algorithm>
#include <climits>
#include <set>

#include <unistd.h>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

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

void checkFormat(const fs::path& file, OutputUses uses) {
    if (!file.empty()) (void)formatOf(file, uses);
}

/// All files of a render.
std::vector<fs::path> plannedFiles(const OutputFiles& outputs, const OutputPlan& plan) {
    std::vector<fs::path> files;
    for (const OutputImage& image : plannedImages(outputs, plan.frames, "")) files.push_back(image.file);
    if (plan.checkpoints)
        for (const OutputImage& image : plannedImages(outputs, plan.frames, CheckpointSuffix))
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

/// Formats that take any number are named.
void requireFewFrames(const fs::path& file, int frames) {
    if (file.empty()) return;
    const OutputFormat& format = formatOf(file, output_use::Linear);
    if (format.mostFrames == 0 || frames <= format.mostFrames) return;
    std::vector<std::string> others;
    for (const OutputFormat* other : outputFormats())
        if ((other->uses & output_use::Linear) != 0 && other->holdsFrames && other->mostFrames == 0)
            others.emplace_back(other->extension);
    throw InputError(file.string(), "cannot hold " + std::to_string(frames) + " frames; " +
                                        std::string(format.extension) + " takes " + std::to_string(format.mostFrames) +
                                        ", " + listOf(others) + " any number of them");
}

/// Writes what it can: a file that fails does not keep the others from being written.
class ImageWriter {
  public:
    explicit ImageWriter(const OutputFilm& film) : film_(film) {}

    /// What an array holds is told (by the file that follows it) only where the array was written.
    void write(const OutputImage& image) {
        if (!image.format && lastFailed_) return;
        lastFailed_ = true;
        try {
            makeFolderOf(image.file);
            if (image.format)
                image.format->write(film_, image);
            else
                writeTextFile(image.file, film_.metadata());
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
    const OutputFilm& film_;
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
    checkFormat(outputs.ldr, output_use::Shown);
    checkFormat(outputs.hdr, output_use::Linear);
    if (!outputs.page.empty()) requireExtension(outputs.page, {".html", ".htm"});
    checkFormat(outputs.sheet, output_use::Sheet);
    checkFormat(outputs.video, output_use::Video);
    requireFewFrames(outputs.hdr, plan.frames);
    for (const OutputBuffer& buffer : outputs.colors) requireFewFrames(buffer.hdrFile, plan.frames);
    for (const fs::path& film : {outputs.sheet, outputs.video})
        if (!film.empty() && plan.frames <= 1)
            throw InputError(film.string(), "would show the frames of a sequence, but the scene has one image; give it "
                                            "an integrator.frame_num");
    const auto check = [](const OutputBuffer& buffer, OutputUses uses) {
        checkFormat(buffer.ldrFile, output_use::Shown);
        checkFormat(buffer.hdrFile, uses);
    };
    for (const OutputBuffer& buffer : outputs.colors) check(buffer, output_use::Linear);
    for (const OutputBuffer& buffer : outputs.series) check(buffer, output_use::Series);
    for (const OutputImage& image : plannedImages(outputs, plan.frames, ""))
        if (image.format && image.format->require) image.format->require(image.file);
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

std::vector<OutputImage> plannedImages(const OutputFiles& outputs, int frames, const std::string& suffix) {
    std::vector<OutputImage> images;
    const auto add = [&](const fs::path& file, OutputUses uses, std::optional<int> frame = {}, bool linear = false) {
        if (file.empty()) return;
        const OutputFormat& format = formatOf(file, uses);
        images.push_back({file, &format, frame, linear});
        if (format.needsMetadata) images.push_back({file.string() + ".json"});
    };
    const auto series = [&](const fs::path& file, OutputUses uses) {
        for (int frame = 0; frame < frames && !file.empty(); ++frame) add(framePath(file, frame, frames), uses, frame);
    };
    const fs::path hdr = outputs.hdr.empty() ? fs::path() : withSuffix(outputs.hdr, suffix);
    add(withSuffix(outputs.ldr, suffix), output_use::Shown);
    add(hdr, output_use::Linear);
    if (!suffix.empty()) return images;
    for (const OutputBuffer& buffer : outputs.colors) {
        add(buffer.ldrFile, output_use::Shown, {}, true);
        add(buffer.hdrFile, output_use::Linear);
    }
    if (frames <= 1) return images;
    const OutputFormat* linear = hdr.empty() ? nullptr : &formatOf(hdr, output_use::Linear);
    if (linear && !linear->holdsArrays) add(fs::path(hdr).replace_extension(".npy"), output_use::Linear);
    add(outputs.sheet, output_use::Sheet);
    add(outputs.video, output_use::Video);
    if (outputs.series.empty()) {
        if (outputs.frames) series(outputs.ldr, output_use::Shown);
        if (linear && !linear->holdsFrames) series(hdr, output_use::Linear);
    }
    for (const OutputBuffer& buffer : outputs.series) {
        series(buffer.ldrFile, output_use::Shown);
        series(buffer.hdrFile, output_use::Series);
    }
    return images;
}

std::vector<fs::path> writeImages(const Film& film, const Film& bias, const Scene& scene, const OutputFiles& outputs,
                                  const std::string& metadata, const std::string& suffix) {
    const OutputFilm shown(film, bias, scene, metadata, outputs.exposure);
    ImageWriter writer(shown);
    for (const OutputImage& image : plannedImages(outputs, film.frames(), suffix)) writer.write(image);
    return writer.finish();
}

std::filesystem::path framePath(const std::filesystem::path& file, int frame, int frames) {
    const size_t digits = std::max<size_t>(std::to_string(std::max(frames - 1, 0)).size(), 2);
    const std::string number = std::to_string(frame);
    const std::string padded = std::string(digits - std::min(digits, number.size()), '0') + number;
    return file.parent_path() / (file.stem().string() + "_" + padded + file.extension().string());
}

} // namespace tungsten
