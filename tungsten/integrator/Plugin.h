#pragma once
// What a plugin exports, and how the host finds plugins.
//
// A plugin is a shared object libtungsten-NAME.so beside the executable or the host's library, in the
// folder tungsten beside that (lib/tungsten of an installation), or on TUNGSTEN_PLUGIN_PATH (colon separated). It
// defines
//
//     extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
//         static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "name", registerIntegrators};
//         return &descriptor;
//     }

#include "tungsten/core/Errors.h"
#include "tungsten/integrator/Integrator.h"

#include <filesystem>
#include <vector>

namespace tungsten {

/// Increases whenever a header that plugins include changes incompatibly; the compiler's ABI is part of it.
inline constexpr const char* PluginAbi = "tungsten-plugin-6/" __VERSION__;

/// Fingerprint of the sizes of what host and plugins share: catches a plugin that was not rebuilt after a header
/// changed.
constexpr uint64_t pluginLayout() {
    uint64_t hash = 0xCBF29CE484222325ull;
    for (const size_t size :
         {sizeof(Scene), sizeof(Primitive), sizeof(Medium), sizeof(Emitter), sizeof(Bsdf), sizeof(Camera),
          sizeof(TransportSettings), sizeof(SurfaceHit), sizeof(Film), sizeof(Statistics), sizeof(SceneFacts),
          sizeof(Features), sizeof(PassInfo), sizeof(ObjectReader)})
        hash = (hash ^ size) * 0x100000001B3ull;
    return hash;
}

struct PluginDescriptor {
    const char* abi;
    const char* name;
    void (*registerIntegrators)(IntegratorRegistry& registry);
    uint64_t layout = pluginLayout();
};

} // namespace tungsten
