// The meshes of the shared scenes: they load as they are, quickly and in little memory.

#include "support/Folders.h"

#include "tungsten/geometry/SceneGeometry.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tungsten {
namespace {

TEST(SharedScenes, MeshesLoadAndBuild) {
    const std::filesystem::path scenes = test::sharedFolder() / "scenes";
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "the shared scenes are not here";
    struct Expectation {
        const char* folder;
        size_t meshes, triangles;
    };
    for (const auto& [folder, meshes, triangles] :
         {Expectation{"cbox/meshes", 11, 72}, Expectation{"dragon/models", 13, 87715},
          Expectation{"staircase/models", 774, 262661}}) {
        std::vector<Shape> shapes;
        size_t bytes = 0;
        for (const auto& entry : std::filesystem::directory_iterator(scenes / folder)) {
            if (entry.path().extension() != ".wo3") continue;
            TriangleMesh mesh = loadMesh(entry.path());
            // 16 + 32 V + 16 T bytes a file: checks that nothing is kept twice.
            EXPECT_EQ(16 + 32 * mesh.positions.size() + 16 * mesh.triangles.size(),
                      std::filesystem::file_size(entry.path()));
            bytes += mesh.positions.capacity() * 12 + mesh.normals.capacity() * 12 + mesh.uvs.capacity() * 8 +
                     mesh.triangles.capacity() * 12 + mesh.materials.capacity() * 4;
            shapes.emplace_back(std::move(mesh));
        }
        std::vector<const Shape*> pointers;
        for (const Shape& shape : shapes) pointers.push_back(&shape);
        const SceneGeometry geometry(pointers);
        EXPECT_EQ(shapes.size(), meshes) << folder;
        EXPECT_EQ(geometry.triangleCount(), triangles) << folder;
        EXPECT_LT(bytes, size_t(16) << 20) << folder;
    }
}

} // namespace
} // namespace tungsten
