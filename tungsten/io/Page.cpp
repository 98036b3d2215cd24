#include "tungsten/io/Page.h"

#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/ToneMap.h"
#include "tungsten/io/FilmCode.h"
#include "tungsten/io/Result.h"
#include "tungsten/scene/JsonWriter.h"

#include <cmath>
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

void describeCurve(JsonWriter& json, const PageContent& content) {
    json.beginObject("curves");
    json.field("label", "relative standard error");
    json.beginArray("curves");
    json.beginObject();
    json.field("name", content.method);
    json.beginArray("points");
    for (const PageContent::CurvePoint& point : content.curve) {
        if (std::isnan(point.error)) continue;
        json.beginObject();
        json.field("cpu", point.cpuSeconds);
        json.field("wall", point.wallSeconds);
        json.field("error", point.error);
        json.endObject();
    }
    json.endArray();
    json.endObject();
    json.endArray();
    json.endObject();
}

void describeScene(JsonWriter& json, const PageContent& content, const FilmCode& code) {
    const Scene& scene = content.scene;
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
    describeFilm(json, content.method, code);
    if (content.curve.size() > 1) describeCurve(json, content);
    json.endObject();
    json.endArray();
}

void describeFacts(JsonWriter& json, const PageContent& content) {
    json.beginArray("facts");
    for (const auto& [name, value] : content.facts) {
        if (value.empty()) continue;
        json.beginObject();
        json.field("name", name);
        json.field("value", value);
        json.endObject();
    }
    json.endArray();
}

/// JSON that can stand inside a script element: "<" only occurs in strings.
std::string forScript(std::string json) {
    for (size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += 6) json.replace(at, 1, "\\u003c");
    return json;
}

} // namespace

void writePage(const std::filesystem::path& file, const PageContent& content) {
    const FilmCode code = encodeFilm(imagesOf(content.film, content.scene), FilmBytesInPage);
    JsonWriter json;
    const std::filesystem::path& sceneFile = content.scene.file;
    json.field("title", (sceneFile.parent_path().filename() / sceneFile.filename()).string());
    json.field("subtitle", content.subtitle);
    describeScene(json, content, code);
    describeFacts(json, content);
    const std::string data = "{\"statistics\": " + content.statistics + "," + json.finish().substr(1);
    const auto element = [](const std::string& attributes, const std::string& text) {
        return "\n<script " + attributes + ">" + text + "</script>";
    };
    writeTextFile(file, pageStart() + element("type=\"application/json\" id=\"page-data\"", forScript(data)) +
                            element(std::string("type=\"text/plain\" id=\"") + FilmId + "\"", base64(code.deflated)) +
                            "\n" + pageEnd());
}

} // namespace tungsten
