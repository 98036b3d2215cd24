#pragma once
// A scene file in a temporary folder of its own, removed with it.

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace tungsten::test {

class TemporaryFolder {
  public:
    TemporaryFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("tungsten_test_" + std::to_string(::getpid()) + "_" + std::to_string(count_++))) {
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    static inline int count_ = 0;
    std::filesystem::path path_;
};

/// Files written byte by byte, in a folder of their own.
class FileFolder {
  public:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }
    [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  private:
    TemporaryFolder folder_;
};

class SceneFile {
  public:
    explicit SceneFile(const std::string& json) { write(json); }
    void write(const std::string& json) const { folder_.write("scene.json", json); }
    [[nodiscard]] std::filesystem::path path() const { return folder_.path("scene.json"); }

  private:
    FileFolder folder_;
};

} // namespace tungsten::test
