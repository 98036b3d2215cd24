#include "tungsten/render/PartialStateReader.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"
#include "tungsten/film/Checksum.h"
#include "tungsten/render/PartialStateHeader.h"
#include "tungsten/render/PassCode.h"
#include "tungsten/scene/JsonWriter.h"

#include <cstring>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

/// Of a detector, after its name.
struct DetectorState {
    float radius, aperture;
};

/// Before each pass; without samples: the end, with the process's CPU seconds.
struct PassHeader {
    uint32_t samples = 0, unused = 0;
    uint64_t bytes = 0; ///< deflated
    double cpuSeconds = 0.0;
};

template <typename Value>
void writeValue(std::ostream& out, const Value& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void writeText(std::ostream& out, const std::string& text) {
    writeValue(out, uint64_t(text.size()));
    out.write(text.data(), std::streamsize(text.size()));
}

template <typename Value>
Value readValue(std::istream& in) {
    Value value{};
    in.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
}

/// A checksum says that a file is as it was written, not who wrote it.
InputError implausible(const fs::path& file) {
    return {file.string(), "the partial state is damaged: what it holds cannot be"};
}

/// What is left of the file, of so many bytes.
uint64_t bytesLeft(std::istream& in, uint64_t size) {
    const auto at = uint64_t(in.tellg());
    return in && at <= size ? size - at : 0;
}

std::string readText(std::istream& in, uint64_t fileSize, const fs::path& file) {
    const auto size = readValue<uint64_t>(in);
    if (size > bytesLeft(in, fileSize)) throw implausible(file);
    std::string value(size, '\0');
    in.read(value.data(), std::streamsize(value.size()));
    return value;
}

/// What a camera of detectors is made of, as far as results tell it.
void writeDetectors(std::ostream& out, const Scene& scene) {
    const auto* detectors = scene.camera.detectors();
    writeValue(out, uint64_t(detectors ? detectors->row.size() : 0));
    for (size_t i = 0; detectors && i < detectors->row.size(); ++i) {
        writeText(out, detectors->row[i].name);
        writeValue(out, DetectorState{detectors->row[i].radius, detectors->row[i].aperture});
    }
}

void readDetectors(std::istream& in, Scene& scene, uint64_t size, const fs::path& file) {
    Detectors detectors;
    const auto count = readValue<uint64_t>(in);
    if (count > size) throw implausible(file);
    for (uint64_t left = count; left > 0; --left) {
        Detector& detector = detectors.row.emplace_back();
        detector.name = readText(in, size, file);
        const auto state = readValue<DetectorState>(in);
        detector.radius = state.radius;
        detector.aperture = state.aperture;
    }
    if (!detectors.row.empty()) scene.camera.model = std::move(detectors);
}

/// Of a file that is whole; the stream goes on behind it.
PartialStateHeader readHeader(std::istream& in, const fs::path& file) {
    const uint64_t size = requireRegularFile(file);
    const auto header = readValue<PartialStateHeader>(in);
    if (!in || std::memcmp(header.magic, header.Magic, header.VersionAt) != 0)
        throw InputError(file.string(), "not a partial state, as --passes writes, or damaged");
    if (std::memcmp(header.magic, header.Magic, sizeof header.Magic) != 0)
        throw InputError(file.string(), "a partial state of another version of this program");
    in.seekg(0);
    if (!endsWithChecksum(in, size))
        throw InputError(file.string(), "the partial state is damaged or truncated (its checksum is wrong)");
    in.seekg(sizeof header);
    if (!header.plausible()) throw implausible(file);
    return header;
}

} // namespace

PartialIdentity PartialIdentity::of(const LoadedScene& loaded, uint64_t seed, int64_t sppStep,
                                    const std::optional<ExposureChoice>& exposure) {
    return {loaded.hash, seed, sppStep, loaded.scene, loaded.integratorType, loaded.text, exposure};
}

struct PartialStateWriter::Implementation {
    std::ostream& target;
    std::string file;
    ChecksumBuffer buffer;
    std::ostream out;

    Implementation(std::ostream& stream, std::string name)
        : target(stream), file(std::move(name)), buffer(*stream.rdbuf()), out(&buffer) {}
    void requireGood() const {
        if (!out) throw InputError(file, "cannot be written: the disk is full, or there is a quota");
    }
};

PartialStateWriter::PartialStateWriter(std::ostream& out, std::string file, const PartialIdentity& identity,
                                       uint32_t firstPass)
    : implementation_(std::make_unique<Implementation>(out, std::move(file))) {
    writeValue(implementation_->out, PartialStateHeader::of(identity, firstPass));
    for (const std::string& text :
         {std::string(TUNGSTEN_VERSION), identity.scene->file.string(), identity.integrator, identity.sceneText})
        writeText(implementation_->out, text);
    writeDetectors(implementation_->out, *identity.scene);
    implementation_->requireGood();
}
PartialStateWriter::~PartialStateWriter() = default;

void PartialStateWriter::add(Film& film, uint32_t samples) {
    const std::vector<unsigned char> deflated = deflatePass(film);
    writeValue(implementation_->out, PassHeader{samples, 0, deflated.size(), 0.0});
    implementation_->out.write(reinterpret_cast<const char*>(deflated.data()), std::streamsize(deflated.size()));
    implementation_->requireGood();
}

void PartialStateWriter::finish(const std::string& statistics, double cpuSeconds) {
    writeValue(implementation_->out, PassHeader{0, 0, 0, cpuSeconds});
    writeText(implementation_->out, statistics);
    writeValue(implementation_->target, implementation_->buffer.checksum());
    implementation_->requireGood();
}

PartialStateReader::PartialStateReader(const fs::path& file) : file_(file) {
    const uint64_t size = requireRegularFile(file);
    std::ifstream in(file, std::ios::binary);
    const PartialStateHeader header = readHeader(in, file);
    first_ = header.firstPass;
    build_ = readText(in, size, file);
    const std::shared_ptr<Scene> scene = header.scene();
    scene->file = readText(in, size, file);
    const std::string integrator = readText(in, size, file);
    identity_ = {header.content, header.seed, header.sppStep, scene, integrator, readText(in, size, file), {}};
    if (header.exposureGiven) identity_.exposure = ExposureChoice{header.exposureAutomatic != 0, header.exposureStops};
    readDetectors(in, *scene, size, file);
    passesAt_ = in.tellg();
    auto pass = readValue<PassHeader>(in);
    for (; pass.samples > 0; pass = readValue<PassHeader>(in)) {
        // A byte that is deflated holds at most 1032.
        const double values = double(header.width) * header.height * header.frames * header.filmChannels;
        if (pass.bytes > bytesLeft(in, size) || values * sizeof(float) > 1032.0 * double(pass.bytes) + 1032.0)
            throw implausible(file);
        samples_.push_back(pass.samples);
        in.seekg(std::streamoff(pass.bytes), std::ios::cur);
    }
    cpuSeconds_ = pass.cpuSeconds;
    statistics_ = readText(in, size, file);
    if (!in || samples_.size() > UINT32_MAX - first_ || !isJsonObject(statistics_) ||
        !isJsonObject(identity_.sceneText))
        throw implausible(file);
}

std::string PartialStateReader::differenceTo(const PartialStateReader& other) const {
    if (build_ != other.build_) return "version of this program (" + build_ + ", " + other.build_ + ")";
    if (identity_.content != other.identity_.content) return "scene (or a changed file or --set)";
    if (identity_.seed != other.identity_.seed) return "seed";
    if (identity_.sppStep != other.identity_.sppStep) return "spp_step";
    return "";
}

void PartialStateReader::fold(Film& film) const {
    std::ifstream in(file_, std::ios::binary);
    in.seekg(passesAt_);
    std::vector<unsigned char> deflated;
    for (const uint32_t samples : samples_) {
        deflated.resize(readValue<PassHeader>(in).bytes);
        in.read(reinterpret_cast<char*>(deflated.data()), std::streamsize(deflated.size()));
        film.beginPass();
        if (!in || !inflatePass(deflated, film))
            throw InputError(file_.string(), "the partial state has changed while it was read");
        film.endPass(double(samples));
    }
}

} // namespace tungsten
