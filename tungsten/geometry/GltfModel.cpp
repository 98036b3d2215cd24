// Reading glTF documents: limits that tinygltf lacks, files, layouts of accessors.

#include "tungsten/geometry/GltfModel.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/InsideFolder.h"

#include <string_view>

namespace tungsten {

namespace {

constexpr int DeepestJson = 256;

/// tinygltf recurses into nested JSON values: bounds their depth first.
void requireShallowJson(std::string_view json, const std::filesystem::path& file) {
    int depth = 0;
    bool inString = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (inString) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            if (++depth > DeepestJson) failGltf(file, "its JSON is nested too deeply");
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

bool isImage(const std::string& name) {
    const std::string extension = std::filesystem::path(name).extension().string();
    return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".ktx2" ||
           extension == ".webp";
}

bool isBinary(std::string_view bytes) {
    return bytes.starts_with("glTF");
}

/// By its start: binary files tell their length there, others are texts.
void requireGltf(std::string_view start, uint64_t size, const std::filesystem::path& file) {
    constexpr size_t LengthAt = 8;
    if (!isBinary(start)) return requireText(file, start, size);
    uint32_t length = 0;
    if (start.size() < LengthAt + sizeof length) return;
    std::memcpy(&length, start.data() + LengthAt, sizeof length);
    constexpr uint64_t Padding = 4096;
    if (size > uint64_t(length) + Padding)
        failGltf(file, "has " + std::to_string(size) + " bytes; its header says " + std::to_string(length));
}

/// Where buffers may lie, and who is told of them.
struct BufferAccess {
    const std::optional<std::filesystem::path>& within;
    const LoadWatch& watch;
};

/// Buffers only: images are neither read nor decoded. `buffers` must outlive the callbacks.
tinygltf::FsCallbacks fileAccess(BufferAccess& buffers) {
    tinygltf::FsCallbacks access{};
    access.user_data = &buffers;
    access.FileExists = [](const std::string& name, void*) {
        std::error_code error;
        return !isImage(name) && std::filesystem::is_regular_file(name, error);
    };
    access.ExpandFilePath = [](const std::string& name, void*) { return name; };
    access.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* message, const std::string& name,
                              void* data) {
        try {
            const BufferAccess& own = *static_cast<const BufferAccess*>(data);
            if (own.within && !isInside(name, *own.within))
                throw InputError(name, "lies outside the scene's folder; --allow-outside lets a scene read it");
            const std::vector<char> bytes = readFileBytes(name, own.watch);
            out->assign(bytes.begin(), bytes.end());
            return true;
        } catch (const InputError& error) {
            *message += error.what();
            return false;
        }
    };
    return access;
}

bool ignoreImage(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

} // namespace

void failGltf(const std::filesystem::path& file, const std::string& message) {
    throw InputError(file.string(), message);
}

tinygltf::Model parseGltf(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within,
                          const LoadWatch& watch) {
    const std::vector<char> bytes =
        readFileBytes(file, watch, [&](std::string_view start, uint64_t size) { requireGltf(start, size, file); });
    constexpr size_t JsonStart = 20; // of .glb files: 12 bytes of header, 8 of chunk header
    const bool binary = bytes.size() >= JsonStart && isBinary({bytes.data(), bytes.size()});
    if (bytes.size() > UINT32_MAX) failGltf(file, "larger than 4 GiB");
    std::string_view json = binary ? std::string_view(bytes.data(), bytes.size()) : utf8Of(bytes, file);
    if (binary) {
        uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, sizeof(length));
        json = json.substr(JsonStart, length);
    }
    requireShallowJson(json, file);
    tinygltf::TinyGLTF reader;
    BufferAccess buffers{within, watch};
    reader.SetFsCallbacks(fileAccess(buffers));
    reader.SetImageLoader(ignoreImage, nullptr);
    tinygltf::Model model;
    std::string errors, warnings;
    const std::string folder = file.parent_path().string();
    const auto size = unsigned(bytes.size());
    bool loaded = false;
    try {
        loaded =
            binary ? reader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                   : reader.LoadASCIIFromString(&model, &errors, &warnings, json.data(), unsigned(json.size()), folder);
    } catch (const std::exception& error) {
        errors = error.what();
    }
    while (!errors.empty() && errors.back() == '\n') errors.pop_back();
    if (!loaded) failGltf(file, "not a readable glTF file: " + errors);
    return model;
}

AccessorView::AccessorView(const tinygltf::Model& model, int index, int components, const std::filesystem::path& file) {
    const std::string name = "accessor " + std::to_string(index);
    if (index < 0 || size_t(index) >= model.accessors.size()) failGltf(file, name + " does not exist");
    const tinygltf::Accessor& accessor = model.accessors[size_t(index)];
    if (accessor.sparse.isSparse) failGltf(file, name + " is sparse, which is not supported");
    if (tinygltf::GetNumComponentsInType(uint32_t(accessor.type)) != components)
        failGltf(file, name + " should have " + std::to_string(components) + " components per element");
    if (accessor.bufferView < 0 || size_t(accessor.bufferView) >= model.bufferViews.size())
        failGltf(file, name + " has no valid buffer view");
    const tinygltf::BufferView& view = model.bufferViews[size_t(accessor.bufferView)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size()) failGltf(file, name + " has no valid buffer");
    const std::vector<unsigned char>& bytes = model.buffers[size_t(view.buffer)].data;
    const int stride = accessor.ByteStride(view);
    const int componentBytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    if (stride <= 0 || componentBytes <= 0) failGltf(file, name + " has an invalid layout");
    count_ = accessor.count;
    stride_ = size_t(stride);
    componentType_ = accessor.componentType;
    normalized_ = accessor.normalized;
    const size_t elementBytes = size_t(componentBytes) * size_t(components);
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
        failGltf(file, name + ": its buffer view ends beyond the buffer");
    const bool fits = accessor.byteOffset <= view.byteLength && elementBytes <= view.byteLength - accessor.byteOffset &&
                      (count_ == 0 || count_ - 1 <= (view.byteLength - accessor.byteOffset - elementBytes) / stride_);
    if (count_ > 0 && !fits) failGltf(file, name + " ends beyond its buffer view");
    if (count_ > 0) data_ = bytes.data() + view.byteOffset + accessor.byteOffset;
}

} // namespace tungsten
