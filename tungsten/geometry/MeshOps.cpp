// Face normals, smooth normals, transforms, and the meshes of quads and cubes.

#include "tungsten/geometry/MeshFile.h"

#include <bit>
#include <unordered_map>

namespace tungsten {

Vec3f unitOrUp(const Vec3d& n) {
    const double length = std::sqrt(n.dot(n));
    if (!(length > 0.0) || !std::isfinite(length)) return {0.0f, 1.0f, 0.0f};
    return Vec3f(n / length);
}

namespace {

struct PositionHash {
    size_t operator()(const Vec3f& p) const {
        uint64_t hash = 0;
        for (const float c : {p.x, p.y, p.z})
            hash = (hash ^ std::bit_cast<uint32_t>(c + 0.0f)) * 0x9E3779B97F4A7C15u; // + 0 makes -0 equal 0
        return size_t(hash ^ (hash >> 29));
    }
};

/// Pass 1 of the crease rule: every vertex takes the normal of its first face; faces beyond the crease get copies of
/// their own. Returns the pass-1 normals, (0, 0, 0) for vertices without a face.
std::vector<Vec3f> splitCreases(TriangleMesh& mesh, float cosCrease) {
    std::vector<Vec3f> faceNormals(mesh.positions.size(), Vec3f(0.0f));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Vec3f normal = mesh.faceNormal(uint32_t(i));
        for (uint32_t& v : mesh.triangles[i].v) {
            if (faceNormals[v] == Vec3f(0.0f)) {
                faceNormals[v] = normal;
            } else if (faceNormals[v].dot(normal) < cosCrease) {
                const Vec3f position = mesh.positions[v];
                mesh.positions.push_back(position);
                if (!mesh.uvs.empty()) {
                    const Vec2f uv = mesh.uvs[v];
                    mesh.uvs.push_back(uv);
                }
                faceNormals.push_back(normal);
                v = uint32_t(mesh.positions.size() - 1);
            }
        }
    }
    return faceNormals;
}

} // namespace

Vec3d TriangleMesh::scaledNormal(uint32_t triangle) const {
    const auto& v = triangles[triangle].v;
    const Vec3d p0(positions[v[0]]);
    return (Vec3d(positions[v[1]]) - p0).cross(Vec3d(positions[v[2]]) - p0);
}

Vec3f TriangleMesh::faceNormal(uint32_t triangle) const {
    return unitOrUp(scaledNormal(triangle));
}

float TriangleMesh::faceArea(uint32_t triangle) const {
    const Vec3d n = scaledNormal(triangle);
    return float(0.5 * std::sqrt(n.dot(n)));
}

Vec3f TriangleMesh::pointOn(uint32_t triangle, float b1, float b2) const {
    // From a corner: the edges are shorter than the corners may be far from the origin.
    const auto& v = triangles[triangle].v;
    const Vec3f& p0 = positions[v[0]];
    return p0 + ((positions[v[1]] - p0) * b1 + (positions[v[2]] - p0) * b2);
}

void recomputeNormals(TriangleMesh& mesh, const LoadWatch& watch) {
    const float cosCrease = std::cos(0.15f * Pi);
    const size_t originals = mesh.positions.size();
    const std::vector<Vec3f> faceNormals = splitCreases(mesh, cosCrease);
    std::unordered_map<Vec3f, std::vector<uint32_t>, PositionHash> verticesAt;
    verticesAt.reserve(originals);
    for (size_t v = 0; v < originals; ++v) {
        watch.pollEvery(v);
        verticesAt[mesh.positions[v]].push_back(uint32_t(v));
    }

    std::vector<Vec3d> sums(originals, Vec3d(0.0));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        watch.pollEvery(i);
        const Triangle& triangle = mesh.triangles[i];
        const Vec3d weighted = mesh.scaledNormal(uint32_t(i));
        if (weighted == Vec3d(0.0)) continue;
        const Vec3f normal = unitOrUp(weighted);
        for (const uint32_t v : triangle.v)
            for (const uint32_t shared : verticesAt[mesh.positions[v]])
                if (faceNormals[shared].dot(normal) >= cosCrease) sums[shared] += weighted;
    }
    mesh.normals = faceNormals;
    for (size_t v = 0; v < originals; ++v)
        if (sums[v] != Vec3d(0.0)) mesh.normals[v] = unitOrUp(sums[v]);
    padPositions(mesh.positions);
    mesh.uvs.shrink_to_fit();
}

void dropUnused(TriangleMesh& mesh) {
    if (!mesh.smooth) std::vector<Vec3f>().swap(mesh.normals);
}

void transformMesh(TriangleMesh& mesh, const Transform& transform) {
    const Vec3f scale = transform.scale();
    const auto inverseSquare = [](float s) { return s > 0.0f ? 1.0 / (double(s) * double(s)) : 1.0; };
    const Vec3d weight(inverseSquare(scale.x), inverseSquare(scale.y), inverseSquare(scale.z));
    for (Vec3f& position : mesh.positions) position = transform.point(position);
    for (Vec3f& normal : mesh.normals) {
        const Vec3d n = weight * Vec3d(transform.vector(normal));
        const double length = std::sqrt(n.dot(n));
        normal = length > 0.0 && std::isfinite(length) ? Vec3f(n / length) : Vec3f(0.0f);
    }
}

TriangleMesh makeQuad(const Transform& transform) {
    TriangleMesh mesh;
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const Vec2f& uv : mesh.uvs) mesh.positions.push_back(transform.point({uv.x - 0.5f, 0.0f, uv.y - 0.5f}));
    mesh.triangles = {{{0, 2, 1}}, {{0, 3, 2}}};
    padPositions(mesh.positions);
    return mesh;
}

TriangleMesh makeCube(const Transform& transform) {
    const Vec3f scale = transform.scale();
    const Frame rotation = transform.rotation();
    const bool mirrored = transform.determinant() < 0.0f;
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        const int uAxis = (axis + 1) % 3, vAxis = (axis + 2) % 3;
        for (const float side : {-0.5f, 0.5f}) {
            const auto first = uint32_t(mesh.positions.size());
            for (const Vec2f& uv : {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)}) {
                Vec3f local;
                local[axis] = side;
                local[uAxis] = uv.x - 0.5f;
                local[vAxis] = uv.y - 0.5f;
                mesh.positions.push_back(transform.translation + rotation.toWorld(scale * local));
                mesh.uvs.push_back(uv);
            }
            // u x v is +axis: counter-clockwise faces look outward on the positive side; a mirror turns that round.
            const bool outward = (side > 0.0f) != mirrored;
            for (const uint32_t corner : {1u, 2u}) {
                const uint32_t b = first + corner, c = first + corner + 1;
                mesh.triangles.push_back(outward ? Triangle{{first, b, c}} : Triangle{{first, c, b}});
            }
        }
    }
    padPositions(mesh.positions);
    return mesh;
}

} // namespace tungsten
