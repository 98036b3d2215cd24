// Registration of the path tracers and the light tracer.

#include "path/PathTracer.h"
#include "path/light/LightTracer.h"

#include "tungsten/integrator/Plugin.h"

namespace {

template <typename Made>
std::unique_ptr<tungsten::Integrator> make(std::shared_ptr<const tungsten::Scene> scene,
                                           const tungsten::ObjectReader& settings) {
    return std::make_unique<Made>(std::move(scene), settings);
}

void registerIntegrators(tungsten::IntegratorRegistry& registry) {
    using tungsten::DefaultGate;
    constexpr auto Paths = tungsten::IntegratorFamily::PathTracers;
    using tungsten::path::LightTracer;
    using tungsten::path::PathTracer;
    registry.add("path_tracer", "unbiased path tracing with next-event estimation, steady state or time-resolved",
                 make<PathTracer>, {DefaultGate::None, Paths});
    registry.add("transient_path_tracer", "the same, always time-resolved", make<PathTracer>,
                 {DefaultGate::Gated, Paths, true});
    registry.add("light_tracer", "plain paths from the lights, connected to the camera; steady state or time-resolved",
                 make<LightTracer>);
    registry.add("transient_light_tracer", "the same, always time-resolved", make<LightTracer>,
                 {.defaultGate = DefaultGate::Gated});
}

} // namespace

extern "C" const tungsten::PluginDescriptor* tungstenPlugin() {
    static const tungsten::PluginDescriptor descriptor{tungsten::PluginAbi, "path", registerIntegrators};
    return &descriptor;
}
