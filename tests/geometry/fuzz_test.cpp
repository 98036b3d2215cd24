// Damaged mesh files: each loads or is an InputError; nothing crashes, hangs or allocates absurd sizes.

#include "mesh_files.h"
#include "support/Fuzz.h"
#include "support/LargestAllocation.h"
#include "support/UseMesh.h"

#include <gtest/gtest.h>

#include <sstream>

namespace tungsten {
namespace {

using test::FileFolder;

std::string sampleObj() {
    std::ostringstream out;
    out << "# sample\nmtllib a.mtl\n";
    for (int i = 0; i < 12; ++i) out << "v " << i % 3 << " " << 0.5 * i << " -1e" << i % 4 << "\n";
    out << "vt 0.5 0.25\nvt 1 0 0\nvn 0 0 1\nvn 0 1 0\n";
    for (int i = 1; i < 10; ++i) out << "f " << i << "/1/2 " << i + 1 << "//1 -1 " << i + 2 << "/2\n";
    return out.str();
}

int fuzz(const FileFolder& folder, const std::string& name, const std::string& original) {
    return test::fuzz(folder, name, original, [](const auto& file) { EXPECT_EQ(test::useMesh(loadMesh(file)), ""); });
}

TEST(MeshFuzz, DamagedFilesLoadOrAreInputErrors) {
    const FileFolder folder;
    const TriangleMesh pyramid = test::samplePyramid();
    folder.write("beside.bin", test::gltfBuffer());
    test::largestAllocation = 0;
    int accepted = 0;
    accepted += fuzz(folder, "a.wo3", test::wo3(pyramid));
    accepted += fuzz(folder, "a.obj", sampleObj());
    accepted += fuzz(folder, "ascii.ply", test::ply(pyramid, test::PlyEncoding::Ascii));
    accepted += fuzz(folder, "little.ply", test::ply(pyramid, test::PlyEncoding::Little));
    accepted += fuzz(folder, "big.ply", test::ply(pyramid, test::PlyEncoding::Big));
    accepted += fuzz(folder, "a.glb", test::glb(test::gltfJson(), test::gltfBuffer()));
    accepted += fuzz(folder, "a.gltf", test::gltfJson("beside.bin"));
    // Both outcomes happen: the mutations are neither harmless nor all fatal.
    EXPECT_GT(accepted, 50);
    EXPECT_LT(accepted, int(7 * test::MutationsPerFile) - 500);
    EXPECT_LT(test::largestAllocation, size_t(1) << 26); // bytes; the files have some hundred
}

} // namespace
} // namespace tungsten
