#pragma once
// The film that a scene asks for.

#include "tungsten/film/Film.h"
#include "tungsten/scene/Scene.h"

namespace tungsten {

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
