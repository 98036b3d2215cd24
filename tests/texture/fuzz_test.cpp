// Damaged image files: each loads or is an InputError; nothing crashes, hangs or allocates absurd sizes.

#include "image_files.h"
#include "support/Fuzz.h"
#include "support/LargestAllocation.h"
#include "tungsten/io/Writers.h"
#include "tungsten/texture/Texture.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <iterator>

namespace tungsten {
namespace {

using test::FileFolder;
using test::Texel;

long peakKilobytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

void useBitmap(const std::shared_ptr<Bitmap>& bitmap) {
    const Texture texture{std::shared_ptr<const Bitmap>(bitmap)};
    for (const Vec2f& uv : {Vec2f(0.1f, 0.9f), Vec2f(1.0f, 1.0f), Vec2f(0.0f, 0.0f)}) {
        EXPECT_TRUE(isFinite(texture.rgb(uv)));
        EXPECT_TRUE(std::isfinite(texture.alpha(uv) + texture.scalar(uv) + texture.derivatives(uv).length()));
    }
}

void appendBytes(void* out, void* bytes, int size) {
    static_cast<std::string*>(out)->append(static_cast<const char*>(bytes), size_t(size));
}

std::string jpeg(int width, int height, const std::vector<Texel>& texels) {
    std::string out;
    stbi_write_jpg_to_func(appendBytes, &out, width, height, 4, texels.data(), 80);
    return out;
}

std::string bmp(int width, int height, const std::vector<Texel>& texels) {
    std::string out;
    stbi_write_bmp_to_func(appendBytes, &out, width, height, 4, texels.data());
    return out;
}

/// 10 x 10, four colours: the palette, an extension block and one LZW-coded frame.
std::string gif() {
    const unsigned char bytes[] = {0x47, 0x49, 0x46, 0x38, 0x39, 0x61, 0x0A, 0x00, 0x0A, 0x00, 0x91, 0x00, 0x00, 0xFF,
                                   0xFF, 0xFF, 0xFF, 0x00, 0x00, 0x00, 0x00, 0xFF, 0x00, 0x00, 0x00, 0x21, 0xF9, 0x04,
                                   0x00, 0x00, 0x00, 0x00, 0x00, 0x2C, 0x00, 0x00, 0x00, 0x00, 0x0A, 0x00, 0x0A, 0x00,
                                   0x00, 0x02, 0x16, 0x8C, 0x2D, 0x99, 0x87, 0x2A, 0x1C, 0xDC, 0x33, 0xA0, 0x02, 0x75,
                                   0xEC, 0x95, 0xFA, 0xA8, 0xDE, 0x60, 0x8C, 0x04, 0x91, 0x4C, 0x01, 0x00, 0x3B};
    return {reinterpret_cast<const char*>(bytes), sizeof(bytes)};
}

int fuzz(const FileFolder& folder, const std::string& name, const std::string& original) {
    return test::fuzz(folder, name, original, [](const auto& file) { useBitmap(loadBitmap(file)); });
}

TEST(ImageFuzz, DamagedFilesLoadOrAreInputErrors) {
    const FileFolder folder;
    std::vector<Texel> texels;
    std::vector<float> values;
    Image image(16, 8);
    for (int i = 0; i < 128; ++i) {
        texels.push_back({uint8_t(2 * i), uint8_t(255 - i), uint8_t(i * i), uint8_t(128 + i / 8)});
        image.pixels[size_t(i)] = Rgb(float(i), 0.5f, 1.0f / float(i + 1));
        for (int c = 0; c < 3; ++c) values.push_back(image.pixels[size_t(i)][c]);
    }
    writeExr(folder.path("sample.exr"), {{"", image, {}, false, 0, 0}});
    std::ifstream in(folder.path("sample.exr"), std::ios::binary);
    const std::string exr((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    test::largestAllocation = 0;
    int accepted = 0;
    accepted += fuzz(folder, "a.png", test::png(16, 8, texels, 4));
    accepted += fuzz(folder, "b.png", test::png(16, 8, texels, 3));
    accepted += fuzz(folder, "a.tga", test::tga(16, 8, texels, true));
    accepted += fuzz(folder, "rle.tga", test::tgaRle(16, {texels.begin(), texels.begin() + 8}));
    accepted += fuzz(folder, "a.pfm", test::pfm(16, 8, values));
    accepted += fuzz(folder, "a.hdr", test::radiance(16, 8, texels));
    accepted += fuzz(folder, "rle.hdr", test::radianceRuns(16, {texels[5], texels[9]}));
    accepted += fuzz(folder, "a.exr", exr);
    accepted += fuzz(folder, "a.jpg", jpeg(16, 8, texels));
    accepted += fuzz(folder, "a.bmp", bmp(16, 8, texels));
    accepted += fuzz(folder, "a.gif", gif());
    EXPECT_GT(accepted, 50);
    EXPECT_LT(accepted, int(11 * test::MutationsPerFile) - 500);
    EXPECT_LT(test::largestAllocation, size_t(1) << 28); // bytes
#ifndef __SANITIZE_ADDRESS__
    EXPECT_LT(peakKilobytes(), 1L << 20);
#endif
}

/// stb never got to the end of them.
TEST(ImageFuzz, RunsOfRadianceFilesEndWithTheFileAndHaveALength) {
    const FileFolder folder;
    const std::string whole = test::radianceRuns(16, {{128, 64, 32, 129}, {128, 64, 32, 130}});
    const auto bitmap = loadBitmap(folder.write("a.hdr", whole));
    ASSERT_EQ(bitmap->hdr.size(), 96u);
    for (size_t i = 0; i < 96; ++i)
        EXPECT_EQ(bitmap->hdr[i], (i < 48 ? 1.0f : 2.0f) * (i % 3 == 0 ? 1.0f : i % 3 == 1 ? 0.5f : 0.25f)) << i;
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW(loadBitmap(folder.write("a.hdr", whole.substr(0, size))), InputError) << size;
    std::string none = whole;
    none[whole.size() - 4] = '\0'; // the last run, of 3 texels
    EXPECT_THROW(loadBitmap(folder.write("a.hdr", none)), InputError);
}

/// OpenEXR sizes its buffers by the sampling of channels: a bit too many was 2 GB.
TEST(ImageFuzz, AbsurdSamplingOfAChannelIsRefused) {
    const FileFolder folder;
    writeExr(folder.path("a.exr"), {{"", Image(4, 3), {}, false, 0, 0}});
    std::ifstream in(folder.path("a.exr"), std::ios::binary);
    std::string exr((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::string name("\0G\0", 3); // after the channel before it
    exr[exr.find(name) + name.size() + 8 + 3] = '\xf6';
    test::largestAllocation = 0;
    try {
        loadBitmap(folder.write("b.exr", exr));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("'G' has a sample every"), std::string::npos) << error.what();
    }
    EXPECT_LT(test::largestAllocation, size_t(1) << 22);
}

} // namespace
} // namespace tungsten
