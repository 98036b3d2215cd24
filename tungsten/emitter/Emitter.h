#pragma once
// Light sources: a closed set of plain structs. Radiometry and power: docs/scene-format.md, section 7.2.

#include "tungsten/core/Distribution.h"
#include "tungsten/core/Overloaded.h"
#include "tungsten/core/TimeProfile.h"
#include "tungsten/geometry/Shape.h"
#include "tungsten/texture/Texture.h"

#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace tungsten {

/// Isotropic point; intensity in W/sr.
struct PointEmitter {
    Vec3f position;
    Rgb intensity{0.0f};
};
/// A laser: carries `power` in one direction.
struct DirectionalPointEmitter {
    Vec3f position, direction;
    Rgb power{0.0f};
};
/// A wide laser: parallel light from a disc of `radius` (0: a line), carries `power`.
struct CollimatedEmitter {
    Vec3f position;
    Frame frame; ///< n is its direction
    float radius = 0.0f;
    Rgb power{0.0f};
};
/// A point with a cone: full intensity inside cosInner, smoothstep to zero at cosOuter.
struct SpotEmitter {
    Vec3f position, direction;
    Rgb intensity{0.0f}; ///< on the axis, W/sr
    float cosInner = 0.9f, cosOuter = 0.8f;

    [[nodiscard]] float falloff(float cosTheta) const;
    /// Towards a unit direction. By the difference from the axis: in a narrow cone a dot product's rounding is a large
    /// part of the edge.
    [[nodiscard]] float falloffTowards(const Vec3f& unit) const {
        return falloff(1.0f - 0.5f * (unit - direction).length2());
    }
};
/// Any surface with emission: one-sided radiance on the side of the geometric normal.
struct AreaEmitter {
    const Shape* shape = nullptr;
    uint32_t primitive = 0; ///< index in Scene::primitives
    Texture radiance;
    std::shared_ptr<const AreaSampler> areaSampler;

    /// A point of it, uniform by area.
    [[nodiscard]] SurfaceSample samplePoint(const Vec2f& u) const;
    /// Cosine of the half angle of the cone about the normal that it shines into: 0 but for disks with a cone_angle.
    [[nodiscard]] float cosCone() const;
    [[nodiscard]] bool shinesAt(float cosine) const { return cosine > 0.0f && cosine >= cosCone(); }
    /// What its radiance is multiplied by for the power: area times projected solid angle.
    [[nodiscard]] float extent() const;
};
/// Environment (steady state only): constant or bitmap radiance.
struct InfiniteSphereEmitter {
    Texture radiance;
    Frame frame; ///< rotation part of the transform
    bool samplable = true;
    std::shared_ptr<const Distribution2D> distribution; ///< over uv for bitmaps
    Vec3f sceneCentre{0, 0, 0};                         ///< set when the scene is complete, for photon emission
    float sceneRadius = 1.0f;
};

using EmitterModel = std::variant<PointEmitter, DirectionalPointEmitter, CollimatedEmitter, SpotEmitter, AreaEmitter,
                                  InfiniteSphereEmitter>;

struct Emitter {
    std::string name;
    EmitterModel model;
    double emissionTime = 0.0; ///< when its pulse starts
    TimeProfile pulse{};       ///< of its power, after that; empty: all at once
    int medium = -1;           ///< medium that surrounds it (ext_medium), -1 for vacuum
    float vacuumSpeed = -1.0f; ///< ext_speed_of_light where positive
    std::string path = {};     ///< in the scene file, as problems have it

    /// Light from infinitely far away, in every direction.
    [[nodiscard]] bool isInfinite() const {
        return std::visit(Overloaded{[](const InfiniteSphereEmitter&) { return true; },
                                     [](const OneOf<PointEmitter, DirectionalPointEmitter, CollimatedEmitter,
                                                    SpotEmitter, AreaEmitter> auto&) { return false; }},
                          model);
    }
    /// Emits in a single direction (directional_point, collimated): cannot be connected to.
    [[nodiscard]] bool isDelta() const {
        return std::visit(
            Overloaded{
                [](const OneOf<DirectionalPointEmitter, CollimatedEmitter> auto&) { return true; },
                [](const OneOf<PointEmitter, SpotEmitter, AreaEmitter, InfiniteSphereEmitter> auto&) { return false; }},
            model);
    }
    /// Null for emitters that are no surface.
    [[nodiscard]] const AreaEmitter* surface() const;
    /// Of a surface: the index of its primitive in Scene::primitives.
    [[nodiscard]] std::optional<uint32_t> primitive() const;
    /// Neither a surface nor the environment: a ray meets it with probability zero.
    [[nodiscard]] bool isPointLike() const { return !isInfinite() && !surface(); }
    /// Vertices may connect to it.
    [[nodiscard]] bool isConnectable() const;
};

/// A photon leaving an emitter.
struct EmissionSample {
    Ray ray;
    Rgb power;          ///< L |cos| / (p_position p_direction): the power of the one photon that stands for the emitter
    float pdfDirection; ///< per solid angle; 0 for a single direction
    Vec3f normal;       ///< of the emitting surface; equals the direction for points
};
EmissionSample sampleEmission(const Emitter& emitter, const Vec2f& uPosition, const Vec2f& uDirection);
/// The same with the start fixed and the direction chosen by the caller: power per steradian that leaves along
/// `direction` (intensity for points, radiance times cosine divided by the density of the position for areas). Zero for
/// single directions.
Rgb emittedIntensity(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction);
/// A starting point for the above: position, normal (points: position only).
SurfaceSample sampleEmissionPoint(const Emitter& emitter, const Vec2f& u);

/// The directions that sampleEmission draws from a start: all within a cone.
struct EmissionCone {
    Vec3f axis{0.0f, 0.0f, 1.0f};
    float widest = 2.0f;         ///< largest 1 - cos of the angle about the axis; 2: the sphere
    bool cosineWeighted = false; ///< density proportional to the cosine; else uniform
};
EmissionCone emissionCone(const Emitter& emitter, const SurfaceSample& start);
/// Density of sampleEmission's directions per solid angle; 0 for a single direction.
float pdfEmissionDirection(const Emitter& emitter, const SurfaceSample& start, const Vec3f& direction);

/// Of a point that shines alike in every direction; none of others.
std::optional<Rgb> isotropicIntensity(const Emitter& emitter);

/// Of the surface that emits; 0 for emitters that are none.
float emittingArea(const Emitter& emitter);
/// About all points from which it emits; of radius Infinity for the environment.
BoundingSphere boundingSphere(const Emitter& emitter);

/// A connection from a receiver to an emitter.
struct DirectSample {
    Vec3f direction; ///< from the receiver, unit
    float distance;  ///< Infinity for the environment
    Rgb weight;      ///< radiance / pdf (area, environment) or intensity / distance^2 (points); visibility not included
    float pdf;       ///< per solid angle at the receiver; 0 for point-like emitters (no MIS with directions)
    Vec3f position;  ///< on the emitter
    SurfaceMargin margin{};

    /// The length of a ray to the emitter on which only other surfaces are met.
    [[nodiscard]] float reach() const { return margin.before(direction, distance); }
};
/// None when the emitter cannot light the point (behind it, outside the cone, single direction).
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
