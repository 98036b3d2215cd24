// The `tungsten` command from outside: exit codes, messages, files.

#include "render/command.h"
#include "support/Folders.h"

#include "tungsten/film/ImageIo.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::Command;
using test::CommandResult;
using test::contentOf;
using test::foggyBox;
using test::SceneFile;

const int BadInput = 1, BadUsage = 2, Interrupted = 130;

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
        {{"--time-center", "noon", file}, {"--time-center"}},
        {{"--set", "camera", file}, {"path.to.field=value"}},
        {{"--set", "primitives.7.bsdf=3", file}, {"3 elements"}},
        {{"--set", "media.fgo.sigma_s=3", file}, {"did you mean 'fog'?"}},
        {{"--spp"}, {"--spp"}},
        {{"--html", "page.html", file, file}, {"--html", "one scene"}},
    };
    for (const Mistake& mistake : mistakes) expectMistake(mistake, BadUsage);
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
    const CommandResult result = test::tungsten({"--explain", "--time-center", "7", scene.path().string()});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    for (const char* part : {"one gate [6, 8)", "scattering media: 'fog'", "'floor'"})
        EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
    EXPECT_FALSE(fs::exists(scene.path().parent_path() / "box.png"));
}

TEST(Command, ASceneRendersAndSaysWhereTheImagesAre) {
    const SceneFile scene(foggyBox(test::Paths));
    const fs::path folder = scene.path().parent_path() / "new" / "folder";
    const CommandResult result = test::tungsten({"-d", folder.string(), "--resolution", "12x10", "--stats",
                                                 (folder / "stats.json").string(), "-t=1", scene.path().string()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    for (const char* name : {"box.png", "box.pfm", "stats.json"}) {
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

TEST(Command, AnInterruptWritesWhatIsThere) {
    const SceneFile scene(foggyBox(test::Paths));
    const fs::path folder = scene.path().parent_path();
    Command command(
        {"--spp", "100000000", "-c", "1ms", "--stats", (folder / "stats.json").string(), scene.path().string()});
    ASSERT_TRUE(command.writes(folder / "box_checkpoint.pfm"));
    command.send(SIGINT);
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exitCode, 0) << result.all();
    EXPECT_TRUE(fs::exists(folder / "box.png"));
    EXPECT_TRUE(fs::exists(folder / "boxState.dat"));
    EXPECT_NE(contentOf(folder / "stats.json").find("\"stopped because\": \"interrupted\""), std::string::npos);
}

/// One pass that would take hours.
const std::vector<std::string> EndlessPass{"--spp",        "1000000", "--set", "renderer.spp_step=1000000",
                                           "--resolution", "512x512"};

TEST(Command, AnInterruptInTheFirstPassWritesNothing) {
    for (const char* const integrator : {test::Paths, test::Photons}) {
        const SceneFile scene(foggyBox(integrator));
        std::vector<std::string> arguments = EndlessPass;
        arguments.push_back(scene.path().string());
        Command command(arguments);
        ASSERT_TRUE(command.handles(SIGTERM));
        std::this_thread::sleep_for(std::chrono::milliseconds(300)); // loading takes less
        EXPECT_TRUE(command.running());
        command.send(SIGINT);
        const CommandResult result = command.wait();
        EXPECT_EQ(result.exitCode, Interrupted);
        EXPECT_NE(result.all().find("nothing was written"), std::string::npos) << result.all();
        EXPECT_FALSE(fs::exists(scene.path().parent_path() / "box.png"));
    }
}

/// Sixty media, each with a table of directions of its own: seconds of preparing.
std::string manyTables() {
    std::string media, cubes;
    for (int i = 0; i < 60; ++i) {
        const std::string number = std::to_string(i), x = std::to_string(0.3 * (i % 10)),
                          z = std::to_string(-0.3 * (i / 10));
        media += R"({"name": "m)" + number +
                 R"(", "type": "guided_homo", "sigma_s": 1, "phase_function": {"type": "ida", "g": )" +
                 std::to_string(0.01 * i) + "}}, ";
        cubes += R"({"type": "cube", "bsdf": {"type": "forward"}, "int_medium": "m)" + number +
                 R"(", "transform": {"position": [)" + x + ", 0.2, " + z + R"(], "scale": 0.2}}, )";
    }
    media.resize(media.size() - 2);
    return R"({"media": [)" + media + R"(], "primitives": [)" + cubes +
           R"({"type": "point", "emission": 8, "transform": {"position": [0.5, 1.8, 0.6]}}],
              "camera": {"type": "pinhole", "resolution": [16, 16], "transform": {"position": [0, 1, 3], "look_at": [0, 0, 0]}},
              "integrator": {"type": "progressive_transient_photon_map", "transient_time_center": 5, "transient_time_width": 2,
                             "photon_count": 1000, "darts": "published"}, "renderer": {"output_file": "box.png"}})";
}

TEST(Command, ATimeOutIsKeptWhilePreparing) {
    const SceneFile scene(manyTables());
    const auto start = std::chrono::steady_clock::now();
    const CommandResult result = test::tungsten({"--timeout", "0.2s", scene.path().string()});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(1500));
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("not one pass ended within 0.2 s, which went into preparing (guides of media, "),
              std::string::npos)
        << result.all();
    EXPECT_EQ(result.err.find("fewer photons"), std::string::npos) << "they would not help: " << result.all();
    EXPECT_FALSE(fs::exists(scene.path().parent_path() / "box.png"));
}

TEST(Command, AnInterruptWhileLoadingLeavesAtOnce) {
    // Text that takes seconds to read.
    std::string mesh;
    for (int i = 0; i < 2000000; ++i) mesh += "v " + std::to_string(i % 1000) + " " + std::to_string(i / 1000) + " 0\n";
    for (int i = 1; i + 1001 < 2000000; ++i)
        mesh += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 1001) + "\n";
    const SceneFile scene(
        R"({"primitives": [{"type": "mesh", "file": "big.obj"}], "renderer": {"output_file": "box.png"}})");
    std::ofstream(scene.path().parent_path() / "big.obj") << mesh;
    Command command({scene.path().string()});
    ASSERT_TRUE(command.handles(SIGTERM));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ASSERT_TRUE(command.running());
    const auto start = std::chrono::steady_clock::now();
    command.send(SIGINT);
    const CommandResult result = command.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    EXPECT_EQ(result.exitCode, Interrupted);
    EXPECT_NE(result.err.find("interrupted while loading: nothing was written"), std::string::npos) << result.all();
}

/// Seconds that the command takes with a time-out.
double secondsWithTimeOut(const std::string& timeOut, std::vector<std::string> arguments, CommandResult& result) {
    arguments.insert(arguments.begin(), {"--timeout", timeOut});
    const auto start = std::chrono::steady_clock::now();
    result = test::tungsten(arguments);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Command, ATimeOutIsKeptInsideAPassAndPassesAreCutToFit) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "not even a sample per pixel ends in time";
#endif
    for (const char* const integrator : {test::Paths, test::Photons}) {
        const SceneFile scene(foggyBox(integrator));
        std::vector<std::string> arguments = EndlessPass;
        arguments.push_back(scene.path().string());
        CommandResult result;
        EXPECT_LT(secondsWithTimeOut("4s", arguments, result), 8.0) << "with all the machine may be busy with";
        EXPECT_EQ(result.exitCode, 0) << result.all();
        EXPECT_NE(result.err.find("the first pass did not end within 1 s"), std::string::npos) << result.err;
        EXPECT_TRUE(fs::exists(scene.path().parent_path() / "box.png"));
    }
}

TEST(Command, ATimeOutWithoutOnePassIsAnError) {
    const SceneFile scene(foggyBox(test::Paths));
    CommandResult result;
    secondsWithTimeOut("1ms", {"--set", "renderer.spp_step=1", "--resolution", "2048x2048", scene.path().string()},
                       result);
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("not one pass ended within 0.001 s"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(scene.path().parent_path() / "box.png"));
}

} // namespace
} // namespace tungsten
