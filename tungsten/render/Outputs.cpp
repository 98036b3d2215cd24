#include "tungsten/render/Outputs.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/ImageIo.h"

#include <algorithm>
#include <cctype>

#include <unistd.h>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> HdrExtensions{".exr", ".pfm", ".npy"};

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

/// -d rebases every name; otherwise relative names are below the scene's output directory.
fs::path rebase(const std::string& name, const fs::path& base) {
    return name.empty() ? fs::path() : (base / name).lexically_normal();
}

/// Lower case, dot included.
std::string extensionOf(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

/// Writes what it can: a file that fails does not keep the others from being written.
class ImageWriter {
  public:
    ImageWriter(const Film& film, const Scene& scene)
        : film_(film), scene_(scene), integrals_(scene.transport.integrateOverGate &&
                                                 !scene.transport.gate.steadyState && !scene.transport.gate.delta) {}

    /// The image of the whole gate; formats that hold several frames get all of them.
    void whole(const fs::path& file) { whole(file, scene_.toneMap); }
    void whole(const fs::path& file, ToneMap toneMap) {
        attempt(file, [&] {
            const std::string extension = extensionOf(file);
            if (extension == ".exr")
                writeExr(file, allFrames());
            else if (extension == ".npy")
                writeCube(file);
            else if (extension == ".pfm")
                writePfm(file, wholeImage());
            else
                writePng(file, wholeImage(), toneMap);
        });
    }
    /// One file per frame.
    void series(const fs::path& file) {
        const std::string extension = extensionOf(file);
        for (int frame = 0; frame < film_.frames(); ++frame)
            attempt(framePath(file, frame), [&] {
                if (extension == ".exr")
                    writeExr(framePath(file, frame), {exrPart(frame)});
                else if (extension == ".pfm")
                    writePfm(framePath(file, frame), overFrame(film_.mean(frame)));
                else
                    writePng(framePath(file, frame), overFrame(film_.mean(frame)), scene_.toneMap);
            });
    }
    void cube(const fs::path& file) {
        attempt(file, [&] { writeCube(file); });
    }
    /// Throws if any file failed.
    [[nodiscard]] std::vector<fs::path> finish() const {
        if (!problems_.empty()) throw InputError(problems_);
        return written_;
    }

  private:
    template <typename Write>
    void attempt(const fs::path& file, Write write) {
        try {
            write();
            written_.push_back(file);
        } catch (const InputError& error) {
            problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
        }
    }
    /// An average over `frames` frames as the output asks for it: as it is, or as their integral.
    [[nodiscard]] Image overFrames(Image average, int frames) const {
        if (!integrals_) return average;
        const float width = float(scene_.transport.gate.frameWidth * frames);
        for (Rgb& pixel : average.pixels) pixel *= width;
        return average;
    }
    [[nodiscard]] Image overFrame(Image average) const { return overFrames(std::move(average), 1); }
    [[nodiscard]] Image wholeImage() const { return overFrames(film_.meanOverFrames(), film_.frames()); }
    [[nodiscard]] ExrPart exrPart(int frame) const {
        const TimeGate& gate = scene_.transport.gate;
        char name[32];
        std::snprintf(name, sizeof name, "frame.%04d", frame);
        return {name,
                overFrame(film_.mean(frame)),
                overFrame(film_.standardError(frame)),
                !gate.steadyState,
                gate.frameStart(frame),
                gate.frameStart(frame + 1)};
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

    const Film& film_;
    const Scene& scene_;
    bool integrals_; ///< integrals over a frame are asked for, not averages
    std::vector<fs::path> written_;
    std::vector<Problem> problems_;
};

void checkFolder(const fs::path& file) {
    const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder, error) || ::access(folder.c_str(), W_OK) != 0)
        throw InputError(file.string(), "cannot be written: the folder '" + folder.string() +
                                            "' cannot be created or written to; choose another with -d DIRECTORY");
    if (fs::is_directory(file, error))
        throw InputError(file.string(), "cannot be written: a folder has this name; choose another with -d, -o or -e");
}

void checkExtension(const fs::path& file, const std::vector<std::string>& accepted) {
    if (file.empty() || std::find(accepted.begin(), accepted.end(), extensionOf(file)) != accepted.end()) return;
    throw InputError(file.string(),
                     "unknown image type '" + file.extension().string() + "'; accepted: " + listOf(accepted));
}

} // namespace

OutputFiles resolveOutputs(const RendererSettings& renderer, const fs::path& sceneFile,
                           const OutputOverrides& overrides) {
    const fs::path base =
        overrides.directory ? *overrides.directory : sceneFile.parent_path() / renderer.outputDirectory;
    const auto commandLine = [&](const fs::path& file) {
        return overrides.directory ? *overrides.directory / file : file;
    };
    OutputFiles outputs;
    outputs.ldr = overrides.ldr ? commandLine(*overrides.ldr) : rebase(renderer.outputFile, base);
    outputs.hdr = overrides.hdr ? commandLine(*overrides.hdr) : rebase(renderer.hdrOutputFile, base);
    outputs.state = rebase(renderer.resumeFile, base);
    if (overrides.statistics) outputs.statistics = *overrides.statistics;
    if (outputs.ldr.empty()) outputs.ldr = base / "TungstenRender.png";
    if (!renderer.overwriteOutputFiles && !overrides.ldr) outputs.ldr = freeName(outputs.ldr);
    if (!renderer.overwriteOutputFiles && !overrides.hdr && !outputs.hdr.empty()) outputs.hdr = freeName(outputs.hdr);
    const auto resolved = [&](const OutputBuffer& buffer) {
        return OutputBuffer{rebase(buffer.ldrFile, base).string(), rebase(buffer.hdrFile, base).string()};
    };
    for (const OutputBuffer& buffer : renderer.colors) outputs.colors.push_back(resolved(buffer));
    for (const OutputBuffer& buffer : renderer.transients) outputs.series.push_back(resolved(buffer));
    return outputs;
}

void checkOutputs(const OutputFiles& outputs, bool withState) {
    checkExtension(outputs.ldr, {".png"});
    checkExtension(outputs.hdr, HdrExtensions);
    std::vector<fs::path> files{outputs.ldr, outputs.hdr, outputs.statistics};
    if (withState) files.push_back(outputs.state);
    const auto add = [&files](const OutputBuffer& buffer, const std::vector<std::string>& hdrExtensions) {
        checkExtension(buffer.ldrFile, {".png"});
        checkExtension(buffer.hdrFile, hdrExtensions);
        files.insert(files.end(), {fs::path(buffer.ldrFile), fs::path(buffer.hdrFile)});
    };
    for (const OutputBuffer& buffer : outputs.colors) add(buffer, HdrExtensions);
    for (const OutputBuffer& buffer : outputs.series) add(buffer, {".exr", ".pfm"});
    for (const fs::path& file : files)
        if (!file.empty()) checkFolder(file);
}

std::vector<fs::path> writeImages(const Film& film, const Scene& scene, const OutputFiles& outputs,
                                  const std::string& suffix) {
    ImageWriter writer(film, scene);
    writer.whole(withSuffix(outputs.ldr, suffix));
    const fs::path hdr = outputs.hdr.empty() ? fs::path() : withSuffix(outputs.hdr, suffix);
    if (!hdr.empty()) writer.whole(hdr);
    if (!suffix.empty()) return writer.finish();
    for (const OutputBuffer& buffer : outputs.colors) {
        if (!buffer.ldrFile.empty()) writer.whole(buffer.ldrFile, ToneMap::Linear);
        if (!buffer.hdrFile.empty()) writer.whole(buffer.hdrFile);
    }
    if (film.frames() <= 1) return writer.finish();

    if (!hdr.empty() && extensionOf(hdr) != ".npy") writer.cube(fs::path(hdr).replace_extension(".npy"));
    if (outputs.series.empty()) {
        writer.series(outputs.ldr);
        if (extensionOf(hdr) == ".pfm") writer.series(hdr);
    }
    for (const OutputBuffer& buffer : outputs.series) {
        if (!buffer.ldrFile.empty()) writer.series(buffer.ldrFile);
        if (!buffer.hdrFile.empty()) writer.series(buffer.hdrFile);
    }
    return writer.finish();
}

} // namespace tungsten
