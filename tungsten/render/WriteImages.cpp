// Every image of a film into its files.

#include "tungsten/film/ContactSheet.h"
#include "tungsten/film/ImageIo.h"
#include "tungsten/film/Video.h"
#include "tungsten/render/PlannedImages.h"
#include "tungsten/render/ResultDescription.h"

namespace tungsten {

namespace fs = std::filesystem;

using Content = PlannedImage::Content;

namespace {

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

Image inOutputUnits(Image average, const Scene& scene, int frames) {
    const TimeGate& gate = scene.transport.gate;
    if (!scene.transport.integrateOverGate || gate.steadyState || gate.delta) return average;
    const float width = float(gate.frameWidth * frames);
    for (Rgb& pixel : average.pixels) pixel *= width;
    return average;
}

std::vector<fs::path> writeImages(const Film& film, const Film& bias, const Scene& scene, const OutputFiles& outputs,
                                  const std::string& metadata, const std::string& suffix) {
    ImageWriter writer(film, bias, scene, metadata, outputs.exposure);
    for (const PlannedImage& image : plannedImages(outputs, film.frames(), suffix)) writer.write(image);
    return writer.finish();
}

} // namespace tungsten
