// The renderer block, and what every integrator's block has in common.

#include "tungsten/scene/LoadContext.h"
#include "tungsten/scene/LoadTimeProfile.h"

#include <algorithm>

namespace tungsten {

namespace {

constexpr double MostFrames = 1e6;

void readOutputBuffer(const ObjectReader& buffer, RendererSettings& renderer) {
    static const std::vector<std::string> types{"color", "depth", "normal", "albedo", "visibility", "transients"};
    const std::string type = buffer.choice(
        "type", "color", types,
        {"none", "color: further files of the image; transients: a series of frames; others are not written",
         "required"});
    if (!buffer.has("type")) buffer.problem("type", "an output buffer needs a type: " + listOf(types));
    const OutputBuffer files{buffer.text("ldr_output_file", "", {"none", meaning::EightBitImage}),
                             buffer.text("hdr_output_file", "", {"none", meaning::LinearImage})};
    for (const char* variance : {"two_buffer_variance", "sample_variance"})
        if (buffer.flag(variance, false, {"none", "not produced: the EXR has a stderr layer"}))
            buffer.warn(variance, "not produced; the stderr layer of an EXR holds each pixel's standard error");
    if (type == "transients")
        renderer.transients.push_back(files);
    else if (type == "color")
        renderer.colors.push_back(files);
    else
        buffer.warn("type", "the " + type + " buffer is not produced");
    buffer.warnAboutUnknown();
}

/// The sensor's gate, and whether it is a sequence of frames.
struct GateRead {
    TimeGate gate;
    bool sequence = false;
};

GateRead readGate(const ObjectReader& reader, DefaultGate defaultGate) {
    if (defaultGate == DefaultGate::Never) {
        reader.accept({"transient_time_width", "transient_time_center", "start_time", "frame_num", "delta_time_gate"});
        return {};
    }
    const bool transient = defaultGate == DefaultGate::Gated;
    const double width = reader.number("transient_time_width", transient ? 0.1 : 0.0,
                                       {"time",
                                        "width of the gate, or of each frame; for photons at a delta gate of their "
                                        "temporal kernel in the first pass",
                                        transient ? nullptr : "none"},
                                       {0.0, Range::measure().high});
    const double centre =
        reader.number("transient_time_center", transient ? 0.0 : -1.0,
                      {"time", transient ? "centre of the gate" : "centre of the gate; below 0: steady state",
                       transient ? nullptr : "none"},
                      Range::measure());
    const double start = reader.number("start_time", 0.0, {"time", "when the first frame starts"}, Range::measure());
    const int frames =
        int(reader.integer("frame_num", 0, {"none", "frames of a sequence; 0: one gate"}, {0, MostFrames}));
    const bool delta = reader.flag("delta_time_gate", false, {"none", "the gate is a single moment, its centre"});
    const auto without = [&](const char* field, const char* with, const std::string& what) {
        if (reader.has(field)) reader.warn(field, std::string("not looked at beside ") + with + ": " + what);
    };
    TimeGate gate;
    if (delta) {
        if (frames > 0) without("frame_num", "delta_time_gate", "a single moment has one frame");
        gate = {false, true, centre, 0.0, 1};
    } else if (frames > 0) {
        if (width <= 0.0)
            reader.problem("transient_time_width", "a sequence (frame_num > 0) needs a frame width above 0");
        gate = {false, false, start, width, frames};
        if (centre >= 0.0) // below: none
            without("transient_time_center", "frame_num",
                    "the first frame starts at start_time (" + brief(start) + ")");
    } else if (width > 0.0 && (centre >= 0.0 || transient)) {
        gate = {false, false, centre - 0.5 * width, width, 1};
    } else if (transient) {
        reader.problem("transient_time_width", "a time gate needs a width above 0 (or delta_time_gate)");
    } else if (width > 0.0 && !reader.has("temporal_response")) {
        reader.warn("transient_time_width",
                    "no gate without a transient_time_center of at least 0, or frame_num: rendered in steady state");
    } else if (centre >= 0.0 && !reader.has("temporal_response")) {
        reader.warn("transient_time_center",
                    "no gate without a transient_time_width above 0: rendered in steady state");
    }
    return {gate, frames > 0 && !delta};
}

/// The format misspells it; both spellings are read.
float readVacuumSpeed(const ObjectReader& reader) {
    const char *const format = "vaccum_speed_of_light", *const right = "vacuum_speed_of_light";
    const Range range = Range::positiveMeasure();
    const double speed = reader.number(
        right, 1.0, {"length/time", "speed of light outside media; media have a speed_of_light of their own"}, range);
    const double formats =
        reader.number(format, speed, {"length/time", "the same, as the format spells it", right}, range);
    if (reader.has(right) && formats != speed)
        reader.problem(right, "is " + brief(speed) + ", but " + format + ", the format's spelling of the same, is " +
                                  brief(formats) + "; say one of them");
    return float(formats);
}

/// Of a single gate, whose times it then is; of a sequence it is a delay.
void useResponse(const ObjectReader& reader, bool sequence, TransportSettings& transport) {
    TimeProfile response =
        readTimeProfile(reader, "temporal_response",
                        {"none", "how the sensor weighs times of arrival, instead of a gate; with frame_num: how long "
                                 "after its arrival light is recorded"});
    if (response.empty()) return;
    if (transport.gate.delta)
        return reader.problem("temporal_response", "says when the sensor is open; leave out delta_time_gate");
    if (sequence) {
        transport.delay = std::move(response);
        return;
    }
    if (transport.integrateOverGate)
        reader.problem("time_normalization", "a temporal response has an integral of 1 and no other normalization");
    const double start = response.times.front(), end = response.times.back();
    transport.gate = {false, false, start, end - start, 1};
    transport.response = std::move(response);
}

std::optional<ExposureChoice> readExposure(const ObjectReader& reader) {
    constexpr Meaning meaning{"stops", "factor 2^stops on 8-bit images; auto: the brightest of each is about white"};
    reader.declare("exposure", "a number from -100 to 100, or auto", "auto with a gate, 0 in steady state", meaning);
    if (!reader.has("exposure")) return std::nullopt;
    if (!reader.isText("exposure"))
        return ExposureChoice{false, reader.number("exposure", 0.0, meaning, {-MostStops, MostStops})};
    (void)reader.choice("exposure", "auto", {"auto"}, meaning);
    return ExposureChoice{};
}

} // namespace

std::string readIntegratorType(const ObjectReader& integrator) {
    return integrator.text("type", "path_tracer", {"none", "which integrator (--list)"});
}

DefaultGate defaultGateOf(const std::string& type) {
    if (type == "photon_map" || type == "progressive_photon_map") return DefaultGate::Never;
    return type.find("transient_") != std::string::npos ? DefaultGate::Gated : DefaultGate::None;
}

TransportSettings readTransport(const ObjectReader& reader, DefaultGate defaultGate) {
    TransportSettings transport;
    transport.minBounces = int(reader.integer(
        "min_bounces", 0, {"none", "interactions, as max_bounces counts them, that light must have had"}, {0, 2e9}));
    transport.maxBounces =
        int(reader.integer("max_bounces", 64,
                           {"none", "interactions that light must have had fewer of: each scattering, reflection, "
                                    "refraction and straight passage through a surface is one; 1: emitters "
                                    "seen directly alone, 2: what was scattered or reflected once, too"},
                           {0, 2e9}));
    transport.twoSidedShading =
        reader.flag("enable_two_sided_shading", true, {"none", "opaque surfaces scatter on both sides"});
    transport.consistencyChecks =
        reader.flag("enable_consistency_checks", false,
                    {"none", "no light where shading and geometric normal disagree on the side"});
    const GateRead read = readGate(reader, defaultGate);
    transport.gate = read.gate;
    transport.cameraUnwarped = reader.flag(
        "camera_unwarped", false, {"none", "time stops at the first thing seen: camera segments do not count"});
    transport.integrateOverGate =
        reader.choice("time_normalization", "average", {"average", "integral"},
                      {"none", "a pixel is the mean of radiance over its frame, or its integral"}) == "integral";
    if (defaultGate != DefaultGate::Never) useResponse(reader, read.sequence, transport);
    transport.vacuumSpeed = readVacuumSpeed(reader);
    return transport;
}

FilmContents readFilm(const ObjectReader& reader) {
    FilmContents film;
    const std::string channels =
        reader.choice("channels", "rgb", {"rgb", "luminance"},
                      {"none", "what is kept of each pixel of each frame; luminance takes a third of the memory"});
    film.channels = channels == "rgb" ? 3 : 1;
    film.moments = reader.flag("moments", true,
                               {"none", "second moments, a third of the memory: standard errors by pixel and frame; "
                                        "without them that of the whole film is still known"});
    film.batches = int(reader.integer("batches", 0,
                                      {"none", "groups of passes whose means over blocks of pixels are kept (16 is "
                                               "enough), for the errors of regions; 0: none"},
                                      {0, 256}));
    film.batchBlock = int(reader.integer("batch_block", 4, {"pixels", "side of those blocks"}, {1, 4096}));
    if (film.batches == 1) reader.problem("batches", "expected 0, or 2 and more: one batch tells no error, found 1");
    reader.refuseUnknown();
    return film;
}

RendererSettings readRenderer(const ObjectReader& reader) {
    RendererSettings renderer;
    renderer.outputDirectory =
        reader.text("output_directory", "", {"none", "base of the files below", "the scene's folder"});
    renderer.outputFile = reader.text("output_file", renderer.outputFile, {"none", meaning::ToneMappedImage});
    renderer.hdrOutputFile = reader.text("hdr_output_file", "", {"none", meaning::LinearImage});
    renderer.exposure = readExposure(reader);
    const std::string state =
        reader.text("resume_render_file", "",
                    {"none", "where a render's state goes", "output_file with State.dat for its extension"});
    if (reader.has("resume_render_file")) renderer.resumeFile = state;
    renderer.overwriteOutputFiles =
        reader.flag("overwrite_output_files", true, {"none", "false: where the file exists a free name is taken"});
    renderer.enableResume =
        reader.flag("enable_resume_render", false, {"none", "the state is saved, and read when there is one"});
    renderer.spp = reader.integer("spp", renderer.spp, {"samples/pixel", "in total"}, {1, 1e12});
    renderer.sppStep =
        reader.integer("spp_step", renderer.sppStep,
                       {"samples/pixel", "in each pass; each pass of a photon map has photons of its own"}, {1, 1e6});
    renderer.checkpointSeconds = reader.durationSeconds(
        "checkpoint_interval", 0.0, {"duration", "how often images and state are saved; no unit: minutes"});
    renderer.timeoutSeconds =
        reader.durationSeconds("timeout", 0.0, {"duration", "of preparing and rendering; no unit: minutes"});
    for (const ObjectReader& buffer : reader.blocks("output_buffers", {"none", "further files"}))
        readOutputBuffer(buffer, renderer);
    // Choices of the format that make no difference here.
    reader.accept({"variance_output_file", "adaptive_sampling", "stratified_sampler", "scene_bvh"});
    reader.warnAboutUnknown();
    return renderer;
}

} // namespace tungsten
