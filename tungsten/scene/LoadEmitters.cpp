#include "tungsten/scene/LoadEmitters.h"

#include "tungsten/emitter/Power.h"
#include "tungsten/scene/LoadTimeProfile.h"

namespace tungsten {

namespace {

constexpr Meaning PowerMeaning{"power", "all that is emitted, instead of `emission`", "none"};
constexpr Meaning SurroundingsMeaning{"none", "medium in which its light starts", "vacuum"};
constexpr Meaning SurroundingSpeedMeaning{"length/time", "speed of light around it, where there is no medium",
                                          "vacuum_speed_of_light"};

/// `power` wins over `emission`; the flag says which was given.
struct Strength {
    Rgb value{0.0f};
    bool isPower = false;
};

/// `emission` means what the emitter's own function says.
Strength readStrength(LoadContext& context, const ObjectReader& reader, const Meaning& emissionMeaning,
                      const Meaning& powerMeaning = PowerMeaning) {
    const Rgb emission = context.fieldsOf(reader).constantTexture("emission", emissionMeaning);
    const Rgb power = context.fieldsOf(reader).constantTexture("power", powerMeaning);
    return reader.has("power") ? Strength{power, true} : Strength{emission, false};
}

void addEmitter(LoadContext& context, const ObjectReader& reader, EmitterModel model) {
    Emitter emitter;
    emitter.name = reader.text("name", "", NameMeaning);
    emitter.path = reader.path();
    emitter.model = std::move(model);
    EmissionTimes times = readEmissionTimes(reader);
    emitter.emissionTime = times.start;
    emitter.pulse = std::move(times.pulse);
    emitter.medium = readMediumReference(context, reader, "ext_medium", SurroundingsMeaning);
    emitter.vacuumSpeed = float(readSpeedOrNone(reader, "ext_speed_of_light", SurroundingSpeedMeaning));
    if (reader.describes()) return;
    context.scene.emitters.push_back(std::move(emitter));
    context.emitters.push_back(reader);
}

/// Dark emitters are left out.
bool shines(const ObjectReader& reader, const Rgb& strength) {
    return maxComponent(strength) > 0.0f || reader.describes();
}

void readPoint(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    const Strength strength = readStrength(context, reader, {"power/steradian", "intensity in every direction"});
    const Rgb intensity = strength.isPower ? pointIntensityFromPower(strength.value) : strength.value;
    if (shines(reader, intensity)) addEmitter(context, reader, PointEmitter{transform.translation, intensity});
}

void readSpot(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    const float halfAngle =
        float(reader.number("cone_angle", 30.0, {"degrees", "half angle of the cone of light along +z"}, {0.1, 180.0}));
    constexpr Meaning edgeMeaning{"degrees", "width of the cone's edge, across which light fades",
                                  "a tenth of cone_angle"};
    reader.declare("edge_angle", "a number from 0 to cone_angle", "", edgeMeaning);
    const float edge = float(reader.number("edge_angle", 0.1 * halfAngle, edgeMeaning, {0.0, halfAngle}));
    const float radians = Pi / 180.0f;
    SpotEmitter spot;
    spot.position = transform.translation;
    spot.direction = transform.rotation().n;
    spot.cosOuter = std::cos(halfAngle * radians);
    spot.cosInner = std::cos((halfAngle - edge) * radians);
    const Strength strength = readStrength(context, reader, {"power/steradian", "intensity on the axis"});
    spot.intensity =
        strength.isPower ? spotIntensityFromPower(strength.value, spot.cosInner, spot.cosOuter) : strength.value;
    if (shines(reader, spot.intensity)) addEmitter(context, reader, spot);
}

void readDirectionalPoint(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    const Strength strength =
        readStrength(context, reader, {"power/steradian", "as if in every direction: all that is emitted, by 4 pi"});
    const Rgb power = strength.isPower ? strength.value : directionalPointPower(strength.value);
    if (shines(reader, power))
        addEmitter(context, reader, DirectionalPointEmitter{transform.translation, transform.rotation().n, power});
}

void readCollimated(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    const float radius = float(reader.number(
        "radius", 0.0, {"length", "of the parallel light along +z; 0: a single ray"}, {0.0, Range::coordinate().high}));
    const Strength strength =
        readStrength(context, reader, {"power/length^2", "irradiance of the light; of a single ray its power"},
                     {"power", "instead of `emission`, which is it divided by 4 pi", "none"});
    const Rgb power = strength.isPower ? collimatedPowerFromPower(strength.value, radius)
                                       : collimatedPowerFromEmission(strength.value, radius);
    if (shines(reader, power))
        addEmitter(context, reader, CollimatedEmitter{transform.translation, transform.rotation(), radius, power});
}

void readInfiniteSphere(LoadContext& context, const ObjectReader& reader, const Transform& transform) {
    Texture radiance = context.fieldsOf(reader).texture(
        "emission", Texture(0.0f), {"radiance", "by direction, from infinitely far away"}, Range::nonNegative());
    const Texture power = context.fieldsOf(reader).texture("power", Texture(0.0f), PowerMeaning, Range::nonNegative());
    if (reader.has("power")) radiance = infiniteRadianceFromPower(power);
    const bool samplable = reader.flag("sample", true, {"none", "vertices may connect to it"});
    if (!shines(reader, radiance.maximum())) return;
    if (!context.scene.transport.gate.steadyState)
        reader.problem("type",
                       "light of an infinite_sphere never arrives in a time-resolved render; remove it, or render "
                       "steady state");
    addEmitter(context, reader, makeInfiniteSphere(radiance, transform.rotation(), samplable));
}

using EmitterReader = void (*)(LoadContext&, const ObjectReader&, const Transform&);

const std::map<std::string, EmitterReader>& emitterReaders() {
    static const std::map<std::string, EmitterReader> readers{{"point", readPoint},
                                                              {"spot", readSpot},
                                                              {"directional_point", readDirectionalPoint},
                                                              {"collimated", readCollimated},
                                                              {"infinite_sphere", readInfiniteSphere}};
    return readers;
}

} // namespace

double readSpeedOrNone(const ObjectReader& reader, const std::string& field, const Meaning& meaning) {
    const double speed = reader.number(field, -1.0, meaning, {-1.0, Range::measure().high});
    const double least = Range::positiveMeasure().low;
    if (speed > 0.0 && speed < least)
        reader.problem(field,
                       "expected a speed of at least " + brief(least) + ", or none (0 or less), found " + brief(speed));
    return speed;
}

std::vector<std::string> emitterTypes() {
    std::vector<std::string> types;
    for (const auto& [type, reader] : emitterReaders()) types.push_back(type);
    return types;
}

bool readPointOrInfiniteEmitter(LoadContext& context, const ObjectReader& reader, const std::string& type) {
    const auto found = emitterReaders().find(type);
    if (found == emitterReaders().end()) return false;
    const Transform transform = reader.transform("transform", PlacementMeaning);
    // Known even where the emitter turns out dark. A light source without a surface has no inside and no material;
    // scenes name them all the same.
    reader.accept({"name", "ext_medium", "int_medium", "ext_speed_of_light", "int_speed_of_light", "bsdf",
                   "emission_time", "pulse"});
    found->second(context, reader, transform);
    return true;
}

std::optional<Texture> readAreaRadiance(LoadContext& context, const ObjectReader& reader, const Shape& shape) {
    Texture radiance = context.fieldsOf(reader).texture(
        "emission", Texture(0.0f), {"radiance", "emitted to the side of the normal"}, Range::nonNegative());
    const Texture power = context.fieldsOf(reader).texture("power", Texture(0.0f), PowerMeaning, Range::nonNegative());
    if (reader.has("power")) radiance = areaRadianceFromPower(power, surfaceArea(shape));
    if (maxComponent(radiance.maximum()) <= 0.0f) return std::nullopt;
    return radiance;
}

EmissionTimes readEmissionTimes(const ObjectReader& reader) {
    return {reader.number("emission_time", 0.0, {"time", "when its pulse starts"}, Range::measure()),
            readTimeProfile(reader, "pulse",
                            {"none", "how its power is spread over the time after emission_time, instead of a flash"})};
}

namespace {

/// Sensors whose weights are no averages over frames meet flashes alone.
void checkPulses(const LoadContext& context) {
    const TransportSettings& transport = context.scene.transport;
    for (size_t i = 0; i < context.emitters.size(); ++i) {
        if (context.scene.emitters[i].pulse.empty()) continue;
        if (transport.gate.delta)
            context.emitters[i].problem("pulse", "light that is spread over time is not seen at a single moment; leave "
                                                 "out delta_time_gate, and give the gate a width");
        if (!transport.response.empty())
            context.emitters[i].problem("pulse", "a temporal_response without frame_num weighs flashes alone; give the "
                                                 "sensor frames, or put the pulse into the response");
    }
}

} // namespace

void finishEmitters(LoadContext& context, const ObjectReader& root) {
    Scene& scene = context.scene;
    if (scene.emitters.empty()) {
        if (!scene.transport.gate.steadyState) {
            root.problem("primitives",
                         "nothing emits light: a time-resolved render needs a primitive with `emission` or `power`");
            return;
        }
        root.warn("primitives", "nothing emits light: lit by a white environment of radiance 1");
        Emitter sky;
        sky.name = "default environment";
        sky.model = makeInfiniteSphere(Texture(1.0f), Frame(), true);
        scene.emitters.push_back(std::move(sky));
    }
    for (size_t i = 0; i < scene.emitters.size(); ++i)
        if (scene.emitters[i].isInfinite()) scene.infiniteEmitters.push_back(int(i));
    checkPulses(context);
}

} // namespace tungsten
