#include "tungsten/scene/LoadContext.h"

#include "tungsten/geometry/ShapeReader.h"
#include "tungsten/reader/FormatTypes.h"
#include "tungsten/scene/LoadEmitters.h"

namespace tungsten {

namespace {

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

void readSurface(LoadContext& context, const ObjectReader& reader, const std::string& type) {
    const Transform transform = reader.transform("transform", PlacementMeaning);
    Primitive primitive;
    primitive.name = reader.text("name", "", NameMeaning);
    primitive.path = reader.path();
    const ShapeReader fields(reader, context.files, transform);
    primitive.shape = ShapeSources::read(type, [&]<typename Model> { return Shape(Model::read(fields)); });
    if (!std::visit([](const auto& m) { return m.isWithin(LargestCoordinate); }, primitive.shape))
        reader.problem("transform", "the surface reaches beyond coordinates of " + brief(double(LargestCoordinate)));
    primitive.bsdfs = context.fieldsOf(reader).bsdfs(
        "bsdf", {"none", "how it scatters light; an array goes by the mesh's materials", "white Lambert"});
    readRegions(context, reader, primitive);
    const std::optional<Texture> radiance = AreaEmitter::readRadiance(context.fieldsOf(reader), primitive.shape);
    EmissionTimes times = readEmissionTimes(reader);
    if (std::visit([](const auto& m) { return m.isEmpty(); }, primitive.shape)) {
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
    if (ShapeSources::has(type)) {
        readSurface(context, reader, type);
    } else if (!readLightSource(context, reader, type)) {
        reader.problem("type", refusal(type, "'" + type + "'", primitiveTypes(), unsupportedPrimitives()));
        return;
    }
    reader.warnAboutUnknown();
}

} // namespace

std::vector<std::string> primitiveTypes() {
    std::vector<std::string> types = LightSources::types();
    const std::vector<std::string> shapes = ShapeSources::types();
    types.insert(types.end(), shapes.begin(), shapes.end());
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
