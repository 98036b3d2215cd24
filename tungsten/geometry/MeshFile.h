#pragma once
// What the mesh loaders share: memory limits and the checks every loaded mesh has passed.

#include "tungsten/core/FileBytes.h"
#include "tungsten/geometry/Mesh.h"

namespace tungsten {

/// Checks indices and positions (InputError), zeroes normals and uvs that are not finite, and releases spare memory.
void finishMesh(TriangleMesh& mesh, const std::filesystem::path& file);

/// Reallocates `positions` with room for exactly one element more: Embree reads 16 bytes at the last vertex of a shared
/// buffer.
void padPositions(std::vector<Vec3f>& positions);

} // namespace tungsten
