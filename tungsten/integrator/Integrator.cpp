#include "tungsten/integrator/Integrator.h"

#include "tungsten/core/Errors.h"
#include "tungsten/scene/SceneLoader.h"

namespace tungsten {

void IntegratorRegistry::add(const std::string& type, const std::string& description, IntegratorFactory factory,
                             const IntegratorTraits& traits) {
    const auto [position, added] = entries_.emplace(type, Entry{std::move(factory), description, origin_, traits});
    if (!added)
        throw InputError(origin_, "registers the integrator '" + type + "', which " + position->second.origin +
                                      " registers too");
}

DefaultGate IntegratorRegistry::defaultGateOf(const std::string& type) const {
    const auto found = entries_.find(type);
    return found == entries_.end() ? tungsten::defaultGateOf(type) : found->second.traits.defaultGate;
}

std::string IntegratorRegistry::typeOf(IntegratorFamily family) const {
    for (const auto& [type, entry] : entries_)
        if (entry.traits.family == family && entry.traits.represents) return type;
    return "";
}

} // namespace tungsten
