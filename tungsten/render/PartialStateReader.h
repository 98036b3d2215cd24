#pragma once
// Reading a partial state.

#include "tungsten/render/PartialState.h"

#include <fstream>
#include <string>
#include <vector>

namespace tungsten {

/// A partial state whose checksum has been looked at: it is as it was written.
class PartialStateReader {
  public:
    /// Throws InputError if the file is no partial state, damaged or of another version.
    explicit PartialStateReader(const std::filesystem::path& file);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const PartialIdentity& identity() const { return identity_; }
    /// Passes [first, end) of the render.
    [[nodiscard]] uint32_t first() const { return first_; }
    [[nodiscard]] uint32_t end() const { return first_ + uint32_t(samples_.size()); }
    /// Per pixel, by pass.
    [[nodiscard]] const std::vector<uint32_t>& samples() const { return samples_; }
    /// JSON, and CPU seconds of the process that wrote it.
    [[nodiscard]] const std::string& statistics() const { return statistics_; }
    [[nodiscard]] double cpuSeconds() const { return cpuSeconds_; }
    /// In what it is of another render; empty: in nothing.
    [[nodiscard]] std::string differenceTo(const PartialStateReader& other) const;
    /// Folds its passes into the film, in their order. Throws InputError if the file has changed.
    void fold(Film& film) const;

  private:
    std::filesystem::path file_;
    PartialIdentity identity_;
    std::string build_, statistics_;
    std::streampos passesAt_;
    uint32_t first_ = 0;
    std::vector<uint32_t> samples_;
    double cpuSeconds_ = 0.0;
};

} // namespace tungsten
