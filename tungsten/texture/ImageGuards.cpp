#include "tungsten/texture/ImageGuards.h"

#include "tungsten/core/Errors.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace tungsten {

namespace {

constexpr int64_t MostTexels = int64_t(1) << 27;
constexpr std::string_view ExrStart = "\x76\x2f\x31\x01";

uint8_t byteAt(std::string_view bytes, size_t position) {
    return static_cast<uint8_t>(bytes[position]);
}

/// Throws if a table definition (the content of a DHT segment) holds a table of more than 256 codes.
void requireSaneTables(std::string_view content, const std::filesystem::path& file) {
    constexpr size_t Lengths = 16, TableHeader = 1 + Lengths, MostCodes = 256;
    while (content.size() >= TableHeader) {
        size_t codes = 0;
        for (size_t i = 1; i <= Lengths; ++i) codes += byteAt(content, i);
        if (codes > MostCodes) throw InputError(file.string(), "not a readable image: a corrupt Huffman table");
        content.remove_prefix(std::min(content.size(), TableHeader + codes));
    }
    // A rest too short to be a table: stb would read it from what follows.
    if (!content.empty()) throw InputError(file.string(), "not a readable image: a truncated Huffman table");
}

uint32_t wordAt(std::string_view bytes, size_t position) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + position, sizeof word);
    return word;
}

/// Throws if a channel of an EXR image (of the content of an attribute of type chlist) has one sample for an absurd
/// number of pixels: OpenEXR sizes its line buffers by that.
void requireSaneSampling(std::string_view channels, const std::filesystem::path& file) {
    constexpr size_t SamplingAt = 8, Size = 16; // after the name: type, linearity, and the sampling in x and y
    constexpr uint32_t Coarsest = 16;
    const auto nameLength = [&] {
        const size_t end = channels.find('\0');
        if (end == std::string_view::npos)
            throw InputError(file.string(), "not a readable EXR image: corrupt channels");
        return end;
    };
    for (size_t end = nameLength(); end > 0; end = nameLength()) {
        const std::string name(channels.substr(0, end));
        channels.remove_prefix(end + 1);
        if (channels.size() < Size) throw InputError(file.string(), "not a readable EXR image: truncated channels");
        for (const size_t at : {SamplingAt, SamplingAt + sizeof(uint32_t)})
            if (const uint32_t step = wordAt(channels, at); step == 0 || step > Coarsest)
                throw InputError(file.string(), "not a readable EXR image: channel '" + name + "' has a sample every " +
                                                    std::to_string(step) + " pixels; accepted: 1 to " +
                                                    std::to_string(Coarsest));
        channels.remove_prefix(Size);
    }
    if (channels.size() != 1) throw InputError(file.string(), "not a readable EXR image: corrupt channels");
}

/// Of attributes whose content has one size; OpenEXR reads that much, whatever size the file tells.
std::optional<uint32_t> sizeOfType(std::string_view type) {
    constexpr std::pair<std::string_view, uint32_t> Sizes[] = {
        {"box2f", 16}, {"box2i", 16}, {"chromaticities", 32}, {"compression", 1}, {"double", 8},   {"envmap", 1},
        {"float", 4},  {"int", 4},    {"keycode", 28},        {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
        {"m44d", 128}, {"m44f", 64},  {"rational", 8},        {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
        {"v2f", 8},    {"v2i", 8},    {"deepImageState", 1},  {"v3d", 24},        {"v3f", 12},     {"v3i", 12}};
    for (const auto& [name, size] : Sizes)
        if (name == type) return size;
    return std::nullopt;
}

/// Deflate reaches 1032 : 1, and a texel has from 1 to 64 bits by the header.
int64_t pngTexelsPerByte(std::string_view bytes) {
    constexpr size_t DepthAt = 24, ColourTypeAt = 25;
    constexpr int64_t MostDeflated = 1032;
    if (bytes.size() <= ColourTypeAt) return MostDeflated;
    const int channels[] = {1, 1, 3, 1, 2, 1, 4, 1}; // by colour type
    const int bits = std::clamp(int(bytes[DepthAt]), 1, 16) * channels[bytes[ColourTypeAt] & 7];
    return std::max(MostDeflated * 8 / bits, int64_t(1));
}

/// The lines of pixels: after an empty line of the header, and that of the resolution.
std::string_view radianceScanlines(std::string_view bytes) {
    const size_t end = bytes.find("\n\n"), resolution = end == std::string_view::npos ? end : bytes.find('\n', end + 2);
    return resolution == std::string_view::npos ? std::string_view() : bytes.substr(resolution + 1);
}

/// Removes the runs of one component of a line; false if they are corrupt or end too soon.
bool skipRadianceRuns(std::string_view& bytes, int width) {
    constexpr uint8_t LongestLiteral = 128; // above: so many less times one value
    while (width > 0) {
        if (bytes.empty()) return false;
        const uint8_t code = byteAt(bytes, 0);
        const bool repeats = code > LongestLiteral;
        const int count = repeats ? code - LongestLiteral : code;
        const size_t stored = 1 + (repeats ? 1 : size_t(count));
        if (count == 0 || count > width || stored > bytes.size()) return false;
        bytes.remove_prefix(stored);
        width -= count;
    }
    return true;
}

/// At most. Those without a case of their own know runs, of 128 texels in two bytes.
int64_t texelsPerByte(std::string_view bytes) {
    constexpr int64_t Packed = 1 << 12, Runs = 64;
    if (isPng(bytes)) return pngTexelsPerByte(bytes);
    return isJpeg(bytes) || bytes.starts_with("GIF8") || bytes.starts_with(ExrStart) ? Packed : Runs;
}

} // namespace

void requirePlausibleSize(int64_t width, int64_t height, std::string_view bytes, const std::filesystem::path& file) {
    const int64_t largest = std::min(MostTexels, int64_t(bytes.size()) * texelsPerByte(bytes));
    if (width <= 0 || height <= 0 || width > largest / height)
        throw InputError(file.string(), "claims to be " + std::to_string(width) + "x" + std::to_string(height) +
                                            " texels, more than a file of " + std::to_string(bytes.size()) +
                                            " bytes can hold, or than the " + std::to_string(MostTexels) + " accepted");
}

bool isPng(std::string_view bytes) {
    return bytes.starts_with("\x89PNG");
}

void requireSanePngChunks(std::string_view bytes, const std::filesystem::path& file) {
    constexpr size_t Signature = 8, Overhead = 12; // length, type and checksum of a chunk
    for (size_t position = Signature; position < bytes.size();) {
        if (bytes.size() - position < Overhead) throw InputError(file.string(), "not a readable image: truncated");
        uint32_t length = 0;
        for (size_t i = 0; i < 4; ++i) length = (length << 8) | static_cast<unsigned char>(bytes[position + i]);
        if (length > bytes.size() - position - Overhead)
            throw InputError(file.string(), "not a readable image: a chunk claims more bytes than there are");
        if (bytes.substr(position + 4, 4) == "IEND") return;
        position += Overhead + length;
    }
}

bool isJpeg(std::string_view bytes) {
    // Filling bytes before the start marker are allowed.
    const size_t marker = bytes.find_first_not_of('\xff');
    return marker != std::string_view::npos && marker > 0 && bytes[marker] == '\xd8';
}

void requireSaneJpegTables(std::string_view bytes, const std::filesystem::path& file) {
    constexpr uint8_t DefineTables = 0xC4, EndOfImage = 0xD9;
    // Markers without content: stuffed bytes, TEM, restarts and the start of the image.
    const auto standsAlone = [](uint8_t marker) { return marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD8); };
    size_t position = 0;
    while ((position = bytes.find('\xff', position)) != std::string_view::npos) {
        position = bytes.find_first_not_of('\xff', position);
        if (position == std::string_view::npos) return;
        const uint8_t marker = byteAt(bytes, position++);
        if (marker == EndOfImage) return;
        if (standsAlone(marker)) continue;
        if (bytes.size() - position < 2) return;
        const size_t length = size_t(byteAt(bytes, position)) << 8 | byteAt(bytes, position + 1);
        const size_t end = std::min(position + std::max<size_t>(length, 2), bytes.size());
        if (marker == DefineTables) requireSaneTables(bytes.substr(position + 2, end - position - 2), file);
        position = end;
    }
}

bool isRadiance(std::string_view bytes) {
    return bytes.starts_with("#?RADIANCE\n") || bytes.starts_with("#?RGBE\n");
}

void requireSaneRadianceRuns(std::string_view bytes, int width, int height, const std::filesystem::path& file) {
    constexpr int Narrowest = 8, Widest = 32767; // of images that have runs
    constexpr size_t LineStart = 4;              // two marks, and the width again
    constexpr int Components = 4;
    if (width < Narrowest || width > Widest) return;
    const auto fail = [&]() -> InputError {
        return {file.string(), "not a readable image: corrupt or truncated runs"};
    };
    std::string_view rest = radianceScanlines(bytes);
    for (int line = 0; line < height; ++line) {
        if (rest.size() < LineStart) throw fail();
        if (rest[0] != 2 || rest[1] != 2 || byteAt(rest, 2) >= 0x80) return; // from here on pixels without runs
        rest.remove_prefix(LineStart);
        for (int component = 0; component < Components; ++component)
            if (!skipRadianceRuns(rest, width)) throw fail();
    }
}

void requireSaneExrAttributes(std::string_view bytes, const std::filesystem::path& file) {
    constexpr size_t HeaderStart = 8;
    const auto fail = [&]() -> InputError {
        return {file.string(), "not a readable EXR image: corrupt or truncated header"};
    };
    if (bytes.size() < HeaderStart) throw fail();
    const bool multiPart = (static_cast<unsigned char>(bytes[5]) & 0x10) != 0;
    size_t position = HeaderStart;
    const auto skipName = [&] {
        const size_t end = bytes.find('\0', position);
        if (end == std::string_view::npos) throw fail();
        const size_t length = end - position;
        position = end + 1;
        return length;
    };
    for (bool inHeaders = true; inHeaders;) {
        size_t attributes = 0;
        for (; skipName() > 0; ++attributes) {
            const size_t typeAt = position, typeLength = skipName();
            if (bytes.size() - position < sizeof(uint32_t)) throw fail();
            const uint32_t size = wordAt(bytes, position);
            position += sizeof(size);
            if (size > bytes.size() - position) throw fail();
            const std::string_view type = bytes.substr(typeAt, typeLength);
            if (sizeOfType(type).value_or(size) != size) throw fail();
            if (type == "chlist") requireSaneSampling(bytes.substr(position, size), file);
            position += size;
        }
        inHeaders = multiPart && attributes > 0; // an empty header ends the list of parts
    }
}

} // namespace tungsten
