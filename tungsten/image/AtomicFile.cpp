#include "tungsten/image/AtomicFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/SystemError.h"
#include "tungsten/image/Destination.h"

#include <cerrno>
#include <ctime>
#include <ext/stdio_filebuf.h>
#include <iostream>
#include <random>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

constexpr const char* Prefix = ".tungsten-";
constexpr const char* Suffix = ".tmp";
constexpr std::time_t YoungSeconds = 60;

InputError cannotWrite(const fs::path& file, const std::string& why) {
    return {file.string(), "cannot be written: " + why};
}

constexpr size_t Digits = 16; ///< of the random part of a name

/// Of what randomName() makes.
bool isTemporaryName(const std::string& name) {
    const size_t begin = std::string(Prefix).size();
    return name.size() == begin + Digits + std::string(Suffix).size() && name.starts_with(Prefix) &&
           name.ends_with(Suffix) && name.find_first_not_of("0123456789abcdef", begin) == begin + Digits;
}

std::string randomName() {
    std::random_device random;
    char name[48];
    std::snprintf(name, sizeof name, "%s%08x%08x%s", Prefix, random(), random(), Suffix);
    return name;
}

/// Closes what it holds.
struct Descriptor {
    explicit Descriptor(int opened) : number(opened) {}
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number;
};

void fillFile(int descriptor, const fs::path& destination, const std::function<void(std::ostream&)>& write) {
    const int copy = ::dup(descriptor); // the buffer closes its own
    if (copy < 0) throw cannotWrite(destination, systemError(errno));
    __gnu_cxx::stdio_filebuf<char> buffer(copy, std::ios::in | std::ios::out | std::ios::binary);
    std::ostream out(&buffer);
    errno = 0;
    write(out);
    out.flush();
    const int reason = errno;
    if (!out || !buffer.close())
        throw cannotWrite(destination, reason ? systemError(reason) : "the disk is full, or there is a quota");
}

/// To what this process has open, behind what has been printed there; all of it, once it is whole, as it may be a pipe.
void writeToDescriptor(int descriptor, const fs::path& destination, const std::function<void(std::ostream&)>& write) {
    const Descriptor whole(::memfd_create("tungsten", MFD_CLOEXEC));
    if (whole.number < 0) throw cannotWrite(destination, systemError(errno));
    fillFile(whole.number, destination, write);
    std::cout.flush();
    std::fflush(stdout);
    char part[1 << 16];
    ::lseek(whole.number, 0, SEEK_SET);
    for (ssize_t count = 0; (count = ::read(whole.number, part, sizeof part)) > 0;)
        for (ssize_t at = 0; at < count;) {
            const ssize_t written = ::write(descriptor, part + at, size_t(count - at));
            if (written < 0 && errno != EINTR) throw cannotWrite(destination, systemError(errno));
            at += std::max<ssize_t>(written, 0);
        }
}

/// The temporary file; whoever holds its lock is still writing. Removed unless it has been renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& destination) : destination_(destination) {
        do {
            path_ = folderOf(destination) / randomName();
            descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        } while (descriptor_ < 0 && errno == EEXIST);
        if (descriptor_ < 0) throw cannotWrite(destination, systemError(errno));
        ::flock(descriptor_, LOCK_EX | LOCK_NB);
    }
    ~TemporaryFile() {
        if (!renamed_) ::unlink(path_.c_str());
        ::close(descriptor_);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void fill(const std::function<void(std::ostream&)>& write) const { fillFile(descriptor_, destination_, write); }
    void rename() {
        // A full disk may be noticed no sooner than here.
        if (::fsync(descriptor_) != 0 && errno != EINVAL) throw cannotWrite(destination_, systemError(errno));
        if (::rename(path_.c_str(), destination_.c_str()) != 0) throw cannotWrite(destination_, systemError(errno));
        renamed_ = true;
        const int folder = ::open(folderOf(destination_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder < 0) return;
        ::fsync(folder); // the name; the bytes are safe already
        ::close(folder);
    }

  private:
    fs::path destination_, path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

} // namespace

fs::path folderOf(const fs::path& file) {
    return file.parent_path().empty() ? fs::path(".") : file.parent_path();
}

void requireReplaceable(const fs::path& file) {
    if (const auto descriptor = descriptorNamed(file)) {
        const int flags = ::fcntl(*descriptor, F_GETFL);
        if (flags < 0) throw cannotWrite(file, systemError(errno));
        if ((flags & O_ACCMODE) == O_RDONLY) throw cannotWrite(file, "it is open for reading alone");
        return;
    }
    std::error_code error;
    const auto status = fs::status(file, error);
    if (fs::is_directory(status)) throw cannotWrite(file, "a folder has this name; choose another with -d, -o or -e");
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw cannotWrite(file, "a device or a pipe has this name, which would be replaced by a file");
}

bool takesFiles(const fs::path& folder) {
    try {
        const TemporaryFile trial(folder / "trial");
        return true;
    } catch (const InputError&) {
        return false;
    }
}

void writeAtomically(const fs::path& destination, const std::function<void(std::ostream&)>& write) {
    requireReplaceable(destination);
    if (const auto descriptor = descriptorNamed(destination)) return writeToDescriptor(*descriptor, destination, write);
    TemporaryFile temporary(destinationOf(destination));
    temporary.fill(write);
    temporary.rename();
}

void removeAbandonedFiles(const fs::path& folder) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (!isTemporaryName(name)) continue;
        const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
        if (descriptor < 0) continue;
        // A writer locks its file right after making it: a young one may not be locked yet.
        struct stat status {};
        if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::fstat(descriptor, &status) == 0 &&
            std::time(nullptr) - status.st_mtime > YoungSeconds)
            ::unlink(entry.path().c_str());
        ::close(descriptor);
    }
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    writeAtomically(file, [&](std::ostream& out) { out << text; });
}

} // namespace tungsten
