#include "darts/EdaTableFile.h"

#include <atomic>
#include <cstring>
#include <fstream>
#include <type_traits>

#include <unistd.h>

namespace darts {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t Magic = 0x4144455354524144u; // "DARTSEDA"; differs on machines of the other byte order
constexpr std::uint32_t Version = 1;                 // of the layout, and of the mathematics behind the numbers

struct Header {
    std::uint64_t magic = Magic;
    std::uint32_t version = Version;
    float albedo = 0, g = 0, floor = 0;
    std::int32_t excessOctaves = 0, log2ExcessPerOctave = 0, lowestDepthLog2 = 0, depthOctaves = 0,
                 log2DepthPerOctave = 0;
    std::uint32_t rows = 0, floats = 0;
    std::uint32_t reserved = 0;
    std::uint64_t checksum = 0; // of the header with 0 here, and the contents
};
static_assert(sizeof(Header) == 64 && std::is_trivially_copyable_v<Header>);

Header headerOf(float albedo, float g, const EdaResolution& r) {
    Header header;
    header.albedo = albedo;
    header.g = g;
    header.floor = r.floor;
    header.excessOctaves = r.excessOctaves;
    header.log2ExcessPerOctave = r.log2ExcessPerOctave;
    header.lowestDepthLog2 = r.lowestDepthLog2;
    header.depthOctaves = r.depthOctaves;
    header.log2DepthPerOctave = r.log2DepthPerOctave;
    header.rows = std::uint32_t(r.excess().count() * r.depth().count());
    return header;
}

/// FNV-1a, 64 bits.
std::uint64_t hash(const void* bytes, size_t count, std::uint64_t state = 0xcbf29ce484222325u) {
    for (const auto* byte = static_cast<const unsigned char*>(bytes); count-- > 0; ++byte)
        state = (state ^ *byte) * 0x100000001b3u;
    return state;
}

std::uint64_t checksum(Header header, std::span<const std::uint8_t> octaves, std::span<const float> cumulative) {
    header.checksum = 0;
    return hash(cumulative.data(), cumulative.size_bytes(),
                hash(octaves.data(), octaves.size_bytes(), hash(&header, sizeof header)));
}

/// loadEdaTable() with the header that is expected.
std::optional<EdaTable> read(const fs::path& file, const Header& expected, const EdaResolution& resolution,
                             std::string& reason) {
    const auto unfit = [&](const char* why) {
        reason = why;
        return std::nullopt;
    };
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    std::ifstream stream(file, std::ios::binary);
    Header header;
    if (error || !stream) return unfit("cannot be read");
    if (!stream.read(reinterpret_cast<char*>(&header), sizeof header)) return unfit("is truncated");
    if (header.magic != Magic) return unfit("is not an EDA table");
    if (header.version != Version) return unfit("is of another version");
    Header comparable = header;
    comparable.floats = 0;
    comparable.checksum = 0;
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c): bit for bit, and without padding
    if (std::memcmp(&comparable, &expected, sizeof expected) != 0) return unfit("holds a table of other parameters");
    if (header.floats > header.rows * std::uint64_t(EdaTable::Row::strideOf(EdaTable::Row::MaxOctaves)))
        return unfit("is damaged");
    const std::uint64_t contents = header.rows + std::uint64_t(header.floats) * sizeof(float);
    if (size < sizeof header + contents) return unfit("is truncated");
    if (size > sizeof header + contents) return unfit("is damaged");
    std::vector<std::uint8_t> octaves(header.rows);
    std::vector<float> cumulative(header.floats);
    stream.read(reinterpret_cast<char*>(octaves.data()), std::streamsize(octaves.size()));
    stream.read(reinterpret_cast<char*>(cumulative.data()), std::streamsize(cumulative.size() * sizeof(float)));
    if (!stream) return unfit("cannot be read");
    if (checksum(header, octaves, cumulative) != header.checksum) return unfit("is damaged");
    auto table = EdaTable::restore(expected.albedo, expected.g, resolution, std::move(octaves), std::move(cumulative));
    if (!table) return unfit("is damaged");
    return table;
}

/// Beside the file, so that the rename stays on one file system; not shared with other threads or processes.
fs::path temporaryBeside(const fs::path& file) {
    static std::atomic<unsigned> count{0};
    fs::path temporary = file;
    temporary += ".tmp" + std::to_string(::getpid()) + "." + std::to_string(count++);
    return temporary;
}

bool write(const fs::path& file, const EdaTable& table, Header header) {
    header.floats = std::uint32_t(table.cumulative().size());
    header.checksum = checksum(header, table.octaves(), table.cumulative());
    const fs::path temporary = temporaryBeside(file);
    bool complete = false;
    {
        std::ofstream stream(temporary, std::ios::binary);
        stream.write(reinterpret_cast<const char*>(&header), sizeof header);
        stream.write(reinterpret_cast<const char*>(table.octaves().data()),
                     std::streamsize(table.octaves().size_bytes()));
        stream.write(reinterpret_cast<const char*>(table.cumulative().data()),
                     std::streamsize(table.cumulative().size_bytes()));
        stream.close();
        complete = bool(stream);
    }
    std::error_code error, ignored;
    if (complete) fs::rename(temporary, file, error);
    if (complete && !error) return true;
    fs::remove(temporary, ignored);
    return false;
}

} // namespace

std::optional<EdaTable> loadEdaTable(const fs::path& file, float albedo, float g, const EdaResolution& resolution,
                                     std::string& reason) {
    EdaTable::requireValid(albedo, g, resolution);
    return read(file, headerOf(albedo, g, resolution), resolution, reason);
}

CachedEdaTable loadOrBuildEdaTable(const fs::path& file, float albedo, float g, const EdaResolution& resolution,
                                   unsigned threads) {
    EdaTable::requireValid(albedo, g, resolution);
    const Header header = headerOf(albedo, g, resolution);
    std::error_code error;
    const fs::file_type type = fs::status(file, error).type();
    std::string reason;
    if (type == fs::file_type::regular) {
        if (auto table = read(file, header, resolution, reason)) return {std::move(*table), false, {}};
    } else if (type != fs::file_type::not_found) {
        reason = error ? "cannot be read" : "is not a file";
    }
    CachedEdaTable result{EdaTable::build(albedo, g, resolution, threads), true, {}};
    // Nothing but a file is ever renamed over: not a folder, not a device.
    const bool mayWrite = type == fs::file_type::regular || type == fs::file_type::not_found;
    const bool written = mayWrite && write(file, result.table, header);
    if (reason.empty() && written) return result;
    result.warning = "EDA table cache " + file.string() + " ";
    if (!reason.empty()) result.warning += reason + (written ? "; built anew" : "; built, and ");
    if (!written) result.warning += "cannot be written";
    return result;
}

} // namespace darts
