// Results as HDF5 files.

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Format.h"
#include "tungsten/io/Result.h"

#include <hdf5.h>

#include <algorithm>
#include <mutex>

namespace tungsten {

namespace {

constexpr hsize_t TileSide = 64;
/// A name that no file has: of files in memory the library would read one that exists.
constexpr const char* NoFile = "/dev/null/in memory";

/// What the library returns is negative if it failed.
template <typename Code>
Code checked(Code code) {
    if (code < 0) throw std::runtime_error("the HDF5 library failed");
    return code;
}

/// An open object of the library.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checked(id)), close_(close) {}
    ~Handle() { close_(id_); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator hid_t() const { return id_; } // NOLINT: stands for it in calls

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Of a text in UTF-8, padded with zeros.
Handle textType(const std::string& text) {
    const hid_t type = checked(H5Tcopy(H5T_C_S1));
    checked(H5Tset_size(type, std::max<size_t>(text.size(), 1)));
    checked(H5Tset_cset(type, H5T_CSET_UTF8));
    checked(H5Tset_strpad(type, H5T_STR_NULLPAD));
    return {type, H5Tclose};
}

void addAttribute(hid_t object, const char* name, hid_t type, const void* value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    checked(H5Awrite(attribute, type, value));
}

void addAttribute(hid_t object, const char* name, const std::string& text) {
    addAttribute(object, name, textType(text), text.data());
}

void addText(hid_t file, const char* name, const std::string& text) {
    const Handle type = textType(text), space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle dataset(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
}

void addVector(hid_t file, const ResultContent::Vector& vector) {
    const hsize_t size = vector.values.size();
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Handle dataset(
        H5Dcreate2(file, vector.name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    checked(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, vector.values.data()));
}

void addArray(hid_t file, const ResultContent::Array& array) {
    const std::vector<hsize_t> shape(array.shape.begin(), array.shape.end());
    const Handle space(H5Screate_simple(int(shape.size()), shape.data(), nullptr), H5Sclose);
    const Handle dataset(
        H5Dcreate2(file, array.name.c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    checked(H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()));
}

void addImages(hid_t file, const ResultContent& content, const ResultContent::Images& images) {
    const auto width = hsize_t(content.width), height = hsize_t(content.height), channels = hsize_t(content.channels);
    const hsize_t shape[] = {hsize_t(content.frames), height, width, channels},
                  oneFrame[] = {1, height, width, channels},
                  tile[] = {1, std::min(height, TileSide), std::min(width, TileSide), channels};
    const Handle space(H5Screate_simple(4, shape, nullptr), H5Sclose),
        frameSpace(H5Screate_simple(4, oneFrame, nullptr), H5Sclose), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    checked(H5Pset_chunk(creation, 4, tile));
    checked(H5Pset_shuffle(creation));
    checked(H5Pset_deflate(creation, 1));
    const Handle dataset(
        H5Dcreate2(file, images.name.c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    addAttribute(dataset, "axes", "frame, row, column, channel");
    for (int frame = 0; frame < content.frames; ++frame) {
        const std::vector<float> values = valuesOf(images.frame(frame), content.channels);
        const hsize_t start[] = {hsize_t(frame), 0, 0, 0};
        checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, oneFrame, nullptr));
        checked(H5Dwrite(dataset, H5T_NATIVE_FLOAT, frameSpace, space, H5P_DEFAULT, values.data()));
    }
}

/// A file in memory goes to a stream, whose failures are those of all outputs.
void writeFile(std::ostream& out, const ResultContent& content) {
    constexpr size_t Increment = size_t(1) << 22;
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    checked(H5Pset_fapl_core(access, Increment, false));
    const Handle file(H5Fcreate(NoFile, H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
    addAttribute(file, "format", "darts-tungsten result");
    addAttribute(file, "format_version", H5T_NATIVE_INT, &ResultVersion);
    for (const ResultContent::Images& images : content.images) addImages(file, content, images);
    for (const ResultContent::Array& array : content.arrays) addArray(file, array);
    for (const ResultContent::Vector& vector : content.vectors) addVector(file, vector);
    addText(file, "metadata", content.metadata);
    checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
    hsize_t size = 0;
    void* memory = nullptr; // the address of the core driver's pointer to its bytes
    checked(H5Fget_filesize(file, &size));
    checked(H5Fget_vfd_handle(file, access, &memory));
    out.write(*static_cast<char**>(memory), std::streamsize(size));
}

} // namespace

void writeHdf5(const std::filesystem::path& file, const ResultContent& content) {
    static std::mutex library; // keeps one state for all threads
    const std::scoped_lock lock(library);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    writeAtomically(file, [&](std::ostream& out) {
        try {
            writeFile(out, content);
        } catch (const std::runtime_error& error) {
            throw InputError(file.string(), std::string("cannot be written: ") + error.what());
        }
    });
}

extern const OutputFormat Hdf5Format{
    .extension = ".h5",
    .uses = output_use::Linear,
    .note = "with all that is known",
    .holdsFrames = true,
    .holdsArrays = true,
    .write = [](const OutputFilm& film, const OutputImage& image) {
        writeHdf5(image.file, resultContent(film.film(), film.bias(), film.scene(), film.metadata()));
    }};

} // namespace tungsten
