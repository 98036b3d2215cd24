#pragma once
// Files that end with the checksum of all their other bytes.

#include "tungsten/core/Hash.h"

#include <istream>
#include <streambuf>

namespace tungsten {

/// Passes bytes on and takes their checksum.
class ChecksumBuffer : public std::streambuf {
  public:
    explicit ChecksumBuffer(std::streambuf& target) : target_(target) {}
    [[nodiscard]] uint64_t checksum() const { return hash_.value(); }

  protected:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override;
    int_type overflow(int_type c) override;

  private:
    std::streambuf& target_;
    Hash hash_;
};

/// Whether a file of so many bytes, read from its start, ends with the checksum of all its other bytes.
bool endsWithChecksum(std::istream& in, uint64_t size);

} // namespace tungsten
