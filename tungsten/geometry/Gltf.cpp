// glTF 2.0 (.gltf, .glb) through tinygltf: the triangles of every node of the default scene, in world space.

#include "tungsten/geometry/GltfModel.h"

namespace tungsten {

namespace {

constexpr size_t MostElements = size_t(1) << 26; ///< vertices or triangles of the merged mesh

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

/// Collects the triangles of the nodes it is given.
class Merger {
  public:
    Merger(const tinygltf::Model& model, const std::filesystem::path& file, const LoadWatch& watch)
        : model_(model), file_(file), watch_(watch) {}

    void addMesh(int index, const NodeTransform& transform) {
        if (size_t(index) >= model_.meshes.size()) failGltf(file_, "mesh " + std::to_string(index) + " does not exist");
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
        if (!positions.isFloat()) failGltf(file_, "positions must be floats");
        const size_t first = mesh_.positions.size();
        if (positions.count() > MostElements - first) failGltf(file_, "has more than 2^26 vertices");
        for (size_t i = 0; i < positions.count(); ++i) {
            watch_.pollEvery(i);
            mesh_.positions.push_back(
                Vec3f(transform.point(Vec3d(positions.real(i, 0), positions.real(i, 1), positions.real(i, 2)))));
        }
        addNormals(primitive, positions.count(), transform);
        addUvs(primitive, positions.count());
        addTriangles(primitive, uint32_t(first), positions.count(), transform.mirrors());
    }

    void addNormals(const tinygltf::Primitive& primitive, size_t count, const NodeTransform& transform) {
        const auto attribute = primitive.attributes.find("NORMAL");
        if (attribute == primitive.attributes.end()) return;
        const AccessorView normals(model_, attribute->second, 3, file_);
        if (!normals.isFloat() || normals.count() != count) failGltf(file_, "normals must be floats, one per position");
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
            failGltf(file_, "texture coordinates must be floats or normalised integers, one pair per position");
        mesh_.uvs.resize(mesh_.positions.size() - count, Vec2f(0.0f));
        for (size_t i = 0; i < count; ++i) mesh_.uvs.push_back({uvs.real(i, 0), 1.0f - uvs.real(i, 1)});
    }

    void addTriangles(const tinygltf::Primitive& primitive, uint32_t first, size_t vertices, bool mirrored) {
        std::vector<uint32_t> corners(primitive.indices < 0 ? vertices : 0);
        if (primitive.indices < 0) {
            for (size_t i = 0; i < vertices; ++i) corners[i] = uint32_t(i);
        } else {
            const AccessorView indices(model_, primitive.indices, 1, file_);
            if (!indices.isUnsigned()) failGltf(file_, "indices must be unsigned integers");
            corners.resize(indices.count());
            for (size_t i = 0; i < corners.size(); ++i) corners[i] = indices.integer(i);
        }
        for (const uint32_t corner : corners)
            if (corner >= vertices) failGltf(file_, "index " + std::to_string(corner) + " is beyond the vertices");
        if (mesh_.triangles.size() + corners.size() > MostElements) failGltf(file_, "has more than 2^26 triangles");
        const auto add = [&](size_t a, size_t b, size_t c) {
            if (mirrored) std::swap(b, c);
            watch_.pollEvery(a);
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
    const LoadWatch& watch_;
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

TriangleMesh mergeScene(const tinygltf::Model& model, const std::filesystem::path& file, const LoadWatch& watch) {
    Merger merger(model, file, watch);
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
            failGltf(file, "node " + std::to_string(visit.node) + " does not exist");
        if (visited[size_t(visit.node)])
            failGltf(file, "node " + std::to_string(visit.node) + " has more than one parent");
        visited[size_t(visit.node)] = true;
        const tinygltf::Node& node = model.nodes[size_t(visit.node)];
        const NodeTransform transform = visit.parent.after(localTransform(node));
        if (node.mesh >= 0) merger.addMesh(node.mesh, transform);
        push(node.children, transform);
    }
    return merger.finish();
}

} // namespace

TriangleMesh loadGltf(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within,
                      const LoadWatch& watch) {
    const tinygltf::Model model = parseGltf(file, within, watch);
    for (const std::string& extension : model.extensionsRequired)
        if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression")
            failGltf(file, "needs the glTF extension " + extension + ", which is not supported");
    return mergeScene(model, file, watch);
}

} // namespace tungsten
