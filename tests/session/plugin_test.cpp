// Finding and loading plugins: what works, and what a broken one says.

#include "support/Folders.h"
#include "support/SceneFile.h"

#include "tungsten/session/Job.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include <dlfcn.h>
#include <sys/stat.h>

namespace tungsten {
namespace {

namespace fs = std::filesystem;

const fs::path Faulty = test::binaryFolder().parent_path() / "faulty_plugins";

std::string problemsOf(const fs::path& directory, IntegratorRegistry& registry) {
    std::string text;
    for (const Problem& problem : loadPlugins({directory}, registry)) text += problem.text() + "\n";
    return text;
}

/// A folder that holds one file under a plugin's name.
class PluginFolder {
  public:
    explicit PluginFolder(const fs::path& original) : PluginFolder() { fs::copy_file(original, file()); }
    explicit PluginFolder(const std::string& content) : PluginFolder() { std::ofstream(file()) << content; }
    [[nodiscard]] const fs::path& path() const { return folder_.path(); }
    [[nodiscard]] fs::path file() const { return folder_.path() / "libtungsten-odd.so"; }

  private:
    PluginFolder() = default;
    test::TemporaryFolder folder_;
};

TEST(Plugin, TheShippedOnesLoadAndSayWhereTheyComeFrom) {
    IntegratorRegistry registry;
    EXPECT_EQ(problemsOf(test::binaryFolder(), registry), "");
    for (const char* type : {"path_tracer", "progressive_photon_map", "progressive_transient_photon_map"}) {
        ASSERT_EQ(registry.entries().count(type), 1u) << type;
        EXPECT_NE(registry.entries().at(type).origin.find("libtungsten-"), std::string::npos);
        EXPECT_FALSE(registry.entries().at(type).description.empty());
    }
}

TEST(Plugin, OfEqualFileNamesTheFirstDirectoryWins) {
    const test::TemporaryFolder folder;
    fs::copy_file(test::binaryFolder() / "libtungsten-path.so", folder.path() / "libtungsten-path.so");
    IntegratorRegistry registry;
    EXPECT_TRUE(loadPlugins({folder.path(), test::binaryFolder()}, registry).empty());
    EXPECT_EQ(fs::path(registry.entries().at("path_tracer").origin).parent_path(), folder.path());
}

TEST(Plugin, MissingDirectoriesAndOtherFilesAreNoProblem) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "libother.so") << "not ours";
    std::ofstream(folder.path() / "libtungsten-notes.txt") << "not ours either";
    IntegratorRegistry registry;
    EXPECT_EQ(problemsOf(folder.path(), registry), "");
    EXPECT_EQ(problemsOf(folder.path() / "nowhere", registry), "");
    EXPECT_TRUE(registry.entries().empty());
}

TEST(Plugin, ABrokenFileIsNamedAndTheOthersStillLoad) {
    const PluginFolder garbage(std::string("this is no shared object"));
    IntegratorRegistry registry;
    const std::vector<Problem> problems = loadPlugins({garbage.path(), test::binaryFolder()}, registry);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].file, garbage.file().string());
    EXPECT_NE(problems[0].message.find("cannot be loaded"), std::string::npos) << problems[0].message;
    EXPECT_EQ(registry.entries().count("path_tracer"), 1u);
}

/// Mapped and touched beyond its end, it would end the process.
TEST(Plugin, ATruncatedFileIsNamed) {
    const fs::path original = test::binaryFolder() / "libtungsten-path.so";
    const auto size = fs::file_size(original);
    for (const std::uintmax_t length : {std::uintmax_t(0), std::uintmax_t(20), std::uintmax_t(64), std::uintmax_t(300),
                                        size / 4, size / 2, size * 3 / 4}) {
        const PluginFolder folder(original);
        fs::resize_file(folder.file(), length);
        IntegratorRegistry registry;
        EXPECT_NE(problemsOf(folder.path(), registry).find("cannot be loaded"), std::string::npos) << length;
        EXPECT_TRUE(registry.entries().empty());
    }
}

TEST(Plugin, APipeIsNotWaitedFor) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder.path() / "libtungsten-pipe.so").c_str(), 0600), 0);
    IntegratorRegistry registry;
    EXPECT_NE(problemsOf(folder.path(), registry).find("not a file"), std::string::npos);
}

TEST(Plugin, AMissingEntryPointIsNamed) {
    const PluginFolder host(test::binaryFolder() / "libtungsten.so");
    IntegratorRegistry registry;
    EXPECT_NE(problemsOf(host.path(), registry).find("does not define tungstenPlugin()"), std::string::npos);
}

TEST(Plugin, AnotherAbiIsRefusedWithBothAbisInTheMessage) {
    const PluginFolder folder(Faulty / "libtungsten-wrong_abi.so");
    IntegratorRegistry registry;
    const std::string text = problemsOf(folder.path(), registry);
    EXPECT_NE(text.find("tungsten-plugin-0/unknown"), std::string::npos) << text;
    EXPECT_NE(text.find(PluginAbi), std::string::npos) << text;
}

TEST(Plugin, OneBuiltAgainstOtherHeadersIsRefused) {
    const PluginFolder folder(Faulty / "libtungsten-stale_layout.so");
    IntegratorRegistry registry;
    EXPECT_NE(problemsOf(folder.path(), registry).find("other headers"), std::string::npos);
}

TEST(Plugin, AnIntegratorNameHasOneOwner) {
    const PluginFolder folder(Faulty / "libtungsten-registers_twice.so");
    IntegratorRegistry registry;
    const std::string text = problemsOf(folder.path(), registry);
    EXPECT_NE(text.find("registers the integrator 'twin'"), std::string::npos) << text;
    EXPECT_EQ(registry.entries().at("twin").description, "the first");
}

TEST(Plugin, DirectoriesComeFromTheVariableAndTheExecutable) {
    ::setenv("TUNGSTEN_PLUGIN_PATH", "/first::/second", 1);
    const std::vector<fs::path> directories = pluginDirectories();
    ::unsetenv("TUNGSTEN_PLUGIN_PATH");
    ASSERT_EQ(directories.size(), 4u);
    EXPECT_EQ(directories[0], "/first");
    EXPECT_EQ(directories[1], "/second");
    EXPECT_EQ(directories[2], fs::read_symlink("/proc/self/exe").parent_path());
    EXPECT_EQ(directories[3].filename(), "tungsten");
}

/// A library whose file is gone does not know where it lay.
TEST(Plugin, NoneIsSoughtInTheCurrentFolder) {
    using Directories = std::vector<fs::path> (*)();
    const test::TemporaryFolder folder;
    const fs::path copy = folder.path() / "libhost.so";
    fs::copy_file(test::binaryFolder() / "libtungsten.so", copy);
    void* const library = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library, nullptr) << dlerror();
    const auto directories = reinterpret_cast<Directories>(dlsym(library, "_ZN8tungsten17pluginDirectoriesB5cxx11Ev"));
    ASSERT_NE(directories, nullptr) << dlerror();
    const auto holds = [](const std::vector<fs::path>& all, const fs::path& one) {
        return std::find(all.begin(), all.end(), one) != all.end();
    };
    EXPECT_TRUE(holds(directories(), fs::canonical(folder.path())));
    fs::remove(copy);
    for (const fs::path& directory : directories()) EXPECT_TRUE(directory.is_absolute()) << directory;
    EXPECT_TRUE(holds(directories(), test::binaryFolder())) << "the executable's";
    dlclose(library);
}

} // namespace
} // namespace tungsten
