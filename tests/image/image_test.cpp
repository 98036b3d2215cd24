// Files that appear whole, and tone curves.

#include "support/SceneFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/ToneMap.h"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

/// What is told when something is brought to the disk: whether that is a folder. Its error number is returned.
std::function<int(bool)> onSync;

} // namespace

/// Stands before the system's, also for the library under test.
extern "C" __attribute__((visibility("default"))) int fsync(int descriptor) {
    struct stat status {};
    if (!onSync || ::fstat(descriptor, &status) != 0) return int(::syscall(SYS_fsync, descriptor));
    errno = onSync(S_ISDIR(status.st_mode));
    return errno == 0 ? 0 : -1;
}

namespace tungsten {
namespace {

using test::TemporaryFolder;

/// The bytes before the name, then the name: a crash leaves the old file or the new one.
TEST(AtomicFile, IsBroughtToTheDiskBeforeAndAfterItHasItsName) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.txt";
    std::vector<std::string> synced;
    onSync = [&](bool isFolder) {
        const std::string name = std::filesystem::exists(file) ? ", named" : ", unnamed";
        synced.push_back((isFolder ? "folder" : "file") + name);
        return 0;
    };
    writeAtomically(file, [](std::ostream& out) { out << "new"; });
    EXPECT_EQ(synced, (std::vector<std::string>{"file, unnamed", "folder, named"}));
    // A disk that fails then.
    onSync = [](bool isFolder) { return isFolder ? 0 : EIO; };
    EXPECT_THROW(writeAtomically(file, [](std::ostream& out) { out << "newer"; }), InputError);
    onSync = {};
    std::string content;
    std::ifstream(file) >> content;
    EXPECT_EQ(content, "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

/// However long its writer has not touched it.
TEST(AtomicFile, IsNotRemovedWhileItIsWritten) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.txt";
    writeAtomically(file, [&](std::ostream& out) {
        for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
            std::filesystem::last_write_time(entry,
                                             std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
        removeAbandonedFiles(folder.path());
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
        out << "whole";
    });
    EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(ToneMap, Values) {
    EXPECT_FLOAT_EQ(applyToneMap(ToneMap::Linear, Rgb(-1.0f)).x, 0.0f);
    EXPECT_NEAR(applyToneMap(ToneMap::Gamma, Rgb(0.5f)).x, 0.72974f, 1e-5f);
    EXPECT_NEAR(applyToneMap(ToneMap::Reinhard, Rgb(1.0f)).x, 0.72974f, 1e-5f);
    EXPECT_NEAR(applyToneMap(ToneMap::Pbrt, Rgb(0.002f)).x, 0.02584f, 1e-5f);
    EXPECT_NEAR(applyToneMap(ToneMap::Pbrt, Rgb(0.5f)).x, 0.735357f, 1e-5f);
    const double x = 0.496;
    EXPECT_NEAR(double(applyToneMap(ToneMap::Filmic, Rgb(0.5f)).x), x * (6.2 * x + 0.5) / (x * (6.2 * x + 1.7) + 0.06),
                1e-5);
    EXPECT_EQ(toLdr(Rgb(0.999f, 1.0f, 3.0f)), (std::array<uint8_t, 3>{254, 255, 255}));
    EXPECT_EQ(toneMapNames().size(), 5u);
}

} // namespace
} // namespace tungsten
