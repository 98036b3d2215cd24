#pragma once
// Light that no technique of the path tracer finds: by mirrors or refraction, from a point.

#include "tungsten/scene/Scene.h"

#include <optional>

namespace tungsten::path {

/// Light of a point or spot, or of a single direction from where that is scattered first, which a surface that is
/// nothing but specular mirrors or refracts before the next vertex that scatters it. No camera path meets the point,
/// and connections to it are straight.
struct MissedLight {
    const Emitter* emitter;
    const Primitive* surface; ///< the first that mirrors or refracts
    bool refracts;            ///< the light has gone through it

    /// "light of 'lamp' that 'jar' refracts before anything scatters it".
    [[nodiscard]] std::string description() const;
};

/// One such way, if light goes any, while the sensor can still see it; by a few thousand light paths, half of which aim
/// at surfaces of this kind. Coats of surfaces that scatter as well are left alone: they mirror a few hundredths.
std::optional<MissedLight> findMissedLight(const Scene& scene);

} // namespace tungsten::path
