#pragma once
// A ray meets a surface; a ray crosses boundaries: what both integrators share.

#include "tungsten/scene/Scene.h"

namespace tungsten {

/// A surface hit ready for shading. Directions `wi` and samples are local to `frame`.
struct SurfaceInteraction {
    SurfaceHit hit;
    const Primitive* primitive = nullptr;
    const Bsdf* bsdf = nullptr;
    Frame frame; ///< shading frame, flipped toward the ray for two-sided models
    Vec3f wi;    ///< local direction back along the ray

    [[nodiscard]] BsdfQuery query(TransportMode mode, LobeMask requested = lobe::All) const {
        return {hit.uv, mode, requested};
    }
    /// |(wo.Ng)(wi.Ns) / ((wi.Ng)(wo.Ns))|: the shading-normal factor of photon transport.
    [[nodiscard]] float photonShadingFactor(const Vec3f& worldWi, const Vec3f& worldWo) const;
    /// False when the consistency checks are on and the side of `worldWo` differs between shading and geometric normal.
    [[nodiscard]] bool consistent(const Vec3f& worldWo, bool checksOn) const;
};

SurfaceInteraction makeInteraction(const Scene& scene, const SurfaceHit& hit, const Vec3f& rayDirection);

/// How a path goes on from a surface; weight, pdf and lobe as in BsdfSample.
struct BsdfDirection {
    Vec3f direction; ///< world, unit
    Rgb weight;
    float pdf;
    LobeMask lobe;

    [[nodiscard]] bool straight() const { return lobe == lobe::Forward; }
};
/// Draws it from the BSDF's lobes that the query asks for. None when they absorb the path, or when `checksOn` and its
/// direction is not consistent(); straight on always is.
std::optional<BsdfDirection> sampleBsdf(const SurfaceInteraction& surface, const BsdfQuery& query, bool checksOn,
                                        Sampler& sampler);

/// The region of a path that leaves a surface along `direction` (world). The primitive's own sides decide; only a path
/// reflected to a side for which the primitive names no medium stays in `current`: meshes that bound nothing may be hit
/// from behind, and what they reflect goes back to where it came from.
Region regionBeyond(const SurfaceInteraction& surface, const Vec3f& direction, const Region& current);

/// A straight connection between two points through index-matched boundaries.
struct Visibility {
    Rgb transmittance{0.0f}; ///< 0 when blocked
    double time = 0.0;       ///< of flight over the whole connection, all speeds included
    int crossings = 0;       ///< forward surfaces passed: each counts as a bounce
    bool oneSpeed = true;    ///< light went at the speed of the starting region all the way
};
/// Along a ray that starts in `region`, for `distance`, which may be Infinity. Between the ray's limits something may
/// be in the way: where the ends lie on surfaces they are short of them. `rays` is increased by the number of rays
/// traced.
Visibility traceVisibility(const Scene& scene, Ray ray, float distance, Region region, uint64_t& rays);

} // namespace tungsten
