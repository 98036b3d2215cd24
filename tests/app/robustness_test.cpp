// What a render may lose or touch: kills, odd files and names, scenes that mean harm.

#include "app/rendered_scene.h"
#include "support/Folders.h"
#include "tungsten/image/ReadImage.h"

#include <sys/stat.h>
#include <sys/sysmacros.h>

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
using test::TemporaryFolder;

using Robustness = test::RenderedScene;

TEST_F(Robustness, ScenesAndStatesAreRegularFiles) {
    const fs::path pipe = folder() / "pipe.json";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const fs::path& odd : {pipe, fs::path("/dev/zero"), folder()}) {
        const CommandResult result = test::tungsten({odd.string()});
        EXPECT_EQ(result.exitCode, BadInput);
        EXPECT_NE(result.err.find("not a file"), std::string::npos) << result.err;
    }
    fs::create_directories(out());
    ASSERT_EQ(::mkfifo((out() / "boxState.dat").c_str(), 0600), 0);
    refuses({"-c", "1h"}, BadInput, {"boxState.dat", "a device or a pipe has this name"});
}

TEST_F(Robustness, OutputsReplaceNothingButOutputs) {
    fs::create_directories(out());
    const fs::path device = out() / "null";
    const bool made =
        ::mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) == 0 || ::mkfifo(device.c_str(), 0600) == 0;
    ASSERT_TRUE(made);
    refuses({"--stats", device.string()}, BadInput, {"null", "a device or a pipe"});
    EXPECT_FALSE(fs::is_regular_file(device));
    const std::string before = contentOf(scene.path());
    refuses({"--stats", scene.path().string()}, BadInput, {"scene.json", "the scene reads it"});
    EXPECT_EQ(contentOf(scene.path()), before);
    const fs::path image = out() / "a.png";
    refuses({"-o", "a.png", "--stats", image.string()}, BadInput, {"a.png", "two outputs"});
    refuses({"-o", "a.png", "--set", R"(renderer.output_buffers=[{"type": "color", "ldr_output_file": "b/../a.png"}])"},
            BadInput, {"a.png", "two outputs"});
    EXPECT_FALSE(fs::exists(image));
    // Names that the checks themselves would make folders of.
    refuses({"--trace", image.string(), "-o", "a.png"}, BadInput, {"a.png", "two outputs"});
    refuses({"--trace", out().string(), "--stats", (out() / "trace.json").string()}, BadInput,
            {"trace.json", "two outputs"});
    refuses({"--stats", (out() / "new/").string()}, BadInput, {"new/", "the name of a folder"});
    for (const fs::path& folder : {image, out() / "new"}) EXPECT_FALSE(fs::exists(folder)) << folder;
}

TEST_F(Robustness, NamesAreCheckedBeforeRendering) {
    const std::string frames = "integrator.frame_num=3", width = "integrator.transient_time_width=1";
    refuses({"-o", std::string(252, 'n') + ".png"}, BadInput, {"the name has 256 bytes"});
    // Only the frames' or the checkpoint's names are too long.
    refuses({"-o", std::string(251, 'n') + ".png", "--set", frames, "--set", width}, BadInput,
            {"the name has 258 bytes"});
    refuses({"-o", std::string(250, 'n') + ".png", "-c", "1h"}, BadInput, {"the name has 265 bytes"});
    fs::create_directories(out() / "f_01.png" / "x");
    refuses({"-o", "f.png", "--set", frames, "--set", width}, BadInput, {"f_01.png", "a folder has this name"});
    refuses({"-c", "1h", "--set", "renderer.resume_render_file=\"\""}, BadInput, {"resume_render_file is empty"});
    // The longest name that fits is written.
    EXPECT_EQ(render({"-o", std::string(251, 'n') + ".png"}).exitCode, 0);
}

TEST_F(Robustness, AFolderThatVanishesIsMadeAgain) {
    Command command({"--spp", "100000000", "-c", "1ms", "-d", out().string(), scene.path().string()});
    ASSERT_TRUE(command.writes(out() / "box_checkpoint.pfm"));
    fs::rename(out(), folder() / "gone"); // at once: what is being written would keep a removed folder from being empty
    command.send(SIGINT);
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exitCode, 0) << result.all();
    EXPECT_TRUE(fs::exists(out() / "box.png"));
}

TEST_F(Robustness, AHangupWritesWhatIsThereAndABrokenPipeEndsNothing) {
    Command command({"--spp", "100000000", "-c", "1ms", "-d", out().string(), scene.path().string()});
    ASSERT_TRUE(command.writes(out() / "box_checkpoint.pfm"));
    command.send(SIGPIPE);
    fs::remove(out() / "box_checkpoint.pfm");
    ASSERT_TRUE(command.writes(out() / "box_checkpoint.pfm")) << "it goes on";
    command.send(SIGHUP);
    EXPECT_EQ(command.wait().exitCode, 0);
    EXPECT_TRUE(fs::exists(out() / "box.png"));
}

/// Who starts it under nohup wants it to go on.
TEST_F(Robustness, AHangupThatIsIgnoredEndsNothing) {
    const auto before = std::signal(SIGHUP, SIG_IGN); // handed on to the command
    Command command({"--spp", "100000000", "-c", "1ms", "-d", out().string(), scene.path().string()});
    std::signal(SIGHUP, before);
    ASSERT_TRUE(command.writes(out() / "box_checkpoint.pfm"));
    command.send(SIGHUP);
    for (int i = 0; i < 3; ++i) {
        fs::remove(out() / "box_checkpoint.pfm");
        ASSERT_TRUE(command.writes(out() / "box_checkpoint.pfm")) << "it goes on";
    }
    command.send(SIGINT);
    EXPECT_EQ(command.wait().exitCode, 0);
}

TEST_F(Robustness, AnInterruptBeforeTheLastSceneIsNoSuccess) {
    const SceneFile second(foggyBox(test::Paths));
    Command command({"--spp", "100000000", "-c", "1ms", scene.path().string(), second.path().string()});
    ASSERT_TRUE(command.writes(folder() / "box_checkpoint.pfm"));
    command.send(SIGINT);
    EXPECT_EQ(command.wait().exitCode, Interrupted);
    EXPECT_TRUE(fs::exists(folder() / "box.png"));
}

TEST_F(Robustness, TwoScenesDoNotShareOutputs) {
    const SceneFile second(foggyBox(test::Paths));
    refuses({second.path().string()}, BadUsage, {scene.path().string(), second.path().string(), "box.png"});
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Robustness, ScenesOfOneCommandHaveStatesOfTheirOwn) {
    std::string other = foggyBox(test::PathFrames);
    for (size_t at = 0; (at = other.find("\"box.", at)) != std::string::npos; at += 5) other.replace(at, 5, "\"other.");
    const SceneFile second(other);
    for (const char* run : {"first", "resumed"}) {
        const CommandResult result = test::tungsten(
            {"--quiet", "-d", out().string(), "-c", "1h", scene.path().string(), second.path().string()});
        EXPECT_EQ(result.exitCode, 0) << run << result.all();
    }
    EXPECT_TRUE(fs::exists(out() / "boxState.dat") && fs::exists(out() / "otherState.dat"));
}

TEST_F(Robustness, TemporaryFilesOfKilledRendersAreRemoved) {
    fs::create_directories(out());
    const fs::path old = out() / ".tungsten-0123456789abcdef.tmp", young = out() / ".tungsten-0123456789abcdee.tmp",
                   other = out() / ".tungsten-notes.txt", named = out() / ".tungsten-important-notes.tmp";
    for (const fs::path& file : {old, young, other, named}) std::ofstream(file) << "x";
    for (const fs::path& file : {old, other, named})
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
    ASSERT_EQ(render({}).exitCode, 0);
    EXPECT_FALSE(fs::exists(old));
    EXPECT_TRUE(fs::exists(young)) << "somebody may be about to write it";
    EXPECT_TRUE(fs::exists(other));
    EXPECT_TRUE(fs::exists(named)) << "no render makes such a name";
}

/// Kills at many moments: what is there is whole, and resuming gives what an uninterrupted render gives.
TEST_F(Robustness, KilledRendersLeaveWholeFilesAndResume) {
    const auto arguments = [&](const fs::path& where) -> std::vector<std::string> {
        return {"--quiet", "-d", where.string(), "-c", "1ms", "--spp", "60", "-e", "box.pfm", scene.path().string()};
    };
    ASSERT_EQ(test::tungsten(arguments(folder() / "whole")).exitCode, 0);
    int kills = 0;
    for (int i = 0; i < 12; ++i) {
        Command command(arguments(out()));
        std::this_thread::sleep_for(std::chrono::milliseconds(40 + 17 * i));
        kills += command.running() ? 1 : 0;
        command.send(SIGKILL);
        (void)command.wait();
        const fs::path checkpoint = out() / "box_checkpoint.pfm";
        if (fs::exists(checkpoint)) {
            EXPECT_NO_THROW((void)readPfm(checkpoint));
        }
    }
    EXPECT_GT(kills, 0);
    const CommandResult last = test::tungsten(arguments(out()));
    ASSERT_EQ(last.exitCode, 0) << last.all();
    EXPECT_EQ(contentOf(out() / "box.pfm"), contentOf(folder() / "whole" / "box.pfm"));
}

TEST_F(Robustness, StatisticsAreJsonWhateverTheSceneIsCalled) {
    const fs::path odd = folder() / "a\xff\xc3\xa9.json";
    fs::copy_file(scene.path(), odd);
    const fs::path stats = folder() / "stats.json";
    ASSERT_EQ(test::tungsten({"--quiet", "--spp", "2", "--stats", stats.string(), odd.string()}).exitCode, 0);
    EXPECT_NE(contentOf(stats).find("a\xef\xbf\xbd\xc3\xa9.json"), std::string::npos) << contentOf(stats);
}

TEST_F(Robustness, MetadataAreUtf8WhateverTheSceneNames) {
    std::string json = contentOf(scene.path());
    const size_t name = json.find("\"fog\"");
    ASSERT_NE(name, std::string::npos);
    for (size_t at = name; at != std::string::npos; at = json.find("\"fog\"", at)) json.replace(at, 5, "\"f\xff\"");
    const SceneFile odd(json);
    ASSERT_EQ(
        test::tungsten({"--quiet", "--spp", "2", "-d", out().string(), "-e", "a.npy", odd.path().string()}).exitCode,
        0);
    const std::string metadata = contentOf(out() / "a.npy.json");
    EXPECT_NE(metadata.find("\"f\xef\xbf\xbd\""), std::string::npos) << metadata;
    EXPECT_EQ(metadata.find('\xff'), std::string::npos);
}

TEST_F(Robustness, ScenesKeepToTheirFolder) {
    const test::FileFolder elsewhere;
    const fs::path mesh = elsewhere.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto use = [](const fs::path& file) {
        return R"(primitives.block={"type": "mesh", "file": ")" + file.string() + "\"}";
    };
    refuses({"--set", use(mesh)}, BadInput, {"a.obj", "--allow-outside"});
    refuses({"--set", use(fs::path("..") / mesh.parent_path().filename() / "a.obj")}, BadInput, {"--allow-outside"});
    fs::create_symlink(mesh, folder() / "link.obj");
    refuses({"--set", use("link.obj")}, BadInput, {"link.obj", "--allow-outside"});
    EXPECT_EQ(render({"--allow-outside", "--set", use(mesh)}).exitCode, 0);
    EXPECT_EQ(render({"-i", mesh.parent_path().string(), "--set", use("a.obj")}).exitCode, 0);
    fs::create_directories(folder() / "meshes");
    fs::copy_file(mesh, folder() / "meshes" / "a.obj");
    EXPECT_EQ(render({"--set", use("meshes/../meshes/a.obj")}).exitCode, 0);
    // External buffers of glTF files.
    std::ofstream(folder() / "a.gltf") << R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "../)"
                                       << mesh.parent_path().filename().string() << R"(/a.obj"}]})";
    refuses({"--set", use("a.gltf")}, BadInput, {"a.gltf", "--allow-outside"});
}

TEST_F(Robustness, ScenesWriteToTheOutputFolder) {
    const TemporaryFolder elsewhere;
    const std::string absolute = "renderer.output_file=" + (elsewhere.path() / "x.png").string();
    refuses({"--set", absolute}, BadInput, {"renderer.output_file", "x.png", "--allow-outside"});
    refuses({"--set", "renderer.hdr_output_file=../x.pfm"}, BadInput,
            {"renderer.hdr_output_file", "x.pfm", "--allow-outside"});
    refuses({"--set", "renderer.output_file=" + std::string(300, 'n') + ".png"}, BadInput,
            {"renderer.output_file", "a name of 304 bytes"});
    refuses({"--set", R"(renderer.output_buffers=[{"type": "color", "ldr_output_file": "../x.png"}])"}, BadInput,
            {"x.png", "--allow-outside"});
    EXPECT_TRUE(fs::is_empty(elsewhere.path()));
    EXPECT_EQ(render({"--allow-outside", "--set", absolute}).exitCode, 0);
    EXPECT_TRUE(fs::exists(elsewhere.path() / "x.png"));
    // Whoever runs the command may name any file.
    EXPECT_EQ(render({"-o", (elsewhere.path() / "y.png").string()}).exitCode, 0);
    // Without -d the scene's own folder counts, and what it calls its output folder does not widen it.
    const CommandResult result =
        test::tungsten({"--quiet", "--spp", "2", "--set", "renderer.output_directory=" + elsewhere.path().string(),
                        scene.path().string()});
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("--allow-outside"), std::string::npos) << result.err;
}

TEST_F(Robustness, WhatDoesNotFitIntoMemoryIsRefusedWithTheFigure) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer's own memory exceeds any limit";
#endif
    refuses({"--memory-limit", "1M", "--resolution", "400x300"}, BadInput,
            {"needs about 13.9 MiB", "400x300", "1 MiB"});
    refuses({"--resolution", "65536x65536"}, BadInput, {"needs about 486 GiB", "65536x65536"});
    refuses({"--set", R"(integrator={"type": "photon_map", "photon_count": 1000000000})", "--memory-limit", "1G"},
            BadInput, {"needs about", "44.9 GiB for the integrator"});
    std::ofstream(folder() / "m.obj") << std::string(8192, '\n');
    fs::resize_file(folder() / "m.obj", uintmax_t(1) << 30);
    refuses({"--set", R"(primitives=[{"type": "mesh", "file": "m.obj"}])", "--memory-limit", "256M"}, BadInput,
            {"m.obj: has 1 GiB, more than the ", " of memory", "--memory-limit"});
    EXPECT_EQ(render({"--memory-limit", "2GiB"}).exitCode, 0);
    refuses({"--memory-limit", "many"}, BadUsage, {"--memory-limit many", "512M"});
}

TEST_F(Robustness, PluginsComeFromTheNamedPlacesOnly) {
    const fs::path plugin = folder() / "libtungsten-here.so";
    fs::copy_file(test::binaryFolder() / "libtungsten-path.so", plugin);
    const fs::path before = fs::current_path();
    fs::current_path(folder());
    const CommandResult result = test::tungsten({"--list"});
    fs::current_path(before);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.all().find("libtungsten-here.so"), std::string::npos) << result.all();
}

} // namespace
} // namespace tungsten
