#include "tungsten/session/PartialState.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"
#include "tungsten/film/Film.h"
#include "tungsten/film/FilmRows.h"
#include "tungsten/image/Checksum.h"
#include "tungsten/scene/JsonWriter.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace tungsten {

namespace {

namespace fs = std::filesystem;

constexpr size_t Step = size_t(1) << 16;

/// A film's pass image, deflated: row by row, so that no second image is needed. Of the pass in progress. Throws
/// std::bad_alloc.
std::vector<unsigned char> deflatePass(const Film& film) {
    z_stream stream{};
    if (deflateInit(&stream, Z_BEST_SPEED) != Z_OK) throw std::bad_alloc();
    std::vector<unsigned char> bytes;
    std::vector<float> row(FilmRows::values(film));
    unsigned char piece[Step];
    for (size_t at = 0; at < FilmRows::count(film); ++at) {
        FilmRows::readPass(film, at, row.data());
        stream.next_in = reinterpret_cast<Bytef*>(row.data());
        stream.avail_in = uInt(row.size() * sizeof(float));
        const int flush = at + 1 == FilmRows::count(film) ? Z_FINISH : Z_NO_FLUSH;
        do {
            stream.next_out = piece;
            stream.avail_out = Step;
            deflate(&stream, flush);
            bytes.insert(bytes.end(), piece, piece + (Step - stream.avail_out));
        } while (stream.avail_out == 0);
    }
    deflateEnd(&stream);
    return bytes;
}

/// The reverse, after Film::beginPass(). False where the bytes are not those of such a pass.
bool inflatePass(const std::vector<unsigned char>& bytes, Film& film) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    std::vector<float> row(FilmRows::values(film));
    size_t taken = 0;
    const auto step = [&] {
        if (stream.avail_in == 0) {
            stream.next_in = const_cast<Bytef*>(bytes.data() + taken);
            stream.avail_in = uInt(std::min(bytes.size() - taken, size_t(1) << 30));
            taken += stream.avail_in;
        }
        return inflate(&stream, Z_NO_FLUSH);
    };
    bool good = true;
    for (size_t at = 0; good && at < FilmRows::count(film); ++at) {
        stream.next_out = reinterpret_cast<Bytef*>(row.data());
        stream.avail_out = uInt(row.size() * sizeof(float));
        while (good && stream.avail_out > 0) {
            const int code = step();
            good = code == Z_OK || (code == Z_STREAM_END && stream.avail_out == 0 && at + 1 == FilmRows::count(film));
        }
        if (good && !std::all_of(row.begin(), row.end(), [](float value) { return value == 0.0f; }))
            FilmRows::setPass(film, at, row.data());
    }
    unsigned char more = 0;
    stream.next_out = &more;
    stream.avail_out = 1;
    int code = good ? step() : Z_DATA_ERROR;
    while (code == Z_OK && stream.avail_out == 1) code = step(); // the checksum may lie in the next piece
    good = code == Z_STREAM_END && stream.avail_out == 1;
    inflateEnd(&stream);
    return good;
}

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

PartialStateHeader PartialStateHeader::of(const PartialIdentity& identity, uint32_t firstPass) {
    const Scene& scene = *identity.scene;
    const TransportSettings& transport = scene.transport;
    PartialStateHeader header{};
    std::memcpy(header.magic, Magic, sizeof Magic);
    header.content = identity.content;
    header.seed = identity.seed;
    header.sppStep = identity.sppStep;
    header.width = scene.camera.resolution.x;
    header.height = scene.camera.resolution.y;
    header.frames = transport.gate.frames;
    header.firstPass = firstPass;
    header.gateStart = transport.gate.start;
    header.frameWidth = transport.gate.frameWidth;
    header.lengthUnit = scene.lengthUnit;
    header.vacuumSpeed = transport.vacuumSpeed;
    header.cameraSpeed = scene.cameraRegion.speed;
    header.steadyState = transport.gate.steadyState;
    header.delta = transport.gate.delta;
    header.hasResponse = !transport.response.empty();
    header.cameraUnwarped = transport.cameraUnwarped;
    header.integrate = transport.integrateOverGate;
    header.toneMap = uint8_t(scene.toneMap);
    header.filmChannels = uint8_t(scene.film.channels);
    header.filmMoments = scene.film.moments;
    header.filmBatches = scene.film.batches;
    header.filmBatchBlock = scene.film.batchBlock;
    header.exposureGiven = identity.exposure.has_value();
    header.exposureAutomatic = identity.exposure && identity.exposure->automatic;
    header.exposureStops = identity.exposure ? identity.exposure->stops : 0.0;
    return header;
}

bool PartialStateHeader::plausible() const {
    const bool sizes = width > 0 && height > 0 && frames > 0;
    const bool contents = filmChannels == 1 || filmChannels == 3;
    const bool numbers = std::isfinite(gateStart) && frameWidth >= 0.0 && lengthUnit >= 0.0;
    const bool batches = filmBatches >= 0 && filmBatches <= 256 && filmBatchBlock > 0;
    return sizes && contents && numbers && batches && sppStep > 0 && toneMap <= uint8_t(ToneMap::Pbrt);
}

std::shared_ptr<Scene> PartialStateHeader::scene() const {
    auto made = std::make_shared<Scene>();
    made->camera.resolution = Vec2i(width, height);
    TransportSettings& transport = made->transport;
    transport.gate = {steadyState != 0, delta != 0, gateStart, frameWidth, frames};
    transport.vacuumSpeed = vacuumSpeed;
    transport.cameraUnwarped = cameraUnwarped != 0;
    transport.integrateOverGate = integrate != 0;
    if (hasResponse) transport.response = {{gateStart, transport.gate.end()}, {1.0, 1.0}};
    made->lengthUnit = lengthUnit;
    made->cameraRegion.speed = cameraSpeed;
    made->toneMap = ToneMap(toneMap);
    made->film = {filmChannels, filmMoments != 0, filmBatches, filmBatchBlock};
    return made;
}

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
