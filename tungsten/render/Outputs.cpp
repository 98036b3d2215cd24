#include "tungsten/render/Outputs.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/ImageIo.h"

#include <set>

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

class ImageWriter {
  public:
    ImageWriter(const Film& film, const Scene& scene)
        : film_(film), scene_(scene),
          scale_(scene.transport.integrateOverGate && !scene.transport.gate.steadyState && !scene.transport.gate.delta
                     ? float(scene.transport.gate.frameWidth)
                     : 1.0f) {}

    void whole(const fs::path& file) {
        const std::string extension = file.extension().string();
        if (extension == ".exr")
            exr(file);
        else if (extension == ".npy")
            cube(file);
        else
            single(file, wholeImage());
    }
    void series(const fs::path& file) {
        for (int frame = 0; frame < film_.frames(); ++frame) single(framePath(file, frame), scaled(film_.mean(frame)));
    }
    void cube(const fs::path& file) {
        std::vector<Image> frames;
        for (int frame = 0; frame < film_.frames(); ++frame) frames.push_back(scaled(film_.mean(frame)));
        writeNpy(file, frames);
        written_.push_back(file);
    }
    [[nodiscard]] std::vector<fs::path> written() const { return written_; }

  private:
    Image scaled(Image image) const {
        if (scale_ != 1.0f)
            for (Rgb& pixel : image.pixels) pixel *= scale_;
        return image;
    }
    /// Mean over the frames; integrated over the whole gate when integrals are asked for.
    Image wholeImage() const {
        Image image = scaled(film_.meanOverFrames());
        if (scale_ != 1.0f)
            for (Rgb& pixel : image.pixels) pixel *= float(film_.frames());
        return image;
    }
    void single(const fs::path& file, const Image& image) {
        const std::string extension = file.extension().string();
        if (extension == ".pfm")
            writePfm(file, image);
        else if (extension == ".exr")
            writeExr(file, {ExrPart{"", image, {}, false, 0, 0}});
        else
            writePng(file, image, scene_.toneMap);
        written_.push_back(file);
    }
    void exr(const fs::path& file) {
        const TimeGate& gate = scene_.transport.gate;
        std::vector<ExrPart> parts;
        for (int frame = 0; frame < film_.frames(); ++frame) {
            char name[32];
            std::snprintf(name, sizeof name, "frame.%04d", frame);
            parts.push_back({name, scaled(film_.mean(frame)), scaled(film_.standardError(frame)), !gate.steadyState,
                             gate.frameStart(frame), gate.frameStart(frame + 1)});
        }
        writeExr(file, parts);
        written_.push_back(file);
    }

    const Film& film_;
    const Scene& scene_;
    float scale_;
    std::vector<fs::path> written_;
};

void checkFolder(const fs::path& file) {
    const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder) || ::access(folder.c_str(), W_OK) != 0)
        throw InputError(file.string(), "cannot be written: the folder '" + folder.string() +
                                            "' is missing or not writable; choose another with -d DIRECTORY");
    if (fs::is_directory(file)) throw InputError(file.string(), "cannot be written: it is a folder");
}

void checkExtension(const fs::path& file, const std::vector<std::string>& accepted) {
    if (file.empty() || std::find(accepted.begin(), accepted.end(), file.extension().string()) != accepted.end())
        return;
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
    for (const TransientsBuffer& buffer : renderer.transients)
        outputs.series.push_back({rebase(buffer.ldrFile, base).string(), rebase(buffer.hdrFile, base).string()});
    return outputs;
}

void checkOutputs(const OutputFiles& outputs) {
    checkExtension(outputs.ldr, {".png"});
    checkExtension(outputs.hdr, HdrExtensions);
    std::vector<fs::path> files{outputs.ldr, outputs.hdr, outputs.statistics};
    for (const TransientsBuffer& buffer : outputs.series) {
        checkExtension(buffer.ldrFile, {".png"});
        checkExtension(buffer.hdrFile, {".exr", ".pfm"});
        files.insert(files.end(), {fs::path(buffer.ldrFile), fs::path(buffer.hdrFile)});
    }
    for (const fs::path& file : files)
        if (!file.empty()) checkFolder(file);
}

std::vector<fs::path> writeImages(const Film& film, const Scene& scene, const OutputFiles& outputs,
                                  const std::string& suffix) {
    ImageWriter writer(film, scene);
    writer.whole(withSuffix(outputs.ldr, suffix));
    const fs::path hdr = outputs.hdr.empty() ? fs::path() : withSuffix(outputs.hdr, suffix);
    if (!hdr.empty()) writer.whole(hdr);
    if (film.frames() <= 1 || !suffix.empty()) return writer.written();

    if (!hdr.empty() && hdr.extension() != ".npy") writer.cube(fs::path(hdr).replace_extension(".npy"));
    if (outputs.series.empty()) {
        writer.series(outputs.ldr);
        if (hdr.extension() == ".pfm") writer.series(hdr);
    }
    for (const TransientsBuffer& buffer : outputs.series) {
        if (!buffer.ldrFile.empty()) writer.series(buffer.ldrFile);
        if (!buffer.hdrFile.empty()) writer.series(buffer.hdrFile);
    }
    return writer.written();
}

} // namespace tungsten
