// The renderer block, and what every integrator's block has in common.

#include "tungsten/scene/LoadContext.h"

#include <algorithm>
#include <functional>

namespace tungsten {

namespace {

constexpr double MostFrames = 1e6;

void readOutputBuffer(const ObjectReader& buffer, RendererSettings& renderer) {
    static const std::vector<std::string> types{"color", "depth", "normal", "albedo", "visibility", "transients"};
    const std::string type = buffer.choice("type", "color", types);
    if (!buffer.has("type")) buffer.problem("type", "an output buffer needs a type: " + listOf(types));
    const OutputBuffer files{buffer.text("ldr_output_file", ""), buffer.text("hdr_output_file", "")};
    for (const char* variance : {"two_buffer_variance", "sample_variance"})
        if (buffer.flag(variance, false))
            buffer.warn(variance, "not produced; the stderr layer of an EXR holds each pixel's standard error");
    if (type == "transients")
        renderer.transients.push_back(files);
    else if (type == "color")
        renderer.colors.push_back(files);
    else
        buffer.warn("type", "the " + type + " buffer is not produced");
    buffer.warnAboutUnknown();
}

/// Whether a block of this type without a gate of its own still has the transient integrators' default gate.
bool isTransientType(const std::string& type) {
    return type.find("transient_") != std::string::npos;
}
bool isSteadyPhotonMap(const std::string& type) {
    return type == "photon_map" || type == "progressive_photon_map";
}

TimeGate readGate(const ObjectReader& reader, const std::string& type) {
    const double defaultWidth = isTransientType(type) ? 0.1 : 0.0;
    const double width = reader.number("transient_time_width", defaultWidth, Range::nonNegative());
    const double centre = reader.number("transient_time_center", isTransientType(type) ? 0.0 : -1.0);
    const double start = reader.number("start_time", 0.0);
    const int frames = int(reader.integer("frame_num", 0, {0, MostFrames}));
    const bool delta = reader.flag("delta_time_gate", false);
    TimeGate gate;
    if (isSteadyPhotonMap(type)) return gate;
    if (delta) {
        gate = {false, true, centre, 0.0, 1};
    } else if (frames > 0) {
        if (width <= 0.0)
            reader.problem("transient_time_width", "a sequence (frame_num > 0) needs a frame width above 0");
        gate = {false, false, start, width, frames};
    } else if (width > 0.0 && (centre >= 0.0 || isTransientType(type))) {
        gate = {false, false, centre - 0.5 * width, width, 1};
    } else if (isTransientType(type)) {
        reader.problem("transient_time_width", "a time gate needs a width above 0 (or delta_time_gate)");
    } else if (width > 0.0 && !reader.has("temporal_response")) {
        reader.warn("transient_time_width",
                    "no gate without a transient_time_center of at least 0, or frame_num: rendered in steady state");
    }
    return gate;
}

TemporalResponse gaussianResponse(double centre, double sigma) {
    constexpr int Points = 65;
    constexpr double Reach = 4.0; // standard deviations
    TemporalResponse response;
    for (int i = 0; i < Points; ++i) {
        const double x = Reach * (2.0 * i / (Points - 1) - 1.0);
        response.times.push_back(centre + x * sigma);
        response.values.push_back(std::exp(-0.5 * x * x));
    }
    return response;
}

/// Why (times, values) are no response; empty if they are.
std::string responseProblem(const TemporalResponse& response) {
    const std::vector<double>&times = response.times, &values = response.values;
    if (times.size() < 2 || times.size() != values.size()) return "expected as many values as times, at least two";
    if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
        return "expected increasing times";
    if (std::any_of(values.begin(), values.end(), [](double v) { return v < 0.0; }))
        return "expected no negative value";
    if (std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; })) return "zero at all times";
    return {};
}

TemporalResponse readResponse(const ObjectReader& reader) {
    const auto block = reader.has("temporal_response") ? reader.object("temporal_response") : std::nullopt;
    if (!block) return {};
    TemporalResponse response;
    const std::string type = block->choice("type", "tabulated", {"box", "gaussian", "tabulated"});
    if (type == "box") {
        response = {{block->number("start", 0.0), block->number("end", 1.0)}, {1.0, 1.0}};
    } else if (type == "gaussian") {
        const double centre = block->number("center", 0.0);
        response = gaussianResponse(centre, block->number("sigma", 1.0, Range::positive()));
    } else {
        response = {block->numbers("times"), block->numbers("values")};
    }
    const std::string problem = responseProblem(response);
    if (!problem.empty()) block->problem(type == "box" ? "end" : "times", problem);
    block->warnAboutUnknown();
    return problem.empty() ? response : TemporalResponse{};
}

/// The response's support becomes the gate.
void useResponse(const ObjectReader& reader, TransportSettings& transport) {
    transport.response = readResponse(reader);
    if (transport.response.empty()) return;
    if (transport.gate.frames > 1 || transport.gate.delta)
        reader.problem("temporal_response", "describes a single gate; leave out frame_num and delta_time_gate");
    if (transport.integrateOverGate)
        reader.problem("time_normalization", "a temporal response has an integral of 1 and no other normalization");
    const double start = transport.response.times.front(), end = transport.response.times.back();
    transport.gate = {false, false, start, end - start, 1};
}

} // namespace

TransportSettings readTransport(const ObjectReader& reader, const std::string& type) {
    TransportSettings transport;
    transport.minBounces = int(reader.integer("min_bounces", 0, {0, 2e9}));
    transport.maxBounces = int(reader.integer("max_bounces", 64, {0, 2e9}));
    transport.twoSidedShading = reader.flag("enable_two_sided_shading", true);
    transport.consistencyChecks = reader.flag("enable_consistency_checks", false);
    transport.gate = readGate(reader, type);
    transport.cameraUnwarped = reader.flag("camera_unwarped", false);
    transport.integrateOverGate = reader.choice("time_normalization", "average", {"average", "integral"}) == "integral";
    if (!isSteadyPhotonMap(type)) useResponse(reader, transport);
    transport.vacuumSpeed = float(reader.number("vaccum_speed_of_light", 1.0, Range::positive()));
    return transport;
}

RendererSettings readRenderer(const ObjectReader& root) {
    RendererSettings renderer;
    const ObjectReader reader = root.has("renderer") && root.isObject("renderer")
                                    ? *root.object("renderer")
                                    : ObjectReader::empty("renderer", root.diagnostics());
    renderer.outputDirectory = reader.text("output_directory", "");
    renderer.outputFile = reader.text("output_file", renderer.outputFile);
    renderer.hdrOutputFile = reader.text("hdr_output_file", "");
    renderer.resumeFile = reader.text("resume_render_file", renderer.resumeFile);
    renderer.overwriteOutputFiles = reader.flag("overwrite_output_files", true);
    renderer.enableResume = reader.flag("enable_resume_render", false);
    renderer.spp = reader.integer("spp", renderer.spp, {1, 1e12});
    renderer.sppStep = reader.integer("spp_step", renderer.sppStep, {1, 1e6});
    renderer.checkpointSeconds = reader.durationSeconds("checkpoint_interval", 0.0);
    renderer.timeoutSeconds = reader.durationSeconds("timeout", 0.0);
    for (const ObjectReader& buffer : reader.objects("output_buffers")) readOutputBuffer(buffer, renderer);
    // Choices of the format that make no difference here.
    reader.accept({"variance_output_file", "adaptive_sampling", "stratified_sampler", "scene_bvh"});
    reader.warnAboutUnknown();
    return renderer;
}

} // namespace tungsten
