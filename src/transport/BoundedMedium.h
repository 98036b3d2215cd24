#pragma once
// Bodies of scattering media: what is known about their shape and how light gets through their boundaries.

#include "tungsten/scene/Scene.h"

#include <optional>
#include <vector>

namespace tungsten::transport {

/// Light goes on straight, at an index-matched boundary.
inline bool isIndexMatched(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::Forward) != 0;
}
inline bool refracts(const Bsdf& bsdf) {
    return (bsdf.lobes() & (lobe::SpecularTransmission | lobe::GlossyTransmission)) != 0;
}

/// All that is made of one medium.
struct BoundedMedium {
    /// Point on a boundary, with its outward unit normal.
    struct Face {
        Vec3f point, normal;
    };
    /// Where a straight way leaves.
    struct BoundaryHit {
        Face face;
        float distance;
    };

    float reducedSigmaT =
        0.0f;            ///< sigmaA + sigmaS (1 - g), mean over the channels; 0 where nothing scatters or no path gets
    Imath::Box3f box;    ///< about its boundaries, and those of scattering media that touch it
    int straight = -1;   ///< first primitive that ends it and that light passes straight
    int refracting = -1; ///< or refracted
    int insides = 0;     ///< boundaries that have the medium inside

    // If it is a single body of a simple shape with one kind of boundary:
    const Primitive* primitive = nullptr; ///< the boundary
    std::vector<Face> faces;              ///< of a convex polyhedron
    const Sphere* sphere = nullptr;

    [[nodiscard]] bool scatters() const { return reducedSigmaT > 0.0f; }
    [[nodiscard]] bool ends() const { return straight >= 0 || refracting >= 0; }
    /// No straight way leads out: of a simple shape, and light is refracted everywhere.
    [[nodiscard]] bool isSealed() const { return primitive && straight < 0; }
    /// D
    [[nodiscard]] float diffusion() const { return 1.0f / (3.0f * reducedSigmaT); }
    /// For simple shapes, from inside.
    [[nodiscard]] BoundaryHit intersectBoundary(const Vec3f& position, const Vec3f& direction) const;
};

/// The bounded media of a scene, by medium.
std::vector<BoundedMedium> boundedMediaOf(const Scene& scene);

/// Spheres about scattering bodies in what does not scatter, that light passes into.
struct MediumSphere {
    Vec3f centre;
    float radius;
};
std::vector<MediumSphere> spheresAboutMedia(const Scene& scene);

/// All that scatters is sealed by walls that refract, without an emitter inside: no connection from there is complete.
bool isSealed(const Scene& scene);

} // namespace tungsten::transport
