#include "tungsten/render/HtmlPage.h"

#include "tungsten/film/FilmCode.h"
#include "tungsten/film/ImageIo.h"
#include "tungsten/render/Progress.h"
#include "tungsten/render/ResultDescription.h"
#include "tungsten/scene/JsonWriter.h"

#include <limits>

namespace tungsten {

/// tungsten/page/page.html with what it includes, before and after the data.
const char* pageStart();
const char* pageEnd();

namespace {

constexpr const char* FilmId = "film";
constexpr double Nothing = std::numeric_limits<double>::quiet_NaN(); ///< null in JSON

FilmImages imagesOf(const Film& film, const Scene& scene) {
    FilmImages images;
    for (int frame = 0; frame < film.frames(); ++frame) {
        images.means.push_back(inOutputUnits(film.mean(frame), scene, 1));
        if (film.passes() >= 2 && film.contents().moments)
            images.standardErrors.push_back(inOutputUnits(film.standardError(frame), scene, 1));
    }
    return images;
}

std::string toneMapName(ToneMap toneMap) {
    for (const std::string& name : toneMapNames())
        if (toneMapByName(name) == toneMap) return name;
    return "gamma";
}

void describeFilm(JsonWriter& json, const std::string& name, const FilmCode& code) {
    json.beginArray("films");
    json.beginObject();
    json.field("name", name);
    json.field("width", uint64_t(code.width));
    json.field("height", uint64_t(code.height));
    json.field("frames", uint64_t(code.frames));
    json.field("block", uint64_t(code.block));
    json.field("step", code.step);
    json.field("top", code.top);
    json.field("errorStep", FilmCode::ErrorStep);
    json.field("errorTop", code.errorTop);
    json.field("hasError", uint64_t(code.hasError));
    json.field("data", FilmId);
    json.endObject();
    json.endArray();
}

void describeTrace(JsonWriter& json, const std::string& name, const std::vector<TraceEntry>& trace) {
    json.beginObject("curves");
    json.field("label", "relative standard error");
    json.beginArray("curves");
    json.beginObject();
    json.field("name", name);
    json.beginArray("points");
    for (const TraceEntry& entry : trace) {
        if (std::isnan(entry.relativeError)) continue;
        json.beginObject();
        json.field("cpu", entry.cpuSeconds);
        json.field("wall", entry.wallSeconds);
        json.field("error", entry.relativeError);
        json.endObject();
    }
    json.endArray();
    json.endObject();
    json.endArray();
    json.endObject();
}

void describeScene(JsonWriter& json, const LoadedScene& loaded, const SessionResult& result, const FilmCode& code) {
    const Scene& scene = *loaded.scene;
    const TimeGate& gate = scene.transport.gate;
    json.beginArray("scenes");
    json.beginObject();
    json.field("name", scene.file.stem().string());
    json.field("toneMap", toneMapName(scene.toneMap));
    json.field("quantity", quantityText(scene));
    json.field("reference", Nothing);
    if (gate.frames > 1) {
        const double picoseconds = picosecondsPerTime(scene);
        const double unit = picoseconds > 0.0 ? picoseconds : 1.0;
        json.beginObject("time");
        json.field("start", gate.start * unit);
        json.field("width", gate.frameWidth * unit);
        json.field("unit", picoseconds > 0.0 ? "ps" : "");
        json.endObject();
    }
    describeFilm(json, loaded.integratorType, code);
    if (result.trace.size() > 1) describeTrace(json, loaded.integratorType, result.trace);
    json.endObject();
    json.endArray();
}

void describeFacts(JsonWriter& json, const SessionOptions& options, const SessionResult& result) {
    const double error = result.film.relativeStandardError();
    const std::string known =
        std::isnan(error) ? "" : errorText(error, result.film.relativeErrorBound(), result.relativeBias());
    json.beginArray("facts");
    for (const auto& [name, value] : {std::pair<std::string, std::string>{"error", known},
                                      {"command", options.command},
                                      {"machine", machineText()},
                                      {"build", buildText()}}) {
        if (value.empty()) continue;
        json.beginObject();
        json.field("name", name);
        json.field("value", value);
        json.endObject();
    }
    json.endArray();
}

std::string subtitle(const LoadedScene& loaded, const SessionResult& result) {
    const TimeGate& gate = loaded.scene->transport.gate;
    char text[200];
    std::snprintf(text, sizeof text, "%s, %d x %d pixels, %s, %u passes, %.1f s (%s)", loaded.integratorType.c_str(),
                  result.film.width(), result.film.height(),
                  gate.steadyState  ? "steady state"
                  : gate.delta      ? "a single moment"
                  : gate.frames > 1 ? (std::to_string(gate.frames) + " frames").c_str()
                                    : "one time gate",
                  result.film.passes(), result.renderSeconds, toString(result.reason).c_str());
    return text;
}

/// JSON that can stand inside a script element: "<" only occurs in strings.
std::string forScript(std::string json) {
    for (size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += 6) json.replace(at, 1, "\\u003c");
    return json;
}

} // namespace

void writeFilmPage(const std::filesystem::path& file, const LoadedScene& loaded, const SessionOptions& options,
                   const SessionResult& result) {
    const FilmCode code = encodeFilm(imagesOf(result.film, *loaded.scene), FilmBytesInPage);
    JsonWriter json;
    const std::filesystem::path& sceneFile = loaded.scene->file;
    json.field("title", (sceneFile.parent_path().filename() / sceneFile.filename()).string());
    json.field("subtitle", subtitle(loaded, result));
    describeScene(json, loaded, result, code);
    describeFacts(json, options, result);
    const std::string data =
        "{\"statistics\": " + statisticsJson(loaded, options, result) + "," + json.finish().substr(1);
    const auto element = [](const std::string& attributes, const std::string& text) {
        return "\n<script " + attributes + ">" + text + "</script>";
    };
    writeTextFile(file, pageStart() + element("type=\"application/json\" id=\"page-data\"", forScript(data)) +
                            element(std::string("type=\"text/plain\" id=\"") + FilmId + "\"", base64(code.deflated)) +
                            "\n" + pageEnd());
}

} // namespace tungsten
