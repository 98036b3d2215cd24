// Images for people, as the command writes them.

#include "app/command.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::BadInput;
using test::BadUsage;
using test::CommandResult;
using test::contentOf;
using test::foggyBox;
using test::SceneFile;

TEST(Command, SequencesAreShown) {
    const SceneFile scene(foggyBox(test::PathFrames)), still(foggyBox(test::Paths));
    const fs::path folder = scene.path().parent_path();
    const auto run = [&](std::vector<std::string> more, const SceneFile& which) {
        more.insert(more.begin(), {"--quiet", "--spp", "2", "-d", folder.string(), which.path().string()});
        return test::tungsten(more);
    };
    ASSERT_EQ(run({"--no-frames", "--sheet", "sheet.png"}, scene).exitCode, 0);
    EXPECT_TRUE(fs::exists(folder / "sheet.png") && fs::exists(folder / "box.png"));
    EXPECT_FALSE(fs::exists(folder / "box_00.png"));
    const std::string automatic = contentOf(folder / "box.png");
    ASSERT_EQ(run({"--exposure", "0"}, scene).exitCode, 0);
    EXPECT_NE(contentOf(folder / "box.png"), automatic);
    ASSERT_EQ(run({"--set", "renderer.exposure=\"auto\""}, scene).exitCode, 0);
    EXPECT_EQ(contentOf(folder / "box.png"), automatic) << "the default with a gate";
    EXPECT_TRUE(fs::exists(folder / "box_03.png"));
    const auto says = [](const CommandResult& result, int code, const std::string& part) {
        EXPECT_EQ(result.exitCode, code);
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    };
    says(run({"--exposure", "bright"}, scene), BadUsage, "--exposure bright: expected auto or a number");
    says(run({"--set", "renderer.exposure=\"dark\""}, scene), BadInput, "renderer.exposure");
    says(run({"--sheet", "s.png"}, still), BadInput, "integrator.frame_num");
    says(run({"--video", "v.avi"}, scene), BadInput, ".mp4 or .gif");
}

} // namespace
} // namespace tungsten
