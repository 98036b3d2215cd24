#pragma once
// Triangle meshes in world space and their files.

#include "tungsten/core/LoadWatch.h"
#include "tungsten/core/Transform.h"
#include "tungsten/geometry/ShapeModel.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace tungsten {

struct Triangle {
    uint32_t v[3];
};

/// Triangles over shared vertices. `normals` and `uvs` are empty or one per vertex; `materials` empty (all 0) or one
/// per triangle.
struct TriangleMesh {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<Vec2f> uvs;
    std::vector<Triangle> triangles;
    std::vector<int32_t> materials;
    bool smooth = false; ///< interpolate `normals`; otherwise shading normals are face normals

    /// Normalised (p1 - p0) x (p2 - p0); (0, 1, 0) for a degenerate triangle.
    [[nodiscard]] Vec3f faceNormal(uint32_t triangle) const;
    /// (p1 - p0) x (p2 - p0) in double: no overflow or underflow for any float positions.
    [[nodiscard]] Vec3d scaledNormal(uint32_t triangle) const;
    [[nodiscard]] float faceArea(uint32_t triangle) const;
    /// At the barycentric weights `b1`, `b2` of the second and third corner.
    [[nodiscard]] Vec3f pointOn(uint32_t triangle, float b1, float b2) const;

    [[nodiscard]] bool isEmpty() const { return triangles.empty(); }
    [[nodiscard]] size_t faceCount() const { return triangles.size(); }
    [[nodiscard]] size_t triangleCount() const { return triangles.size(); }
    [[nodiscard]] bool isWithin(float limit) const;
    [[nodiscard]] bool isSheet() const;
    [[nodiscard]] Imath::Box3f bounds() const;
    [[nodiscard]] BoundingSphere boundingSphere() const;
    [[nodiscard]] float area() const;
    [[nodiscard]] std::vector<float> faceAreas() const;
    [[nodiscard]] SurfaceSample samplePoint(const Distribution1D& areas, const Vec2f& u) const;
    [[nodiscard]] FacePlane facePlane(uint32_t face, const Vec3f& position) const;
    [[nodiscard]] Tangents tangents(const SurfaceHit& hit) const;
    void complete(const Ray& ray, const Vec2f& barycentric, SurfaceHit& hit) const;
};

/// Of length 1; (0, 1, 0) for what is zero or not finite.
Vec3f unitOrUp(const Vec3d& n);

/// Reads .wo3, .obj, .ply, .gltf, .glb (by extension, case-insensitive; glTF node transforms applied, all nodes
/// merged). Throws InputError naming the file for anything missing, truncated, corrupt or out of range (indices, counts
/// against the file's size, non-finite positions). A file without triangles gives an empty mesh. Normals and uvs that
/// are not finite become 0 (the face normal is used there). Buffers of a glTF in files of their own must lie `within`
/// that folder, if there is one.
TriangleMesh loadMesh(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within = {},
                      const LoadWatch& watch = {});

/// Frees what rendering will not read: the normals of a mesh that is not smooth.
void dropUnused(TriangleMesh& mesh);

/// Replaces the vertex normals by area-weighted ones with the format's 27 degree crease rule (may split vertices).
void recomputeNormals(TriangleMesh& mesh, const LoadWatch& watch = {});

/// Positions by M; normals by S^-2 M (S the column lengths of M, applied on the left as the format does), normalised.
void transformMesh(TriangleMesh& mesh, const Transform& transform);

/// [-1/2, 1/2]^2 in xz with normal e1 x e0 (+y), uv along +x, +z; a mirroring transform flips the normal.
TriangleMesh makeQuad(const Transform& transform);
/// [-1/2, 1/2]^3 with outward normals; for the faces of axis k, u runs along axis k+1 and v along axis k+2.
TriangleMesh makeCube(const Transform& transform);

} // namespace tungsten
