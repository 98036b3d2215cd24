// Image files, format by format.

#include "support/SceneFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/ReadImage.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/io/Writers.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>

namespace tungsten {
namespace {

using test::TemporaryFolder;

Image gradient(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = Rgb(float(x) + 0.25f, float(y) * 0.5f, 1e-3f * float(x * y));
    return image;
}

TEST(ImageIo, PfmRoundTripsAndNamesDamage) {
    const TemporaryFolder folder;
    const Image image = gradient(5, 3);
    writePfm(folder.path() / "a.pfm", image);
    EXPECT_EQ(readPfm(folder.path() / "a.pfm").pixels, image.pixels);
    std::filesystem::resize_file(folder.path() / "a.pfm", 100);
    EXPECT_THROW(readPfm(folder.path() / "a.pfm"), InputError);
    EXPECT_THROW(readPfm(folder.path() / "none.pfm"), InputError);
}

TEST(ImageIo, ExrKeepsLayersAndParts) {
    const TemporaryFolder folder;
    const Image image = gradient(7, 4), error = gradient(7, 4);
    writeExr(folder.path() / "one.exr", {ExrPart{"", image, error, true, 1.5, 2.0}});
    EXPECT_EQ(exrPartCount(folder.path() / "one.exr"), 1);
    EXPECT_EQ(readExr(folder.path() / "one.exr").pixels, image.pixels);
    EXPECT_EQ(readExr(folder.path() / "one.exr", 0, "stderr.").pixels, error.pixels);
    std::vector<ExrPart> parts;
    for (int i = 0; i < 3; ++i)
        parts.push_back({"frame." + std::to_string(i), image, error, true, double(i), double(i) + 1.0});
    parts[2].colour.at(0, 0) = Rgb(42.0f);
    writeExr(folder.path() / "many.exr", parts);
    EXPECT_EQ(exrPartCount(folder.path() / "many.exr"), 3);
    EXPECT_EQ(readExr(folder.path() / "many.exr", 2).at(0, 0), Rgb(42.0f));
    EXPECT_THROW(readExr(folder.path() / "one.exr", 0, "nothing."), InputError);
}

/// As the format stores it: the attribute's name and type, a size, and the value.
double doubleAttribute(const std::string& exr, const std::string& name) {
    const std::string start = name + '\0' + "double" + '\0' + std::string("\x08\0\0\0", 4);
    const size_t at = exr.find(start);
    double value = std::numeric_limits<double>::quiet_NaN();
    if (at != std::string::npos) std::memcpy(&value, exr.data() + at + start.size(), sizeof value);
    return value;
}

TEST(ImageIo, AnExrSaysWhenItsFrameStartsAndEnds) {
    const TemporaryFolder folder;
    writeExr(folder.path() / "a.exr", {ExrPart{"", gradient(2, 2), {}, true, 1.5, 2.25}});
    std::ifstream in(folder.path() / "a.exr", std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(doubleAttribute(bytes, "timeStart"), 1.5);
    EXPECT_EQ(doubleAttribute(bytes, "timeEnd"), 2.25);
}

/// Bytes.
double peakMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * double(usage.ru_maxrss);
}

TEST(ImageIo, ManyPartsOfAnExrTakeLittleMemory) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "what is freed stays";
#endif
    const TemporaryFolder folder;
    constexpr int Parts = 400;
    Image noise(256, 64);
    Sampler random(7, RandomStream::Test, 0, 0);
    for (Rgb& pixel : noise.pixels) pixel = Rgb(random.next1D(), random.next1D(), random.next1D());
    const double before = peakMemory();
    writeExr(folder.path() / "many.exr", Parts, [&](int i) {
        return ExrPart{"frame." + std::to_string(i), noise, noise, true, double(i), double(i) + 1.0};
    });
    EXPECT_LT(peakMemory() - before, 40e6) << "131 MB in blocks of 16 lines, which are kept for each part";
    EXPECT_EQ(readExr(folder.path() / "many.exr", Parts - 1, "stderr.").pixels, noise.pixels);
}

TEST(ImageIo, PartsAreMadeOneByOneAndWrittenAsIfAllWereThere) {
    const TemporaryFolder folder;
    const auto named = [&](const char* name) { return folder.path() / name; };
    const auto bytesOf = [](const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    std::vector<Image> images;
    std::vector<ExrPart> parts;
    for (int i = 0; i < 3; ++i) {
        images.push_back(gradient(5, 3));
        images.back().at(0, 0) = Rgb(float(40 + i));
        parts.push_back({"frame." + std::to_string(i), images.back(), gradient(5, 3), true, 1.0 * i, 1.0 + i});
    }
    std::vector<int> asked;
    const auto part = [&](int i) {
        asked.push_back(i);
        return parts[size_t(i)];
    };
    writeExr(named("all.exr"), parts, "what it is");
    writeExr(named("each.exr"), 3, part, "what it is");
    EXPECT_EQ(bytesOf(named("each.exr")), bytesOf(named("all.exr")));
    EXPECT_EQ(asked, (std::vector<int>{0, 1, 2, 0, 1, 2}));
    const std::vector<Image> frames(4, images[0]);
    writeNpy(named("all.npy"), frames);
    writeNpy(named("each.npy"), 4, [&](int i) { return frames[size_t(i)]; });
    EXPECT_EQ(bytesOf(named("each.npy")), bytesOf(named("all.npy")));
}

TEST(ImageIo, NumpyReadsTheCube) {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
        GTEST_SKIP() << "python3-numpy is not installed";
    const TemporaryFolder folder;
    writeNpy(folder.path() / "cube.npy", {gradient(5, 3), gradient(5, 3), gradient(5, 3), gradient(5, 3)});
    const std::string script = "import numpy as n; a = n.load('" + (folder.path() / "cube.npy").string() +
                               "'); assert a.shape == (4, 3, 5, 3) and a.dtype == n.float32, a.shape; "
                               "assert a[2, 1, 4, 0] == 4.25 and a[3, 2, 0, 1] == 1.0";
    EXPECT_EQ(std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str()), 0);
}

TEST(ImageIo, FailedWritesKeepTheOldFile) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "image.pfm";
    writePfm(file, gradient(2, 2));
    EXPECT_THROW(writePfm(folder.path() / "missing" / "image.pfm", gradient(2, 2)), InputError);
    // An EXR that cannot be made (parts of one name twice) leaves neither a new file nor a temporary one.
    EXPECT_THROW(writeExr(file, {ExrPart{"same", gradient(2, 2), {}, false, 0, 0},
                                 ExrPart{"same", gradient(2, 2), {}, false, 0, 0}}),
                 InputError);
    EXPECT_EQ(readPfm(file).pixels, gradient(2, 2).pixels);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(ImageIo, FrameNamesSortAsFramesDo) {
    EXPECT_EQ(framePath("out/result.pfm", 7, 8), "out/result_07.pfm");
    EXPECT_EQ(framePath("out/result.pfm", 99, 100), "out/result_99.pfm");
    EXPECT_EQ(framePath("out/result.pfm", 99, 101), "out/result_099.pfm");
    EXPECT_EQ(framePath("out/result.pfm", 1000, 1001), "out/result_1000.pfm");
}

} // namespace
} // namespace tungsten
