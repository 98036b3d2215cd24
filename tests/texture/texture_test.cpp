#include "tungsten/texture/Texture.h"

#include "image_files.h"
#include "support/Folders.h"
#include "tungsten/core/Errors.h"
#include "tungsten/io/Writers.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::FileFolder;
using test::Texel;

/// 2 x 2: red, green over blue, a grey with alpha.
const std::vector<Texel> Corners{{255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 0}, {100, 150, 201, 64}};

void expectRgb(const Rgb& found, const Rgb& expected, float tolerance = 1e-6f) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
}

std::shared_ptr<Bitmap> loadCorners(const FileFolder& folder, bool interpolate) {
    auto bitmap = loadBitmap(folder.write("corners.tga", test::tga(2, 2, Corners, false)));
    bitmap->interpolate = interpolate;
    return bitmap;
}

TEST(Bitmap, GammaIsRequantisedToEightBitsByTruncation) {
    // Expected values from an independent evaluation of floor(255 (i / 255)^2.2).
    const FileFolder folder;
    std::vector<Texel> ramp;
    for (int i = 0; i < 256; ++i) ramp.push_back({uint8_t(i), uint8_t(i), uint8_t(i), 255});
    const auto bitmap = loadBitmap(folder.write("ramp.tga", test::tga(256, 1, ramp, false)));
    bitmap->interpolate = false;
    const auto level = [&](int i) { return bitmap->rgb({(float(i) + 0.5f) / 256.0f, 0.5f}).x * 255.0f; };
    for (int i = 0; i <= 20; ++i) EXPECT_EQ(level(i), 0.0f) << i;
    EXPECT_NEAR(level(21), 1.0f, 1e-4f);
    EXPECT_NEAR(level(64), 12.0f, 1e-4f);
    EXPECT_NEAR(level(128), 55.0f, 1e-4f);
    EXPECT_NEAR(level(200), 149.0f, 1e-4f);
    EXPECT_NEAR(level(254), 252.0f, 1e-4f);
    EXPECT_NEAR(level(255), 255.0f, 1e-4f);
    // Scalars are never gamma-corrected; nor are colours when that is switched off.
    EXPECT_FLOAT_EQ(bitmap->scalar({128.5f / 256.0f, 0.5f}), 128.0f / 255.0f);
    bitmap->gammaCorrect = false;
    EXPECT_FLOAT_EQ(bitmap->rgb({128.5f / 256.0f, 0.5f}).y, 128.0f / 255.0f);
}

TEST(Bitmap, VOneIsTheTopAndUZeroTheLeft) {
    const FileFolder folder;
    const auto bitmap = loadCorners(folder, false);
    expectRgb(bitmap->rgb({0.25f, 0.75f}), {1, 0, 0});
    expectRgb(bitmap->rgb({0.75f, 0.75f}), {0, 1, 0});
    expectRgb(bitmap->rgb({0.25f, 0.25f}), {0, 0, 1});
}

TEST(Bitmap, ScalarIsTheIntegerMean) {
    const FileFolder folder;
    const auto bitmap = loadCorners(folder, false);
    EXPECT_FLOAT_EQ(bitmap->scalar({0.75f, 0.25f}), 150.0f / 255.0f); // (100 + 150 + 201) / 3 = 150.33
}

TEST(Bitmap, BilinearWithCentresAtHalfIntegers) {
    const FileFolder folder;
    const auto bitmap = loadCorners(folder, true);
    expectRgb(bitmap->rgb({0.25f, 0.75f}), {1, 0, 0}); // a centre
    expectRgb(bitmap->rgb({0.5f, 0.75f}), {0.5f, 0.5f, 0});
    expectRgb(bitmap->rgb({0.25f, 0.5f}), {0.5f, 0, 0.5f});
    expectRgb(bitmap->rgb({0.375f, 0.75f}), {0.75f, 0.25f, 0});
}

TEST(Bitmap, RepeatsOrClampsAtItsEdges) {
    const FileFolder folder;
    const auto bitmap = loadCorners(folder, true);
    expectRgb(bitmap->rgb({0.0f, 0.75f}), {0.5f, 0.5f, 0}); // half of the texel across the edge
    expectRgb(bitmap->rgb({1.25f, -0.25f}), {1, 0, 0});
    expectRgb(bitmap->rgb({-999.75f, 1000.75f}), {1, 0, 0}, 1e-3f);
    bitmap->clamp = true;
    expectRgb(bitmap->rgb({0.0f, 0.75f}), {1, 0, 0});
    expectRgb(bitmap->rgb({-5.0f, 7.0f}), {1, 0, 0});
    expectRgb(bitmap->rgb({5.0f, 7.0f}), {0, 1, 0});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float absurd : {nan, Infinity, -Infinity, 1e30f})
        for (const bool clamped : {false, true}) {
            bitmap->clamp = clamped;
            EXPECT_TRUE(isFinite(bitmap->rgb({absurd, absurd})));
        }
}

TEST(Bitmap, ScaleActsOnlyWithInterpolation) {
    const FileFolder folder;
    const auto bitmap = loadCorners(folder, true);
    bitmap->scale = 3.0f;
    expectRgb(bitmap->rgb({0.25f, 0.75f}), {3, 0, 0});
    expectRgb(bitmap->maximum(), {3, 3, 3});
    bitmap->interpolate = false;
    expectRgb(bitmap->rgb({0.25f, 0.75f}), {1, 0, 0});
    expectRgb(bitmap->maximum(), {1, 1, 1});
}

TEST(Bitmap, AutoAlphaFollowsTheReportedChannels) {
    const FileFolder folder;
    const Vec2f greenTexel(0.75f, 0.75f);
    const auto read = [&](const std::string& name, const std::string& bytes) {
        auto bitmap = loadBitmap(folder.write(name, bytes));
        bitmap->interpolate = false;
        return bitmap->alpha(greenTexel);
    };
    EXPECT_FLOAT_EQ(read("a.tga", test::tga(2, 2, Corners, true)), 128.0f / 255.0f);
    EXPECT_FLOAT_EQ(read("b.tga", test::tga(2, 2, Corners, false)), 85.0f / 255.0f); // no alpha: the mean
    EXPECT_FLOAT_EQ(read("a.png", test::png(2, 2, Corners, 4)), 128.0f / 255.0f);
    EXPECT_FLOAT_EQ(read("b.png", test::png(2, 2, Corners, 3)), 1.0f); // PNG always reports four
}

TEST(Bitmap, EveryFormatShowsTheSameTexels) {
    const FileFolder folder;
    const std::vector<float> values{1, 0, 0, 0, 1, 0, 0, 0, 1, 0.25f, 0.5f, 2.0f};
    Image image(2, 2);
    image.pixels = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25f, 0.5f, 2.0f}};
    writeExr(folder.path("a.exr"), {{"", image, {}, false, 0, 0}});
    // Mantissas over 256 times 2^(e - 128): (128, 0, 0) with e = 129 is 1.
    const std::vector<Texel> rgbe{{128, 0, 0, 129}, {0, 128, 0, 129}, {0, 0, 128, 129}, {16, 32, 128, 130}};
    for (const auto& file : {folder.write("a.pfm", test::pfm(2, 2, values)), folder.path("a.exr"),
                             folder.write("a.hdr", test::radiance(2, 2, rgbe))}) {
        const auto bitmap = loadBitmap(file);
        EXPECT_TRUE(bitmap->ldr.empty()) << file;
        expectRgb(bitmap->rgb({0.25f, 0.75f}), {1, 0, 0});
        expectRgb(bitmap->rgb({0.75f, 0.75f}), {0, 1, 0});
        expectRgb(bitmap->rgb({0.25f, 0.25f}), {0, 0, 1});
        expectRgb(bitmap->rgb({0.75f, 0.25f}), {0.25f, 0.5f, 2.0f}, 1e-3f);
        EXPECT_NEAR(bitmap->scalar({0.75f, 0.25f}), 2.75f / 3.0f, 1e-3f);
    }
}

TEST(Bitmap, RunLengthTga) {
    const FileFolder folder;
    const auto bitmap = loadBitmap(folder.write("rle.tga", test::tgaRle(7, {{255, 0, 0, 255}, {0, 0, 255, 255}})));
    EXPECT_EQ(bitmap->width, 7);
    EXPECT_EQ(bitmap->height, 2);
    expectRgb(bitmap->rgb({0.5f, 0.75f}), {1, 0, 0});
    expectRgb(bitmap->rgb({0.5f, 0.25f}), {0, 0, 1});
    const auto single = loadBitmap(folder.write("one.tga", test::tgaRle(1, {{255, 255, 0, 255}})));
    expectRgb(single->rgb({0.3f, 0.9f}), {1, 1, 0});
}

TEST(Bitmap, NonFiniteFloatsAreReplaced) {
    const FileFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto bitmap = loadBitmap(folder.write("a.pfm", test::pfm(1, 1, {nan, Infinity, -Infinity})));
    expectRgb(bitmap->rgb({0.5f, 0.5f}), {0.0f, 65504.0f, -65504.0f});
}

TEST(Bitmap, AverageIsTheMeanOfTheTexels) {
    const FileFolder folder;
    const auto bitmap = loadBitmap(folder.write("a.pfm", test::pfm(2, 1, {1, 2, 3, 3, 2, 1})));
    expectRgb(bitmap->average(), {2, 2, 2});
}

/// Runs hold 64 texels a byte: what claims more is refused before it is decoded.
TEST(Bitmap, SizesAreThoseThatRunsCanHold) {
    const FileFolder folder;
    std::string full = test::tgaRle(128, std::vector<test::Texel>(200, test::Texel{9, 9, 9, 255}));
    EXPECT_EQ(loadBitmap(folder.write("full.tga", full))->width, 128);
    full[12] = full[14] = 0;
    full[13] = full[15] = 4; // 1024 x 1024 texels of 818 bytes
    try {
        loadBitmap(folder.write("claims.tga", full));
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_TRUE(error.problems().front().message.starts_with("claims to be 1024x1024"))
            << error.problems().front().message;
    }
}

TEST(Bitmap, BadFilesAreInputErrorsThatNameThem) {
    const FileFolder folder;
    std::string absurd = test::tga(2, 2, Corners, false);
    absurd[12] = absurd[13] = absurd[14] = absurd[15] = char(0xff);
    const std::string good = test::tga(2, 2, Corners, false);
    const std::string goodPng = test::png(2, 2, Corners, 4);
    std::string greedyPng = goodPng;
    greedyPng[33] = 0x3f; // the length of the IDAT chunk
    // A Huffman table of 16 x 16 + 1 codes, once behind a filling byte.
    const std::string table =
        std::string("\xff\xc4\x01\x14\x00", 5) + '\x11' + std::string(15, '\x10') + std::string(257, 'c');
    const std::vector<std::filesystem::path> files{
        folder.write("greedy.png", greedyPng),
        folder.write("tables.jpg", "\xff\xd8" + table),
        folder.write("filled.jpg", "\xff\xff\xd8" + table),
        folder.path("missing.png"),
        folder.path(""),
        folder.write("empty.png", ""),
        folder.write("text.png", "this is no image at all, it only says so in its name, and it says it at some length"),
        folder.write("absurd.tga", absurd),
        folder.write("short.tga", good.substr(0, good.size() - 1)),
        folder.write("short.png", goodPng.substr(0, goodPng.size() - 20)),
        folder.write("short.pfm", "PF\n4 4\n-1\n0000"),
        folder.write("absurd.pfm", "PF\n1000000 1000000\n-1\n0000"),
        folder.write("short.exr", "\x76\x2f\x31\x01\x02")};
    for (const auto& file : files) {
        try {
            loadBitmap(file);
            ADD_FAILURE() << file << " was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(error.problems().front().file, file.string());
        }
    }
}

TEST(Bitmap, GitLfsPointerBecomesTheFormatsPlaceholder) {
    const FileFolder folder;
    const auto bitmap =
        loadBitmap(folder.write("a.tga", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12\n"));
    EXPECT_TRUE(bitmap->placeholder);
    EXPECT_TRUE(bitmap->interpolate); // yet it is not
    expectRgb(bitmap->rgb({0.3f, 0.7f}), {0, 0, 0});
    expectRgb(bitmap->rgb({0.7f, 0.7f}), {1, 1, 1});
    expectRgb(bitmap->rgb({0.51f, 0.49f}), {0, 0, 0});
}

TEST(Bitmap, SharedSceneTexturesLoad) {
    const std::filesystem::path scenes = test::sharedFolder() / "scenes";
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "the shared scenes are not here";
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes)) {
        if (entry.path().extension() != ".tga") continue;
        const auto bitmap = loadBitmap(entry.path());
        EXPECT_GT(bitmap->width, 0) << entry.path();
        EXPECT_EQ(bitmap->ldr.size(), size_t(bitmap->width) * size_t(bitmap->height) * 4) << entry.path();
        EXPECT_EQ(bitmap->ldr.size(), bitmap->ldr.capacity()) << entry.path();
        ++count;
    }
    EXPECT_EQ(count, 15);
}

TEST(Texture, CheckerIsOnWhereTheCellSumIsOdd) {
    CheckerTexture model;
    model.onColor = Rgb(1.0f);
    model.offColor = Rgb(0.0f);
    model.resU = 4;
    model.resV = 2;
    const Texture checker(model);
    EXPECT_EQ(checker.rgb({0.1f, 0.1f}).x, 0.0f);
    EXPECT_EQ(checker.rgb({0.3f, 0.1f}).x, 1.0f);
    EXPECT_EQ(checker.rgb({0.1f, 0.6f}).x, 1.0f);
    EXPECT_EQ(checker.rgb({0.3f, 0.6f}).x, 0.0f);
    EXPECT_EQ(checker.rgb({-0.1f, 0.1f}).x, 1.0f); // cell -1
    EXPECT_EQ(checker.rgb({-0.1f, -0.1f}).x, 0.0f);
    EXPECT_TRUE(isFinite(checker.rgb({1e30f, -1e30f})));
    EXPECT_FLOAT_EQ(checker.average().x, 0.5f);
    EXPECT_FLOAT_EQ(checker.scaled(Rgb(2.0f)).maximum().x, 2.0f);
    model.resU = model.resV = 3; // 4 of 9 cells are on
    EXPECT_FLOAT_EQ(Texture(model).average().x, 4.0f / 9.0f);
}

TEST(Texture, ConstantsAndScaling) {
    const Texture constant(Rgb(0.2f, 0.4f, 0.9f));
    EXPECT_TRUE(constant.isConstant());
    EXPECT_FLOAT_EQ(constant.scalar({0, 0}), 0.5f);
    expectRgb(constant.scaled({2, 1, 0}).rgb({0, 0}), {0.4f, 0.4f, 0});
    expectRgb(constant.scaled({2, 1, 0}).scaled({0.5f, 3, 7}).rgb({0, 0}), {0.2f, 1.2f, 0});
    const FileFolder folder;
    const Texture bitmap(std::shared_ptr<const Bitmap>(loadCorners(folder, true)));
    expectRgb(bitmap.scaled({2, 3, 4}).rgb({0.25f, 0.25f}), {0, 0, 4});
    EXPECT_FALSE(bitmap.scaled(Rgb(2.0f)).isConstant());
}

TEST(Texture, BumpDerivativesAreCentralTexelDifferences) {
    // A height linear in the texels: 10 levels a column, 20 a row (downward); differences span two texels.
    const FileFolder folder;
    std::vector<Texel> texels;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const auto h = uint8_t(10 * x + 20 * y);
            texels.push_back({h, h, h, 255});
        }
    const Texture bump(
        std::shared_ptr<const Bitmap>(loadBitmap(folder.write("bump.tga", test::tga(4, 4, texels, false)))));
    const Vec2f slope = bump.derivatives({0.5f, 0.5f});
    EXPECT_NEAR(slope.x, 20.0f / 255.0f, 1e-6f);
    EXPECT_NEAR(slope.y, -40.0f / 255.0f, 1e-6f); // v grows upward
    EXPECT_EQ(Texture(0.5f).derivatives({0.5f, 0.5f}), Vec2f(0.0f));
    EXPECT_EQ(Texture(CheckerTexture{}).derivatives({0.5f, 0.5f}), Vec2f(0.0f));
}

} // namespace
} // namespace tungsten
