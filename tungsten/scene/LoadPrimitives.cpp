#include "tungsten/scene/LoadContext.h"

#include "tungsten/core/Overloaded.h"
#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadEmitters.h"

#include <map>

namespace tungsten {

namespace {

using SurfaceReader = Shape (*)(LoadContext&, const ObjectReader&, const Transform&);

Shape readMesh(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    TriangleMesh mesh;
    mesh.smooth = reader.flag("smooth", false, {"none", "shading normals are interpolated"});
    const bool smooth = mesh.smooth;
    const bool recompute =
        reader.flag("recompute_normals", false, {"none", "of smooth meshes: from the triangles instead of the file"});
    reader.accept({"backface_culling"});
    const std::string file = reader.text("file", "", {"none", ".wo3, .obj, .ply, .gltf or .glb", "required"});
    if (file.empty()) {
        reader.problem("file", "a mesh needs a file (.wo3, .obj, .ply, .gltf or .glb)");
        return mesh;
    }
    try {
        mesh = loadMesh(context.files.find(file), context.files.allowedFolder(), context.files.watch);
    } catch (const InputError& error) {
        reader.problem("file", error.what());
        return TriangleMesh{};
    }
    mesh.smooth = smooth;
    if (smooth && recompute) recomputeNormals(mesh, context.files.watch);
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
    return makeDisk(transform,
                    float(reader.number("cone_angle", 90.0, {"degrees", "it emits within that angle of its normal"},
                                        {0.0, 180.0})));
}

const std::map<std::string, SurfaceReader>& surfaceReaders() {
    static const std::map<std::string, SurfaceReader> readers{
        {"mesh", readMesh}, {"quad", readQuad}, {"cube", readCube}, {"sphere", readSphere}, {"disk", readDisk}};
    return readers;
}

Region regionOn(const LoadContext& context, int medium, double speed) {
    if (medium >= 0) return {medium, context.scene.media[size_t(medium)].speedOfLight};
    return {-1, speed > 0.0 ? float(speed) : context.scene.transport.vacuumSpeed};
}

/// What lies on the two sides: a surface that names any medium or speed bounds the region; what it leaves out is
/// vacuum.
void readRegions(LoadContext& context, const ObjectReader& reader, Primitive& primitive) {
    const int inside = readMediumReference(context, reader, "int_medium", {"none", "behind its normal"});
    const int outside = readMediumReference(context, reader, "ext_medium", {"none", "before its normal"});
    const double insideSpeed = readSpeedOrNone(
        reader, "int_speed_of_light",
        {"length/time", "speed of light behind its normal, where there is no medium", "vacuum_speed_of_light"});
    const double outsideSpeed = readSpeedOrNone(
        reader, "ext_speed_of_light",
        {"length/time", "speed of light before its normal, where there is no medium", "vacuum_speed_of_light"});
    primitive.boundsMedium = reader.has("int_medium") || reader.has("ext_medium");
    primitive.boundsRegion = primitive.boundsMedium || insideSpeed > 0.0 || outsideSpeed > 0.0;
    primitive.inside = regionOn(context, inside, insideSpeed);
    primitive.outside = regionOn(context, outside, outsideSpeed);
}

/// Areas of what lies further out are no numbers, and Embree leaves it out without a word.
constexpr float LargestCoordinate = 2e9f;

bool isNear(const Vec3f& p) {
    return std::abs(p.x) <= LargestCoordinate && std::abs(p.y) <= LargestCoordinate &&
           std::abs(p.z) <= LargestCoordinate;
}

bool isPlaced(const Shape& shape) {
    return std::visit(Overloaded{[](const TriangleMesh& mesh) {
                                     return std::all_of(mesh.positions.begin(), mesh.positions.end(), isNear);
                                 },
                                 [](const OneOf<Sphere, Disk> auto& round) {
                                     return isNear(round.centre) && round.radius <= LargestCoordinate;
                                 }},
                      shape);
}

bool isUsable(const Shape& shape) {
    return std::visit(Overloaded{[](const TriangleMesh& mesh) { return !mesh.triangles.empty(); },
                                 [](const OneOf<Sphere, Disk> auto&) { return true; }},
                      shape);
}

void readSurface(LoadContext& context, const ObjectReader& reader, SurfaceReader readShape) {
    const Transform transform = reader.transform("transform", PlacementMeaning);
    Primitive primitive;
    primitive.name = reader.text("name", "", NameMeaning);
    primitive.path = reader.path();
    primitive.shape = readShape(context, reader, transform);
    if (!isPlaced(primitive.shape))
        reader.problem("transform", "the surface reaches beyond coordinates of " + brief(double(LargestCoordinate)));
    primitive.bsdfs = context.fieldsOf(reader).bsdfs(
        "bsdf", {"none", "how it scatters light; an array goes by the mesh's materials", "white Lambert"});
    readRegions(context, reader, primitive);
    const std::optional<Texture> radiance = AreaEmitter::readRadiance(context.fieldsOf(reader), primitive.shape);
    EmissionTimes times = readEmissionTimes(reader);
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
    emitter.path = stored.path;
    emitter.emissionTime = times.start;
    emitter.pulse = std::move(times.pulse);
    emitter.medium = stored.outside.medium;
    emitter.vacuumSpeed = stored.outside.medium < 0 ? stored.outside.speed : -1.0f;
    emitter.model = AreaEmitter{{},
                                &stored.shape,
                                uint32_t(context.scene.primitives.size() - 1),
                                *radiance,
                                std::make_shared<const AreaSampler>(stored.shape)};
    context.scene.emitters.push_back(std::move(emitter));
    context.emitters.push_back(reader);
}

constexpr Meaning TypeMeaning{"none", "which shape or light source", "required"};

void readPrimitive(LoadContext& context, const ObjectReader& reader) {
    if (reader.describes()) reader.declare("type", listOf(primitiveTypes()), "none", TypeMeaning);
    const std::string type = reader.text("type", "", TypeMeaning);
    const auto surface = surfaceReaders().find(type);
    if (surface != surfaceReaders().end()) {
        readSurface(context, reader, surface->second);
    } else if (!readLightSource(context, reader, type)) {
        reader.problem("type", refusal(type, "'" + type + "'", primitiveTypes(), unsupportedPrimitives()));
        return;
    }
    reader.warnAboutUnknown();
}

} // namespace

std::vector<std::string> primitiveTypes() {
    std::vector<std::string> types = LightSources::types();
    for (const auto& [type, reader] : surfaceReaders()) types.push_back(type);
    return types;
}

void describePrimitive(const std::shared_ptr<Description>& description) {
    ScratchContext scratch;
    readPrimitive(scratch.context, ObjectReader::describing(description, description->name));
}

void readPrimitives(LoadContext& context, const ObjectReader& root) {
    for (const ObjectReader& primitive : root.objects("primitives", {"none", "surfaces and light sources"})) {
        context.files.watch.poll();
        readPrimitive(context, primitive);
    }
    finishEmitters(context, root);
}

} // namespace tungsten
