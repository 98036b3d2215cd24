#pragma once
// Memory: what there is, the film that a scene asks for, and refusing what does not fit before it is asked for.

#include "tungsten/core/AvailableMemory.h"
#include "tungsten/film/Film.h"
#include "tungsten/scene/Scene.h"

namespace tungsten {

struct LoadedScene;

/// Throws InputError unless `films` films of the scene and the integrator's bytes fit into `limit` (0: what is
/// available).
void requireMemory(const LoadedScene& loaded, double films, double integratorBytes, double limit);

/// From now on freed memory stays with the process, up to half a gigabyte: passes take and free the same every time,
/// and having the system clear its pages anew costs about 1 % of a pass.
void keepFreedMemory();

/// From now on allocations beyond so many bytes fail (std::bad_alloc), instead of having the kernel end the process.
/// What the libraries and the threads' stacks take comes on top: without it they end the process themselves.
void limitMemory(double bytes, unsigned threads);

inline Film filmOf(const Scene& scene, PassWeight meaning = PassWeight::Samples) {
    const Vec2i size = scene.camera.resolution;
    FilmContents contents = scene.film;
    if (meaning == PassWeight::Repeats) contents.batches = 0; // of the image alone
    return {size.x, size.y, scene.transport.gate.frames, contents, meaning};
}

/// Bytes that it takes.
inline double filmMemoryOf(const Scene& scene) {
    const Vec2i size = scene.camera.resolution;
    return Film::memoryFor(size.x, size.y, scene.transport.gate.frames, scene.film);
}

} // namespace tungsten
