#include "darts/EdaTableFile.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <type_traits>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
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

/// An open file, closed at its end.
class OpenFile {
  public:
    explicit OpenFile(int descriptor = -1) : descriptor_(descriptor) {}
    ~OpenFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    OpenFile& operator=(OpenFile&&) = delete;

    [[nodiscard]] bool isOpen() const { return descriptor_ >= 0; }
    /// Zeroes for what is not known.
    [[nodiscard]] struct stat status() const {
        struct stat status {};
        ::fstat(descriptor_, &status);
        return status;
    }
    /// False unless all of it was read, or written.
    [[nodiscard]] bool read(void* bytes, size_t count) const {
        return whole(count, [&](size_t at) { return ::read(descriptor_, static_cast<char*>(bytes) + at, count - at); });
    }
    [[nodiscard]] bool write(const void* bytes, size_t count) const {
        return whole(count,
                     [&](size_t at) { return ::write(descriptor_, static_cast<const char*>(bytes) + at, count - at); });
    }

  private:
    template <typename Transfer>
    static bool whole(size_t count, const Transfer& transfer) {
        for (size_t at = 0; at < count;) {
            const ssize_t some = transfer(at);
            if (some == 0 || (some < 0 && errno != EINTR)) return false;
            at += some > 0 ? size_t(some) : 0;
        }
        return true;
    }

    int descriptor_;
};

/// loadEdaTable() with the header that is expected, of a file that has been opened.
std::optional<EdaTable> read(const OpenFile& file, const Header& expected, const EdaResolution& resolution,
                             std::string& reason) {
    const auto unfit = [&](const char* why) {
        reason = why;
        return std::nullopt;
    };
    const auto size = std::uint64_t(file.status().st_size);
    Header header;
    if (!file.isOpen()) return unfit("cannot be read");
    if (!file.read(&header, sizeof header)) return unfit("is truncated");
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
    if (!file.read(octaves.data(), octaves.size()) || !file.read(cumulative.data(), cumulative.size() * sizeof(float)))
        return unfit("cannot be read");
    if (checksum(header, octaves, cumulative) != header.checksum) return unfit("is damaged");
    auto table = EdaTable::restore(expected.albedo, expected.g, resolution, std::move(octaves), std::move(cumulative));
    if (!table) return unfit("is damaged");
    return table;
}

/// The file of a cache, if nobody else can have put another in its place: links are not followed, and it must be this
/// user's or root's. Otherwise `reason` says what it is; empty where there is none.
OpenFile openTrusted(const fs::path& file, std::string& reason) {
    OpenFile opened(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (!opened.isOpen()) {
        reason = errno == ENOENT ? "" : errno == ELOOP ? "is a link" : "cannot be read";
        return opened;
    }
    const struct stat status = opened.status();
    const bool regular = S_ISREG(status.st_mode), own = status.st_uid == ::geteuid() || status.st_uid == 0;
    if (regular && own) return opened;
    reason = regular ? "belongs to another user" : "is not a file";
    return OpenFile();
}

/// Beside the file, so that the rename stays on one file system, and new, under a name that nobody can foresee.
std::pair<OpenFile, fs::path> temporaryBeside(const fs::path& file) {
    for (;;) {
        std::random_device random;
        char suffix[32];
        std::snprintf(suffix, sizeof suffix, ".tmp%08x%08x", random(), random());
        fs::path temporary = file;
        temporary += suffix;
        OpenFile opened(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
        if (opened.isOpen() || errno != EEXIST) return {std::move(opened), std::move(temporary)};
    }
}

bool write(const fs::path& file, const EdaTable& table, Header header) {
    header.floats = std::uint32_t(table.cumulative().size());
    header.checksum = checksum(header, table.octaves(), table.cumulative());
    const auto [opened, temporary] = temporaryBeside(file);
    if (!opened.isOpen()) return false;
    const bool complete = opened.write(&header, sizeof header) &&
                          opened.write(table.octaves().data(), table.octaves().size_bytes()) &&
                          opened.write(table.cumulative().data(), table.cumulative().size_bytes());
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
    return read(OpenFile(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)), headerOf(albedo, g, resolution),
                resolution, reason);
}

CachedEdaTable loadOrBuildEdaTable(const fs::path& file, float albedo, float g, const EdaResolution& resolution,
                                   unsigned threads) {
    EdaTable::requireValid(albedo, g, resolution);
    const Header header = headerOf(albedo, g, resolution);
    std::string reason;
    // Nothing but a file of this user's is ever renamed over: not a link, not a folder, not a device.
    bool mayWrite = false;
    {
        const OpenFile cached = openTrusted(file, reason);
        mayWrite = cached.isOpen() || reason.empty();
        if (cached.isOpen())
            if (auto table = read(cached, header, resolution, reason)) return {std::move(*table), false, {}};
    }
    CachedEdaTable result{EdaTable::build(albedo, g, resolution, threads), true, {}};
    const bool written = mayWrite && write(file, result.table, header);
    if (reason.empty() && written) return result;
    result.warning = "EDA table cache " + file.string() + " ";
    if (!reason.empty()) result.warning += reason + (written ? "; built anew" : "; built, and ");
    if (!written) result.warning += "cannot be written";
    return result;
}

} // namespace darts
