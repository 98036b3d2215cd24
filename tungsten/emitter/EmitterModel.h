#pragma once
// What a light source answers: a plain struct with its parameters, in a file of its own. Radiometry and power:
// docs/scene-format.md, section 7.2.

#include "tungsten/core/ModelSet.h"
#include "tungsten/geometry/Shape.h"

#include <concepts>
#include <optional>

namespace tungsten {

/// A photon leaving an emitter.
struct EmissionSample {
    Ray ray;
    Rgb power;          ///< L |cos| / (p_position p_direction): the power of the one photon that stands for the emitter
    float pdfDirection; ///< per solid angle; 0 for a single direction
    Vec3f normal;       ///< of the emitting surface; equals the direction for points
};

/// The directions that sampleEmission draws from a start: all within a cone.
struct EmissionCone {
    Vec3f axis{0.0f, 0.0f, 1.0f};
    float widest = 2.0f;         ///< largest 1 - cos of the angle about the axis; 2: the sphere
    bool cosineWeighted = false; ///< density proportional to the cosine; else uniform
};

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
using MaybeDirect = std::optional<DirectSample>;

class EmitterReader;

/// Each as the function of that name says (Emitter.h).
template <typename M>
concept EmitterModel = std::copyable<M> &&
    requires(const M& m, M& changed, const SurfaceSample& start, const Vec3f& v, const Vec2f& u) {
    { m.isInfinite() } -> std::same_as<bool>;
    { m.isDelta() } -> std::same_as<bool>;
    { m.isConnectable() } -> std::same_as<bool>;
    { m.sampleEmission(u, u) } -> std::same_as<EmissionSample>;
    { m.emittedIntensity(start, v) } -> std::same_as<Rgb>;
    { m.emissionCone(start) } -> std::same_as<EmissionCone>;
    { m.pdfEmissionDirection(start, v) } -> std::same_as<float>;
    { m.isotropicIntensity() } -> std::same_as<std::optional<Rgb>>;
    { m.boundingSphere() } -> std::same_as<BoundingSphere>;
    { m.sampleDirect(v, u) } -> std::same_as<MaybeDirect>;
    { m.totalPower() } -> std::same_as<Rgb>;
    { m.pdfDirectInfinite(v) } -> std::same_as<float>;
    { m.environmentRadiance(v) } -> std::same_as<Rgb>;
    changed.encloseScene(v, 1.0f);
};
/// A primitive of scene files that is nothing but a light source.
template <typename M>
concept LightSource = EmitterModel<M> && requires(const EmitterReader& fields) {
    { M::Type } -> std::convertible_to<std::string>;
    { M::read(fields) } -> std::same_as<std::optional<M>>; // none if it is dark
};

template <EmitterModel M>
using CheckedEmitter = M;
template <LightSource M>
using CheckedSource = M;
template <typename... M>
using LightSourceSet = ModelSet<CheckedSource<M>...>;

/// What most emitters answer alike: their light comes from somewhere, in many directions.
struct EmitterBase {
    [[nodiscard]] bool isInfinite() const { return false; }
    [[nodiscard]] bool isDelta() const { return false; }
    [[nodiscard]] bool isConnectable() const { return true; }
    [[nodiscard]] std::optional<Rgb> isotropicIntensity() const { return std::nullopt; }
    [[nodiscard]] float pdfDirectInfinite(const Vec3f&) const { return 0.0f; }
    [[nodiscard]] Rgb environmentRadiance(const Vec3f&) const { return Rgb(0.0f); }
    void encloseScene(const Vec3f&, float) {}
};

} // namespace tungsten
