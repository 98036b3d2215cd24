#pragma once
// Small image files written byte by byte, so that the decoders are tested against the formats and not against a writer.

#include "support/SceneFile.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace tungsten::test {

/// One 8-bit texel.
using Texel = std::array<uint8_t, 4>;

inline void append16(std::string& out, int value) {
    out += char(value & 255);
    out += char(value >> 8);
}
inline void append32BigEndian(std::string& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out += char(value >> shift);
}

/// Uncompressed TGA, 24 or 32 bits, rows top down; texels in row order from the top left.
inline std::string tga(int width, int height, const std::vector<Texel>& texels, bool alpha) {
    std::string out("\0\0\2\0\0\0\0\0\0\0\0\0", 12);
    append16(out, width);
    append16(out, height);
    out += char(alpha ? 32 : 24);
    out += char(0x20 | (alpha ? 8 : 0));
    for (const Texel& t : texels) {
        out += {char(t[2]), char(t[1]), char(t[0])};
        if (alpha) out += char(t[3]);
    }
    return out;
}

/// Run-length encoded 24-bit TGA, rows bottom up, one packet per row of a single colour.
inline std::string tgaRle(int width, const std::vector<Texel>& rowsFromTop) {
    std::string out("\0\0\12\0\0\0\0\0\0\0\0\0", 12);
    append16(out, width);
    append16(out, int(rowsFromTop.size()));
    out += {char(24), char(0)};
    for (auto row = rowsFromTop.rbegin(); row != rowsFromTop.rend(); ++row)
        out += {char(0x80 | (width - 1)), char((*row)[2]), char((*row)[1]), char((*row)[0])};
    return out;
}

inline uint32_t crc32(const std::string& bytes) {
    uint32_t crc = ~0u;
    for (const char c : bytes) {
        crc ^= uint8_t(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    return ~crc;
}
inline void appendChunk(std::string& out, const std::string& type, const std::string& content) {
    append32BigEndian(out, uint32_t(content.size()));
    out += type + content;
    append32BigEndian(out, crc32(type + content));
}

/// PNG of 3 (RGB) or 4 (RGBA) channels with one stored (not compressed) deflate block.
inline std::string png(int width, int height, const std::vector<Texel>& texels, int channels) {
    std::string raw;
    for (int y = 0; y < height; ++y) {
        raw += '\0';
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) raw += char(texels[size_t(y * width + x)][size_t(c)]);
    }
    uint32_t a = 1, b = 0;
    for (const char c : raw) {
        a = (a + uint8_t(c)) % 65521;
        b = (b + a) % 65521;
    }
    std::string zlib("\x78\x01\x01", 3);
    append16(zlib, int(raw.size()));
    append16(zlib, int(~raw.size() & 0xffff));
    zlib += raw;
    append32BigEndian(zlib, (b << 16) | a);
    std::string header;
    append32BigEndian(header, uint32_t(width));
    append32BigEndian(header, uint32_t(height));
    header += {char(8), char(channels == 4 ? 6 : 2), char(0), char(0), char(0)};
    std::string out("\x89PNG\r\n\x1a\n", 8);
    appendChunk(out, "IHDR", header);
    appendChunk(out, "IDAT", zlib);
    appendChunk(out, "IEND", "");
    return out;
}

/// Little-endian colour PFM; values in row order from the top left (the file stores the bottom row first).
inline std::string pfm(int width, int height, const std::vector<float>& rgb) {
    std::string out = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1\n";
    const size_t row = size_t(width) * 3 * sizeof(float);
    for (int y = height - 1; y >= 0; --y) out.append(reinterpret_cast<const char*>(rgb.data()) + size_t(y) * row, row);
    return out;
}

/// Flat (not run-length encoded) Radiance file; each texel is a shared-exponent quadruple.
inline std::string radiance(int width, int height, const std::vector<Texel>& rgbe) {
    std::string out =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    for (const Texel& t : rgbe) out.append(reinterpret_cast<const char*>(t.data()), 4);
    return out;
}

/// Lines of one colour each, as runs; of 8 to 127 texels.
inline std::string radianceRuns(int width, const std::vector<Texel>& lines) {
    std::string out = radiance(width, int(lines.size()), {});
    for (const Texel& rgbe : lines) {
        out += {'\2', '\2', '\0', char(width)};
        for (const uint8_t value : rgbe)
            out += {char(128 + width - 3), char(value), '\3', char(value), char(value), char(value)};
    }
    return out;
}

} // namespace tungsten::test
