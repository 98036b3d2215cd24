#include "tungsten/render/PlannedImages.h"

#include "tungsten/film/ImageIo.h"

#include <cctype>

namespace tungsten {

namespace fs = std::filesystem;

using Content = PlannedImage::Content;

namespace {

/// Files that hold all frames as arrays.
bool holdsArrays(const fs::path& file) {
    const std::string extension = extensionOf(file);
    return extension == ".npy" || extension == ".npz" || extension == ".h5";
}

} // namespace

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

} // namespace tungsten
