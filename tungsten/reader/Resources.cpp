#include "tungsten/reader/Resources.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/InsideFolder.h"

namespace tungsten {

std::filesystem::path Resources::find(const std::string& name) const {
    const std::filesystem::path path = folder / std::filesystem::path(name);
    if (!allowOutside && !isInside(path, folder))
        throw InputError(path.string(), "lies outside the scene's folder (-i chooses another); if you trust the scene, "
                                        "--allow-outside lets it read any file");
    return path;
}

} // namespace tungsten
