#include "tungsten/image/Checksum.h"

#include <vector>

namespace tungsten {

std::streamsize ChecksumBuffer::xsputn(const char* bytes, std::streamsize count) {
    hash_.addBytes(bytes, size_t(count));
    return target_.sputn(bytes, count);
}

ChecksumBuffer::int_type ChecksumBuffer::overflow(int_type c) {
    const char byte = traits_type::to_char_type(c);
    return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
}

bool endsWithChecksum(std::istream& in, uint64_t size) {
    constexpr uint64_t ChunkSize = 1 << 16;
    uint64_t left = size - std::min<uint64_t>(size, sizeof(uint64_t)), stored = 0;
    std::vector<char> chunk(ChunkSize);
    Hash hash;
    while (left > 0 && in) {
        const uint64_t count = std::min(left, ChunkSize);
        in.read(chunk.data(), std::streamsize(count));
        hash.addBytes(chunk.data(), size_t(in.gcount()));
        left -= count;
    }
    in.read(reinterpret_cast<char*>(&stored), sizeof stored);
    return in && stored == hash.value();
}

} // namespace tungsten
