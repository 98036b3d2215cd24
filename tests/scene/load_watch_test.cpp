// Loading that is asked, on the way, whether to go on.

#include "geometry/mesh_files.h"
#include "support/SceneFile.h"

#include "tungsten/core/FileBytes.h"
#include "tungsten/geometry/SceneGeometry.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <exception>

namespace tungsten {
namespace {

class Enough : public std::exception {};

/// Asks whenever it can; `most` looks are enough.
struct Counting {
    explicit Counting(int most = 1 << 30) : most_(most) {}

    LoadWatch watch{[this] {
                        if (++looks >= most_) throw Enough();
                    },
                    std::chrono::milliseconds(0)};
    int looks = 0;

  private:
    int most_;
};

/// A square of side x side vertices.
TriangleMesh grid(uint32_t side) {
    TriangleMesh mesh;
    mesh.positions.reserve(size_t(side) * side + 1);
    for (uint32_t i = 0; i < side * side; ++i) {
        mesh.positions.push_back({float(i % side), 0.0f, float(i / side)});
        mesh.normals.push_back({0, 1, 0});
        mesh.uvs.push_back({0, 0});
    }
    for (uint32_t i = 0; i + side + 1 < side * side; ++i) {
        if (i % side == side - 1) continue;
        mesh.triangles.push_back({{i, i + side, i + 1}});
        mesh.triangles.push_back({{i + 1, i + side, i + side + 1}});
        mesh.materials.insert(mesh.materials.end(), 2, 0);
    }
    return mesh;
}

std::string obj(const TriangleMesh& mesh) {
    std::string text;
    for (const Vec3f& p : mesh.positions) text += "v " + std::to_string(p.x) + " 0 " + std::to_string(p.z) + "\n";
    for (const Triangle& t : mesh.triangles) {
        text += "f";
        for (const uint32_t v : t.v) text += " " + std::to_string(v + 1);
        text += "\n";
    }
    return text;
}

TEST(LoadWatch, IsAskedWhileMeshesAreRead) {
    const test::FileFolder folder;
    const TriangleMesh mesh = grid(100);
    for (const auto& [name, content] : {std::pair("a.wo3", test::wo3(mesh)), std::pair("a.obj", obj(mesh)),
                                        std::pair("a.ply", test::ply(mesh, test::PlyEncoding::Little))}) {
        const auto file = folder.write(name, content);
        Counting all;
        EXPECT_EQ(loadMesh(file, {}, all.watch).triangles.size(), mesh.triangles.size()) << name;
        EXPECT_GE(all.looks, 20) << name << ": 10000 vertices and 19602 triangles";
        for (const int most : {1, all.looks / 2, all.looks}) {
            Counting some(most);
            EXPECT_THROW(loadMesh(file, {}, some.watch), Enough) << name;
            EXPECT_EQ(some.looks, most) << name << ": nothing is asked any more";
        }
    }
}

TEST(LoadWatch, IsAskedWhileNormalsAreMade) {
    TriangleMesh mesh = grid(100);
    Counting some(20);
    EXPECT_THROW(recomputeNormals(mesh, some.watch), Enough);
}

TEST(LoadWatch, EndsEmbreesWork) {
    const Shape mesh = grid(700);
    Counting all;
    const SceneGeometry whole({&mesh}, {}, all.watch);
    EXPECT_TRUE(whole.occluded({{100.3f, 1, 100.4f}, {0, -1, 0}}));
    EXPECT_GE(all.looks, 3) << "its builder asks, too";
    Counting some(2);
    EXPECT_THROW(SceneGeometry({&mesh}, {}, some.watch), Enough);
}

TEST(LoadWatch, EndsScenes) {
    const std::string lamp = R"({"type": "point", "emission": 1})";
    std::string lamps = lamp;
    for (int i = 0; i < 9; ++i) lamps += ", " + lamp;
    const test::SceneFile file(R"({"primitives": [)" + lamps + "]}");
    Counting all, some(5);
    LoadOptions options;
    options.watch = all.watch;
    EXPECT_EQ(loadScene(file.path(), options).scene->emitters.size(), 10u);
    EXPECT_GE(all.looks, 10);
    options.watch = some.watch;
    EXPECT_THROW(loadScene(file.path(), options), Enough);
}

TEST(LoadWatch, AsksNowAndThen) {
    int looks = 0;
    const LoadWatch watch([&] { ++looks; }, std::chrono::hours(1));
    for (size_t i = 0; i < 1000000; ++i) watch.pollEvery(i);
    EXPECT_EQ(looks, 0);
    const LoadWatch nobody;
    nobody.poll();
    EXPECT_TRUE(nobody.goesOn());
}

} // namespace
} // namespace tungsten
