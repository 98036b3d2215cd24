#include "photon/PhotonSettings.h"

#include "photon/PrimitivePilot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tungsten::photon {

namespace {

constexpr double MostPhotons = 1e9;
constexpr float Unbounded = 1e30f;

/// None: the scene leaves the choice to a pilot.
std::optional<VolumePrimitive> readPrimitive(const ObjectReader& block) {
    constexpr Meaning meaning{"none", "what the light that scatters in media is stored as; auto: as suits the scene"};
    std::vector<NamedPrimitive> primitives;
    forEachPrimitive(VolumePrimitive{}, [&](const auto& primitive) {
        const auto kinds = named(primitive);
        primitives.insert(primitives.end(), kinds.begin(), kinds.end());
    });
    std::string all;
    for (const NamedPrimitive& primitive : primitives) all += std::string(primitive.type) + " or ";
    all += "auto";
    block.declare("volume_photon_type", all, Points::Type, meaning);
    const std::string type = block.text("volume_photon_type", Points::Type, meaning);
    if (type == "auto") return std::nullopt;
    for (const NamedPrimitive& known : primitives)
        if (type == known.type) return known.primitive;
    block.problem("volume_photon_type", type == "planes_1d"
                                            ? "'planes_1d' is not supported: use planes; supported: " + all
                                            : "expected " + all + ", found '" + type + "'");
    return Points{};
}

bool readShortFlights(const ObjectReader& block) {
    constexpr Meaning meaning{"none", "planes, volumes, balls, hypervolumes: flights that are weighed by their "
                                      "transmittance, or end at random lengths"};
    block.declare("volume_photon_length", "long or short", "long", meaning);
    const std::string length = block.text("volume_photon_length", "long", meaning);
    if (length != "long" && length != "short")
        block.problem("volume_photon_length", "expected long or short, found '" + length + "'");
    return length == "short";
}

/// Every primitive that can make the scene's light. Beams blur by a radius that only a scene can name. What a pilot
/// cannot see are biases: kernels of points and beams are the scene's own, slices have none.
std::vector<VolumePrimitive> alternativesIn(const Scene& scene, const PhotonSettings& settings) {
    std::vector<VolumePrimitive> alternatives{Points{}};
    const SceneFacts facts = analyseScene(scene);
    if (!facts.mediumScattering || !facts.heterogeneousMedia.empty()) return alternatives;
    // About the peak of a phase function beams have no bound, and slices, which rarely meet it, are dark with little
    // noise: a pilot would take either for better than it is.
    if (largestPeak(scene) > tuning::MostGuidedPeak) return alternatives;
    const bool hasRadius = settings.volumeRadius < Unbounded;
    if (hasRadius) alternatives.push_back(Beams{});
    if (facts.speedsDiffer && !scene.transport.cameraUnwarped) return alternatives; // slices would have to be gathered
    for (const SliceName& name : SliceNames) {
        const bool isBest = name.kind == SliceKind::MisVolumesBalls || name.kind == SliceKind::Hypervolumes;
        if (!isBest || (scene.transport.gate.steadyState && !name.steadyState)) continue;
        const SliceClasses classes = SliceClasses::of(name.kind, scene.transport.gate.steadyState, true, false);
        if (hasRadius || !slicesNeedBeams(scene, classes)) alternatives.push_back(Slices{name.kind, {}});
    }
    return alternatives;
}

/// The primitive, radius and temporal kernel of the volume store.
void readKernels(const ObjectReader& block, const Scene& scene, PhotonSettings& settings) {
    const auto primitive = readPrimitive(block);
    settings.volumeRadius = float(block.number(
        "volume_gather_radius", settings.gatherRadius,
        {"length",
         "radius in media: of beams, and of points with fixed_volume_radius, made for the scene (--explain) where "
         "gather_radius is left out too; other points: without effect, their radii follow the density",
         "gather_radius"},
        Range::positive()));
    settings.alternatives = primitive ? std::vector{*primitive} : alternativesIn(scene, settings);
    settings.fixedVolumeRadius = block.flag(
        "fixed_volume_radius", false, {"none", "points: one radius, instead of one that follows the photons' density"});
    if (!scene.transport.gate.delta) return;
    settings.temporalRadius =
        0.5 * block.number("transient_time_width", 0.1, {"time", "width of the temporal kernel in the first pass"},
                           Range::nonNegative());
    if (settings.temporalRadius <= 0.0)
        block.problem("transient_time_width", "photons see a delta gate through a temporal kernel, which starts with "
                                              "this width: it must be above 0");
}

// ---- The default radius

constexpr int RaysPerSide = 8;
constexpr float PartOfSpan = 0.01f, LeastPart = 0.1f, FreePaths = 3.0f;

Ray rayThrough(const Camera& camera, float u, float v) {
    const Vec2i pixel{std::min(int(u * float(camera.resolution.x)), camera.resolution.x - 1),
                      std::min(int(v * float(camera.resolution.y)), camera.resolution.y - 1)};
    return camera.generateRay(pixel, Vec2f(0.5f), Vec2f(0.5f));
}

/// How far a ray of the image sees at most, for the medium about the camera.
float farthest(const Scene& scene) {
    const int medium = scene.cameraRegion.medium;
    if (medium < 0 || !scene.media[size_t(medium)].isHomogeneous()) return Infinity;
    const float density = meanComponent(scene.media[size_t(medium)].sigmaT());
    return density > 0.0f ? FreePaths / density : Infinity;
}

/// The median of what rays all over the image see; where most see nothing, the way to the middle of the objects.
float depthOf(const Scene& scene) {
    std::vector<float> depths;
    for (int y = 0; y < RaysPerSide; ++y)
        for (int x = 0; x < RaysPerSide; ++x) {
            const auto hit = scene.geometry->intersect(
                rayThrough(scene.camera, (float(x) + 0.5f) / RaysPerSide, (float(y) + 0.5f) / RaysPerSide));
            depths.push_back(hit ? hit->t : Infinity);
        }
    std::nth_element(depths.begin(), depths.begin() + std::ssize(depths) / 2, depths.end());
    const float depth = std::min(depths[depths.size() / 2], farthest(scene));
    if (depth < Infinity) return depth;
    const Vec3f middle = (scene.geometry->boundsMin() + scene.geometry->boundsMax()) * 0.5f;
    const float distance = (middle - scene.camera.position()).length();
    return distance > 0.0f ? distance : 1.0f;
}

} // namespace

DefaultRadius DefaultRadius::of(const Scene& scene) {
    const float depth = depthOf(scene);
    const Ray left = rayThrough(scene.camera, 0.0f, 0.5f), right = rayThrough(scene.camera, 1.0f, 0.5f);
    const float span = ((left.origin + left.direction * depth) - (right.origin + right.direction * depth)).length();
    const float ofSpan = PartOfSpan * (span > 0.0f ? span : depth);
    const TimeGate& gate = scene.transport.gate;
    const bool lasts = !gate.steadyState && !gate.delta;
    const float inFrame = lasts ? float(gate.frameWidth) * scene.cameraRegion.speed : Infinity;
    const float radius = std::min(ofSpan, std::max(inFrame, LeastPart * ofSpan));
    char text[200];
    std::snprintf(text, sizeof text, "%.3g, as the scene names no volume_gather_radius: %s", double(radius),
                  radius < ofSpan && radius == inFrame ? "what light travels in a frame"
                  : radius < ofSpan ? "a thousandth of what the image spans, as frames are narrower still"
                                    : "a hundredth of what the image spans at the depth that it shows");
    return {radius, text};
}

void PhotonSettings::requireRadius(const ObjectReader& block, const Scene& scene) {
    if (volumeRadius < Unbounded || block.describes()) return;
    if (block.has("volume_gather_radius"))
        return block.problem("volume_gather_radius", "beams and fixed radii must be below 1e30");
    const DefaultRadius chosen = DefaultRadius::of(scene);
    volumeRadius = chosen.radius;
    radiusReason = chosen.reason;
}

PhotonSettings PhotonSettings::ofShare(double share) const {
    PhotonSettings part = *this;
    for (uint64_t* count : {&part.photonCount, &part.volumePhotonCount})
        *count = std::max<uint64_t>(uint64_t(std::ceil(double(*count) * share)), 1);
    return part;
}

PhotonSettings readPhotonSettings(const ObjectReader& block, const Scene& scene, bool progressive) {
    PhotonSettings settings;
    settings.progressive = progressive;
    settings.photonCount = uint64_t(
        block.integer("photon_count", 1000000,
                      {"none", "light paths in each pass, and the most photons kept on surfaces"}, {1, MostPhotons}));
    settings.volumePhotonCount = uint64_t(block.integer(
        "volume_photon_count", 1000000, {"none", "the most photons or beams kept in media"}, {1, MostPhotons}));
    settings.gatherCount = uint32_t(
        block.integer("gather_photon_count", 20,
                      {"none", "nearest photons on a surface that give the radius, within gather_radius"}, {2, 1e9}));
    settings.gatherRadius = float(
        block.number("gather_radius", Unbounded,
                     {"length", "largest distance of photons gathered on a surface", "unbounded"}, Range::positive()));
    readKernels(block, scene, settings);
    settings.lowOrderScattering =
        block.flag("low_order_scattering", true,
                   {"none", "false: no photons where light scatters first after a light or surface"});
    settings.includeSurfaces =
        block.flag("include_surfaces", true, {"none", "false: no photons on surfaces and no visible emission"});
    settings.alpha = float(block.number(
        "alpha", 0.3, {"none", "progressive maps: how fast radii on surfaces shrink; 1: not at all"}, Range::unit()));
    settings.volumeAlpha = float(
        block.number("volume_alpha", double(settings.alpha), {"none", "the same in media", "alpha"}, Range::unit()));
    settings.policy = transport::readPolicy(block);
    settings.boundaryKernels = block.flag(
        "boundary_kernels", !settings.policy.sampling.published,
        {"none",
         "media: kernels of points and beams end at surfaces; false: they reach beyond, where nothing gathers them",
         "false with published"});
    // Ways of building the published structures; the gathers here need no such choice.
    block.accept(
        {"use_grid", "grid_memory", "use_frustum_grid", "strict_time_width", "frustum_culling", "reuse_path_dir"});
    settings.excludeNonMis =
        block.flag("exclude_non_mis", false,
                   {"none", "volumes and balls: without what scatters once or twice after a light or surface"});
    settings.shortFlights = readShortFlights(block);
    for (VolumePrimitive& one : settings.alternatives)
        std::visit([&](auto& primitive) { primitive.read(block, scene, settings); }, one);
    settings.primitive = settings.alternatives.front();
    if (settings.alternatives.size() > 1) settings.primitiveReason = primitivesToMeasure(settings.alternatives);
    return settings;
}

} // namespace tungsten::photon
