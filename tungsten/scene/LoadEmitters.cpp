#include "tungsten/scene/LoadEmitters.h"

#include "tungsten/emitter/EmitterReader.h"
#include "tungsten/scene/LoadTimeProfile.h"

namespace tungsten {

namespace {

constexpr Meaning SurroundingsMeaning{"none", "medium in which its light starts", "vacuum"};
constexpr Meaning SurroundingSpeedMeaning{"length/time", "speed of light around it, where there is no medium",
                                          "vacuum_speed_of_light"};

void addEmitter(LoadContext& context, const ObjectReader& reader, EmitterVariant model) {
    Emitter emitter;
    emitter.name = reader.text("name", "", NameMeaning);
    emitter.path = reader.path();
    emitter.model = std::move(model);
    if (emitter.isInfinite() && !context.scene.transport.gate.steadyState)
        reader.problem("type",
                       "light of an infinite_sphere never arrives in a time-resolved render; remove it, or render "
                       "steady state");
    EmissionTimes times = readEmissionTimes(reader);
    emitter.emissionTime = times.start;
    emitter.pulse = std::move(times.pulse);
    emitter.medium = readMediumReference(context, reader, "ext_medium", SurroundingsMeaning);
    emitter.vacuumSpeed = float(readSpeedOrNone(reader, "ext_speed_of_light", SurroundingSpeedMeaning));
    if (reader.describes()) return;
    context.scene.emitters.push_back(std::move(emitter));
    context.emitters.push_back(reader);
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

bool readLightSource(LoadContext& context, const ObjectReader& reader, const std::string& type) {
    if (!LightSources::has(type)) return false;
    const Transform transform = reader.transform("transform", PlacementMeaning);
    // Known even where the emitter turns out dark. A light source without a surface has no inside and no material;
    // scenes name them all the same.
    reader.accept({"name", "ext_medium", "int_medium", "ext_speed_of_light", "int_speed_of_light", "bsdf",
                   "emission_time", "pulse"});
    const EmitterReader fields(context.fieldsOf(reader), transform);
    auto model =
        LightSources::read(type, [&]<typename Model> { return std::optional<EmitterVariant>(Model::read(fields)); });
    if (model) addEmitter(context, reader, std::move(*model));
    return true;
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
