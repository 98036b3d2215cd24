// Disks that are full, or a quota: earlier files stay, and the command says so.

#include "app/rendered_scene.h"
#include "support/Folders.h"

#include "tungsten/core/Errors.h"
#include "tungsten/io/Result.h"
#include "tungsten/io/Writers.h"

#include <sys/mount.h>
#include <sys/resource.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;
using test::BadInput;
using test::CommandResult;
using test::contentOf;
using test::TemporaryFolder;

using FullDisk = test::RenderedScene;

/// Files of this process and its children end after so many bytes, as on a full disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, SIG_DFL);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit before_{};
};

/// A file system of so many KiB, if mounting is permitted.
class SmallDisk {
  public:
    SmallDisk(const fs::path& where, int kibibytes) : where_(where) {
        fs::create_directories(where);
        const std::string size = "size=" + std::to_string(kibibytes) + "k";
        mounted_ = ::mount("tmpfs", where.c_str(), "tmpfs", 0, size.c_str()) == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(where_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    [[nodiscard]] bool mounted() const { return mounted_; }
    [[nodiscard]] bool makeReadOnly() const {
        return ::mount("tmpfs", where_.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
    }

  private:
    fs::path where_;
    bool mounted_ = false;
};

/// Renders images of that type small, then larger while `Shortage` lasts: the second must fail and leave the first.
template <typename Render, typename Shortage>
void expectTheEarlierOnesKept(const fs::path& out, const Render& render, const Shortage& shortage,
                              const std::string& image = "box.exr") {
    ASSERT_EQ(render("8x8").exitCode, 0);
    const std::vector<fs::path> names{"box.png", image, "boxState.dat"};
    std::vector<std::string> before;
    for (const fs::path& name : names) before.push_back(contentOf(out / name));
    const CommandResult result = shortage();
    EXPECT_EQ(result.exitCode, BadInput) << result.all();
    for (size_t i = 0; i < names.size(); ++i) {
        EXPECT_NE(result.err.find(names[i].string() + ": cannot be written"), std::string::npos) << result.err;
        EXPECT_FALSE(before[i].empty());
        EXPECT_EQ(contentOf(out / names[i]), before[i]) << names[i];
    }
}

TEST_F(FullDisk, FilesThatCannotGrowLeaveTheEarlierOnes) {
    for (const std::string image : {"box.exr", "box.npz", "box.h5"}) {
        const auto run = [&](const std::string& size) {
            return render({"-e", image, "-c", "1h", "-r", "--resolution", size});
        };
        const auto runShort = [&] {
            const FileSizeLimit limit(1200);
            return run("64x64");
        };
        expectTheEarlierOnesKept(out(), run, runShort, image);
        EXPECT_EQ(filesOf(out()).size(), 3u) << "nothing is left behind";
        fs::remove(out() / image);
    }
}

/// What stands beside an array is that array's.
TEST_F(FullDisk, AnArrayThatFailsKeepsItsMetadata) {
    const auto run = [&](const std::string& size) { return render({"-e", "box.npy", "--resolution", size}); };
    ASSERT_EQ(run("8x8").exitCode, 0);
    const std::string before = contentOf(out() / "box.npy.json");
    const FileSizeLimit limit(30000); // enough for the text, not for 64 x 64 pixels
    EXPECT_EQ(run("64x64").exitCode, BadInput);
    EXPECT_EQ(contentOf(out() / "box.npy.json"), before);
}

/// Unless it is ignored, the signal ends whoever writes.
TEST_F(FullDisk, TheSignalOfTooLargeFilesEndsNothing) {
    const FileSizeLimit limit(40000); // enough for statistics, not for 64 x 64 pixels of four floats and more
    std::signal(SIGXFSZ, SIG_DFL);
    const CommandResult result = render({"-e", "box.npz", "--resolution", "64x64", "-c", "1h", "--stats",
                                         (out() / "stats.json").string(), "--html", (out() / "box.html").string()});
    EXPECT_EQ(result.exitCode, BadInput) << result.all();
    for (const char* const name : {"box.npz", "boxState.dat", "box.html"})
        EXPECT_NE(result.err.find(std::string(name) + ": cannot be written: File too large"), std::string::npos)
            << result.err;
    EXPECT_EQ(filesOf(out()), (std::vector<std::string>{"box.png", "stats.json"})) << "those that fit, and no others";
    const std::string list =
        (test::binaryFolder() / "tungsten").string() + " --describe > " + (folder() / "list").string() + " 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(list.c_str())), BadInput);
}

/// Where in the file the disk is full makes no difference.
TEST_F(FullDisk, ImagesAreWholeWhereverTheyAreCut) {
    const TemporaryFolder folder;
    Image image(40, 30);
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = Rgb(float(i * 7919 % 1013), 1.0f, float(i));
    const fs::path png = folder.path() / "a.png", exr = folder.path() / "a.exr", npy = folder.path() / "a.npy",
                   npz = folder.path() / "a.npz", hdf5 = folder.path() / "a.h5";
    const ResultContent content{image.width, image.height, 1, 3, {{"mean", [&](int) { return image; }}}, {}, "{}"};
    const auto writeAll = [&](int& failures) {
        const auto attempt = [&](auto write) {
            try {
                write();
            } catch (const InputError&) {
                ++failures;
            }
        };
        attempt([&] { writePng(png, image, ToneMap::Linear); });
        attempt([&] { writeExr(exr, {ExrPart{"", image, image, false, 0, 0}}); });
        attempt([&] { writeNpy(npy, {image}); });
        attempt([&] { writeNpz(npz, content); });
        attempt([&] { writeHdf5(hdf5, content); });
    };
    int failures = 0;
    writeAll(failures);
    ASSERT_EQ(failures, 0);
    const std::vector<fs::path> files{png, exr, npy, npz, hdf5};
    std::vector<std::string> whole;
    for (const fs::path& file : files) whole.push_back(contentOf(file));
    for (const std::string& bytes : whole)
        for (size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 60) {
            const FileSizeLimit limit(size);
            int failed = 0;
            writeAll(failed);
            EXPECT_GE(failed, 1) << size;
        }
    for (size_t i = 0; i < files.size(); ++i) EXPECT_EQ(contentOf(files[i]), whole[i]) << files[i];
    EXPECT_EQ(filesOf(folder.path()).size(), files.size());
}

TEST_F(FullDisk, AFullDiskLeavesTheEarlierFiles) {
    const SmallDisk disk(out(), 64);
    if (!disk.mounted()) GTEST_SKIP() << "mounting a small disk is not permitted here";
    const auto run = [&](const std::string& size) {
        return render({"-e", "box.exr", "-c", "1h", "-r", "--resolution", size});
    };
    expectTheEarlierOnesKept(out(), run, [&] {
        std::ofstream(out() / "rest") << std::string(1 << 20, 'x');
        return run("128x128");
    });
}

TEST_F(FullDisk, AReadOnlyFolderIsRefusedBeforeRendering) {
    const SmallDisk disk(out(), 1024);
    if (!disk.mounted()) GTEST_SKIP() << "mounting a small disk is not permitted here";
    ASSERT_EQ(render({"-e", "box.exr", "--resolution", "8x8"}).exitCode, 0);
    const std::string before = contentOf(out() / "box.exr");
    ASSERT_TRUE(disk.makeReadOnly());
    const CommandResult result = render({"-e", "box.exr", "-r"});
    EXPECT_EQ(result.exitCode, BadInput) << result.all();
    EXPECT_NE(result.err.find("cannot be created or written to; choose another with -d"), std::string::npos)
        << result.err;
    EXPECT_EQ(contentOf(out() / "box.exr"), before);
}

TEST_F(FullDisk, StandardOutputOnAFullDiskIsAnError) {
    for (const char* option : {"--list", "--version"}) {
        const std::string command =
            (test::binaryFolder() / "tungsten").string() + " " + option + " > /dev/full 2>/dev/null";
        const int status = std::system(command.c_str());
        EXPECT_EQ(WEXITSTATUS(status), BadInput) << option;
    }
}

} // namespace
} // namespace tungsten
