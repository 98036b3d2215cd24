#pragma once
// Reading light sources out of primitives.

#include "tungsten/scene/LoadContext.h"

#include <optional>

namespace tungsten {

/// Adds the emitter if `type` is one of LightSources; false otherwise.
bool readLightSource(LoadContext& context, const ObjectReader& reader, const std::string& type);
/// `emission_time` and `pulse`: when the source's light starts.
struct EmissionTimes {
    double start = 0.0;
    TimeProfile pulse;
};
EmissionTimes readEmissionTimes(const ObjectReader& reader);
/// Default light of a scene without emitters, and the checks that need all of them.
void finishEmitters(LoadContext& context, const ObjectReader& root);
/// Warns where the camera, a light or a surface names another medium than what it sees; once the geometry is there.
void warnAboutMedia(const LoadContext& context, const ObjectReader& root, const ObjectReader& camera);
/// Warns about point-like lights in the plane of a surface; once the geometry is there.
void warnAboutLightsOnSurfaces(const LoadContext& context);

/// A speed of light; 0 or less: the vacuum's.
double readSpeedOrNone(const ObjectReader& reader, const std::string& field, const Meaning& meaning);

} // namespace tungsten
