#include "tungsten/io/Result.h"

#include "tungsten/scene/JsonWriter.h"

#include <fstream>
#include <limits>
#include <thread>

#include <sys/utsname.h>

namespace tungsten {

namespace {

constexpr double SpeedOfLight = 299792458.0; ///< m/s

std::string kindOf(const TransportSettings& transport) {
    const TimeGate& gate = transport.gate;
    return gate.steadyState              ? "steady state"
           : gate.delta                  ? "single moment"
           : !transport.response.empty() ? "response"
           : gate.frames > 1             ? "frames"
                                         : "gate";
}

void describeTime(JsonWriter& json, const Scene& scene) {
    const std::vector<double> edges = frameEdges(scene.transport.gate);
    json.beginObject("time");
    json.field("kind", kindOf(scene.transport));
    json.field("edges", edges);
    const double picoseconds = picosecondsPerTime(scene);
    if (picoseconds > 0.0) {
        json.field("edges in picoseconds", frameEdgesInPicoseconds(scene));
        json.field("picoseconds per unit", picoseconds);
        json.field("metres per unit of length", scene.lengthUnit);
    }
    json.field("camera segments count", !scene.transport.cameraUnwarped);
    json.field("speed of light in vacuum", double(scene.transport.vacuumSpeed));
    json.field("speed of light at the camera", double(scene.cameraRegion.speed));
    json.endObject();
}

/// By column of the image.
void describeDetectors(JsonWriter& json, const Scene& scene) {
    const auto* detectors = scene.camera.detectors();
    if (!detectors) return;
    std::vector<std::string> names;
    std::vector<double> etendues;
    for (const Detector& detector : detectors->row) {
        names.push_back(detector.name.empty() ? std::to_string(names.size()) : detector.name);
        etendues.push_back(detector.etendue());
    }
    json.beginObject("detectors");
    json.field("names", names);
    json.field("etendues", etendues);
    json.endObject();
}

} // namespace

Image inOutputUnits(Image average, const Scene& scene, int frames) {
    const TimeGate& gate = scene.transport.gate;
    if (!scene.transport.integrateOverGate || gate.steadyState || gate.delta) return average;
    const float width = float(gate.frameWidth * frames);
    for (Rgb& pixel : average.pixels) pixel *= width;
    return average;
}

std::vector<double> frameEdges(const TimeGate& gate) {
    constexpr double Infinite = std::numeric_limits<double>::infinity();
    if (gate.steadyState) return {-Infinite, Infinite};
    std::vector<double> edges;
    for (int frame = 0; frame <= gate.frames; ++frame) edges.push_back(gate.frameStart(frame));
    return edges;
}

double picosecondsPerTime(const Scene& scene) {
    return 1e12 * double(scene.transport.vacuumSpeed) * scene.lengthUnit / SpeedOfLight;
}

std::vector<double> frameEdgesInPicoseconds(const Scene& scene) {
    const double picoseconds = picosecondsPerTime(scene);
    if (picoseconds <= 0.0) return {};
    std::vector<double> edges = frameEdges(scene.transport.gate);
    for (double& edge : edges) edge *= picoseconds;
    return edges;
}

ResultContent::Array batchMeans(const Film& film, const Scene& scene) {
    const BatchMeans& batches = film.batches();
    ResultContent::Array array{"batch_means",
                               {size_t(batches.count()), size_t(film.frames()), size_t(batches.rows()),
                                size_t(batches.columns()), size_t(film.contents().channels)},
                               {batches.means().begin(), batches.means().end()}};
    Image factor(1, 1);
    factor.pixels[0] = Rgb(1.0f);
    const float units = inOutputUnits(factor, scene, 1).pixels[0].x;
    for (float& value : array.values) value *= units;
    return array;
}

ResultContent resultContent(const Film& film, const Film& bias, const Scene& scene, const std::string& metadata) {
    ResultContent content{film.width(), film.height(), film.frames(), film.contents().channels, {}, {}, metadata};
    const auto add = [&](const std::string& mean, const std::string& error, const Film& of) {
        content.images.push_back({mean, [&](int frame) { return inOutputUnits(of.mean(frame), scene, 1); }});
        if (of.contents().moments)
            content.images.push_back(
                {error, [&](int frame) { return inOutputUnits(of.standardError(frame), scene, 1); }});
    };
    add("mean", "standard_error", film);
    if (bias.frames() > 0) add("bias", "bias_standard_error", bias);
    content.vectors = {{"time_edges", frameEdges(scene.transport.gate)}};
    if (film.batches().count() > 0) {
        content.arrays.push_back(batchMeans(film, scene));
        content.vectors.push_back({"batch_weights", film.batches().weights()});
    }
    if (picosecondsPerTime(scene) > 0.0) content.vectors.push_back({"time_edges_ps", frameEdgesInPicoseconds(scene)});
    return content;
}

std::string quantityText(const Scene& scene) {
    const TimeGate& gate = scene.transport.gate;
    const bool integral = scene.transport.integrateOverGate && !gate.steadyState && !gate.delta;
    return integral ? "radiance, integrated over a frame" : "radiance, mean over a frame";
}

std::string describeResult(const ResultOrigin& origin) {
    JsonWriter json;
    json.field("format", "darts-tungsten result");
    json.field("format version", uint64_t(ResultVersion));
    json.field("quantity", quantityText(origin.scene));
    json.field("axes", std::vector<std::string>{"frame", "row", "column", "channel"});
    json.field("channels", origin.scene.film.channels == 1 ? std::vector<std::string>{"Y"}
                                                           : std::vector<std::string>{"R", "G", "B"});
    if (origin.scene.film.batches > 0) json.field("batch block", uint64_t(origin.scene.film.batchBlock));
    describeTime(json, origin.scene);
    describeDetectors(json, origin.scene);
    json.field("integrator", origin.integrator);
    json.field("build", buildText());
    json.field("machine", machineText());
    if (!origin.command.empty()) json.field("command", origin.command);
    json.jsonField("statistics", origin.statistics);
    json.jsonField("scene", origin.sceneText);
    return json.finish();
}

std::string machineText() {
    std::ifstream information("/proc/cpuinfo");
    std::string processor = "unknown processor";
    for (std::string line; std::getline(information, line);)
        if (line.starts_with("model name")) {
            processor = line.substr(line.find(':') + 2);
            break;
        }
    utsname system{};
    ::uname(&system);
    return processor + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads, " + system.sysname +
           " " + system.machine;
}

std::string buildText() {
    return "darts-tungsten " TUNGSTEN_VERSION ", GCC " __VERSION__ ", " TUNGSTEN_BUILD_TYPE;
}

} // namespace tungsten
