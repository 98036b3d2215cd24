// OpenEXR files: single images that any viewer opens, multi-part files for sequences.

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Format.h"
#include "tungsten/io/Writers.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstdio>

namespace tungsten {

namespace {

constexpr const char* Components[3] = {"R", "G", "B"};
constexpr const char* MetadataName = "metadata";

void insertLayer(Imf::FrameBuffer& buffer, const std::string& layer, const Image& image) {
    for (int c = 0; c < 3; ++c) {
        auto* base = const_cast<char*>(reinterpret_cast<const char*>(image.pixels.data())) + size_t(c) * sizeof(float);
        buffer.insert(layer + Components[c],
                      Imf::Slice(Imf::FLOAT, base, sizeof(Rgb), sizeof(Rgb) * size_t(image.width)));
    }
}

/// Layers besides the image, by the prefix of their channels.
std::vector<std::pair<std::string, const Image*>> layersOf(const ExrPart& part) {
    std::vector<std::pair<std::string, const Image*>> layers{
        {"stderr.", &part.standardError}, {"bias.", &part.bias}, {"biasStderr.", &part.biasError}};
    std::erase_if(layers, [](const auto& layer) { return layer.second->pixels.empty(); });
    return layers;
}

/// OpenEXR keeps three buffers of a block of lines for each part until the file is complete: 300 MB for 1024 parts of
/// 256 pixels and six channels in blocks of 16 lines. Many parts are compressed line by line instead.
Imf::Compression compressionOf(const Imf::Header& header, int parts) {
    constexpr double MostBytes = 32.0 * 1024 * 1024, LinesOfBlock = 16.0, Buffers = 3.0;
    double channels = 0.0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) channels += 1.0;
    const double line = channels * sizeof(float) * (double(header.dataWindow().max.x) + 1.0);
    return double(parts) * Buffers * LinesOfBlock * line <= MostBytes ? Imf::ZIP_COMPRESSION : Imf::ZIPS_COMPRESSION;
}

Imf::Header headerOf(const ExrPart& part, int parts) {
    Imf::Header header(part.colour.width, part.colour.height);
    header.setType(Imf::SCANLINEIMAGE);
    if (parts > 1) header.setName(part.name);
    for (const char* component : Components) {
        header.channels().insert(component, Imf::Channel(Imf::FLOAT));
        for (const auto& [layer, image] : layersOf(part))
            header.channels().insert(layer + component, Imf::Channel(Imf::FLOAT));
    }
    header.compression() = compressionOf(header, parts);
    if (part.hasTime) {
        header.insert("timeStart", Imf::DoubleAttribute(part.timeStart));
        header.insert("timeEnd", Imf::DoubleAttribute(part.timeEnd));
    }
    return header;
}

/// OpenEXR writes its last rows and the table of lines in destructors that swallow errors; a stream remembers them.
class ExrStream : public Imf::OStream {
  public:
    ExrStream(std::ostream& out, const std::filesystem::path& file) : Imf::OStream(file.c_str()), out_(out) {}
    void write(const char bytes[], int count) override { out_.write(bytes, count); }
    // From a failed stream the position would be -1.
    uint64_t tellp() override { return out_ ? uint64_t(out_.tellp()) : 0; }
    void seekp(uint64_t position) override { out_.seekp(std::streamoff(position)); }

  private:
    std::ostream& out_;
};

void writeParts(std::ostream& stream, const std::filesystem::path& file, int parts,
                const std::function<ExrPart(int)>& partOf, const std::string& metadata) {
    try {
        std::vector<Imf::Header> headers;
        for (int i = 0; i < parts; ++i) headers.push_back(headerOf(partOf(i), parts));
        if (!metadata.empty()) headers.at(0).insert(MetadataName, Imf::StringAttribute(metadata));
        ExrStream target(stream, file);
        Imf::MultiPartOutputFile out(target, headers.data(), int(headers.size()));
        for (int i = 0; i < parts; ++i) {
            const ExrPart images = partOf(i);
            Imf::FrameBuffer buffer;
            insertLayer(buffer, "", images.colour);
            for (const auto& [layer, image] : layersOf(images)) insertLayer(buffer, layer, *image);
            Imf::OutputPart part(out, i);
            part.setFrameBuffer(buffer);
            part.writePixels(images.colour.height);
        }
    } catch (const std::exception& error) {
        throw InputError(file.string(), std::string("cannot be written: ") + error.what());
    }
}

ExrPart partOf(const OutputFilm& film, int frame) {
    const TimeGate& gate = film.scene().transport.gate;
    char name[32];
    std::snprintf(name, sizeof name, "frame.%04d", frame);
    ExrPart part{.name = name,
                 .colour = film.frame(frame),
                 .standardError = film.overFrame(film.film().standardError(frame)),
                 .hasTime = !gate.steadyState,
                 .timeStart = gate.frameStart(frame),
                 .timeEnd = gate.frameStart(frame + 1)};
    if (frame >= film.bias().frames()) return part;
    part.bias = film.overFrame(film.bias().mean(frame));
    part.biasError = film.overFrame(film.bias().standardError(frame));
    return part;
}

void writeFilmAsExr(const OutputFilm& film, const OutputImage& image) {
    const int parts = image.frame ? 1 : film.frames();
    const auto part = [&](int i) { return partOf(film, image.frame.value_or(i)); };
    writeExr(image.file, parts, part, film.metadata());
}

} // namespace

void writeExr(const std::filesystem::path& file, const std::vector<ExrPart>& parts, const std::string& metadata) {
    writeExr(
        file, int(parts.size()), [&](int i) { return parts[size_t(i)]; }, metadata);
}

void writeExr(const std::filesystem::path& file, int parts, const std::function<ExrPart(int)>& part,
              const std::string& metadata) {
    writeAtomically(file, [&](std::ostream& out) { writeParts(out, file, parts, part, metadata); });
}

/// OpenEXR keeps a header of 28 KiB for every part, in memory and while it writes.
extern const OutputFormat ExrFormat{.extension = ".exr",
                                    .uses = output_use::Linear | output_use::Series,
                                    .note = "with standard error",
                                    .holdsFrames = true,
                                    .mostFrames = 10000,
                                    .write = writeFilmAsExr};

} // namespace tungsten
