// A plugin that works, but claims a name twice.

#include "tungsten/integrator/Plugin.h"

namespace {

std::unique_ptr<tungsten::Integrator> none(std::shared_ptr<const tungsten::Scene>, const tungsten::ObjectReader&) {
    return nullptr;
}

void registerIntegrators(tungsten::IntegratorRegistry& registry) {
    registry.add("twin", "the first", none);
    registry.add("twin", "the second", none);
}

} // namespace

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "registers_twice", registerIntegrators};
    return &descriptor;
}
