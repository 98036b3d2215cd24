#pragma once
// What rendering would do with a mesh, whatever is in it.

#include "tungsten/geometry/SceneGeometry.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tungsten::test {

/// Normals are recomputed, rays meet it, and its surface is sampled; returns what is wrong, or nothing.
inline std::string useMesh(TriangleMesh mesh) {
    mesh.smooth = true;
    TriangleMesh recomputed = mesh;
    recomputeNormals(recomputed);
    const std::vector<Shape> shapes{std::move(mesh), std::move(recomputed)};
    const SceneGeometry geometry({&shapes[0], &shapes[1]});
    for (const Vec3f& direction : {Vec3f(0, 0, 1), Vec3f(0.6f, 0.8f, 0)}) {
        const auto hit = geometry.intersect({{0.25f, 0.25f, -10}, direction});
        if (hit && !(std::abs(hit->ng.length() - 1.0f) < 1e-4f)) return "a normal has not the length 1";
    }
    const SurfaceSample sample = AreaSampler(shapes[0]).sample(shapes[0], {0.3f, 0.7f});
    return std::isnan(sample.normal.length()) ? "a sampled normal is not a number" : "";
}

} // namespace tungsten::test
