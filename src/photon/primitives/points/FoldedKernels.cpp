#include "photon/primitives/points/FoldedKernels.h"

#include "photon/primitives/NearSurfaces.h"

#include "tungsten/core/Warp.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// What surfaces make of a photon's kernel.
struct Fold {
    KernelEdge edge; ///< none: nothing
    float radius = 0.0f;
    float weight = 1.0f; ///< one over the part of kernel and image that lies before all surfaces
};

/// A point of the kernel, in discs of any direction: the radius holds 1 - (1 - d^2/r^2)^3 of it within d.
Vec3f pointOfKernel(float radius, Sampler& random) {
    const float distance = radius * std::sqrt(1.0f - std::cbrt(1.0f - random.next1D()));
    return warp::squareToSphere(random.next2D()) * distance;
}

Fold foldOf(const NearSurfaces& surfaces, const Vec3f& position, float radius, Sampler random) {
    const NearSurfaces::Nearest nearest = surfaces.nearest(position, radius);
    Fold fold{nearest.edge, radius};
    const KernelEdge& edge = fold.edge;
    if (!edge.exists() || nearest.alone) return fold;
    const KernelEdge opposite = nearest.faced ? surfaces.opposite(position, edge, radius) : KernelEdge{};
    if (opposite.exists()) fold.radius = std::max(std::min(opposite.reach, radius), edge.reach);
    fold.weight = float(triesUntilSeen([&] {
        Vec3f offset = pointOfKernel(fold.radius, random);
        const float beyond = edge.normal.dot(offset) - edge.reach;
        if (beyond > 0.0f) offset -= edge.normal * (2.0f * beyond);
        return surfaces.sees(position, offset, fold.radius);
    }));
    return fold;
}

/// Behind the plane; the camera sees it when it sees the photon itself.
Photon imageOf(const Scene& scene, const Photon& photon, const KernelEdge& edge) {
    Photon image = photon;
    image.position = photon.position + edge.normal * (2.0f * edge.reach);
    if (scene.transport.cameraUnwarped || scene.camera.hasParallelRays()) return image;
    const Vec3d camera(scene.camera.position());
    const double farther = (Vec3d(image.position) - camera).length() - (Vec3d(photon.position) - camera).length();
    image.time -= farther / double(scene.media[size_t(photon.medium)].speedOfLight);
    return image;
}

} // namespace

void foldAtSurfaces(const KernelEnds& ends, std::vector<Photon>& photons, Radii& radii) {
    std::vector<Fold> folds(photons.size());
    ends.watch.stage("kernels at surfaces", photons.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, photons.size(), 256), [&](const auto& range) {
        for (size_t i = range.begin(); i < range.end(); ++i) {
            ends.watch.advanceEvery(256, i);
            // What an image adds before the plane lies within the radius of the record itself.
            const Vec3f& position = photons[i].position;
            folds[i] = ends.view && !ends.view->around(position, radii[i])
                           ? Fold{{}, radii[i]}
                           : foldOf(ends.surfaces, position, radii[i], ends.random.branch(RandomStream::Record, i));
        }
    });
    if (std::none_of(folds.begin(), folds.end(), [](const Fold& fold) { return fold.edge.exists(); })) return;
    std::vector<float> own;
    std::vector<KernelEdges> edges;
    own.reserve(folds.size());
    edges.reserve(folds.size());
    for (size_t i = 0; i < folds.size(); ++i) {
        own.push_back(folds[i].radius);
        edges.push_back({folds[i].edge, {}});
        photons[i].power = photons[i].power * folds[i].weight;
    }
    for (size_t i = 0; i < folds.size(); ++i) {
        const KernelEdge& edge = folds[i].edge;
        if (!(edge.reach < folds[i].radius)) continue;
        photons.push_back(imageOf(ends.scene, photons[i], edge));
        own.push_back(folds[i].radius);
        edges.push_back({{edge.normal, -edge.reach}, {}});
    }
    radii = {std::move(own), std::move(edges)};
}

} // namespace tungsten::photon
