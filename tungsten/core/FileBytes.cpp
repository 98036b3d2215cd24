#include "tungsten/core/FileBytes.h"

#include "tungsten/core/AvailableMemory.h"
#include "tungsten/core/Errors.h"
#include "tungsten/core/SystemError.h"

#include <algorithm>
#include <cerrno>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tungsten {

uint64_t requireRegularFile(const std::filesystem::path& file) {
    // A pipe without a writer would keep a blocking open waiting.
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0 && errno == ENOENT) throw InputError(file.string(), "no such file");
    if (descriptor < 0) throw InputError(file.string(), "cannot be read: " + systemError(errno));
    struct stat status {};
    const bool known = ::fstat(descriptor, &status) == 0;
    ::close(descriptor);
    if (!known || !S_ISREG(status.st_mode))
        throw InputError(file.string(), "not a file (a folder, a device or a pipe)");
    return uint64_t(status.st_size);
}

namespace {

/// Of files that are large enough for it to matter.
void requireRoomFor(uint64_t size, const std::filesystem::path& file) {
    constexpr uint64_t Small = uint64_t(1) << 26;
    if (size < Small) return;
    const double available = availableMemoryBytes();
    if (double(size) > available)
        throw InputError(file.string(), "has " + memoryText(double(size)) + ", more than the " + memoryText(available) +
                                            " of memory that can be had (--memory-limit, if given, says how much)");
}

constexpr std::string_view Utf8Mark = "\xEF\xBB\xBF";

/// Marked or not: the first characters of such texts have zero bytes.
void requireUtf8(const std::filesystem::path& file, std::string_view text) {
    const std::string_view start = text.substr(0, 2), longer = text.substr(0, 4);
    const bool zeros =
        start.find('\0') != std::string_view::npos && longer.find_first_not_of('\0') != std::string_view::npos;
    if (start == "\xFF\xFE" || start == "\xFE\xFF" || zeros)
        throw InputError(file.string(), "text in UTF-16 or UTF-32, which is not read; save it as UTF-8");
}

} // namespace

std::vector<char> readFileBytes(const std::filesystem::path& file, const LoadWatch& watch, const FileCheck& check) {
    constexpr uint64_t LargestFile = uint64_t(1) << 32, Part = uint64_t(1) << 23, StartSize = uint64_t(1) << 12;
    const uint64_t size = requireRegularFile(file);
    if (size > LargestFile) throw InputError(file.string(), "larger than 4 GiB");
    std::ifstream in(file, std::ios::binary);
    std::vector<char> bytes(std::min(size, StartSize));
    const auto read = [&](uint64_t from, uint64_t to) {
        in.read(bytes.data() + from, std::streamsize(to - from));
        if (!in) throw InputError(file.string(), "cannot be read");
    };
    read(0, bytes.size());
    if (check) check({bytes.data(), bytes.size()}, size);
    requireRoomFor(size, file);
    bytes.resize(size);
    for (uint64_t at = std::min(size, StartSize); at < size; at += Part) {
        watch.poll();
        read(at, std::min(at + Part, size));
    }
    watch.read(file, {bytes.data(), bytes.size()});
    return bytes;
}

std::string_view utf8Of(std::string_view text, const std::filesystem::path& file) {
    requireUtf8(file, text);
    return text.substr(text.starts_with(Utf8Mark) ? Utf8Mark.size() : 0);
}

void requireText(const std::filesystem::path& file, std::string_view start, uint64_t size) {
    requireUtf8(file, start);
    if (size > start.size() && start.find('\0') != std::string_view::npos)
        throw InputError(file.string(), "not a text: it begins with zero bytes, or holds some early on");
}

} // namespace tungsten
