#pragma once
// The host's types for the sampling library: vectors, coefficients, and what scatters.

#include "darts/Settings.h"

#include "tungsten/scene/Interaction.h"

namespace tungsten::path {

inline darts::Vec3 toDarts(const Vec3f& v) {
    return {v.x, v.y, v.z};
}
inline darts::Vec3 toDarts(const Rgb& c) {
    return {c.x, c.y, c.z};
}
inline Vec3f directionFrom(const darts::Vec3& v) {
    return {v.x, v.y, v.z};
}
inline Rgb colourFrom(const darts::Vec3& c) {
    return {c.x, c.y, c.z};
}
inline darts::Medium toDarts(const Medium& medium) {
    return {toDarts(medium.sigmaA), toDarts(medium.sigmaS), medium.phase.g()};
}

/// The phase function of light that travels along `before`.
struct PhaseScatterer {
    const PhaseFunction& phase;
    const Vec3f& before;

    [[nodiscard]] darts::Vec3 sample(float u, float v) const { return toDarts(phase.sample(before, {u, v})); }
    [[nodiscard]] float pdf(const darts::Vec3& direction) const { return phase.pdf(before, directionFrom(direction)); }
};

/// A surface whose lobes are all smooth and reflect. Directions into it stand for absorption: their density is 0.
struct SurfaceScatterer {
    const SurfaceInteraction& surface;
    Sampler& sampler; ///< chooses among lobes

    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        const BsdfRandom random{{u, v}, sampler.next1D()};
        const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance), surface.wi, random);
        return toDarts(sample ? surface.frame.toWorld(sample->wo).normalized() : -surface.frame.n);
    }
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        return surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi,
                                 surface.frame.toLocal(directionFrom(direction)));
    }
};

} // namespace tungsten::path
