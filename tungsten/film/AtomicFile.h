#pragma once
// Files that appear whole or not at all.

#include <filesystem>

namespace tungsten {

/// A temporary file beside its target: write to path(), then commit() renames it over the target. Removed if never
/// committed.
class AtomicFile {
  public:
    /// Throws InputError naming the target when its folder does not exist.
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
    void commit();

  private:
    std::filesystem::path target_, temporary_;
    bool committed_ = false;
};

} // namespace tungsten
