// Tungsten's own mesh format: counts and packed little-endian records, no header.

#include "tungsten/core/Errors.h"
#include "tungsten/geometry/MeshFile.h"

#include <cstring>

namespace tungsten {

namespace {

constexpr uint64_t CountBytes = 8, VertexBytes = 32, TriangleBytes = 16;

/// The count at `offset`, checked so that `count` records of `recordBytes` fit behind it.
uint64_t readCount(const std::vector<char>& bytes, uint64_t offset, uint64_t recordBytes, const char* what,
                   const std::filesystem::path& file) {
    if (bytes.size() < CountBytes || offset > bytes.size() - CountBytes)
        throw InputError(file.string(), std::string("ends before the number of ") + what);
    uint64_t count = 0;
    std::memcpy(&count, bytes.data() + offset, CountBytes);
    const uint64_t room = (bytes.size() - offset - CountBytes) / recordBytes;
    if (count > room || count > UINT32_MAX)
        throw InputError(file.string(),
                         "claims " + std::to_string(count) + " " + what + ", but has room for " + std::to_string(room));
    return count;
}

} // namespace

TriangleMesh loadWo3(const std::filesystem::path& file, const LoadWatch& watch) {
    const std::vector<char> bytes = readFileBytes(file, watch);
    const uint64_t vertices = readCount(bytes, 0, VertexBytes, "vertices", file);
    const uint64_t trianglesAt = CountBytes + vertices * VertexBytes;
    const uint64_t triangles = readCount(bytes, trianglesAt, TriangleBytes, "triangles", file);
    const uint64_t expected = trianglesAt + CountBytes + triangles * TriangleBytes;
    if (expected != bytes.size())
        throw InputError(file.string(),
                         "has " + std::to_string(bytes.size()) + " bytes; its counts make " + std::to_string(expected));
    TriangleMesh mesh;
    mesh.positions.reserve(vertices + 1); // see padPositions
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    mesh.uvs.resize(vertices);
    const char* record = bytes.data() + CountBytes;
    for (uint64_t i = 0; i < vertices; ++i, record += VertexBytes) {
        watch.pollEvery(i);
        std::memcpy(mesh.positions[i].getValue(), record, 12);
        std::memcpy(mesh.normals[i].getValue(), record + 12, 12);
        std::memcpy(mesh.uvs[i].getValue(), record + 24, 8);
    }
    mesh.triangles.resize(triangles);
    mesh.materials.resize(triangles);
    record = bytes.data() + trianglesAt + CountBytes;
    for (uint64_t i = 0; i < triangles; ++i, record += TriangleBytes) {
        watch.pollEvery(i);
        std::memcpy(mesh.triangles[i].v, record, 12);
        std::memcpy(&mesh.materials[i], record + 12, 4);
    }
    finishMesh(mesh, file);
    return mesh;
}

} // namespace tungsten
