#include "tungsten/film/AtomicFile.h"

#include "tungsten/core/Errors.h"

#include <unistd.h>

namespace tungsten {

AtomicFile::AtomicFile(std::filesystem::path destination)
    : destination_(std::move(destination)), temporary_(destination_) {
    std::error_code error;
    const std::filesystem::path folder = destination_.parent_path().empty() ? "." : destination_.parent_path();
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(destination_.string(),
                         "cannot be written: the folder '" + folder.string() + "' does not exist");
    temporary_ += ".tmp" + std::to_string(::getpid());
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    std::error_code error;
    std::filesystem::rename(temporary_, destination_, error);
    if (error) throw InputError(destination_.string(), "cannot be written: " + error.message());
    committed_ = true;
}

} // namespace tungsten
