// Tungsten's own mesh format: counts and packed little-endian records, no header.

#include "tungsten/core/Errors.h"
#include "tungsten/geometry/MeshFile.h"

#include <cstring>
#include <fstream>

namespace tungsten {

namespace {

constexpr uint64_t CountBytes = 8, VertexBytes = 32, TriangleBytes = 16;

struct Counts {
    uint64_t vertices = 0, triangles = 0;

    [[nodiscard]] uint64_t trianglesAt() const { return CountBytes + vertices * VertexBytes; }
};

/// The count at `offset`, checked so that `count` records of `recordBytes` fit behind it.
uint64_t readCount(std::istream& in, uint64_t size, uint64_t offset, uint64_t recordBytes, const char* what,
                   const std::filesystem::path& file) {
    if (size < CountBytes || offset > size - CountBytes)
        throw InputError(file.string(), std::string("ends before the number of ") + what);
    uint64_t count = 0;
    in.seekg(std::streamoff(offset));
    in.read(reinterpret_cast<char*>(&count), CountBytes);
    if (!in) throw InputError(file.string(), "cannot be read");
    const uint64_t room = (size - offset - CountBytes) / recordBytes;
    if (count > room || count > UINT32_MAX)
        throw InputError(file.string(),
                         "claims " + std::to_string(count) + " " + what + ", but has room for " + std::to_string(room));
    return count;
}

/// Of a file of this size, which they must make; the records are left unread.
Counts readCounts(const std::filesystem::path& file, uint64_t size) {
    std::ifstream in(file, std::ios::binary);
    Counts counts;
    counts.vertices = readCount(in, size, 0, VertexBytes, "vertices", file);
    counts.triangles = readCount(in, size, counts.trianglesAt(), TriangleBytes, "triangles", file);
    const uint64_t expected = counts.trianglesAt() + CountBytes + counts.triangles * TriangleBytes;
    if (expected != size)
        throw InputError(file.string(),
                         "has " + std::to_string(size) + " bytes; its counts make " + std::to_string(expected));
    return counts;
}

} // namespace

TriangleMesh loadWo3(const std::filesystem::path& file, const LoadWatch& watch) {
    Counts counts;
    const std::vector<char> bytes =
        readFileBytes(file, watch, [&](std::string_view, uint64_t size) { counts = readCounts(file, size); });
    const auto [vertices, triangles] = counts;
    const uint64_t trianglesAt = counts.trianglesAt();
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
