#pragma once
// Mesh files written byte by byte.

#include "support/SceneFile.h"
#include "tungsten/geometry/Mesh.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>

namespace tungsten::test {

template <typename Value>
void append(std::string& out, Value value, bool bigEndian = false) {
    char raw[sizeof(Value)];
    std::memcpy(raw, &value, sizeof(Value));
    if (bigEndian) std::reverse(raw, raw + sizeof(Value));
    out.append(raw, sizeof(Value));
}

/// A pyramid of four vertices with distinct normals, uvs and materials.
inline TriangleMesh samplePyramid() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0.25f, 0.5f, 3}};
    mesh.normals = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {0.5f, 0.5f}};
    mesh.triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}};
    mesh.materials = {-1, 0, 7, 2};
    return mesh;
}

inline std::string wo3(const TriangleMesh& mesh) {
    std::string out;
    append(out, uint64_t(mesh.positions.size()));
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        for (const float v : {mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z}) append(out, v);
        for (const float v : {mesh.normals[i].x, mesh.normals[i].y, mesh.normals[i].z}) append(out, v);
        append(out, mesh.uvs[i].x);
        append(out, mesh.uvs[i].y);
    }
    append(out, uint64_t(mesh.triangles.size()));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const uint32_t v : mesh.triangles[i].v) append(out, v);
        append(out, mesh.materials[i]);
    }
    return out;
}

enum class PlyEncoding { Ascii, Little, Big };

/// Properties in an unusual order (doubles, an unknown list and an unknown element between them), faces of unsigned
/// indices.
inline std::string ply(const TriangleMesh& mesh, PlyEncoding encoding) {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    std::string out = std::string("ply\r\nformat ") + names[int(encoding)] +
                      " 1.0\ncomment made by a test\nelement vertex " + std::to_string(mesh.positions.size()) +
                      "\nproperty double z\nproperty uchar red\nproperty float x\nproperty list uchar short extra\n"
                      "property float y\nproperty float s\nproperty float t\nproperty float nx\nproperty float ny\n"
                      "property float nz\nelement edge 2\nproperty int a\nproperty ushort b\nelement face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty char flag\nproperty list uint uint vertex_indices\nend_header\n";
    const auto put = [&](auto value) {
        if (encoding == PlyEncoding::Ascii)
            out += std::to_string(+value) + ' ';
        else
            append(out, value, encoding == PlyEncoding::Big);
    };
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        put(double(mesh.positions[i].z));
        put(uint8_t(200));
        put(mesh.positions[i].x);
        put(uint8_t(2));
        put(int16_t(-3));
        put(int16_t(4));
        for (const float v : {mesh.positions[i].y, mesh.uvs[i].x, mesh.uvs[i].y, mesh.normals[i].x, mesh.normals[i].y,
                              mesh.normals[i].z})
            put(v);
    }
    for (int i = 0; i < 2; ++i) {
        put(int32_t(-i));
        put(uint16_t(i));
    }
    for (const Triangle& triangle : mesh.triangles) {
        put(int8_t(-1));
        put(uint32_t(3));
        for (const uint32_t v : triangle.v) put(v);
    }
    return out;
}

inline std::string glb(std::string json, std::string binary) {
    while (json.size() % 4) json += ' ';
    while (binary.size() % 4) binary += '\0';
    std::string out = "glTF";
    append(out, uint32_t(2));
    append(out, uint32_t(12 + 8 + json.size() + 8 + binary.size()));
    append(out, uint32_t(json.size()));
    out += "JSON" + json;
    append(out, uint32_t(binary.size()));
    out += std::string("BIN\0", 4) + binary;
    return out;
}

/// Two unit right triangles: an indexed one (16-bit, normals, uvs, material 3) and a strip of floats without indices.
/// Buffer: 0 positions (36), 36 normals (36), 72 uvs (24), 96 indices (6 + 2), 104 strip positions (48).
inline std::string gltfBuffer() {
    std::string out;
    for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(out, v);
    for (int i = 0; i < 3; ++i)
        for (const float v : {0.f, 0.f, 1.f}) append(out, v);
    for (const float v : {0.f, 0.f, 1.f, 0.f, 0.f, 1.f}) append(out, v);
    for (const int v : {0, 1, 2, 0}) append(out, uint16_t(v));
    for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 1.f, 1.f, 0.f}) append(out, v);
    return out;
}

/// A parent (translated, turned by 90 degrees about z, doubled) with a child given by a matrix that mirrors x.
inline std::string gltfJson(const std::string& uri = "") {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "children": [1], "translation": [10, 20, 30], "rotation": [0, 0, 0.70710678118, 0.70710678118],
            "scale": [2, 2, 2]},
           {"mesh": 1, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
           {"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 3}]},
            {"primitives": [{"attributes": {"POSITION": 4}, "mode": 5}, {"attributes": {"POSITION": 4}, "mode": 0}]}],
 "materials": [{}, {}, {}, {}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
               {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"},
               {"bufferView": 0, "byteOffset": 72, "componentType": 5126, "count": 3, "type": "VEC2"},
               {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
               {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 8},
                 {"buffer": 0, "byteOffset": 104, "byteLength": 48, "byteStride": 12}],
 "images": [{"uri": "not there.png"}],
 "buffers": [{"byteLength": 152)" +
           (uri.empty() ? "" : R"(, "uri": ")" + uri + "\"") + "}]}";
}

} // namespace tungsten::test
