#include "tungsten/scene/SceneLoader.h"

#include "tungsten/core/Hash.h"
#include "tungsten/reader/Json.h"
#include "tungsten/scene/LoadContext.h"
#include "tungsten/scene/LoadEmitters.h"

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <map>
#include <set>

namespace tungsten {

namespace {

/// The grammar's own NaN and Inf included: fields that nobody reads may hold them.
std::string textOf(const rapidjson::Value& value) {
    rapidjson::StringBuffer buffer;
    rapidjson::Writer<rapidjson::StringBuffer, rapidjson::UTF8<>, rapidjson::UTF8<>, rapidjson::CrtAllocator,
                      rapidjson::kWriteNanAndInfFlag>
        writer(buffer);
    value.Accept(writer);
    return buffer.GetString();
}

uint64_t hashOf(const rapidjson::Document& document, Hash hash) {
    for (const auto& member : document.GetObject()) {
        if (std::string_view(member.name.GetString()) == "renderer") continue;
        hash.add(std::string(member.name.GetString()) + textOf(member.value));
    }
    return hash.value();
}

/// Files that a scene names, and those that these name, as they were when they were read.
struct FilesRead {
    std::vector<std::filesystem::path> files; ///< each once
    std::set<std::filesystem::path> known;
    Hash hash; ///< of their bytes, in the order in which they were read: not of their names

    void add(const std::filesystem::path& file, std::string_view bytes) {
        if (known.insert(file).second) files.push_back(file);
        hash.add(std::to_string(bytes.size()));
        hash.addMany(bytes.data(), bytes.size());
    }
};

ObjectReader blockOf(const ObjectReader& root, const std::string& name, const Meaning& meaning) {
    const auto block = root.object(name, meaning);
    return block ? *block : ObjectReader::empty(name, root.diagnostics());
}

/// What can only be known once every primitive is there.
void finishGeometry(Scene& scene, const LoadWatch& watch = {}) {
    std::vector<const Shape*> shapes;
    std::vector<bool> opaque;
    for (const Primitive& primitive : scene.primitives) {
        shapes.push_back(&primitive.shape);
        const bool passes = std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(), [](const BsdfPtr& bsdf) {
            return (bsdf->lobes() & lobe::AnyTransmission) != 0;
        });
        opaque.push_back(!passes && primitive.emitter < 0);
    }
    scene.geometry = std::make_shared<const SceneGeometry>(shapes, opaque, watch);
    const Vec3f low = scene.geometry->boundsMin(), high = scene.geometry->boundsMax();
    const float radius = std::max((high - low).length() * 0.5f, 1e-6f);
    for (Emitter& emitter : scene.emitters) encloseScene(emitter, (low + high) * 0.5f, radius);
}

/// Lengths that light goes until the gate's end must be floats whose squares are floats.
void checkReach(const Scene& scene, const ObjectReader& root) {
    if (scene.transport.gate.steadyState) return;
    double speed = double(scene.transport.vacuumSpeed), delay = 0.0;
    for (const Medium& medium : scene.media) speed = std::max(speed, double(medium.speedOfLight));
    for (const Primitive& primitive : scene.primitives)
        speed = std::max({speed, double(primitive.inside.speed), double(primitive.outside.speed)});
    const auto longest = [](const TimeProfile& profile) {
        return profile.empty() ? 0.0 : std::max(std::abs(profile.times.front()), std::abs(profile.times.back()));
    };
    for (const Emitter& emitter : scene.emitters)
        delay = std::max(delay, std::abs(emitter.emissionTime) + longest(emitter.pulse));
    delay += longest(scene.transport.delay);
    const double reach =
        speed * (std::max(std::abs(scene.transport.gate.start), std::abs(scene.transport.gate.end())) + delay);
    if (reach > Range::measure().high)
        root.problem("integrator", "light would go " + brief(reach) +
                                       " lengths until the gate ends, which is too far: " + "at most " +
                                       brief(Range::measure().high) + "; check times and speeds of light");
}

/// Metres; 0: not said.
double readLengthUnit(const ObjectReader& root) {
    static const std::map<std::string, double> metres{{"km", 1e3},  {"m", 1.0},     {"cm", 1e-2},  {"mm", 1e-3},
                                                      {"um", 1e-6}, {"in", 0.0254}, {"ft", 0.3048}};
    const std::string unit =
        root.choice("length_unit", "", {"km", "m", "cm", "mm", "um", "in", "ft"},
                    {"none", "what a unit of length is: results then tell time in picoseconds too", "not said"});
    return unit.empty() ? 0.0 : metres.at(unit);
}

/// A file of anything else would be an empty scene, since a scene may leave out any other block.
void requirePrimitives(const rapidjson::Document& document, const ObjectReader& root) {
    if (root.has("primitives")) return;
    constexpr int MostNamed = 8;
    std::string found;
    int count = 0;
    for (const auto& member : document.GetObject())
        if (++count <= MostNamed) found += (count > 1 ? ", '" : "'") + std::string(member.name.GetString()) + "'";
    root.problem("", "not a scene: there are no 'primitives', the array of its surfaces and light sources; found " +
                         (count == 0 ? "nothing" : found + (count > MostNamed ? " and others" : "")) +
                         "; a scene has them, and may have " +
                         listOf({"media", "bsdfs", "camera", "integrator", "renderer", "film", "length_unit"}));
}

/// What loading leaves beside the scene itself.
struct Blocks {
    RendererSettings renderer;
    std::string integratorType;
    ObjectReader integrator, camera;
};

/// Reads all blocks in the order in which they need one another.
Blocks readScene(LoadContext& context, const ObjectReader& root, const LoadOptions& options = {}) {
    const ObjectReader integrator = blockOf(root, "integrator", {"none", "how light is simulated, and when"});
    const std::string type = readIntegratorType(integrator);
    context.scene.transport = readTransport(integrator, options.defaultGate(type));
    context.scene.lengthUnit = readLengthUnit(root);
    readMedia(context, root);
    for (const ObjectReader& bsdf : root.objects("bsdfs", {"none", "how surfaces scatter"}))
        context.fieldsOf(bsdf).asBsdf();
    readPrimitives(context, root);
    const ObjectReader camera = blockOf(root, "camera", {"none", "where it is seen from"});
    readCamera(context, root, camera);
    context.scene.film = readFilm(blockOf(root, "film", {"none", "what is kept of every pixel of every frame"}));
    const RendererSettings renderer =
        readRenderer(blockOf(root, "renderer", {"none", "how long, and what is written"}));
    root.warnAboutUnknown();
    return {renderer, type, integrator, camera};
}

} // namespace

void throwIfProblems(const Diagnostics& diagnostics) {
    if (diagnostics.problems.empty()) return;
    std::vector<Problem> problems = diagnostics.problems;
    if (diagnostics.moreProblems > 0)
        problems.push_back({diagnostics.file, "", "and " + std::to_string(diagnostics.moreProblems) + " more"});
    std::vector<Problem> warnings = diagnostics.warnings;
    if (diagnostics.moreWarnings > 0)
        warnings.push_back({diagnostics.file, "", "and " + std::to_string(diagnostics.moreWarnings) + " more"});
    throw InputError(std::move(problems), std::move(warnings));
}

namespace {

/// What the integrator says against its block, as far as it is not said yet, where there is no scene for it.
void readIntegratorAnyway(const LoadOptions& options, const ObjectReader& root, const std::string& type,
                          const TransportSettings& transport, Diagnostics& diagnostics) {
    if (!options.readIntegrator) return;
    const auto own = std::make_shared<Diagnostics>();
    own->file = diagnostics.file;
    const ObjectReader again = blockOf(root.withDiagnostics(own), "integrator", {"none", ""});
    (void)readIntegratorType(again);
    (void)readTransport(again, options.defaultGate(type));
    options.readIntegrator(again, type, transport);
    const auto append = [](std::vector<Problem>& all, const std::vector<Problem>& more) {
        for (const Problem& problem : more) {
            const bool isBlocks = problem.path == "integrator" || problem.path.starts_with("integrator.");
            const bool isKnown = std::any_of(all.begin(), all.end(), [&](const Problem& known) {
                return known.path == problem.path && known.message == problem.message;
            });
            if (isBlocks && !isKnown && all.size() < Diagnostics::MostListed) all.push_back(problem);
        }
    };
    append(diagnostics.problems, own->problems);
    append(diagnostics.warnings, own->warnings);
}

} // namespace

LoadedScene loadScene(const std::filesystem::path& file, const LoadOptions& options) {
    const std::shared_ptr<rapidjson::Document> document =
        options.text ? parseJson(*options.text, file.string()) : parseJsonFile(file, options.watch);
    for (const std::string& assignment : options.overrides) applyOverride(*document, assignment);

    auto diagnostics = std::make_shared<Diagnostics>();
    diagnostics->file = file.string();
    const ObjectReader root(document, nodeOf(*document), "", diagnostics);
    auto scene = std::make_shared<Scene>();
    scene->file = file;
    LoadContext context{
        *scene, {options.inputDirectory.empty() ? file.parent_path() : options.inputDirectory, options.allowOutside}};
    FilesRead read;
    context.files.watch = options.watch.telling(
        [&read](const std::filesystem::path& resource, std::string_view bytes) { read.add(resource, bytes); });
    requirePrimitives(*document, root);
    const Blocks blocks = readScene(context, root, options);
    checkReach(*scene, root);
    if (!diagnostics->problems.empty())
        readIntegratorAnyway(options, root, blocks.integratorType, scene->transport, *diagnostics);
    throwIfProblems(*diagnostics);

    finishGeometry(*scene, options.watch);
    warnAboutMedia(context, root, blocks.camera);
    warnAboutLightsOnSurfaces(context);
    warnAboutBlindDetectors(context, blocks.camera);
    std::vector<std::filesystem::path> inputs = std::move(read.files);
    if (!options.text) inputs.insert(inputs.begin(), file);
    return {scene,       blocks.renderer,   blocks.integratorType,        blocks.integrator,
            diagnostics, std::move(inputs), hashOf(*document, read.hash), textOf(*document)};
}

RendererSettings peekRenderer(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    try {
        const std::shared_ptr<rapidjson::Document> document = parseJsonFile(file);
        for (const std::string& assignment : overrides) applyOverride(*document, assignment);
        const ObjectReader root(document, nodeOf(*document), "", std::make_shared<Diagnostics>());
        return readRenderer(blockOf(root, "renderer", {"none", "how long, and what is written"}));
    } catch (const std::runtime_error&) {
        return {}; // told about when the scene is loaded
    }
}

std::shared_ptr<const Scene> emptyScene(const TransportSettings& transport) {
    auto scene = std::make_shared<Scene>();
    LoadContext context{*scene};
    readScene(context, ObjectReader::empty("", std::make_shared<Diagnostics>()));
    scene->transport = transport;
    finishGeometry(*scene);
    return scene;
}

namespace {

using Describe = void (*)(const std::shared_ptr<Description>&);

void describeFilter(const std::shared_ptr<Description>& description) {
    description->note = "A value of the camera's `reconstruction_filter`, without fields of its own.";
}

void describeToneMap(const std::shared_ptr<Description>& description) {
    description->note = "A value of the camera's `tonemap`, without fields of its own.";
}

/// The closed sets: everything a scene names but integrators.
struct Kind {
    const char* name;
    std::vector<std::string> (*types)();
    Describe describe;
};
constexpr Kind Kinds[] = {{"media", mediumTypes, describeMedium},
                          {"phase functions", phaseFunctionTypes, describePhaseFunction},
                          {"bsdfs", Bsdfs::types, describeBsdf},
                          {"textures", Textures::types, describeTexture},
                          {"primitives", primitiveTypes, describePrimitive},
                          {"cameras", Cameras::names, describeCamera},
                          {"filters", filterNames, describeFilter},
                          {"tone maps", toneMapNames, describeToneMap}};

void describeRoot(const std::shared_ptr<Description>& description) {
    ScratchContext scratch;
    readScene(scratch.context, ObjectReader::describing(description, ""));
}

void describeRenderer(const std::shared_ptr<Description>& description) {
    readRenderer(ObjectReader::describing(description, ""));
}

void describeFilm(const std::shared_ptr<Description>& description) {
    readFilm(ObjectReader::describing(description, ""));
}

std::shared_ptr<Description> described(const std::string& name, Describe describe) {
    auto description = std::make_shared<Description>();
    description->name = name;
    describe(description);
    return description;
}

} // namespace

std::vector<std::pair<std::string, std::vector<std::string>>> sceneTypes() {
    std::vector<std::pair<std::string, std::vector<std::string>>> types;
    for (const Kind& kind : Kinds) types.emplace_back(kind.name, kind.types());
    return types;
}

std::vector<DescribedKind> describeScene() {
    std::vector<DescribedKind> kinds{
        {"blocks",
         {described("scene", describeRoot), described("renderer", describeRenderer), described("film", describeFilm)}}};
    for (const Kind& kind : Kinds) {
        kinds.push_back({kind.name, {}});
        for (const std::string& type : kind.types()) kinds.back().types.push_back(described(type, kind.describe));
    }
    return kinds;
}

void describeTransport(const ObjectReader& describing, DefaultGate gate) {
    (void)readIntegratorType(describing);
    (void)readTransport(describing, gate);
}

} // namespace tungsten
