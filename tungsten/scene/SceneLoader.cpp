#include "tungsten/scene/SceneLoader.h"

#include "tungsten/scene/Json.h"
#include "tungsten/scene/LoadContext.h"
#include "tungsten/scene/LoadEmitters.h"

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

namespace tungsten {

namespace {

/// FNV-1a, 64 bits.
class Hash {
  public:
    void add(const std::string& text) {
        for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
        value_ *= 0x100000001B3ull;
    }
    [[nodiscard]] uint64_t value() const { return value_; }

  private:
    uint64_t value_ = 0xCBF29CE484222325ull;
};

uint64_t hashScene(const rapidjson::Document& document, const std::vector<std::filesystem::path>& resources) {
    Hash hash;
    for (const auto& member : document.GetObject()) {
        if (std::string_view(member.name.GetString()) == "renderer") continue;
        rapidjson::StringBuffer buffer;
        rapidjson::Writer<rapidjson::StringBuffer, rapidjson::UTF8<>, rapidjson::UTF8<>, rapidjson::CrtAllocator,
                          rapidjson::kWriteNanAndInfFlag>
            writer(buffer);
        member.value.Accept(writer);
        hash.add(std::string(member.name.GetString()) + buffer.GetString());
    }
    for (const auto& file : resources) {
        std::error_code error;
        hash.add(file.string() + std::to_string(std::filesystem::file_size(file, error)) +
                 std::to_string(std::filesystem::last_write_time(file, error).time_since_epoch().count()));
    }
    return hash.value();
}

ObjectReader blockOf(const ObjectReader& root, const std::string& name) {
    const auto block = root.has(name) ? root.object(name) : std::nullopt;
    return block ? *block : ObjectReader::empty(name, root.diagnostics());
}

/// What can only be known once every primitive is there.
void finishGeometry(Scene& scene) {
    std::vector<const Shape*> shapes;
    for (const Primitive& primitive : scene.primitives) shapes.push_back(&primitive.shape);
    scene.geometry = std::make_unique<SceneGeometry>(shapes);
    const Vec3f low = scene.geometry->boundsMin(), high = scene.geometry->boundsMax();
    for (Emitter& emitter : scene.emitters) {
        auto* sky = std::get_if<InfiniteSphereEmitter>(&emitter.model);
        if (!sky) continue;
        sky->sceneCentre = (low + high) * 0.5f;
        sky->sceneRadius = std::max((high - low).length() * 0.5f, 1e-6f);
    }
}

} // namespace

void throwIfProblems(const Diagnostics& diagnostics) {
    if (!diagnostics.problems.empty()) throw InputError(diagnostics.problems);
}

std::vector<std::pair<std::string, std::vector<std::string>>> sceneTypes() {
    return {{"media", mediumTypes()},         {"phase functions", phaseFunctionTypes()},
            {"bsdfs", bsdfTypes()},           {"textures", textureTypes()},
            {"primitives", primitiveTypes()}, {"cameras", cameraTypes()},
            {"filters", filterNames()},       {"tone maps", toneMapNames()}};
}

LoadedScene loadScene(const std::filesystem::path& file, const LoadOptions& options) {
    const std::shared_ptr<rapidjson::Document> document = parseJsonFile(file);
    for (const std::string& assignment : options.overrides) applyOverride(*document, assignment);

    auto diagnostics = std::make_shared<Diagnostics>();
    diagnostics->file = file.string();
    const ObjectReader root(document, nodeOf(*document), "", diagnostics);
    const ObjectReader integrator = blockOf(root, "integrator");
    const std::string type = integrator.text("type", "path_tracer");

    auto scene = std::make_shared<Scene>();
    scene->file = file;
    LoadContext context{
        *scene, options.inputDirectory.empty() ? file.parent_path() : options.inputDirectory, {}, {}, {}, {}, {}};
    scene->transport = readTransport(integrator, type);
    readMedia(context, root);
    readBsdfs(context, root);
    readPrimitives(context, root);
    readCamera(context, root);
    const RendererSettings renderer = readRenderer(root);
    root.warnAboutUnknown();
    throwIfProblems(*diagnostics);

    finishGeometry(*scene);
    warnAboutMediaOfEmitters(context);
    return {scene, renderer, type, integrator, diagnostics, hashScene(*document, context.resources)};
}

} // namespace tungsten
