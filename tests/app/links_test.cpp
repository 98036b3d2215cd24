// Outputs whose names are links: they are written through, but for a scene's own that lead out of its folder.

#include "app/command.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::BadInput;
using test::CommandResult;
using test::contentOf;
using test::FileFolder;

class Links : public testing::Test {
  protected:
    CommandResult render(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"--quiet", "-t", "1", "--spp", "1"});
        arguments.push_back(scene_.path().string());
        return test::tungsten(arguments);
    }
    [[nodiscard]] fs::path link(const fs::path& target, const std::string& name) const {
        fs::create_symlink(target, names_.path(name));
        return names_.path(name);
    }
    [[nodiscard]] fs::path folder() const { return scene_.path().parent_path(); }

    test::SceneFile scene_{test::foggyBox(test::Paths)};
    FileFolder names_, targets_;
};

TEST_F(Links, TheirTargetIsReplaced) {
    const fs::path old = targets_.write("old.json", "old");
    const fs::path toOld = link(old, "old.json"), toNew = link(targets_.path("new.json"), "new.json"),
                   twice = link("again.json", "twice.json"), again = link(targets_.path("last.json"), "again.json");
    for (const fs::path& name : {toOld, toNew, twice}) {
        const CommandResult result = render({"--stats", name.string()});
        EXPECT_EQ(result.exitCode, 0) << result.all();
        EXPECT_TRUE(fs::is_symlink(name));
        EXPECT_EQ(contentOf(name).front(), '{') << name;
    }
    EXPECT_TRUE(fs::is_symlink(again));
    EXPECT_EQ(contentOf(targets_.path("last.json")).front(), '{');
    EXPECT_EQ(std::distance(fs::directory_iterator(targets_.path("")), {}), 3) << "three files, nothing temporary";
}

TEST_F(Links, StandardOutputIsWrittenTo) {
    const fs::path out = link("/proc/self/fd/1", "stdout");
    const CommandResult result = render({"--stats", out.string()});
    EXPECT_EQ(result.exitCode, 0) << result.all();
    EXPECT_EQ(result.out.substr(0, 1), "{");
    EXPECT_EQ(fs::read_symlink(out), "/proc/self/fd/1");
    const CommandResult closed = render({"--stats", "/proc/self/fd/77"});
    EXPECT_EQ(closed.exitCode, BadInput);
    EXPECT_NE(closed.err.find("/proc/self/fd/77: cannot be written"), std::string::npos) << closed.all();
    const CommandResult others = render({"--stats", "/proc/1/fd/1"});
    EXPECT_EQ(others.exitCode, BadInput) << "another process's";
}

TEST_F(Links, APipeGetsAllOfIt) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    writeAtomically("/dev/fd/" + std::to_string(ends[1]), [](std::ostream& out) {
        out << "hallo";
        out.seekp(1);
        out << "e";
    });
    char text[16]{};
    EXPECT_EQ(::read(ends[0], text, sizeof text), 5);
    EXPECT_STREQ(text, "hello");
    EXPECT_THROW(writeAtomically("/dev/fd/" + std::to_string(ends[0]), [](std::ostream&) {}), InputError);
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_F(Links, ASceneDoesNotLeadOutOfItsFolder) {
    const fs::path victim = targets_.write("victim", "precious");
    for (const char* const name : {"box.png", "box.pfm", "boxState.dat", "box_checkpoint.png"}) {
        fs::remove(folder() / name);
        fs::create_symlink(victim, folder() / name);
        const CommandResult result = render({"-c", "1h"});
        EXPECT_EQ(result.exitCode, BadInput) << name;
        EXPECT_NE(result.err.find("the output folder '" + folder().string()), std::string::npos) << result.all();
        EXPECT_EQ(contentOf(victim), "precious");
        fs::remove(folder() / name);
    }
    fs::create_symlink(victim, folder() / "box_passes_0-2.state");
    EXPECT_EQ(test::tungsten({"--passes", "0:2", scene_.path().string()}).exitCode, BadInput);
    EXPECT_EQ(contentOf(victim), "precious");
    fs::create_symlink(victim, folder() / "box.png");
    EXPECT_EQ(render({"--allow-outside"}).exitCode, 0);
    EXPECT_EQ(contentOf(victim).substr(1, 3), "PNG");
}

TEST_F(Links, TwoNamesOfOneFileAndOfAnInputAreFound) {
    const fs::path a = link(targets_.path("one.json"), "a.html"), b = link(targets_.path("one.json"), "b.json");
    CommandResult result = render({"--stats", b.string(), "--html", a.string()});
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("the name of two outputs"), std::string::npos) << result.all();
    result = render({"--stats", link(scene_.path(), "c.json").string()});
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("the scene reads it"), std::string::npos) << result.all();
    result = render({"--stats", link("circle.json", "circle.json").string()});
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("in a circle"), std::string::npos) << result.all();
}

TEST_F(Links, OthersLinksInSharedFoldersAreNotFollowed) {
    if (::geteuid() != 0) GTEST_SKIP() << "files are given away by root alone";
    const fs::path victim = targets_.write("victim.json", "precious"), planted = link(victim, "planted.json");
    ASSERT_EQ(::lchown(planted.c_str(), 12345, 12345), 0);
    ASSERT_EQ(::chmod(names_.path("").c_str(), 01777), 0);
    const CommandResult result = render({"--stats", planted.string()});
    EXPECT_EQ(result.exitCode, BadInput);
    EXPECT_NE(result.err.find("a link of another user"), std::string::npos) << result.all();
    EXPECT_EQ(contentOf(victim), "precious");
    ASSERT_EQ(::chmod(names_.path("").c_str(), 0755), 0);
    EXPECT_EQ(render({"--stats", planted.string()}).exitCode, 0);
}

} // namespace
} // namespace tungsten
