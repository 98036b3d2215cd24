// The same seed gives the same image: on any number of threads, and however often a render is stopped and resumed.

#include "app/command.h"
#include "tungsten/image/ReadImage.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::foggyBox;
using test::SceneFile;

/// Renders and returns the linear image's file.
fs::path render(const SceneFile& scene, const std::string& name, std::vector<std::string> options) {
    const fs::path file = scene.path().parent_path() / name;
    for (const std::string& fixed : {std::string("--quiet"), std::string("-e"), file.string(), scene.path().string()})
        options.push_back(fixed);
    const test::CommandResult result = test::tungsten(options);
    EXPECT_EQ(result.exitCode, 0) << result.all();
    return file;
}

/// Largest difference of a pixel, relative to the mean.
double relativeDifference(const Image& a, const Image& b) {
    double largest = 0.0, mean = 0.0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            largest = std::max(largest, std::abs(double(a.pixels[i][c]) - double(b.pixels[i][c])));
            mean += double(a.pixels[i][c]) / double(3 * a.pixels.size());
        }
    return largest / mean;
}

TEST(Determinism, PathTracingDoesNotDependOnTheThreads) {
    for (const char* const integrator : {test::Paths, test::PathFrames}) {
        const SceneFile scene(foggyBox(integrator));
        const std::string one = test::contentOf(render(scene, "one.npy", {"-t", "1"}));
        EXPECT_EQ(one, test::contentOf(render(scene, "two.npy", {"-t", "2"})));
        EXPECT_EQ(one, test::contentOf(render(scene, "five.npy", {"-t", "5"})));
        EXPECT_NE(one, test::contentOf(render(scene, "other.npy", {"-s", "7"})));
    }
}

TEST(Determinism, PhotonMapsAgreeAcrossThreadsToRounding) {
    const SceneFile scene(foggyBox(test::Photons));
    const Image one = readPfm(render(scene, "one.pfm", {"-t", "1"}));
    const Image two = readPfm(render(scene, "two.pfm", {"-t", "2"}));
    EXPECT_LE(relativeDifference(one, two), 1e-6);
    EXPECT_GT(relativeDifference(one, readPfm(render(scene, "other.pfm", {"-s", "7"}))), 1e-3);
}

TEST(Determinism, SeedsMayBeHexadecimal) {
    const SceneFile scene(foggyBox(test::Paths));
    EXPECT_EQ(test::contentOf(render(scene, "hex.pfm", {"-s", "0xBEEF"})),
              test::contentOf(render(scene, "decimal.pfm", {"--seed=48879"})));
}

/// Every run adds one pass; the fourth completes the eight samples.
void expectResumedEqualsWhole(const char* integrator) {
    const SceneFile whole(foggyBox(integrator)), pieces(foggyBox(integrator));
    const std::string expected = test::contentOf(render(whole, "image.npy", {}));
    fs::path file;
    for (int run = 0; run < 4; ++run) {
        EXPECT_TRUE(run == 0 || test::contentOf(file) != expected);
        file = render(pieces, "image.npy", {"-c", "1h", "--spp", std::to_string(2 * run + 2)});
    }
    EXPECT_EQ(test::contentOf(file), expected);
}

TEST(Determinism, AResumedPathTracingEqualsAnUninterruptedOne) {
    expectResumedEqualsWhole(test::Paths);
    expectResumedEqualsWhole(test::PathFrames);
}

TEST(Determinism, AResumedPhotonMapUsesTheSamePhotons) {
    const SceneFile whole(foggyBox(test::Photons)), pieces(foggyBox(test::Photons));
    const Image expected = readPfm(render(whole, "image.pfm", {}));
    fs::path file;
    for (int run = 0; run < 4; ++run)
        file = render(pieces, "image.pfm", {"-c", "1h", "--spp", std::to_string(2 * run + 2)});
    EXPECT_LE(relativeDifference(readPfm(file), expected), 1e-6);
}

TEST(Determinism, AStateOfAnotherSceneIsRefusedUnlessRestarted) {
    const SceneFile scene(foggyBox(test::Paths));
    const std::string file = scene.path().string();
    ASSERT_EQ(test::tungsten({"-c", "1h", "--spp", "2", file}).exitCode, 0);
    const test::CommandResult refused = test::tungsten({"-c", "1h", "--set", "camera.fov=40", file});
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_NE(refused.err.find("another scene"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("-r starts over"), std::string::npos) << refused.err;
    EXPECT_EQ(test::tungsten({"-c", "1h", "-r", "--set", "camera.fov=40", file}).exitCode, 0);
}

} // namespace
} // namespace tungsten
