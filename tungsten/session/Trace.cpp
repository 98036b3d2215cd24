#include "tungsten/session/Trace.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/integrator/Statistics.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/io/Result.h"
#include "tungsten/io/Writers.h"
#include "tungsten/scene/JsonWriter.h"

#include <chrono>

namespace tungsten {

namespace {

double wallNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::filesystem::path listIn(const std::filesystem::path& folder) {
    return folder / "trace.json";
}

} // namespace

Trace::Trace(std::filesystem::path folder, const Scene& scene, uint64_t seed)
    : folder_(std::move(folder)), scene_(scene), seed_(seed) {}

std::vector<std::filesystem::path> Trace::filesIn(const std::filesystem::path& folder) {
    if (folder.empty()) return {};
    return {listIn(folder)};
}

void Trace::start() {
    wallStart_ = wallNow();
    cpuStart_ = processCpuSeconds();
}

bool Trace::due() const {
    return !folder_.empty() && !failure_ && wallNow() - wallStart_ >= next_;
}

void Trace::record(const Film& film, const Film& bias, bool whole) {
    if (folder_.empty()) return;
    const bool writes = whole && due();
    wall_ = wallNow();
    cpu_ = processCpuSeconds();
    written_ = false;
    if (writes) attempt(film, bias);
}

void Trace::end(const Film& film, const Film& bias) {
    if (!written_ && !failure_) attempt(film, bias);
}

/// The render is worth more than its trace.
void Trace::attempt(const Film& film, const Film& bias) {
    try {
        write(film, bias);
    } catch (const InputError&) {
        failure_ = std::current_exception();
    }
}

void Trace::requireWritten() const {
    if (failure_) std::rethrow_exception(failure_);
}

void Trace::write(const Film& film, const Film& bias) {
    const double wallSeconds = wall_ - wallStart_, cpuSeconds = cpu_ - cpuStart_;
    const std::string number = std::to_string(film.passes());
    const std::string name = std::string(6 - std::min<size_t>(number.size(), 6), '0') + number + ".npy";
    TraceEntry entry{film.passes(), film.totalWeight(), wallSeconds,      cpuSeconds, relativeStandardError(film),
                     {0.0, 0.0},    "mean-" + name,     "stderr-" + name, ""};
    std::vector<Image> means, errors, biases;
    for (int frame = 0; frame < film.frames(); ++frame) {
        means.push_back(inOutputUnits(film.mean(frame), scene_, 1));
        errors.push_back(inOutputUnits(film.standardError(frame), scene_, 1));
        if (frame < bias.frames()) biases.push_back(inOutputUnits(bias.mean(frame), scene_, 1));
    }
    makeFolderOf(listIn(folder_));
    writeNpy(folder_ / entry.mean, means);
    writeNpy(folder_ / entry.standardError, errors);
    if (!biases.empty()) {
        entry.relativeBias = RelativeBias::of(film, bias);
        entry.bias = "bias-" + name;
        writeNpy(folder_ / entry.bias, biases);
    }
    entries_.push_back(entry);
    writeList();
    written_ = true;
    next_ = 2.0 * wallSeconds;
    wallStart_ += wallNow() - wall_;
    cpuStart_ += processCpuSeconds() - cpu_;
}

void Trace::writeList() const {
    JsonWriter json;
    json.field("scene", scene_.file.string());
    json.field("seed", seed_);
    json.beginArray("entries");
    for (const TraceEntry& entry : entries_) {
        json.beginObject();
        json.field("passes", uint64_t(entry.passes));
        json.field("samples per pixel", entry.samples);
        json.field("wall seconds", entry.wallSeconds);
        json.field("CPU seconds", entry.cpuSeconds);
        json.field("relative standard error", entry.relativeError);
        json.field("mean", entry.mean);
        json.field("standard error", entry.standardError);
        if (!entry.bias.empty()) {
            json.field("relative bias", entry.relativeBias.estimate);
            json.field("relative bias bound", entry.relativeBias.bound);
            json.field("bias", entry.bias);
        }
        json.endObject();
    }
    json.endArray();
    writeTextFile(listIn(folder_), json.finish());
}

} // namespace tungsten
