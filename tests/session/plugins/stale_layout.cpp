// A plugin built before some shared structure changed.

#include "tungsten/integrator/Plugin.h"

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{
        tungsten::PluginAbi, "stale_layout", [](tungsten::IntegratorRegistry&) {}, tungsten::pluginLayout() + 1};
    return &descriptor;
}
