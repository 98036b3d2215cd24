#pragma once
// A glTF 2.0 document as tinygltf parses it, and its accessors, checked.

#include "tungsten/geometry/MeshFile.h"

#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wextra"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <cstring>
#include <string>

namespace tungsten {

[[noreturn]] void failGltf(const std::filesystem::path& file, const std::string& message);

/// Parses .gltf or .glb, with its buffers; images are neither read nor decoded. Buffers in files of their own
/// must lie `within` that folder, if there is one. Throws InputError.
tinygltf::Model parseGltf(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within,
                          const LoadWatch& watch);

/// The elements of an accessor, checked to lie inside its buffer.
class AccessorView {
  public:
    AccessorView(const tinygltf::Model& model, int index, int components, const std::filesystem::path& file);

    [[nodiscard]] size_t count() const { return count_; }
    [[nodiscard]] bool isFloat() const { return componentType_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }
    [[nodiscard]] bool isUnsigned() const {
        return componentType_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
               componentType_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
               componentType_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    }
    [[nodiscard]] bool isNormalized() const { return normalized_; }
    [[nodiscard]] uint32_t integer(size_t element, size_t component = 0) const {
        if (componentType_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return read<uint8_t>(element, component);
        if (componentType_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return read<uint16_t>(element, component);
        return read<uint32_t>(element, component);
    }
    /// Floats as they are, normalised integers in [0, 1].
    [[nodiscard]] float real(size_t element, size_t component) const {
        if (isFloat()) return read<float>(element, component);
        const float largest = componentType_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ? 255.0f : 65535.0f;
        return float(integer(element, component)) / largest;
    }

  private:
    template <typename Value>
    [[nodiscard]] Value read(size_t element, size_t component) const {
        Value value;
        std::memcpy(&value, data_ + element * stride_ + component * sizeof(Value), sizeof(Value));
        return value;
    }

    const unsigned char* data_ = nullptr;
    size_t count_ = 0, stride_ = 0;
    int componentType_ = 0;
    bool normalized_ = false;
};

} // namespace tungsten
