#include "tungsten/image/Destination.h"

#include "tungsten/core/Errors.h"
#include "tungsten/image/AtomicFile.h"

#include <charconv>

#include <sys/stat.h>
#include <unistd.h>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

constexpr int MostLinks = 40; ///< as the kernel's

InputError refusal(const fs::path& file, const std::string& why) {
    return {file.string(), "cannot be written: " + why};
}

/// Where the link leads; none: no link.
std::optional<fs::path> followed(const fs::path& file) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(file, error))) return std::nullopt;
    const fs::path target = fs::read_symlink(file, error);
    return error ? std::nullopt : std::optional(folderOf(file) / target); // absolute ones replace the folder
}

/// As the kernel's protected_symlinks.
void requireTrusted(const fs::path& link, const fs::path& file) {
    struct stat own {
    }, folder{};
    if (::lstat(link.c_str(), &own) != 0 || ::stat(folderOf(link).c_str(), &folder) != 0) return;
    const bool shared = (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0;
    if (shared && own.st_uid != ::geteuid() && own.st_uid != folder.st_uid)
        throw refusal(file, "it leads through a link of another user in a folder that everybody may write to, " +
                                link.string());
}

/// Of a name that is no link but the last, of /proc/self/fd.
std::optional<int> descriptorOf(const fs::path& file) {
    std::error_code error;
    if (fs::weakly_canonical(folderOf(file), error) != "/proc/" + std::to_string(::getpid()) + "/fd")
        return std::nullopt;
    const std::string name = file.filename().string();
    int descriptor = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
    return failure == std::errc() && end == name.data() + name.size() ? std::optional(descriptor) : std::nullopt;
}

} // namespace

fs::path destinationOf(const fs::path& file) {
    fs::path at = file;
    for (int links = 0; links < MostLinks; ++links) {
        if (descriptorOf(at)) return at;
        const auto next = followed(at);
        if (!next) return at;
        requireTrusted(at, file);
        at = *next;
    }
    throw refusal(file, "its links lead in a circle");
}

std::optional<int> descriptorNamed(const fs::path& file) {
    return descriptorOf(destinationOf(file));
}

} // namespace tungsten
