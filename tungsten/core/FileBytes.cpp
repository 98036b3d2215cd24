#include "tungsten/core/FileBytes.h"

#include "tungsten/core/Errors.h"

#include <cstdint>
#include <fstream>

namespace tungsten {

std::vector<char> readFileBytes(const std::filesystem::path& file) {
    constexpr uint64_t LargestFile = uint64_t(1) << 32;
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) throw InputError(file.string(), "no such file");
    if (!std::filesystem::is_regular_file(status)) throw InputError(file.string(), "not a file (a folder or a device)");
    const uint64_t size = std::filesystem::file_size(file, error);
    if (error) throw InputError(file.string(), "cannot be read: " + error.message());
    if (size > LargestFile) throw InputError(file.string(), "larger than 4 GiB");
    std::vector<char> bytes(size);
    std::ifstream in(file, std::ios::binary);
    if (!in.read(bytes.data(), std::streamsize(size))) throw InputError(file.string(), "cannot be read");
    return bytes;
}

} // namespace tungsten
