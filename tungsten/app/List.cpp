#include "tungsten/app/List.h"

#include "tungsten/core/Errors.h"
#include "tungsten/scene/SceneLoader.h"

#include <ostream>

namespace tungsten {

void printTypes(const IntegratorRegistry& registry, std::ostream& out) {
    out << "integrators\n";
    for (const auto& [type, entry] : registry.entries())
        out << "  " << type << "\n      " << entry.description << "\n      from " << entry.origin << '\n';
    if (registry.entries().empty())
        out << "  none: no plugin was found beside the executable or on TUNGSTEN_PLUGIN_PATH\n";
    for (const auto& [kind, types] : sceneTypes()) {
        out << kind << "\n ";
        for (const std::string& type : types) out << ' ' << type;
        out << '\n';
    }
}

} // namespace tungsten
