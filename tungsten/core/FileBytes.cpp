#include "tungsten/core/FileBytes.h"

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

std::vector<char> readFileBytes(const std::filesystem::path& file, const LoadWatch& watch) {
    constexpr uint64_t LargestFile = uint64_t(1) << 32, Part = uint64_t(1) << 23;
    const uint64_t size = requireRegularFile(file);
    if (size > LargestFile) throw InputError(file.string(), "larger than 4 GiB");
    std::vector<char> bytes(size);
    std::ifstream in(file, std::ios::binary);
    for (uint64_t at = 0; at < size && in; at += Part) {
        watch.poll();
        in.read(bytes.data() + at, std::streamsize(std::min(Part, size - at)));
    }
    if (!in) throw InputError(file.string(), "cannot be read");
    return bytes;
}

std::string_view utf8Of(const std::vector<char>& bytes, const std::filesystem::path& file) {
    const std::string_view text(bytes.data(), bytes.size()), start = text.substr(0, 2);
    if (start == "\xFF\xFE" || start == "\xFE\xFF" || start.find('\0') != std::string_view::npos)
        throw InputError(file.string(), "text in UTF-16 or UTF-32, which is not read; save it as UTF-8");
    return text.substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
}

} // namespace tungsten
