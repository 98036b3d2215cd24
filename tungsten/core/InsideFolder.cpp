#include "tungsten/core/InsideFolder.h"

namespace tungsten {

bool isInside(const std::filesystem::path& file, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path top = fs::weakly_canonical(folder.empty() ? "." : fs::absolute(folder), error);
    if (error) return false;
    const fs::path target = fs::weakly_canonical(fs::absolute(file), error);
    if (error) return false;
    const fs::path way = target.lexically_relative(top);
    return !way.empty() && *way.begin() != "..";
}

} // namespace tungsten
