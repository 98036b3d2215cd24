#include "tungsten/integrator/Integrator.h"

#include "tungsten/core/Errors.h"

namespace tungsten {

void IntegratorRegistry::add(const std::string& type, const std::string& description, IntegratorFactory factory) {
    const auto [position, added] = entries_.emplace(type, Entry{std::move(factory), description, origin_});
    if (!added)
        throw InputError(origin_, "registers the integrator '" + type + "', which " + position->second.origin +
                                      " registers too");
}

} // namespace tungsten
