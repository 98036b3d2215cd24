#pragma once
// Files that appear whole or not at all.

#include <filesystem>

namespace tungsten {

/// A temporary file beside its destination: write to path(), then commit() renames it over the destination. Removed if
/// never committed.
class AtomicFile {
  public:
    /// Throws InputError naming the destination when its folder does not exist.
    explicit AtomicFile(std::filesystem::path destination);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
    void commit();

  private:
    std::filesystem::path destination_, temporary_;
    bool committed_ = false;
};

} // namespace tungsten
