// The `tungsten` command from outside: exit codes, messages, files.

#include "app/command.h"
#include "support/Folders.h"
#include "tungsten/image/ReadImage.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::BadInput;
using test::BadUsage;
using test::Command;
using test::CommandResult;
using test::contentOf;
using test::foggyBox;
using test::Interrupted;
using test::SceneFile;

struct Mistake {
    std::vector<std::string> arguments;
    std::vector<std::string> expected; ///< parts of the message
};

/// One line starting with "error:" that has every expected part.
void expectMistake(const Mistake& mistake, int exitCode) {
    const CommandResult result = test::tungsten(mistake.arguments);
    EXPECT_EQ(result.exitCode, exitCode) << result.all();
    EXPECT_EQ(result.err.rfind("error: ", 0), 0u) << result.err;
    for (const std::string& part : mistake.expected)
        EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
}

TEST(Command, BadUsageIsExitCodeTwo) {
    const SceneFile scene(foggyBox(test::Paths));
    const std::string file = scene.path().string();
    const std::vector<Mistake> mistakes{
        {{}, {"no scene file", "--help"}},
        {{"--sppp", "4", file}, {"--sppp", "did you mean --spp?"}},
        {{"--treads=2", file}, {"did you mean --threads?"}},
        {{"-x", file}, {"-x"}},
        {{"--spp", "many", file}, {"--spp", "many"}},
        {{"--spp", "0", file}, {"--spp"}},
        {{"--spp", "1", "--spp", "2", file}, {"--spp"}},
        {{"-t", "0", file}, {"--threads"}},
        {{"-s", "-1", file}, {"--seed", "0x"}},
        {{"-s", "0xZZ", file}, {"--seed"}},
        {{"--resolution", "12", file}, {"--resolution", "320x240"}},
        {{"--resolution", "0x4", file}, {"--resolution"}},
        {{"--resolution", "4294967297x8", file}, {"--resolution"}},
        {{"--timeout", "soon", file}, {"--timeout", "minutes"}},
        {{"-c", "often", file}, {"--checkpoint"}},
        {{"--target-error", "-1", file}, {"--target-error"}},
        {{"--target-error", "nan", file}, {"--target-error", "1e-6 to 1e6"}},
        {{"--timeout", "0", file}, {"--timeout 0: expected a duration above 0"}},
        {{"--timeout", "-1", file}, {"--timeout -1: expected a duration above 0"}},
        {{"--timeout", "1h -90m", file}, {"--timeout"}},
        {{"--timeout", "nan", file}, {"--timeout"}},
        {{"--timeout", "1e-999", file}, {"--timeout"}},
        {{"--timeout", "", file}, {"--timeout: is empty"}},
        {{"--timeout=", file}, {"--timeout"}},
        {{"-c", "0", file}, {"--checkpoint 0: expected a duration above 0"}},
        {{"-c", "-1s", file}, {"--checkpoint"}},
        {{"-c", "", file}, {"--checkpoint: is empty"}},
        {{"--spp", "-1", file}, {"--spp"}},
        {{"--spp", "", file}, {"--spp"}},
        {{"--target-error", "0", file}, {"--target-error"}},
        {{"--target-error", "inf", file}, {"--target-error"}},
        {{"--target-error", "", file}, {"--target-error"}},
        {{"--memory-limit", "0", file}, {"--memory-limit"}},
        {{"--memory-limit", "-1G", file}, {"--memory-limit"}},
        {{"--memory-limit", "nan", file}, {"--memory-limit"}},
        {{"--memory-limit", "", file}, {"--memory-limit: is empty"}},
        {{"--seed", "", file}, {"--seed: is empty"}},
        {{"--passes", "", file}, {"--passes: is empty"}},
        {{"--resolution", "", file}, {"--resolution: is empty"}},
        {{"--exposure", "", file}, {"--exposure: is empty"}},
        {{"--exposure", "nan", file}, {"--exposure"}},
        {{"--time-center", "", file}, {"--time-center"}},
        {{"--stats", "", file}, {"--stats: is empty"}},
        {{"-d", "", file}, {"--output-directory: is empty"}},
        {{"--trace", "", file}, {"--trace: is empty"}},
        {{"merge", "a.state", "-e", ""}, {"--hdr-output-file: is empty"}},
        {{""}, {"scenes: is empty"}},
        {{"--quiet", "merge", "a.state", "-e", "a.exr"}, {"merge: comes first"}},
        {{"--time-center", "noon", file}, {"--time-center"}},
        {{"--set", "camera", file}, {"path.to.field=value"}},
        {{"--set", "primitives.7.bsdf=3", file}, {"3 elements"}},
        {{"--set", "media.fgo.sigma_s=3", file}, {"did you mean 'fog'?"}},
        {{"--spp"}, {"--spp"}},
        {{"--html", "page.html", file, file}, {"--html", "one scene"}},
    };
    for (const Mistake& mistake : mistakes) expectMistake(mistake, BadUsage);
}

/// Mistakes of every block, with the integrator's own, and fields that nobody reads, at once.
TEST(Command, EverythingWrongIsToldAtOnce) {
    const SceneFile scene(foggyBox(test::Paths));
    const std::string file = scene.path().string();
    const CommandResult result = test::tungsten(
        {"--set", "camera.resolutoin=8", "--set", "camera.fov=900", "--set", "integrator.max_bounces=\"x\"", "--set",
         "integrator.enable_light_sampling=3", "--set", "integrator.max_bounce=3", file});
    EXPECT_EQ(result.exitCode, BadInput);
    for (const char* part :
         {"warning: ", "camera.resolutoin: unknown field, ignored; did you mean 'resolution'?", "error: ", "camera.fov",
          "integrator.max_bounces: expected", "integrator.enable_light_sampling: expected true or false",
          "integrator.max_bounce: unknown field"}) {
        const size_t at = result.err.find(part);
        EXPECT_NE(at, std::string::npos) << part << " is not in: " << result.err;
        const bool again = result.err.find(part, at + 1) != std::string::npos;
        EXPECT_EQ(again, std::string(part).ends_with(": ")) << part << result.err;
    }
    expectMistake({{"--set", "camera.fov=900", "--set", "integrator.type=bidirectional_path_tracer", "--set",
                    "media.fog.type=voxel", file},
                   {"camera.fov", "media[0].type: 'voxel' is not supported: media are homogeneous",
                    "integrator.type: 'bidirectional_path_tracer' is not supported: use path_tracer"}},
                  BadInput);
}

TEST(Command, BadInputIsExitCodeOne) {
    const SceneFile scene(foggyBox(test::Paths));
    const std::string file = scene.path().string();
    const std::vector<Mistake> mistakes{
        {{"/nowhere/scene.json"}, {"/nowhere/scene.json", "no such file"}},
        {{"--set", "integrator.type=path_trace", file},
         {file, "integrator.type", "did you mean 'path_tracer'?", "progressive_photon_map",
          test::binaryFolder().string()}},
        {{"--set", "integrator.max_bounces=\"x\"", file}, {file, "integrator.max_bounces"}},
        {{"--set", "primitives.block.bsdf=gray", file}, {file, "primitives[1].bsdf", "grey"}},
        {{"--set", "camera.type=pinhol", file}, {"camera.type", "pinhole"}},
        {{"-o", "x.jpg", file}, {"x.jpg", "accepted: .png"}},
        {{"-e", "x.tiff", file}, {"x.tiff", ".exr, .npz, .h5, .pfm or .npy"}},
        {{"--html", "x.htlm", file}, {"x.htlm", "accepted: .html or .htm"}},
        {{"--html", file + "/x.html", file}, {"x.html", "cannot be created or written to"}},
        {{"-d", file, file}, {"cannot be created or written to", "-d DIRECTORY"}},
        {{"--resolution", "1000000x1000000", file}, {"resolution"}},
    };
    for (const Mistake& mistake : mistakes) expectMistake(mistake, BadInput);
}

TEST(Command, AJsonErrorHasLineAndColumn) {
    const SceneFile scene("{\n  \"camera\": {\"type\" \"pinhole\"}}");
    expectMistake({{scene.path().string()}, {scene.path().string(), "line 2, column"}}, BadInput);
}

TEST(Command, HelpAndVersionAnswerAndStop) {
    const CommandResult help = test::tungsten({"--help"});
    EXPECT_EQ(help.exitCode, 0);
    for (const char* option : {"--help",
                               "--version",
                               "--threads",
                               "--restart",
                               "--checkpoint",
                               "--input-directory",
                               "--output-directory",
                               "--spp",
                               "--timeout",
                               "--seed",
                               "--output-file",
                               "--hdr-output-file",
                               "--exposure",
                               "--no-frames",
                               "--sheet",
                               "--video",
                               "--time-center",
                               "--set",
                               "--resolution",
                               "--stats",
                               "--target-error",
                               "--memory-limit",
                               "--allow-outside",
                               "--explain",
                               "--list",
                               "--describe",
                               "--markdown",
                               "--quiet",
                               "--manual",
                               "--completion"})
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
    EXPECT_EQ(test::tungsten({"-h"}).out, help.out);
    const CommandResult version = test::tungsten({"-v"});
    EXPECT_EQ(version.exitCode, 0);
    EXPECT_EQ(version.out.rfind("tungsten (darts-tungsten) ", 0), 0u) << version.out;
}

TEST(Command, ListShowsIntegratorsWithTheirFilesAndEveryKindOfType) {
    const CommandResult result = test::tungsten({"--list"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    for (const char* part : {"path_tracer", "libtungsten-path.so", "progressive_photon_map", "libtungsten-photon.so",
                             "rough_dielectric", "guided_homo", "henyey_greenstein", "directional_point",
                             "orthographic", "mitchell_netravali", "filmic", "checker"})
        EXPECT_NE(result.out.find(part), std::string::npos) << part;
}

TEST(Command, ListReportsABrokenPluginAndListsTheOthers) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "libtungsten-broken.so") << "garbage";
    ::setenv("TUNGSTEN_PLUGIN_PATH", folder.path().c_str(), 1);
    const CommandResult result = test::tungsten({"--list"});
    ::unsetenv("TUNGSTEN_PLUGIN_PATH");
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_NE(result.err.find("libtungsten-broken.so: the plugin cannot be loaded"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("path_tracer"), std::string::npos);
}

TEST(Command, ExplainPrintsThePlanAndRendersNothing) {
    const SceneFile scene(foggyBox(test::Photons));
    const CommandResult result = test::tungsten({"--explain=effects", "--time-center", "7", scene.path().string()});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    for (const char* part : {"one gate [6, 8)", "scattering media: 'fog'", "'floor'"})
        EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
    EXPECT_FALSE(fs::exists(scene.path().parent_path() / "box.png"));
}

TEST(Command, ASceneRendersAndSaysWhereTheImagesAre) {
    const SceneFile scene(foggyBox(test::Paths));
    const fs::path folder = scene.path().parent_path() / "new" / "folder";
    const CommandResult result =
        test::tungsten({"-d", folder.string(), "--resolution", "12x10", "--stats", "stats.json", "--html", "page.html",
                        "--trace", "trace", "-t=1", scene.path().string()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(fs::exists(folder / "trace" / "trace.json"));
    for (const char* name : {"box.png", "box.pfm", "stats.json", "page.html"}) {
        EXPECT_TRUE(fs::exists(folder / name));
        EXPECT_NE(result.out.find("wrote " + (folder / name).string()), std::string::npos) << result.out;
    }
    EXPECT_NE(result.out.find("4 passes, 8 samples per pixel"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("standard error"), std::string::npos) << result.out;
    EXPECT_NE(result.err.find("pass 4/4"), std::string::npos) << result.err;
    EXPECT_EQ(readPfm(folder / "box.pfm").width, 12);
    const std::string stats = contentOf(folder / "stats.json");
    for (const char* part : {"\"threads\": 1", "\"rays\"", "\"load\"", "\"integrator\": \"path_tracer\""})
        EXPECT_NE(stats.find(part), std::string::npos) << part;
}

TEST(Command, APageHoldsFilmCommandAndFigures) {
    const SceneFile scene(foggyBox(test::PathFrames));
    const fs::path page = scene.path().parent_path() / "new" / "page.html";
    const CommandResult result = test::tungsten(
        {"--html", page.string(), "--quiet", "--set", "primitives.lamp.name=</script> it's", scene.path().string()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const std::string text = contentOf(page);
    EXPECT_EQ(text.rfind("<!DOCTYPE html>", 0), 0u);
    for (const char* line : {"\n@include", "\n@data"}) EXPECT_EQ(text.find(line), std::string::npos) << line;
    EXPECT_EQ(text.substr(text.size() - 8), "</html>\n");
    for (const char* part : {"\"frames\": 4", "\"samples per pixel\": 8", "\"value\": \"standard error", "new uPlot(",
                             "Leon Sorokin", R"('primitives.lamp.name=\u003c/script> it'\\''s')"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST(Command, APageTellsTimesInPicosecondsWhereTheSceneSaysItsUnit) {
    const SceneFile scene(foggyBox(test::PathFrames));
    const auto timeOf = [&](const std::vector<std::string>& options) {
        std::vector<std::string> all{"--quiet", "--html", "page.html", "-d", scene.path().parent_path().string()};
        all.insert(all.end(), options.begin(), options.end());
        all.push_back(scene.path().string());
        EXPECT_EQ(test::tungsten(all).exitCode, 0);
        const std::string page = contentOf(scene.path().parent_path() / "page.html");
        const size_t at = page.find("\"width\": ", page.find("\"start\": ", page.find("\"toneMap\"")));
        const size_t unit = page.find("\"unit\": \"", at) + 9;
        return std::pair{std::stod(page.substr(at + 9)), page.substr(unit, page.find('"', unit) - unit)};
    };
    const auto plain = timeOf({});
    EXPECT_EQ(plain.second, "");
    const auto metres = timeOf({"--set", "length_unit=m"});
    EXPECT_EQ(metres.second, "ps");
    EXPECT_NEAR(metres.first / plain.first, 1e12 / 299792458.0, 1e-3);
}

TEST(Command, QuietIsQuiet) {
    const SceneFile scene(foggyBox(test::Paths));
    const CommandResult result = test::tungsten({"--quiet", "--spp", "2", scene.path().string()});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.all(), "");
}

TEST(Command, UnknownFieldsAreWarnedAboutOnce) {
    const SceneFile scene(foggyBox(std::string(test::Paths) + ", \"max_bouncse\": 3"));
    const CommandResult result = test::tungsten({"--quiet", "--spp", "2", scene.path().string()});
    EXPECT_EQ(result.exitCode, 0);
    const size_t first = result.err.find("integrator.max_bouncse: unknown field");
    EXPECT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("max_bouncse", first + 25), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("did you mean 'max_bounces'?"), std::string::npos);
}

TEST(Command, ABadSceneDoesNotKeepTheNextFromRendering) {
    const SceneFile bad("{ nonsense"), good(foggyBox(test::Paths));
    const CommandResult result = test::tungsten({"--spp", "2", bad.path().string(), good.path().string()});
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find(bad.path().string()), std::string::npos);
    EXPECT_TRUE(fs::exists(good.path().parent_path() / "box.png"));
}

TEST(Command, DescribesWhatIsThereWithoutPlugins) {
    const test::TemporaryFolder folder;
    for (const char* file : {"tungsten", "libtungsten.so"})
        fs::copy_file(test::binaryFolder() / file, folder.path() / file);
    const CommandResult described = test::Command({"--describe", "--markdown"}, folder.path()).wait();
    EXPECT_EQ(described.exitCode, 0) << described.all();
    EXPECT_NE(described.out.find("### renderer"), std::string::npos);
}

} // namespace
} // namespace tungsten
