#pragma once
// Light sources: the set of models, and one of them with the times and surroundings of its light.

#include "tungsten/core/TimeProfile.h"
#include "tungsten/emitter/Area.h"
#include "tungsten/emitter/Infinite.h"
#include "tungsten/emitter/Laser.h"
#include "tungsten/emitter/Point.h"

#include <string>

namespace tungsten {

using LightSources =
    LightSourceSet<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter, InfiniteSphereEmitter>;
/// Those, and any surface with emission.
using EmitterVariant = LightSources::With<CheckedEmitter<AreaEmitter>>;

struct Emitter {
    std::string name;
    EmitterVariant model;
    double emissionTime = 0.0; ///< when its pulse starts
    TimeProfile pulse{};       ///< of its power, after that; empty: all at once
    int medium = -1;           ///< medium that surrounds it (ext_medium), -1 for vacuum
    float vacuumSpeed = -1.0f; ///< ext_speed_of_light where positive
    std::string path = {};     ///< in the scene file, as problems have it

    /// Light from infinitely far away, in every direction.
    [[nodiscard]] bool isInfinite() const {
        return std::visit([](const auto& m) { return m.isInfinite(); }, model);
    }
    /// Emits in a single direction (directional_point, collimated): cannot be connected to.
    [[nodiscard]] bool isDelta() const {
        return std::visit([](const auto& m) { return m.isDelta(); }, model);
    }
    /// Null for emitters that are no surface.
    [[nodiscard]] const AreaEmitter* surface() const { return std::get_if<AreaEmitter>(&model); }
    /// Of a surface: the index of its primitive in Scene::primitives.
    [[nodiscard]] std::optional<uint32_t> primitive() const {
        return surface() ? std::optional(surface()->primitive) : std::nullopt;
    }
    /// Neither a surface nor the environment: a ray meets it with probability zero.
    [[nodiscard]] bool isPointLike() const { return !isInfinite() && !surface(); }
    /// Vertices may connect to it.
    [[nodiscard]] bool isConnectable() const {
        return std::visit([](const auto& m) { return m.isConnectable(); }, model);
    }
};

/// A photon leaving an emitter.
EmissionSample sampleEmission(const Emitter& emitter, const Vec2f& uPosition, const Vec2f& uDirection);
/// The same with the start fixed and the direction chosen by the caller: power per steradian that leaves along
/// `direction` (intensity for points, radiance times cosine divided by the density of the position for areas). Zero for
/// single directions.
Rgb emittedIntensity(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction);
/// A starting point for the above: position, normal (points: position only).
SurfaceSample sampleEmissionPoint(const Emitter& emitter, const Vec2f& u);

/// The directions that sampleEmission draws from a start.
EmissionCone emissionCone(const Emitter& emitter, const SurfaceSample& start);
/// Density of sampleEmission's directions per solid angle; 0 for a single direction.
float pdfEmissionDirection(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction);

/// Of a point that shines alike in every direction; none of others.
std::optional<Rgb> isotropicIntensity(const Emitter& emitter);

/// Of the surface that emits; 0 for emitters that are none.
float emittingArea(const Emitter& emitter);
/// About all points from which it emits; of radius Infinity for the environment.
BoundingSphere boundingSphere(const Emitter& emitter);

/// A connection from the receiver. None when the emitter cannot light it (behind it, outside the cone, single
/// direction).
std::optional<DirectSample> sampleDirect(const Emitter& emitter, const Vec3f& receiver, const Vec2f& u);
/// Density of sampleDirect for a direction that hit this area emitter at `position` with geometric normal `ng`.
float pdfDirect(const Emitter& emitter, const Vec3f& receiver, const Vec3f& position, const Vec3f& ng);
/// The same for an escaped direction and an environment.
float pdfDirectInfinite(const Emitter& emitter, const Vec3f& direction);
/// Radiance that leaves a surface hit toward `towards` (zero on the back side).
Rgb emittedRadiance(const Emitter& emitter, const Vec2f& uv, const Vec3f& ng, const Vec3f& towards);
/// Radiance from the environment along an escaping direction.
Rgb environmentRadiance(const Emitter& emitter, const Vec3f& direction);

/// Tells an emitter that shines from outside how large the scene is; others have no use for it.
void encloseScene(Emitter& emitter, const Vec3f& centre, float radius);

/// Total emitted power per channel.
Rgb emitterPower(const Emitter& emitter);

} // namespace tungsten
