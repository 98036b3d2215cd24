#pragma once
// How a shape reads itself: fields, files, and where it stands.

#include "tungsten/geometry/Shape.h"
#include "tungsten/reader/ObjectReader.h"
#include "tungsten/reader/Resources.h"

namespace tungsten {

class ShapeReader : public ObjectReader {
  public:
    ShapeReader(const ObjectReader& object, const Resources& resources, const Transform& transform)
        : ObjectReader(object), files(resources), placement(transform) {}

    const Resources& files;
    const Transform placement;
};

// Meshes go by three names.
struct MeshFile {
    static constexpr const char* Type = "mesh";
    static TriangleMesh read(const ShapeReader& fields);
};
struct Quad {
    static constexpr const char* Type = "quad";
    static TriangleMesh read(const ShapeReader& fields) { return makeQuad(fields.placement); }
};
struct Cube {
    static constexpr const char* Type = "cube";
    static TriangleMesh read(const ShapeReader& fields) { return makeCube(fields.placement); }
};

using ShapeSources = ModelSet<MeshFile, Quad, Cube, Sphere, Disk>;

} // namespace tungsten
