#include "fuzz/Targets.h"

#include "support/SceneFile.h"
#include "support/UseMesh.h"

#include "darts/EdaTableFile.h"
#include "tungsten/core/Errors.h"
#include "tungsten/core/Hash.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/reader/Duration.h"
#include "tungsten/reader/Json.h"
#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Checkpoint.h"
#include "tungsten/session/PartialState.h"
#include "tungsten/texture/Texture.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace tungsten::fuzz {

namespace {

namespace fs = std::filesystem;

void require(bool promise, const char* what) {
    if (promise) return;
    std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

template <typename Use>
void orInputError(Use use) {
    try {
        use();
    } catch (const InputError& error) {
        require(!error.problems().empty() && !error.problems().front().message.empty(), "an error says what is wrong");
    } catch (const UsageError& error) {
        require(*error.what() != '\0', "an error says what is wrong");
    }
}

/// A file of these bytes, one for all inputs of the process.
fs::path fileOf(const std::string& name, const std::string& bytes) {
    static const test::FileFolder folder;
    return folder.write(name, bytes);
}

/// Formats that end with a checksum: without it the fuzzer would not get behind it.
std::string summed(const std::string& bytes) {
    Hash hash;
    hash.addBytes(bytes.data(), bytes.size());
    const uint64_t value = hash.value();
    return bytes + std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

template <const char* Name>
void mesh(const std::string& bytes) {
    orInputError([&] {
        const std::string fault = test::useMesh(loadMesh(fileOf(Name, bytes)));
        require(fault.empty(), fault.c_str());
    });
}
constexpr char Wo3[] = "a.wo3", Obj[] = "a.obj", Ply[] = "a.ply", Gltf[] = "a.gltf", Glb[] = "a.glb";

/// Both forms: the loader tells them apart by what is in the file.
void gltf(const std::string& bytes) {
    bytes.starts_with("glTF") ? mesh<Glb>(bytes) : mesh<Gltf>(bytes);
}

void image(const std::string& bytes) {
    orInputError([&] {
        const Texture texture{std::shared_ptr<const Bitmap>(loadBitmap(fileOf("image", bytes)))};
        for (const Vec2f& uv : {Vec2f(0.1f, 0.9f), Vec2f(1.0f, 1.0f), Vec2f(0.0f, 0.0f)}) {
            require(isFinite(texture.rgb(uv)), "texels are finite");
            require(std::isfinite(texture.alpha(uv) + texture.scalar(uv) + texture.derivatives(uv).length()),
                    "alpha, scalar and derivatives are finite");
        }
    });
}

/// The other formats tell themselves by their first bytes.
void exr(const std::string& bytes) {
    image("\x76\x2f\x31\x01" + bytes);
}

void scene(const std::string& bytes) {
    orInputError([&] {
        LoadOptions options;
        options.text = bytes;
        const LoadedScene loaded = loadScene(fileOf("scene.json", ""), options);
        const Scene& scene = *loaded.scene;
        const Vec2i last(scene.camera.resolution.x - 1, scene.camera.resolution.y - 1);
        for (const Vec2i& pixel : {Vec2i(0, 0), last}) {
            const Ray ray = scene.camera.generateRay(pixel, {0.3f, 0.6f}, {0.7f, 0.2f});
            require(isFinite(ray.direction) && isFinite(ray.origin), "camera rays are finite");
            if (const auto hit = scene.geometry->intersect(ray)) (void)scene.bsdfOf(*hit);
        }
        for (const Emitter& emitter : scene.emitters)
            if (const auto sample = sampleDirect(emitter, {0.1f, 0.2f, 0.3f}, {0.4f, 0.6f}))
                require(!std::isnan(sample->direction.length()), "directions to light are numbers");
    });
}

/// The scene file's other way in, and durations: lines of path=value.
void override(const std::string& bytes) {
    (void)parseDuration(bytes);
    orInputError([&] {
        const auto document =
            parseJson(R"({"camera": {"fov": 1, "resolution": [2, 2]}, "primitives": [{"name": "a.b"}, 3]})", "scene");
        for (size_t at = 0; at < bytes.size();) {
            const size_t end = std::min(bytes.find('\n', at), bytes.size());
            applyOverride(*document, bytes.substr(at, end - at));
            at = end + 1;
        }
    });
}

/// Of the film's sizes and with the identity that the file names.
void state(const std::string& bytes) {
    struct Start {
        char magic[8];
        uint64_t sceneHash, seed;
        int64_t sppStep;
    } start{};
    std::memcpy(&start, bytes.data(), std::min(bytes.size(), sizeof start));
    Film film(3, 2, 2), bias(3, 2, 1);
    orInputError([&] {
        const fs::path file = fileOf("a.state", summed(bytes));
        if (!readCheckpoint(file, {start.sceneHash, start.seed, start.sppStep}, film, bias)) return;
        (void)film.meanOverFrames();
        require(!(relativeErrorBound(film) < 0.0), "bounds are not negative");
        film.beginPass();
        film.endPass(1.0);
    });
}

void partial(const std::string& bytes) {
    orInputError([&] { (void)mergePartialStates({fileOf("a.part", summed(bytes))}); });
}

/// A small table. The checksum in its header is made right, over all bytes with 0 in its place.
void table(const std::string& input) {
    std::string bytes = input;
    constexpr size_t ChecksumAt = 56, HeaderSize = 64;
    if (bytes.size() >= HeaderSize) {
        bytes.replace(ChecksumAt, HeaderSize - ChecksumAt, HeaderSize - ChecksumAt, '\0');
        const std::string sum = summed(bytes).substr(bytes.size());
        bytes.replace(ChecksumAt, sum.size(), sum);
    }
    const darts::EdaResolution resolution{2, 0, -1, 2, 0, 0.02f};
    std::string reason;
    const auto read = darts::loadEdaTable(fileOf("a.eda", bytes), 0.9f, 0.5f, resolution, reason);
    require(read.has_value() == reason.empty(), "a table, or what is wrong");
    if (!read) return;
    for (const float u : {0.0f, 0.5f, 0.999f}) {
        const float h = read->sample(1.0f, 0.5f, 1.0f, u);
        require(h >= 0.0f && h <= 2.0f, "sampled h lie within 0 and 2");
    }
}

constexpr Target Targets[] = {
    {"scene", scene},   {"sky", scene},     {"override", override}, {"wo3", mesh<Wo3>},
    {"obj", mesh<Obj>}, {"ply", mesh<Ply>}, {"gltf", gltf},         {"image", image},
    {"exr", exr},       {"state", state},   {"partial", partial},   {"table", table},
};

} // namespace

std::span<const Target> targets() {
    return Targets;
}

} // namespace tungsten::fuzz
