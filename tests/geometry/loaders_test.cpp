#include "mesh_files.h"
#include "tungsten/core/Errors.h"

#include "support/ExpectNear.h"

#include <gtest/gtest.h>

#include <bit>

namespace tungsten {
namespace {

using test::expectNear;
using test::FileFolder;

void expectSamePyramid(const TriangleMesh& mesh, bool withMaterials) {
    const TriangleMesh expected = test::samplePyramid();
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.normals, expected.normals);
    EXPECT_EQ(mesh.uvs, expected.uvs);
    ASSERT_EQ(mesh.triangles.size(), expected.triangles.size());
    for (size_t i = 0; i < expected.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.triangles[i].v[k], expected.triangles[i].v[k]);
    EXPECT_EQ(mesh.materials, withMaterials ? expected.materials : std::vector<int32_t>{});
    EXPECT_GT(mesh.positions.capacity(), mesh.positions.size()); // Embree's padding
}

std::string messageOf(const std::filesystem::path& file) {
    try {
        loadMesh(file);
    } catch (const InputError& error) {
        EXPECT_EQ(error.problems().front().file, file.string());
        return error.what();
    }
    ADD_FAILURE() << file << " was accepted";
    return "";
}

TEST(Wo3, RoundTripKeepsRawMaterials) {
    const FileFolder folder;
    expectSamePyramid(loadMesh(folder.write("a.wo3", test::wo3(test::samplePyramid()))), true);
    expectSamePyramid(loadMesh(folder.write("B.WO3", test::wo3(test::samplePyramid()))), true);
}

TEST(Wo3, CountsAreCheckedBeforeAnythingIsAllocated) {
    const FileFolder folder;
    const std::string good = test::wo3(test::samplePyramid());
    for (const uint64_t count : {~uint64_t(0), uint64_t(1) << 59, uint64_t(5), (uint64_t(1) << 59) + 4}) {
        std::string bad = good; // 2^59 · 32 wraps around to 0
        std::memcpy(bad.data(), &count, 8);
        EXPECT_NE(messageOf(folder.write("v.wo3", bad)).find("claims"), std::string::npos) << count;
        bad = good;
        std::memcpy(bad.data() + 8 + 4 * 32, &count, 8);
        EXPECT_NE(messageOf(folder.write("t.wo3", bad)).find("claims"), std::string::npos) << count;
    }
    messageOf(folder.write("long.wo3", good + "x"));
    messageOf(folder.write("short.wo3", good.substr(0, good.size() - 1)));
    messageOf(folder.write("empty.wo3", ""));
}

TEST(Wo3, BadIndicesAndPositionsAreErrorsBadNormalsAreNot) {
    const FileFolder folder;
    TriangleMesh mesh = test::samplePyramid();
    mesh.triangles[2].v[1] = 4;
    EXPECT_NE(messageOf(folder.write("i.wo3", test::wo3(mesh))).find("triangle 2 refers to vertex 4"),
              std::string::npos);
    mesh = test::samplePyramid();
    mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(messageOf(folder.write("p.wo3", test::wo3(mesh))).find("vertex 3"), std::string::npos);
    mesh = test::samplePyramid();
    mesh.normals[1].x = Infinity;
    EXPECT_EQ(loadMesh(folder.write("n.wo3", test::wo3(mesh))).normals[1], Vec3f(0.0f));
}

TEST(Wo3, EmptyMeshesLoad) {
    const FileFolder folder;
    EXPECT_TRUE(loadMesh(folder.write("e.wo3", std::string(16, '\0'))).triangles.empty());
}

TEST(Obj, PolygonsNegativeIndicesAndSharedCorners) {
    const FileFolder folder;
    const TriangleMesh mesh = loadMesh(folder.write("a.obj", R"(# a square and a triangle
mtllib none.mtl
V 0 0 0
v 1 0 0 1.0
v 1 +1 0
v 0 1e0 0
vt 0 0.25
vt 1
vn 0 0 1
g group
usemtl ignored
f 1/1/1 2/2/1 3//1 4
f -4 -3 \
  -2
)"));
    ASSERT_EQ(mesh.triangles.size(), 3u);
    ASSERT_EQ(mesh.positions.size(), 7u); // the second face's corners have neither uv nor normal
    EXPECT_EQ(mesh.positions[2], Vec3f(1, 1, 0));
    const uint32_t expected[3][3] = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    for (size_t i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.triangles[i].v[k], expected[i][k]);
    EXPECT_EQ(mesh.positions[4], Vec3f(0, 0, 0));
    EXPECT_EQ(mesh.positions[6], Vec3f(1, 1, 0));
    EXPECT_EQ(mesh.uvs[0], Vec2f(0, 0.25f)); // v as it is
    EXPECT_EQ(mesh.uvs[1], Vec2f(1, 0));
    EXPECT_EQ(mesh.uvs[2], Vec2f(0, 0));
    EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.normals[3], Vec3f(0, 1, 0)); // missing
    EXPECT_TRUE(mesh.materials.empty());
}

TEST(Obj, CornersAreShared) {
    const FileFolder folder;
    const TriangleMesh mesh =
        loadMesh(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 1 2\n"));
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u); // two corners make no face
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Obj, ErrorsNameTheLine) {
    const FileFolder folder;
    EXPECT_NE(messageOf(folder.write("a.obj", "v 0 0 0\nf 1 2 3\n")).find("line 2: position 2"), std::string::npos);
    EXPECT_NE(messageOf(folder.write("b.obj", "v 0 0 0\nf 0 1 1\n")).find("line 2"), std::string::npos);
    EXPECT_NE(messageOf(folder.write("c.obj", "v 0 0 zero\n")).find("found 'zero'"), std::string::npos);
    EXPECT_NE(messageOf(folder.write("d.obj", "v 0 0\n")).find("line 1"), std::string::npos);
    EXPECT_NE(messageOf(folder.write("e.obj", "v 0 0 0\nf -2 1 1\n")).find("-2"), std::string::npos);
    EXPECT_NE(messageOf(folder.write("f.obj", "v 0 0 nan\nf 1 1 1\n")).find("finite"), std::string::npos);
}

TEST(Ply, AllEncodingsAndAnyPropertyOrder) {
    const FileFolder folder;
    for (const auto encoding : {test::PlyEncoding::Ascii, test::PlyEncoding::Little, test::PlyEncoding::Big})
        expectSamePyramid(loadMesh(folder.write("a.ply", test::ply(test::samplePyramid(), encoding))), false);
}

TEST(Ply, PolygonsAreFannedAndUvNamesVary) {
    const FileFolder folder;
    const TriangleMesh mesh =
        loadMesh(folder.write("a.ply", "ply\nformat ascii 1.0\nelement face 2\n"
                                       "property list uchar int vertex_index\nelement vertex 5\n"
                                       "property float x\nproperty float y\nproperty float z\n"
                                       "property float u\nproperty float v\nend_header\n"
                                       "5 0 1 2 3 4\n2 0 1\n"
                                       "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n.5 2 0 .5 .75\n0 1 0 0 1"));
    ASSERT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.triangles[2].v[0], 0u);
    EXPECT_EQ(mesh.triangles[2].v[1], 3u);
    EXPECT_EQ(mesh.triangles[2].v[2], 4u);
    EXPECT_EQ(mesh.uvs[3], Vec2f(0.5f, 0.75f));
    EXPECT_TRUE(mesh.normals.empty());
}

TEST(Ply, BadFilesAreErrors) {
    const FileFolder folder;
    const std::string head = "ply\nformat ascii 1.0\nelement vertex ", tail = "\nproperty float x\nproperty float y\n"
                                                                              "property float z\n";
    messageOf(folder.write("a.ply", "plx\n"));
    messageOf(folder.write("b.ply", "ply\nformat ascii 1.0\n"));
    EXPECT_NE(messageOf(folder.write("c.ply", head + "4000000000" + tail + "end_header\n0 0 0\n")).find("claims"),
              std::string::npos);
    messageOf(folder.write("d.ply", head + "1" + tail + "end_header\n0 0\n"));
    messageOf(folder.write("e.ply", head + "1" + tail + "end_header\n0 0 x\n"));
    const std::string faces = head + "3" + tail +
                              "element face 1\nproperty list int int vertex_indices\nend_header\n"
                              "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(loadMesh(folder.write("good.ply", faces + "3 0 1 2")).triangles.size(), 1u);
    messageOf(folder.write("f.ply", faces + "3 0 1 3"));
    messageOf(folder.write("g.ply", faces + "3 0 1 -1"));
    messageOf(folder.write("h.ply", faces + "-3 0 1 2"));
    messageOf(folder.write("i.ply", faces + "1000000000 0 1 2"));
    messageOf(folder.write("j.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n"));
}

/// Parent: p -> (10, 20, 30) + 2 Rz(90) p. Child: p -> parent((5 - x, y, z)).
void expectSampleScene(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.triangles.size(), 3u); // node 2 is not in the scene; points are left out
    ASSERT_EQ(mesh.positions.size(), 7u);
    expectNear(mesh.positions[0], {10, 20, 30});
    expectNear(mesh.positions[1], {10, 22, 30});
    expectNear(mesh.positions[2], {8, 20, 30});
    expectNear(mesh.positions[3], {10, 30, 30});
    expectNear(mesh.positions[4], {10, 28, 30});
    expectNear(mesh.positions[5], {8, 30, 30});
    EXPECT_EQ(mesh.materials, (std::vector<int32_t>{3, -1, -1}));
    expectNear(mesh.normals[1], {0, 0, 1});
    EXPECT_EQ(mesh.normals[4], Vec3f(0.0f)); // none in the file: flat
    EXPECT_EQ(mesh.uvs[0], Vec2f(0, 1));     // glTF counts v downward
    EXPECT_EQ(mesh.uvs[2], Vec2f(0, 0));
    // A mirrored node still shows its front: all faces look along +z.
    for (uint32_t i = 0; i < 3; ++i) expectNear(mesh.faceNormal(i), {0, 0, 1});
}

TEST(Gltf, GlbWithHierarchyMirrorAndStrip) {
    const FileFolder folder;
    expectSampleScene(loadMesh(folder.write("a.glb", test::glb(test::gltfJson(), test::gltfBuffer()))));
}

TEST(Gltf, GltfWithItsBufferBesideIt) {
    const FileFolder folder;
    folder.write("beside.bin", test::gltfBuffer());
    expectSampleScene(loadMesh(folder.write("a.gltf", test::gltfJson("beside.bin"))));
    EXPECT_NE(messageOf(folder.write("b.gltf", test::gltfJson("missing.bin"))).find("missing.bin"), std::string::npos);
}

TEST(Gltf, BoundsCyclesAndDepthAreChecked) {
    const FileFolder folder;
    const auto broken = [&](const std::string& from, const std::string& to) {
        std::string json = test::gltfJson();
        const size_t at = json.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        json.replace(at, from.size(), to);
        return messageOf(folder.write("a.glb", test::glb(json, test::gltfBuffer())));
    };
    EXPECT_NE(broken("\"count\": 3", "\"count\": 9").find("beyond"), std::string::npos);
    EXPECT_NE(broken("\"count\": 3", "\"count\": 18446744073709551615").find("a.glb"), std::string::npos);
    EXPECT_NE(broken("\"byteLength\": 96", "\"byteLength\": 9600").find("beyond the buffer"), std::string::npos);
    broken("\"byteOffset\": 36", "\"byteOffset\": 18446744073709551600");
    broken("\"bufferView\": 1", "\"bufferView\": 7");
    broken("\"byteLength\": 152", "\"byteLength\": 1000000000000");
    broken("\"POSITION\": 0", "\"POSITION\": 3");
    broken("\"POSITION\": 0", "\"POSITION\": 99");
    broken("\"mesh\": 0", "\"mesh\": 99");
    EXPECT_NE(broken("\"children\": [1]", "\"children\": [0]").find("more than one parent"), std::string::npos);
    EXPECT_NE(broken("\"children\": [1]", "\"children\": [99]").find("does not exist"), std::string::npos);
    EXPECT_NE(broken("\"materials\"", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"], \"materials\"")
                  .find("draco"),
              std::string::npos);
    const std::string deep = std::string(100000, '[') + std::string(100000, ']');
    EXPECT_NE(broken("\"materials\"", "\"extras\": " + deep + ", \"materials\"").find("too deeply"), std::string::npos);
    std::string indices = test::gltfBuffer();
    indices[96] = 3;
    EXPECT_NE(messageOf(folder.write("b.glb", test::glb(test::gltfJson(), indices))).find("index 3"),
              std::string::npos);
}

constexpr const char* Utf8Mark = "\xEF\xBB\xBF";

/// In each of the ways in which programs end lines, with and without a mark before the first.
std::vector<std::string> variantsOf(const std::string& text) {
    std::vector<std::string> variants;
    for (const std::string end : {"\n", "\r\n", "\r"})
        for (const std::string mark : {"", Utf8Mark}) {
            std::string variant = mark;
            for (const char c : text) variant += c == '\n' ? end : std::string(1, c);
            variants.push_back(variant);
        }
    return variants;
}

/// In UTF-16, of either order, and with a mark or without.
std::vector<std::string> wideVariantsOf(const std::string& text) {
    std::string little, big;
    for (const char c : text) {
        little += {c, '\0'};
        big += {'\0', c};
    }
    return {little, big, "\xFF\xFE" + little, "\xFE\xFF" + big};
}

TEST(LoadMesh, TextMayBeginWithAMarkAndEndLinesAsItLikes) {
    const FileFolder folder;
    const std::string obj = "v 0 0 0\n  v 1 0 0\nv 0 \\\n1 0 # a comment\n\nv 9 9 9\nf 1 2 3\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const auto& [name, text] : {std::pair{"a.obj", obj}, {"a.ply", ply}}) {
        for (const std::string& variant : variantsOf(text)) {
            SCOPED_TRACE(testing::PrintToString(variant));
            const TriangleMesh mesh = loadMesh(folder.write(name, variant));
            ASSERT_EQ(mesh.triangles.size(), 1u);
            for (const auto& [vertex, position] : {std::pair{0, Vec3f(0)}, {1, Vec3f(1, 0, 0)}, {2, Vec3f(0, 1, 0)}})
                EXPECT_EQ(mesh.positions[mesh.triangles[0].v[vertex]], position);
        }
        for (const std::string& wide : wideVariantsOf(text))
            EXPECT_NE(messageOf(folder.write(name, wide)).find("save it as UTF-8"), std::string::npos);
    }
}

/// After a header of CR alone the body may begin with the byte that LF is.
TEST(Ply, BodiesBeginAfterTheHeadersOwnLineEnd) {
    const FileFolder folder;
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const std::string line :
             {"ply", "format binary_little_endian 1.0", "element vertex 3", "property float x", "property float y",
              "property float z", "element face 1", "property list uchar int vertex_indices", "end_header"})
            text += line + end;
        const float first = std::bit_cast<float>(0x3F80000Au);
        for (const float x : {first, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) test::append(text, x);
        test::append(text, uint8_t(3));
        for (const int32_t vertex : {0, 1, 2}) test::append(text, vertex);
        EXPECT_EQ(loadMesh(folder.write("a.ply", text)).positions[0].x, first);
    }
}

TEST(Gltf, TextMayBeginWithAMark) {
    const FileFolder folder;
    const std::string text = R"({"asset": {"version": "2.0"}, "nodes": [{}], "scenes": [{"nodes": [0]}], "scene": 0})";
    EXPECT_TRUE(loadMesh(folder.write("a.gltf", text)).triangles.empty());
    EXPECT_TRUE(loadMesh(folder.write("a.gltf", Utf8Mark + text)).triangles.empty());
    for (const std::string& wide : wideVariantsOf(text))
        EXPECT_NE(messageOf(folder.write("a.gltf", wide)).find("save it as UTF-8"), std::string::npos);
}

TEST(LoadMesh, MissingFilesFoldersAndUnknownTypes) {
    const FileFolder folder;
    EXPECT_NE(messageOf(folder.path("none.wo3")).find("no such file"), std::string::npos);
    EXPECT_NE(messageOf(folder.write("a.stl", "solid")).find("accepted: .wo3"), std::string::npos);
    std::filesystem::create_directory(folder.path("folder.ply"));
    messageOf(folder.path("folder.ply"));
}

} // namespace
} // namespace tungsten
