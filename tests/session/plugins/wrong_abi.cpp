// A plugin of some other host.

#include "tungsten/integrator/Plugin.h"

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{"tungsten-plugin-0/unknown", "wrong_abi",
                                                       [](tungsten::IntegratorRegistry&) {}};
    return &descriptor;
}
