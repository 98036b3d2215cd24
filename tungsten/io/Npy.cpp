// Arrays as numpy reads them: NPY, and NPZ, a zip of such (by minizip).

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Format.h"
#include "tungsten/io/Result.h"
#include "tungsten/io/Writers.h"

#include <minizip/zip.h>

namespace tungsten {

namespace {

/// Magic, version and dictionary, padded to 64 bytes. `type` such as "<f4", `shape` such as "3, 2,".
std::string npyHeader(const std::string& type, const std::string& shape) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
    constexpr size_t Preamble = 10, Alignment = 64;
    header.append((Alignment - (Preamble + header.size() + 1) % Alignment) % Alignment, ' ');
    header += '\n';
    const auto length = uint16_t(header.size());
    return std::string("\x93NUMPY\x01\x00", 8) + char(length & 255) + char(length >> 8) + header;
}

std::string imagesHeader(size_t frames, int height, int width, int channels) {
    return npyHeader("<f4", std::to_string(frames) + ", " + std::to_string(height) + ", " + std::to_string(width) +
                                ", " + std::to_string(channels));
}

/// A zip in a stream. A stream that failed is left to its owner, and minizip, which leaks when it fails, not told.
class ZipStream {
  public:
    explicit ZipStream(std::ostream& out) : out_(out) {
        zlib_filefunc64_def functions{};
        functions.zopen64_file = [](voidpf stream, const void*, int) { return stream; };
        functions.zwrite_file = write;
        functions.ztell64_file = [](voidpf, voidpf stream) { return at(stream); };
        functions.zseek64_file = seek;
        functions.zclose_file = [](voidpf, voidpf) { return 0; };
        functions.zerror_file = [](voidpf, voidpf) { return 0; };
        functions.opaque = &out;
        zip_ = zipOpen2_64("", APPEND_STATUS_CREATE, nullptr, &functions);
    }
    ~ZipStream() {
        if (zip_) zipClose(zip_, nullptr);
    }
    ZipStream(const ZipStream&) = delete;
    ZipStream& operator=(const ZipStream&) = delete;

    void beginMember(const std::string& name) {
        zip_fileinfo information{};
        information.tmz_date.tm_year = 1980; // the earliest that a zip knows
        information.tmz_date.tm_mday = 1;
        constexpr int Stored = 0, Level = 0, Large = 1;
        require(zipOpenNewFileInZip64(zip_, name.c_str(), &information, nullptr, 0, nullptr, 0, nullptr, Stored, Level,
                                      Large));
    }
    void append(const void* bytes, size_t count) {
        constexpr size_t Most = size_t(1) << 30; // a call takes 32 bits
        for (size_t done = 0; done < count; done += Most)
            require(zipWriteInFileInZip(zip_, static_cast<const char*>(bytes) + done,
                                        unsigned(std::min(Most, count - done))));
    }
    void endMember() { require(zipCloseFileInZip(zip_)); }
    void finish() {
        const int code = zipClose(zip_, nullptr);
        zip_ = nullptr;
        require(code);
    }

  private:
    static std::ostream& streamOf(voidpf stream) { return *static_cast<std::ostream*>(stream); }
    static ZPOS64_T at(voidpf stream) { return streamOf(stream) ? ZPOS64_T(streamOf(stream).tellp()) : 0; }
    static uLong write(voidpf, voidpf stream, const void* bytes, uLong count) {
        streamOf(stream).write(static_cast<const char*>(bytes), std::streamsize(count));
        return count;
    }
    static long seek(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
        constexpr std::ios::seekdir Directions[] = {std::ios::beg, std::ios::cur, std::ios::end};
        streamOf(stream).seekp(std::streamoff(offset), Directions[origin]);
        return 0;
    }
    void require(int code) const {
        if (code != ZIP_OK && out_) throw std::runtime_error("zip error " + std::to_string(code));
    }

    std::ostream& out_;
    zipFile zip_ = nullptr;
};

void writeMembers(ZipStream& zip, const ResultContent& content) {
    const auto begin = [&](const std::string& name, const std::string& header) {
        zip.beginMember(name + ".npy");
        zip.append(header.data(), header.size());
    };
    for (const ResultContent::Images& images : content.images) {
        begin(images.name, imagesHeader(size_t(content.frames), content.height, content.width, content.channels));
        for (int frame = 0; frame < content.frames; ++frame) {
            const std::vector<float> values = valuesOf(images.frame(frame), content.channels);
            zip.append(values.data(), values.size() * sizeof(float));
        }
        zip.endMember();
    }
    for (const ResultContent::Array& array : content.arrays) {
        std::string shape;
        for (const size_t size : array.shape) shape += std::to_string(size) + ", ";
        begin(array.name, npyHeader("<f4", shape));
        zip.append(array.values.data(), array.values.size() * sizeof(float));
        zip.endMember();
    }
    for (const auto& [name, values] : content.vectors) {
        begin(name, npyHeader("<f8", std::to_string(values.size()) + ","));
        zip.append(values.data(), values.size() * sizeof(double));
        zip.endMember();
    }
    zip.beginMember("metadata.json");
    zip.append(content.metadata.data(), content.metadata.size());
    zip.endMember();
}

} // namespace

std::vector<float> valuesOf(const Image& image, int channels) {
    std::vector<float> values;
    values.reserve(image.pixels.size() * size_t(channels));
    for (const Rgb& pixel : image.pixels)
        for (int c = 0; c < channels; ++c) values.push_back(pixel[c]);
    return values;
}

void writeNpy(const std::filesystem::path& file, const std::vector<Image>& frames) {
    writeNpy(file, int(frames.size()), [&](int frame) { return frames[size_t(frame)]; });
}

void writeNpy(const std::filesystem::path& file, int frames, const std::function<Image(int)>& frame) {
    writeAtomically(file, [&](std::ostream& out) {
        for (int i = 0; i < frames; ++i) {
            const Image image = frame(i);
            if (i == 0) out << imagesHeader(size_t(frames), image.height, image.width, 3);
            out.write(reinterpret_cast<const char*>(image.pixels.data()),
                      std::streamsize(image.pixels.size() * sizeof(Rgb)));
        }
    });
}

void writeNpz(const std::filesystem::path& file, const ResultContent& content) {
    writeAtomically(file, [&](std::ostream& out) {
        try {
            ZipStream zip(out);
            writeMembers(zip, content);
            zip.finish();
        } catch (const std::runtime_error& error) {
            throw InputError(file.string(), std::string("cannot be written: ") + error.what());
        }
    });
}

extern const OutputFormat NpyFormat{.extension = ".npy",
                                    .uses = output_use::Linear,
                                    .holdsFrames = true,
                                    .holdsArrays = true,
                                    .needsMetadata = true,
                                    .write = [](const OutputFilm& film, const OutputImage& image) {
                                        writeNpy(image.file, film.frames(), [&](int i) { return film.frame(i); });
                                    }};

extern const OutputFormat NpzFormat{
    .extension = ".npz",
    .uses = output_use::Linear,
    .note = "with all that is known",
    .holdsFrames = true,
    .holdsArrays = true,
    .write = [](const OutputFilm& film, const OutputImage& image) {
        writeNpz(image.file, resultContent(film.film(), film.bias(), film.scene(), film.metadata()));
    }};

} // namespace tungsten
