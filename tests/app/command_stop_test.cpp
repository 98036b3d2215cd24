// The `tungsten` command from outside: how it ends before its time.

#include "app/command.h"
#include "support/Folders.h"

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

TEST(CommandStops, AnInterruptWritesWhatIsThere) {
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

TEST(CommandStops, AnInterruptInTheFirstPassWritesNothing) {
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

TEST(CommandStops, ATimeOutIsKeptWhilePreparing) {
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

TEST(CommandStops, AnInterruptWhileLoadingLeavesAtOnce) {
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

TEST(CommandStops, ATimeOutIsKeptInsideAPassAndPassesAreCutToFit) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "not even a sample per pixel ends in time";
#endif
    for (const char* const integrator : {test::Paths, test::Photons}) {
        const SceneFile scene(foggyBox(integrator));
        std::vector<std::string> arguments = EndlessPass;
        arguments.back() = "256x256"; // a sample per pixel takes a small part of the time
        arguments.push_back(scene.path().string());
        CommandResult result;
        EXPECT_LT(secondsWithTimeOut("1.2s", arguments, result), 5.0) << "with all the machine may be busy with";
        EXPECT_EQ(result.exitCode, 0) << result.all();
        EXPECT_NE(result.err.find("the first pass did not end within 0.3 s"), std::string::npos) << result.err;
        EXPECT_TRUE(fs::exists(scene.path().parent_path() / "box.png"));
    }
}

TEST(CommandStops, ATimeOutWithoutOnePassIsAnError) {
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
