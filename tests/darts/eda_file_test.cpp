// The EDA table's cache file: what is written is read back, and whatever else stands there is replaced with a warning.

#include "support/SceneFile.h"

#include "darts/EdaTableFile.h"

#include "tungsten/core/Random.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <sstream>

#include <sys/resource.h>

namespace darts {
namespace {

namespace fs = std::filesystem;
using tungsten::RandomStream;
using tungsten::Sampler;

class EdaTableFile : public testing::Test {
  protected:
    static EdaResolution coarse() {
        EdaResolution resolution;
        resolution.excessOctaves = 4;
        resolution.depthOctaves = 5;
        resolution.log2ExcessPerOctave = resolution.log2DepthPerOctave = 0;
        return resolution;
    }
    [[nodiscard]] CachedEdaTable load() const { return loadOrBuildEdaTable(file(), 0.8f, 0.2f, coarse(), 1); }
    [[nodiscard]] fs::path file() const { return folder_.path() / "table.eda"; }
    [[nodiscard]] std::string contents() const {
        std::stringstream text;
        text << std::ifstream(file(), std::ios::binary).rdbuf();
        return text.str();
    }
    void write(const std::string& bytes) const { std::ofstream(file(), std::ios::binary) << bytes; }
    /// What is in the file now is replaced, with a warning holding `expected`, by a table that is good.
    void expectRebuilt(const std::string& expected) const {
        const CachedEdaTable rebuilt = load();
        EXPECT_TRUE(rebuilt.built);
        EXPECT_TRUE(rebuilt.table == good_) << expected;
        EXPECT_NE(rebuilt.warning.find(expected), std::string::npos) << rebuilt.warning;
        EXPECT_NE(rebuilt.warning.find(file().string()), std::string::npos) << rebuilt.warning;
        const CachedEdaTable again = load();
        EXPECT_FALSE(again.built);
        EXPECT_EQ(again.warning, "");
        EXPECT_TRUE(again.table == good_);
    }

    tungsten::test::TemporaryFolder folder_;
    EdaTable good_ = EdaTable::build(0.8f, 0.2f, coarse(), 1);
};

TEST_F(EdaTableFile, IsWrittenOnceAndReadBack) {
    const CachedEdaTable first = load();
    EXPECT_TRUE(first.built);
    EXPECT_EQ(first.warning, "");
    const auto written = fs::last_write_time(file());
    const CachedEdaTable second = load();
    EXPECT_FALSE(second.built);
    EXPECT_EQ(second.warning, "");
    EXPECT_EQ(fs::last_write_time(file()), written);
    EXPECT_TRUE(first.table == good_ && second.table == good_);
    EXPECT_EQ(second.table.pdf(0.5f, 0.4f, 2.0f, 0.1f), good_.pdf(0.5f, 0.4f, 2.0f, 0.1f));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "a temporary file was left";
}

TEST_F(EdaTableFile, ForeignAndTruncatedFilesAreReplaced) {
    (void)load();
    const std::string whole = contents();
    for (const size_t size : {size_t(0), size_t(1), size_t(63), size_t(64), size_t(70), whole.size() - 1}) {
        write(whole.substr(0, size));
        expectRebuilt("truncated");
    }
    write(whole + "x");
    expectRebuilt("damaged");
    write(std::string(1000, 'x'));
    expectRebuilt("not an EDA table");
    std::string version = whole;
    version[8] = char(version[8] + 1);
    write(version);
    expectRebuilt("another version");
}

TEST_F(EdaTableFile, EveryDamagedByteIsNoticed) {
    (void)load();
    const std::string whole = contents();
    for (size_t i = 0; i < 400; ++i) {
        Sampler sampler(1, RandomStream::Test, 0, i);
        const size_t position = i < 64 ? i : size_t(sampler.nextDouble() * double(whole.size()));
        std::string damaged = whole;
        damaged[position] = char(damaged[position] ^ (1 << (sampler.nextBits() % 8)));
        write(damaged);
        const CachedEdaTable rebuilt = load();
        ASSERT_TRUE(rebuilt.built) << position;
        ASSERT_NE(rebuilt.warning, "") << position;
        ASSERT_TRUE(rebuilt.table == good_) << position;
    }
}

TEST_F(EdaTableFile, OtherParametersAreNotTakenForThese) {
    const auto refuses = [&](float albedo, float g, const EdaResolution& resolution) {
        fs::remove(file());
        EXPECT_EQ(loadOrBuildEdaTable(file(), albedo, g, resolution, 1).warning, "");
        expectRebuilt("other parameters");
    };
    refuses(0.81f, 0.2f, coarse());
    refuses(0.8f, 0.21f, coarse());
    for (int EdaResolution::*const member :
         {&EdaResolution::excessOctaves, &EdaResolution::log2ExcessPerOctave, &EdaResolution::lowestDepthLog2,
          &EdaResolution::depthOctaves, &EdaResolution::log2DepthPerOctave}) {
        EdaResolution other = coarse();
        other.*member += 1;
        refuses(0.8f, 0.2f, other);
    }
    EdaResolution other = coarse();
    other.floor = 0.1f;
    refuses(0.8f, 0.2f, other);
}

TEST_F(EdaTableFile, PlacesThatCannotBeWrittenAreOnlyAWarning) {
    const fs::path nowhere = folder_.path() / "missing" / "table.eda";
    CachedEdaTable table = loadOrBuildEdaTable(nowhere, 0.8f, 0.2f, coarse(), 1);
    EXPECT_TRUE(table.built && table.table == good_);
    EXPECT_NE(table.warning.find("cannot be written"), std::string::npos) << table.warning;

    fs::create_directory(file());
    table = load();
    EXPECT_TRUE(table.built && table.table == good_);
    EXPECT_NE(table.warning.find("is not a file"), std::string::npos) << table.warning;
    EXPECT_TRUE(fs::is_directory(file()));

    // A file where a folder is named.
    fs::remove(file());
    write("x");
    table = loadOrBuildEdaTable(file() / "table.eda", 0.8f, 0.2f, coarse(), 1);
    EXPECT_TRUE(table.built && table.table == good_);
    EXPECT_NE(table.warning, "");
    EXPECT_EQ(contents(), "x");
    EXPECT_THROW((void)loadOrBuildEdaTable(nowhere, 2.0f, 0.2f), std::invalid_argument);
}

TEST_F(EdaTableFile, LinksAreNeitherReadNorWrittenThrough) {
    (void)load();
    const fs::path other = folder_.path() / "other.eda";
    fs::rename(file(), other);
    const auto expectLeft = [&](const fs::path& target) {
        fs::remove(file());
        fs::create_symlink(target, file());
        const CachedEdaTable table = load();
        EXPECT_TRUE(table.built && table.table == good_);
        EXPECT_NE(table.warning.find("is a link"), std::string::npos) << table.warning;
        EXPECT_EQ(fs::read_symlink(file()), target);
    };
    expectLeft(other);
    expectLeft(folder_.path() / "missing.eda");
    EXPECT_FALSE(fs::exists(folder_.path() / "missing.eda"));
}

TEST_F(EdaTableFile, AnotherUsersFileIsNotTrusted) {
    if (::geteuid() != 0) GTEST_SKIP() << "files are given away by root alone";
    (void)load();
    const std::string whole = contents();
    ASSERT_EQ(::chown(file().c_str(), 12345, 12345), 0);
    const CachedEdaTable table = load();
    EXPECT_TRUE(table.built && table.table == good_);
    EXPECT_NE(table.warning.find("belongs to another user"), std::string::npos) << table.warning;
    EXPECT_EQ(contents(), whole);
}

/// Names that can be foreseen could be links to what the user may overwrite.
TEST_F(EdaTableFile, TheTemporaryNameIsNotForeseen) {
    const fs::path victim = folder_.path() / "victim";
    std::ofstream(victim) << "precious";
    for (int i = 0; i < 200; ++i)
        fs::create_symlink(victim, file().string() + ".tmp" + std::to_string(::getpid()) + "." + std::to_string(i));
    EXPECT_EQ(load().warning, "");
    std::stringstream left;
    left << std::ifstream(victim).rdbuf();
    EXPECT_EQ(left.str(), "precious");
}

/// While it lives, files of this process end after so many bytes, as on a full disk.
class ShortFiles {
  public:
    explicit ShortFiles(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~ShortFiles() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    ShortFiles(const ShortFiles&) = delete;
    ShortFiles& operator=(const ShortFiles&) = delete;

  private:
    rlimit before_{};
    void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

TEST_F(EdaTableFile, WhatCannotBeWrittenWholeLeavesNothing) {
    const auto files = [&] { return std::distance(fs::directory_iterator(folder_.path()), {}); };
    const auto loadShort = [&] {
        const ShortFiles disk(100);
        return load();
    };
    CachedEdaTable table = loadShort();
    EXPECT_TRUE(table.built && table.table == good_);
    EXPECT_NE(table.warning.find("cannot be written"), std::string::npos) << table.warning;
    EXPECT_EQ(files(), 0) << "a part of the file was left";
    write("x");
    table = loadShort();
    EXPECT_TRUE(table.built && table.table == good_);
    EXPECT_EQ(contents(), "x");
    EXPECT_EQ(files(), 1) << "a part of the file was left beside the old one";
}

TEST_F(EdaTableFile, ContentsThatAreNoTableAreRefused) {
    // As after a forged checksum.
    const std::vector<std::uint8_t> octaves(good_.octaves().begin(), good_.octaves().end());
    const std::vector<float> cumulative(good_.cumulative().begin(), good_.cumulative().end());
    const auto restores = [&](auto octavesOf, auto cumulativeOf) {
        return EdaTable::restore(0.8f, 0.2f, coarse(), octavesOf, cumulativeOf).has_value();
    };
    EXPECT_TRUE(restores(octaves, cumulative));
    for (const auto damage : {0, 41, 255}) {
        auto other = octaves;
        other[3] = std::uint8_t(damage);
        EXPECT_FALSE(restores(other, cumulative)) << damage;
    }
    for (const float damage : {-1.0f, 0.0f, 1.0f, 2.0f, NAN})
        for (const size_t position : {size_t(5), cumulative.size() - 1}) {
            if (damage == 1.0f && position != 5) continue;
            auto other = cumulative;
            other[position] = damage;
            EXPECT_FALSE(restores(octaves, other)) << damage << " " << position;
        }
    auto shorter = cumulative;
    shorter.pop_back();
    EXPECT_FALSE(restores(octaves, shorter));
    auto fewer = octaves;
    fewer.pop_back();
    EXPECT_FALSE(restores(fewer, cumulative));
}

} // namespace
} // namespace darts
