// What people look at: exposure, contact sheets, videos.

#include "support/SceneFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/Exposure.h"
#include "tungsten/io/ContactSheet.h"
#include "tungsten/io/Video.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tungsten {
namespace {

/// One row of values from 1/100 to 1 times `scale`, and as many black pixels.
Image ramp(float scale) {
    Image image(100, 2);
    for (int x = 0; x < 100; ++x) image.at(x, 0) = Rgb(0.5f, 1.0f, 0.1f) * (scale * float(x + 1) / 100.0f);
    return image;
}

TEST(Exposure, BringsThePercentileOfWhatIsLitToWhite) {
    for (const float scale : {1e-30f, 1e-6f, 1.0f, 1e20f}) {
        AutomaticExposure exposure;
        exposure.include(ramp(scale));
        EXPECT_NEAR(exposure.factor() * scale * 0.99f, AutomaticExposure::White, 0.02) << scale;
    }
}

TEST(Exposure, IsOneForAllFramesAndLeavesOutWhatIsNoNumber) {
    AutomaticExposure both, dark, none;
    dark.include(ramp(0.01f));
    both.include(ramp(0.01f));
    both.include(ramp(1.0f));
    EXPECT_GT(dark.factor(), 50.0f * both.factor());
    Image strange(2, 1);
    strange.at(0, 0) = Rgb(std::numeric_limits<float>::infinity());
    strange.at(1, 0) = Rgb(std::numeric_limits<float>::quiet_NaN());
    none.include(strange);
    EXPECT_EQ(none.factor(), 1.0f);
}

TEST(Exposure, IsReadAsStopsOrAuto) {
    EXPECT_TRUE(ExposureChoice::read("auto")->automatic);
    EXPECT_EQ(ExposureChoice::read("-2.5")->stops, -2.5);
    EXPECT_EQ(ExposureChoice::read("+3")->stops, 3.0);
    for (const char* bad : {"", "bright", "nan", "inf", "1e9", "3 stops", "++3"})
        EXPECT_FALSE(ExposureChoice::read(bad).has_value()) << bad;
    EXPECT_EQ(exposureFactor(-2.0), 0.25f);
}

TEST(ContactSheet, ShowsFramesInReadingOrder) {
    const auto grey = [](int frame) {
        Image image(4, 3);
        std::fill(image.pixels.begin(), image.pixels.end(), Rgb(float(frame)));
        return image;
    };
    const Image sheet = contactSheet(sheetFrames(5), grey);
    ASSERT_EQ(sheet.width, 3 * 4 + 2 * 2);
    ASSERT_EQ(sheet.height, 2 * 3 + 2);
    EXPECT_EQ(sheet.at(0, 0).x, 0.0f);
    EXPECT_EQ(sheet.at(15, 2).x, 2.0f);
    EXPECT_EQ(sheet.at(6, 7).x, 4.0f);
    EXPECT_EQ(sheet.at(15, 7).x, sheet.at(4, 0).x) << "no frame: as the lines between";
}

TEST(ContactSheet, ShrinksToMeansAndChoosesEvenly) {
    const std::vector<int> frames = sheetFrames(1000);
    EXPECT_EQ(frames.size(), 64u);
    EXPECT_EQ(frames.front(), 0);
    EXPECT_EQ(frames.back(), 999);
    const auto stripes = [](int) {
        Image image(1024, 2);
        for (int x = 0; x < 1024; ++x) image.at(x, 0) = image.at(x, 1) = Rgb(x % 2 == 0 ? 1.0f : 3.0f);
        return image;
    };
    const Image sheet = contactSheet(frames, stripes);
    EXPECT_LE(sheet.width, 2016);
    EXPECT_NEAR(sheet.at(0, 0).x, 2.0f, 0.21f);
}

bool hasFfmpeg() {
    try {
        requireFfmpeg("x.mp4");
        return true;
    } catch (const InputError&) {
        return false;
    }
}

std::string contentOf(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

std::vector<uint8_t> frameOf(int frame) {
    return std::vector<uint8_t>(size_t(9 * 7 * 3), uint8_t(25 * frame));
}

TEST(Video, IsMadeByFfmpeg) {
    if (!hasFfmpeg()) GTEST_SKIP() << "no ffmpeg";
    const test::TemporaryFolder folder;
    for (const char* name : {"film.gif", "film 'of mine' $(false).mp4"}) {
        const auto file = folder.path() / name;
        writeVideo(file, {9, 7}, 10, frameOf);
        const std::string bytes = contentOf(file);
        EXPECT_NE(bytes.substr(0, 16).find(file.extension() == ".gif" ? "GIF89a" : "ftyp"), std::string::npos);
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

/// With a stand-in for ffmpeg that fails, or none.
TEST(Video, FailuresLeaveTheEarlierFile) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "film.mp4";
    std::ofstream(file) << "earlier";
    const std::string path = std::getenv("PATH");
    const auto said = [&] {
        try {
            writeVideo(file, {9, 7}, 1000, frameOf);
            return std::string();
        } catch (const InputError& error) {
            return std::string(error.what());
        }
    };
    ::setenv("PATH", folder.path().c_str(), 1);
    const std::string missing = said();
    std::ofstream(folder.path() / "ffmpeg") << "#!/bin/sh\necho no such encoder >&2\nexit 1\n";
    std::filesystem::permissions(folder.path() / "ffmpeg", std::filesystem::perms::owner_all);
    const std::string failed = said();
    // It takes all frames, and fails in the end.
    std::ofstream(folder.path() / "ffmpeg") << "#!/bin/sh\n/bin/cat >/dev/null\necho no space >&2\nexit 1\n";
    const std::string failedLate = said();
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_NE(missing.find("film.mp4: cannot be written: that takes the program ffmpeg"), std::string::npos) << missing;
    EXPECT_NE(failed.find("ffmpeg failed: no such encoder"), std::string::npos) << failed;
    EXPECT_NE(failedLate.find("ffmpeg failed: no space"), std::string::npos) << failedLate;
    EXPECT_EQ(contentOf(file), "earlier");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

} // namespace
} // namespace tungsten
