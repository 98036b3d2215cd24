// What a scene's hash is of: the contents of every file that it reads, wherever they lie. Files that cannot be what
// they are meant for are refused before they are read.

#include "geometry/mesh_files.h"
#include "support/SceneFile.h"

#include "tungsten/core/Hash.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;

constexpr const char* Triangle = R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "t.bin", "byteLength": 36}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3,
    "type": "VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes":
    [{"nodes": [0]}], "scene": 0})";

std::string bytesOf(std::vector<float> numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

/// A file that a scene reads, itself or through another, and where a byte of it can be changed.
struct Resource {
    const char* name;
    std::string bytes;
    size_t at;
    char other;
};

std::vector<Resource> resources() {
    const std::string wo3 = test::wo3(test::samplePyramid());
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n";
    return {{"m.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", 2, '3'},
            {"m.ply", ply, ply.find("1 0 0"), '4'},
            {"m.wo3", wo3, 18, char(wo3[18] ^ 1)},
            {"t.bin", bytesOf({0, 0, 0, 1, 0, 0, 0, 0, 1}), 14, 0x7f},
            {"p.pfm", "PF\n1 1\n-1\n" + bytesOf({0.5f, 0.25f, 0.125f}), 12, 1}};
}

/// A folder with a scene and all that it reads.
class Folder {
  public:
    Folder() {
        for (const Resource& resource : resources()) files_.write(resource.name, resource.bytes);
        files_.write("m.gltf", Triangle);
        std::string meshes;
        for (const char* const mesh : {"m.obj", "m.ply", "m.wo3", "m.gltf"})
            meshes += std::string(R"({"type": "mesh", "file": ")") + mesh + R"(", "bsdf": "paper"}, )";
        files_.write("scene.json", R"({"bsdfs": [{"name": "paper", "type": "lambert", "albedo": "p.pfm"}],
            "primitives": [)" + meshes +
                                       R"({"type": "point", "emission": 1}]})");
    }
    [[nodiscard]] LoadedScene load(const fs::path& scene) const { return loadScene(scene); }
    [[nodiscard]] uint64_t hash() const { return loadScene(files_.path("scene.json")).hash; }
    [[nodiscard]] const test::FileFolder& files() const { return files_; }

  private:
    test::FileFolder files_;
};

TEST(SceneContent, FilesCountByContentAlone) {
    const Folder folder, other;
    const uint64_t hash = folder.hash();
    EXPECT_EQ(other.hash(), hash) << "the same in another folder";
    for (const Resource& resource : resources()) {
        const fs::path file = folder.files().path(resource.name);
        const auto time = fs::last_write_time(file);
        fs::last_write_time(file, time + std::chrono::hours(1));
        EXPECT_EQ(folder.hash(), hash) << resource.name << ", touched";
        std::string changed = resource.bytes;
        ASSERT_NE(changed.at(resource.at), resource.other) << resource.name;
        changed[resource.at] = resource.other;
        folder.files().write(resource.name, changed);
        fs::last_write_time(file, time);
        EXPECT_NE(folder.hash(), hash) << resource.name << ", changed, of the same size and time";
        folder.files().write(resource.name, resource.bytes);
    }
    EXPECT_EQ(folder.hash(), hash);
}

TEST(SceneContent, BuffersOfGltfFilesAreInputs) {
    const Folder folder;
    const LoadedScene loaded = loadScene(folder.files().path("scene.json"));
    std::vector<std::string> names;
    for (const fs::path& input : loaded.inputs) names.push_back(input.filename().string());
    std::sort(names.begin() + 1, names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"scene.json", "m.gltf", "m.obj", "m.ply", "m.wo3", "p.pfm", "t.bin"}));
}

TEST(SceneContent, TwoChangesDoNotCancel) {
    // Signs of neighbouring doubles: the top bits of words, which products do not bring down.
    const auto hash = [](std::vector<double> numbers) {
        Hash sum;
        sum.addMany(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
        return sum.value();
    };
    EXPECT_NE(hash({1, 2, 3, 4}), hash({-1, -2, 3, 4}));
    EXPECT_NE(hash({1, 2, 3, 4}), hash({1, -2, 3, -4}));
    EXPECT_NE(hash({1, 2, 3, 4}), hash({2, 1, 3, 4}));
}

class ReadOn : public std::exception {};

/// What is wrong with a scene, read by someone who does not wait for hundreds of megabytes.
std::string problemsOf(const fs::path& scene) {
    LoadOptions options;
    int looks = 0; // one every eight megabytes
    const auto look = [&] {
        if (++looks > 8) throw ReadOn();
    };
    options.watch = LoadWatch(look, std::chrono::milliseconds(0));
    try {
        (void)loadScene(scene, options);
    } catch (const InputError& error) {
        return error.what();
    } catch (const ReadOn&) {
        return "read on";
    }
    return "none";
}

TEST(SceneContent, LargeFilesOfAnotherTypeAreNotRead) {
    constexpr uint64_t Large = uint64_t(1) << 29;
    const std::vector<std::tuple<const char*, std::string, const char*>> files{
        {"m.obj", "", "not a text"},
        {"m.gltf", "", "not a text"},
        {"m.glb", std::string("glTF\2\0\0\0\x20\0\0\0", 12), "its header says 32"},
        {"m.ply", "", "not a PLY file"},
        {"m.wo3", "", "its counts make 16"}};
    for (const auto& [name, start, expected] : files) {
        const test::FileFolder folder;
        fs::resize_file(folder.write(name, start), Large); // a hole
        const fs::path scene =
            folder.write("scene.json", std::string(R"({"primitives": [{"type": "mesh", "file": ")") + name + R"("}]})");
        EXPECT_NE(problemsOf(scene).find(expected), std::string::npos) << name << ": " << problemsOf(scene);
    }
    const test::FileFolder folder;
    const fs::path textured = folder.write(
        "scene.json", R"({"primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": "p.png"}}]})");
    fs::resize_file(folder.write("p.png", ""), Large);
    EXPECT_NE(problemsOf(textured).find("not a readable image"), std::string::npos) << problemsOf(textured);
    fs::resize_file(folder.write("p.png", "\x89PNG\r\n\x1a\n"), 5 * Large);
    EXPECT_NE(problemsOf(textured).find("larger than 2 GiB"), std::string::npos) << problemsOf(textured);
    fs::resize_file(folder.write("scene.json", ""), Large);
    EXPECT_NE(problemsOf(folder.path("scene.json")).find("not a text"), std::string::npos);
    fs::resize_file(folder.write("scene.json", "{}" + std::string(5000, ' ')), 3 * Large);
    EXPECT_NE(problemsOf(folder.path("scene.json")).find("larger than 1 GiB"), std::string::npos);
}

} // namespace
} // namespace tungsten
