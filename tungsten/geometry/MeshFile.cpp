#include "tungsten/geometry/MeshFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/geometry/ShapeReader.h"

#include <algorithm>
#include <cctype>

namespace tungsten {

namespace {

bool isFinite3(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string lowerCaseExtension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

} // namespace

void padPositions(std::vector<Vec3f>& positions) {
    if (positions.capacity() == positions.size() + 1) return;
    std::vector<Vec3f> exact;
    exact.reserve(positions.size() + 1);
    exact.assign(positions.begin(), positions.end());
    positions.swap(exact);
}

void finishMesh(TriangleMesh& mesh, const std::filesystem::path& file) {
    const size_t count = mesh.positions.size();
    const auto bad = std::find_if_not(mesh.positions.begin(), mesh.positions.end(), isFinite3);
    if (bad != mesh.positions.end())
        throw InputError(file.string(), "the position of vertex " + std::to_string(bad - mesh.positions.begin()) +
                                            " is not a finite number");
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const uint32_t v : mesh.triangles[i].v)
            if (v >= count)
                throw InputError(file.string(), "triangle " + std::to_string(i) + " refers to vertex " +
                                                    std::to_string(v) + ", but there are " + std::to_string(count));
    for (Vec3f& normal : mesh.normals)
        if (!isFinite3(normal)) normal = Vec3f(0.0f);
    for (Vec2f& uv : mesh.uvs)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = Vec2f(0.0f);
    padPositions(mesh.positions);
    mesh.normals.shrink_to_fit();
    mesh.uvs.shrink_to_fit();
    mesh.triangles.shrink_to_fit();
    mesh.materials.shrink_to_fit();
}

TriangleMesh loadMesh(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within,
                      const LoadWatch& watch) {
    const std::string extension = lowerCaseExtension(file);
    if (extension == ".wo3") return loadWo3(file, watch);
    if (extension == ".obj") return loadObj(file, watch);
    if (extension == ".ply") return loadPly(file, watch);
    if (extension == ".gltf" || extension == ".glb") return loadGltf(file, within, watch);
    throw InputError(file.string(), "a mesh of type '" + extension + "'; accepted: .wo3, .obj, .ply, .gltf or .glb");
}

TriangleMesh MeshFile::read(const ShapeReader& fields) {
    TriangleMesh mesh;
    mesh.smooth = fields.flag("smooth", false, {"none", "shading normals are interpolated"});
    const bool smooth = mesh.smooth;
    const bool recompute =
        fields.flag("recompute_normals", false, {"none", "of smooth meshes: from the triangles instead of the file"});
    fields.accept({"backface_culling"});
    const std::string file = fields.text("file", "", {"none", ".wo3, .obj, .ply, .gltf or .glb", "required"});
    if (file.empty()) {
        fields.problem("file", "a mesh needs a file (.wo3, .obj, .ply, .gltf or .glb)");
        return mesh;
    }
    try {
        mesh = loadMesh(fields.files.find(file), fields.files.allowedFolder(), fields.files.watch);
    } catch (const InputError& error) {
        fields.problem("file", error.what());
        return {};
    }
    mesh.smooth = smooth;
    if (smooth && recompute) recomputeNormals(mesh, fields.files.watch);
    if (!smooth) std::vector<Vec3f>().swap(mesh.normals);
    transformMesh(mesh, fields.placement);
    return mesh;
}

} // namespace tungsten
