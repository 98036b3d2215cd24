// glTF 2.0 (.gltf, .glb) through tinygltf: the triangles of every node of the default scene, in world space.

#include "tungsten/core/Errors.h"
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

#include <array>
#include <cstring>
#include <string>

namespace tungsten {

namespace {

constexpr size_t MostElements = size_t(1) << 26; ///< vertices or triangles of the merged mesh
constexpr int DeepestJson = 256;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw InputError(file.string(), message);
}

/// Affine map of a node: images of the axes and translation.
struct NodeTransform {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation{0, 0, 0};

    [[nodiscard]] Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
    [[nodiscard]] Vec3d point(const Vec3d& p) const { return vector(p) + translation; }
    [[nodiscard]] bool mirrors() const { return x.cross(y).dot(z) < 0.0; }
    /// Direction of M^-T n, by cofactors.
    [[nodiscard]] Vec3f normal(const Vec3d& n) const {
        const Vec3d image = (y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z) * (mirrors() ? -1.0 : 1.0);
        const double length = std::sqrt(image.dot(image));
        return length > 0.0 ? Vec3f(image / length) : Vec3f(0.0f);
    }
    [[nodiscard]] NodeTransform after(const NodeTransform& inner) const {
        return {vector(inner.x), vector(inner.y), vector(inner.z), point(inner.translation)};
    }
};

/// The node's matrix, or translation · rotation · scale.
NodeTransform localTransform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
        const auto& m = node.matrix;
        return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    }
    NodeTransform result;
    if (node.rotation.size() == 4) {
        const Vec3d axis(node.rotation[0], node.rotation[1], node.rotation[2]);
        const double w = node.rotation[3], squared = axis.dot(axis) + w * w;
        const double k = squared > 0.0 ? 2.0 / squared : 0.0;
        // v + k (w (q x v) + q x (q x v)) for each unit axis.
        const auto rotate = [&](const Vec3d& v) { return v + (axis.cross(v) * w + axis.cross(axis.cross(v))) * k; };
        result = {rotate(result.x), rotate(result.y), rotate(result.z), result.translation};
    }
    if (node.scale.size() == 3) {
        result.x *= node.scale[0];
        result.y *= node.scale[1];
        result.z *= node.scale[2];
    }
    if (node.translation.size() == 3)
        result.translation = {node.translation[0], node.translation[1], node.translation[2]};
    return result;
}

/// The elements of an accessor, checked to lie inside its buffer.
class AccessorView {
  public:
    AccessorView(const tinygltf::Model& model, int index, int components, const std::filesystem::path& file) {
        const std::string name = "accessor " + std::to_string(index);
        if (index < 0 || size_t(index) >= model.accessors.size()) fail(file, name + " does not exist");
        const tinygltf::Accessor& accessor = model.accessors[size_t(index)];
        if (accessor.sparse.isSparse) fail(file, name + " is sparse, which is not supported");
        if (tinygltf::GetNumComponentsInType(uint32_t(accessor.type)) != components)
            fail(file, name + " should have " + std::to_string(components) + " components per element");
        if (accessor.bufferView < 0 || size_t(accessor.bufferView) >= model.bufferViews.size())
            fail(file, name + " has no valid buffer view");
        const tinygltf::BufferView& view = model.bufferViews[size_t(accessor.bufferView)];
        if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size()) fail(file, name + " has no valid buffer");
        const std::vector<unsigned char>& bytes = model.buffers[size_t(view.buffer)].data;
        const int stride = accessor.ByteStride(view);
        const int componentBytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
        if (stride <= 0 || componentBytes <= 0) fail(file, name + " has an invalid layout");
        count_ = accessor.count;
        stride_ = size_t(stride);
        componentType_ = accessor.componentType;
        normalized_ = accessor.normalized;
        const size_t elementBytes = size_t(componentBytes) * size_t(components);
        if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
            fail(file, name + ": its buffer view ends beyond the buffer");
        const bool fits =
            accessor.byteOffset <= view.byteLength && elementBytes <= view.byteLength - accessor.byteOffset &&
            (count_ == 0 || count_ - 1 <= (view.byteLength - accessor.byteOffset - elementBytes) / stride_);
        if (count_ > 0 && !fits) fail(file, name + " ends beyond its buffer view");
        if (count_ > 0) data_ = bytes.data() + view.byteOffset + accessor.byteOffset;
    }

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

/// Collects the triangles of the nodes it is given.
class Merger {
  public:
    Merger(const tinygltf::Model& model, const std::filesystem::path& file) : model_(model), file_(file) {}

    void addMesh(int index, const NodeTransform& transform) {
        if (size_t(index) >= model_.meshes.size()) fail(file_, "mesh " + std::to_string(index) + " does not exist");
        for (const tinygltf::Primitive& primitive : model_.meshes[size_t(index)].primitives)
            addPrimitive(primitive, transform);
    }
    TriangleMesh finish() {
        // Primitives without normals (flat) or uvs leave zeros where others have them.
        if (!mesh_.normals.empty()) mesh_.normals.resize(mesh_.positions.size(), Vec3f(0.0f));
        if (!mesh_.uvs.empty()) mesh_.uvs.resize(mesh_.positions.size(), Vec2f(0.0f));
        finishMesh(mesh_, file_);
        return std::move(mesh_);
    }

  private:
    void addPrimitive(const tinygltf::Primitive& primitive, const NodeTransform& transform) {
        const auto attribute = primitive.attributes.find("POSITION");
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES || attribute == primitive.attributes.end())
            return; // points, lines
        const AccessorView positions(model_, attribute->second, 3, file_);
        if (!positions.isFloat()) fail(file_, "positions must be floats");
        const size_t first = mesh_.positions.size();
        if (positions.count() > MostElements - first) fail(file_, "has more than 2^26 vertices");
        for (size_t i = 0; i < positions.count(); ++i)
            mesh_.positions.push_back(
                Vec3f(transform.point(Vec3d(positions.real(i, 0), positions.real(i, 1), positions.real(i, 2)))));
        addNormals(primitive, positions.count(), transform);
        addUvs(primitive, positions.count());
        addTriangles(primitive, uint32_t(first), positions.count(), transform.mirrors());
    }

    void addNormals(const tinygltf::Primitive& primitive, size_t count, const NodeTransform& transform) {
        const auto attribute = primitive.attributes.find("NORMAL");
        if (attribute == primitive.attributes.end()) return;
        const AccessorView normals(model_, attribute->second, 3, file_);
        if (!normals.isFloat() || normals.count() != count) fail(file_, "normals must be floats, one per position");
        mesh_.normals.resize(mesh_.positions.size() - count, Vec3f(0.0f));
        for (size_t i = 0; i < count; ++i)
            mesh_.normals.push_back(
                transform.normal(Vec3d(normals.real(i, 0), normals.real(i, 1), normals.real(i, 2))));
    }

    void addUvs(const tinygltf::Primitive& primitive, size_t count) {
        const auto attribute = primitive.attributes.find("TEXCOORD_0");
        if (attribute == primitive.attributes.end()) return;
        const AccessorView uvs(model_, attribute->second, 2, file_);
        if (!(uvs.isFloat() || (uvs.isUnsigned() && uvs.isNormalized())) || uvs.count() != count)
            fail(file_, "texture coordinates must be floats or normalised integers, one pair per position");
        mesh_.uvs.resize(mesh_.positions.size() - count, Vec2f(0.0f));
        for (size_t i = 0; i < count; ++i) mesh_.uvs.push_back({uvs.real(i, 0), 1.0f - uvs.real(i, 1)});
    }

    void addTriangles(const tinygltf::Primitive& primitive, uint32_t first, size_t vertices, bool mirrored) {
        std::vector<uint32_t> corners(primitive.indices < 0 ? vertices : 0);
        if (primitive.indices < 0) {
            for (size_t i = 0; i < vertices; ++i) corners[i] = uint32_t(i);
        } else {
            const AccessorView indices(model_, primitive.indices, 1, file_);
            if (!indices.isUnsigned()) fail(file_, "indices must be unsigned integers");
            corners.resize(indices.count());
            for (size_t i = 0; i < corners.size(); ++i) corners[i] = indices.integer(i);
        }
        for (const uint32_t corner : corners)
            if (corner >= vertices) fail(file_, "index " + std::to_string(corner) + " is beyond the vertices");
        if (mesh_.triangles.size() + corners.size() > MostElements) fail(file_, "has more than 2^26 triangles");
        const auto add = [&](size_t a, size_t b, size_t c) {
            if (mirrored) std::swap(b, c);
            mesh_.triangles.push_back({{first + corners[a], first + corners[b], first + corners[c]}});
            mesh_.materials.push_back(primitive.material);
        };
        const size_t count = corners.size();
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES)
            for (size_t i = 0; i + 2 < count; i += 3) add(i, i + 1, i + 2);
        else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP)
            for (size_t i = 0; i + 2 < count; ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
        else
            for (size_t i = 1; i + 1 < count; ++i) add(0, i, i + 1);
    }

    const tinygltf::Model& model_;
    std::filesystem::path file_;
    TriangleMesh mesh_;
};

std::vector<int> rootNodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const bool named = model.defaultScene >= 0 && size_t(model.defaultScene) < model.scenes.size();
        return model.scenes[named ? size_t(model.defaultScene) : 0].nodes;
    }
    std::vector<bool> isChild(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children)
            if (child >= 0 && size_t(child) < isChild.size()) isChild[size_t(child)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < isChild.size(); ++i)
        if (!isChild[i]) roots.push_back(int(i));
    return roots;
}

TriangleMesh mergeScene(const tinygltf::Model& model, const std::filesystem::path& file) {
    Merger merger(model, file);
    struct Visit {
        int node;
        NodeTransform parent;
    };
    std::vector<Visit> pending;
    std::vector<bool> visited(model.nodes.size(), false);
    const auto push = [&](const std::vector<int>& nodes, const NodeTransform& parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) pending.push_back({*node, parent});
    };
    push(rootNodes(model), NodeTransform{});
    while (!pending.empty()) {
        const Visit visit = pending.back();
        pending.pop_back();
        if (visit.node < 0 || size_t(visit.node) >= model.nodes.size())
            fail(file, "node " + std::to_string(visit.node) + " does not exist");
        if (visited[size_t(visit.node)]) fail(file, "node " + std::to_string(visit.node) + " has more than one parent");
        visited[size_t(visit.node)] = true;
        const tinygltf::Node& node = model.nodes[size_t(visit.node)];
        const NodeTransform transform = visit.parent.after(localTransform(node));
        if (node.mesh >= 0) merger.addMesh(node.mesh, transform);
        push(node.children, transform);
    }
    return merger.finish();
}

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
            if (++depth > DeepestJson) fail(file, "its JSON is nested too deeply");
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

/// Buffers only: images are neither read nor decoded.
tinygltf::FsCallbacks fileAccess() {
    tinygltf::FsCallbacks access{};
    access.FileExists = [](const std::string& name, void*) {
        std::error_code error;
        return !isImage(name) && std::filesystem::is_regular_file(name, error);
    };
    access.ExpandFilePath = [](const std::string& name, void*) { return name; };
    access.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* message, const std::string& name, void*) {
        try {
            const std::vector<char> bytes = readFileBytes(name);
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

tinygltf::Model parseModel(const std::vector<char>& bytes, const std::filesystem::path& file) {
    constexpr size_t JsonStart = 20; // of .glb files: 12 bytes of header, 8 of chunk header
    const bool binary = bytes.size() >= JsonStart && std::string_view(bytes.data(), 4) == "glTF";
    if (bytes.size() > UINT32_MAX) fail(file, "larger than 4 GiB");
    std::string_view json(bytes.data(), bytes.size());
    if (binary) {
        uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, sizeof(length));
        json = json.substr(JsonStart, length);
    }
    requireShallowJson(json, file);
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(fileAccess());
    reader.SetImageLoader(ignoreImage, nullptr);
    tinygltf::Model model;
    std::string errors, warnings;
    const std::string folder = file.parent_path().string();
    const auto size = unsigned(bytes.size());
    bool loaded = false;
    try {
        loaded = binary
                     ? reader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                   reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                     : reader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), size, folder);
    } catch (const std::exception& error) {
        errors = error.what();
    }
    while (!errors.empty() && errors.back() == '\n') errors.pop_back();
    if (!loaded) fail(file, "not a readable glTF file: " + errors);
    return model;
}

} // namespace

TriangleMesh loadGltf(const std::filesystem::path& file) {
    const tinygltf::Model model = parseModel(readFileBytes(file), file);
    for (const std::string& extension : model.extensionsRequired)
        if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression")
            fail(file, "needs the glTF extension " + extension + ", which is not supported");
    return mergeScene(model, file);
}

} // namespace tungsten
