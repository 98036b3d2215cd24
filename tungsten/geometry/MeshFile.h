#pragma once
// The mesh loaders, and what they share: memory limits and the checks every loaded mesh has passed.

#include "tungsten/core/FileBytes.h"
#include "tungsten/geometry/Mesh.h"

namespace tungsten {

TriangleMesh loadWo3(const std::filesystem::path& file, const LoadWatch& watch);
/// Groups, objects and materials are ignored; a corner without a normal gets (0, 1, 0), without uv (0, 0).
TriangleMesh loadObj(const std::filesystem::path& file, const LoadWatch& watch);
/// ASCII and binary, both endians; elements vertex (x y z, nx ny nz, s t or u v) and face (vertex_indices).
TriangleMesh loadPly(const std::filesystem::path& file, const LoadWatch& watch);
/// Triangles of the default scene's nodes; material index = glTF material; v flipped to the convention that 1 is the
/// top.
TriangleMesh loadGltf(const std::filesystem::path& file, const std::optional<std::filesystem::path>& within,
                      const LoadWatch& watch);

/// Checks indices and positions (InputError), zeroes normals and uvs that are not finite, and releases spare memory.
void finishMesh(TriangleMesh& mesh, const std::filesystem::path& file);

/// Reallocates `positions` with room for exactly one element more: Embree reads 16 bytes at the last vertex of a shared
/// buffer.
void padPositions(std::vector<Vec3f>& positions);

} // namespace tungsten
