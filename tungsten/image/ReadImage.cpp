#include "tungsten/image/ReadImage.h"

#include "tungsten/core/Errors.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <fstream>

namespace tungsten {

namespace {

constexpr int LargestSide = 1 << 20;
constexpr int64_t LargestImage = int64_t(1) << 28;
constexpr const char* Components[3] = {"R", "G", "B"};

} // namespace

Image readPfm(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file.string(), "no such file, or it cannot be read");
    std::string magic;
    int width = 0, height = 0;
    double scale = 0.0;
    in >> magic >> width >> height >> scale;
    in.get();
    if (!in || (magic != "PF" && magic != "Pf") || width <= 0 || height <= 0 || width > LargestSide ||
        height > LargestSide)
        throw InputError(file.string(), "not a PFM image");
    const size_t channels = magic == "PF" ? 3 : 1;
    std::error_code error;
    if (std::filesystem::file_size(file, error) < size_t(width) * size_t(height) * channels * 4 || error)
        throw InputError(file.string(), "the PFM image is truncated");
    Image image(width, height);
    std::vector<float> row(size_t(width) * channels);
    for (int y = height - 1; y >= 0; --y) {
        in.read(reinterpret_cast<char*>(row.data()), std::streamsize(row.size() * sizeof(float)));
        if (!in) throw InputError(file.string(), "the PFM image is truncated");
        for (int x = 0; x < width; ++x) {
            const float* texel = &row[size_t(x) * channels];
            image.at(x, y) = channels == 3 ? Rgb(texel[0], texel[1], texel[2]) : Rgb(texel[0]);
        }
    }
    return image;
}

std::string readExrMetadata(const std::filesystem::path& file) {
    try {
        const Imf::MultiPartInputFile in(file.c_str());
        const auto* attribute = in.header(0).findTypedAttribute<Imf::StringAttribute>("metadata");
        return attribute ? attribute->value() : "";
    } catch (const std::exception& error) {
        throw InputError(file.string(), std::string("not a readable EXR image: ") + error.what());
    }
}

int exrPartCount(const std::filesystem::path& file) {
    try {
        return Imf::MultiPartInputFile(file.c_str()).parts();
    } catch (const std::exception& error) {
        throw InputError(file.string(), std::string("not a readable EXR image: ") + error.what());
    }
}

Image readExr(const std::filesystem::path& file, int part, const std::string& layer) {
    try {
        Imf::MultiPartInputFile in(file.c_str());
        Imf::InputPart input(in, part);
        const auto window = input.header().dataWindow();
        const int64_t width = int64_t(window.max.x) - window.min.x + 1,
                      height = int64_t(window.max.y) - window.min.y + 1;
        if (width <= 0 || height <= 0 || width > LargestImage || height > LargestImage || width * height > LargestImage)
            throw InputError(file.string(), "the EXR image has an absurd size");
        const Imf::ChannelList& channels = input.header().channels();
        const bool grey = layer.empty() && !channels.findChannel("R") && channels.findChannel("Y");
        Image image{int(width), int(height)};
        Imf::FrameBuffer buffer;
        for (int c = 0; c < 3; ++c) {
            const std::string name = grey ? "Y" : layer + Components[c];
            if (!channels.findChannel(name)) throw InputError(file.string(), "the EXR image has no channel " + name);
            if (grey && c > 0) continue;
            buffer.insert(name,
                          Imf::Slice::Make(Imf::FLOAT,
                                           reinterpret_cast<char*>(image.pixels.data()) + size_t(c) * sizeof(float),
                                           window, sizeof(Rgb), sizeof(Rgb) * size_t(width)));
        }
        input.setFrameBuffer(buffer);
        input.readPixels(window.min.y, window.max.y);
        if (grey)
            for (Rgb& pixel : image.pixels) pixel = Rgb(pixel.x);
        return image;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(file.string(), std::string("not a readable EXR image: ") + error.what());
    }
}

} // namespace tungsten
