#include "tungsten/scene/LoadContext.h"

#include "tungsten/scene/LoadEmitters.h"

#include <map>

namespace tungsten {

namespace {

using SurfaceReader = Shape (*)(LoadContext&, const ObjectReader&, const Transform&);

Shape readMesh(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    TriangleMesh mesh;
    mesh.smooth = reader.flag("smooth", false);
    const bool smooth = mesh.smooth, recompute = reader.flag("recompute_normals", false);
    reader.accept({"backface_culling"});
    const std::string file = reader.text("file", "");
    if (file.empty()) {
        reader.problem("file", "a mesh needs a file (.wo3, .obj, .ply, .gltf or .glb)");
        return mesh;
    }
    try {
        mesh = loadMesh(context.resource(file));
    } catch (const InputError& error) {
        reader.problem("file", error.what());
        return TriangleMesh{};
    }
    mesh.smooth = smooth;
    if (smooth && recompute) recomputeNormals(mesh);
    if (!smooth) std::vector<Vec3f>().swap(mesh.normals);
    transformMesh(mesh, transform);
    return mesh;
}

Shape readQuad(LoadContext&, const ObjectReader&, const Transform& transform) {
    return makeQuad(transform);
}
Shape readCube(LoadContext&, const ObjectReader&, const Transform& transform) {
    return makeCube(transform);
}
Shape readSphere(LoadContext&, const ObjectReader&, const Transform& transform) {
    return makeSphere(transform);
}
Shape readDisk(LoadContext&, const ObjectReader& reader, const Transform& transform) {
    return makeDisk(transform, float(reader.number("cone_angle", 90.0, {0.0, 180.0})));
}

const std::map<std::string, SurfaceReader>& surfaceReaders() {
    static const std::map<std::string, SurfaceReader> readers{
        {"mesh", readMesh}, {"quad", readQuad}, {"cube", readCube}, {"sphere", readSphere}, {"disk", readDisk}};
    return readers;
}

const std::vector<std::string>& unsupportedTypes() {
    static const std::vector<std::string> types{"cylinder", "infinite_sphere_cap", "skydome", "instances",
                                                "curves",   "minecraft_map"};
    return types;
}

Region regionOn(const LoadContext& context, int medium, double speed) {
    if (medium >= 0) return {medium, context.scene.media[size_t(medium)].speedOfLight};
    return {-1, speed > 0.0 ? float(speed) : context.scene.transport.vacuumSpeed};
}

/// What lies on the two sides: a surface that names any medium or speed bounds the region; what it leaves out is
/// vacuum.
void readRegions(LoadContext& context, const ObjectReader& reader, Primitive& primitive) {
    const bool hasInside = reader.has("int_medium"), hasOutside = reader.has("ext_medium");
    const double insideSpeed = reader.number("int_speed_of_light", -1.0),
                 outsideSpeed = reader.number("ext_speed_of_light", -1.0);
    const int inside = hasInside ? readMediumReference(context, reader, "int_medium") : -1;
    const int outside = hasOutside ? readMediumReference(context, reader, "ext_medium") : -1;
    primitive.boundsMedium = hasInside || hasOutside;
    primitive.boundsRegion = primitive.boundsMedium || insideSpeed > 0.0 || outsideSpeed > 0.0;
    primitive.inside = regionOn(context, inside, insideSpeed);
    primitive.outside = regionOn(context, outside, outsideSpeed);
}

bool isUsable(const Shape& shape) {
    const auto* mesh = std::get_if<TriangleMesh>(&shape);
    return !mesh || !mesh->triangles.empty();
}

void readSurface(LoadContext& context, const ObjectReader& reader, SurfaceReader readShape) {
    const Transform transform = reader.transform("transform");
    Primitive primitive;
    primitive.name = reader.text("name", "");
    primitive.shape = readShape(context, reader, transform);
    primitive.bsdfs = readBsdfList(context, reader, "bsdf");
    readRegions(context, reader, primitive);
    const std::optional<Texture> radiance = readAreaRadiance(context, reader, primitive.shape);
    const double emissionTime = readEmissionTime(reader);
    if (!isUsable(primitive.shape)) {
        if (context.scene.geometry == nullptr) reader.warn("file", "the mesh has no triangles: left out");
        return;
    }
    context.scene.primitives.push_back(std::move(primitive));
    if (!radiance) return;
    Primitive& stored = context.scene.primitives.back();
    stored.emitter = int(context.scene.emitters.size());
    Emitter emitter;
    emitter.name = stored.name;
    emitter.emissionTime = emissionTime;
    emitter.medium = stored.outside.medium;
    emitter.vacuumSpeed = stored.outside.medium < 0 ? stored.outside.speed : -1.0f;
    emitter.model = AreaEmitter{&stored.shape, uint32_t(context.scene.primitives.size() - 1), *radiance,
                                std::make_shared<const AreaSampler>(stored.shape)};
    context.scene.emitters.push_back(std::move(emitter));
    context.emitters.push_back(reader);
}

void readPrimitive(LoadContext& context, const ObjectReader& reader) {
    const std::string type = reader.text("type", "");
    const auto surface = surfaceReaders().find(type);
    if (surface != surfaceReaders().end()) {
        readSurface(context, reader, surface->second);
    } else if (!readPointOrInfiniteEmitter(context, reader, type)) {
        const auto& known = unsupportedTypes();
        const std::string near = nearestName(type, primitiveTypes());
        if (std::find(known.begin(), known.end(), type) != known.end())
            reader.problem("type", "primitives of type '" + type +
                                       "' are not supported; supported: " + listOf(primitiveTypes()));
        else
            reader.problem("type", "expected " + listOf(primitiveTypes()) + ", found '" + type + "'" +
                                       (near.empty() ? "" : "; did you mean '" + near + "'?"));
        return;
    }
    reader.warnAboutUnknown();
}

} // namespace

std::vector<std::string> primitiveTypes() {
    std::vector<std::string> types = emitterTypes();
    for (const auto& [type, reader] : surfaceReaders()) types.push_back(type);
    return types;
}

void readPrimitives(LoadContext& context, const ObjectReader& root) {
    for (const ObjectReader& primitive : root.objects("primitives")) readPrimitive(context, primitive);
    finishEmitters(context, root);
}

} // namespace tungsten
