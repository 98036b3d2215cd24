#include "tungsten/integrator/EarliestArrival.h"

#include "tungsten/integrator/SceneElements.h"
#include "tungsten/reader/Field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tungsten {

namespace {

constexpr double Never = std::numeric_limits<double>::infinity();

/// Rounding of positions, and of the lengths that walks add up: far more than either.
constexpr double Slack = 1e-5;

Vec3f nearestIn(const Imath::Box3f& box, const Vec3f& from) {
    return {std::clamp(from.x, box.min.x, box.max.x), std::clamp(from.y, box.min.y, box.max.y),
            std::clamp(from.z, box.min.z, box.max.z)};
}

double wayBetween(const Vec3f& a, const Vec3f& b) {
    return Vec3d(double(a.x) - double(b.x), double(a.y) - double(b.y), double(a.z) - double(b.z)).length();
}

/// Of parallel rays, which start all over a plane: how far the box is from that.
double gapToPlane(const Transform& toWorld, const Imath::Box3f& box) {
    const Vec3d normal = Vec3d(toWorld.x.cross(toWorld.y)).normalized();
    double least = Never, most = -Never;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f at((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                       (corner & 4) != 0 ? box.max.z : box.min.z);
        const double height = normal.dot(Vec3d(at) - Vec3d(toWorld.translation));
        least = std::min(least, height);
        most = std::max(most, height);
    }
    return std::max({least, -most, 0.0});
}

/// How far the box is at least from where camera rays start.
double wayToSensor(const Camera& camera, const Imath::Box3f& box) {
    const auto wayTo = [&](const Vec3f& place) { return wayBetween(nearestIn(box, place), place); };
    if (const Detectors* detectors = camera.detectors()) {
        double way = Never;
        for (const Detector& detector : detectors->row)
            way = std::min(way, wayTo(detector.position) - double(detector.radius));
        return way;
    }
    if (camera.hasParallelRays()) return gapToPlane(camera.toWorld, box);
    return wayTo(camera.position()) - double(camera.aperture());
}

/// No less than this lies between the sensor and what is within `radius` of the box.
double gapToSensor(const Scene& scene, const Imath::Box3f& box, double radius = 0.0) {
    if (box.isEmpty()) return Never;
    if (scene.transport.cameraUnwarped) return 0.0;
    const Vec3f from = scene.camera.position();
    const Vec3f nearest = nearestIn(box, from);
    const double way = wayToSensor(scene.camera, box);
    const double rounding =
        Slack * (wayBetween(nearest, from) + double(nearest.length()) + double(from.length()) + std::abs(way) + radius);
    const double gap = way - radius - rounding;
    return std::isfinite(gap) ? std::max(gap, 0.0) : 0.0;
}

/// How far the box is from the emitter at least; 0 where the camera's segments, of which it may be one, do not count.
double gapToEmitter(const Scene& scene, const Emitter& emitter, const Imath::Box3f& box) {
    if (scene.transport.cameraUnwarped || emitter.isInfinite()) return 0.0;
    const BoundingSphere sphere = boundingSphere(emitter);
    const Vec3f nearest = nearestIn(box, sphere.centre);
    const double way = double((nearest - sphere.centre).length()), radius = double(sphere.radius);
    const double gap =
        way - radius - Slack * (way + double(sphere.centre.length()) + double(nearest.length()) + radius);
    return std::isfinite(gap) ? std::max(gap, 0.0) : 0.0;
}

/// When it starts to shine.
double startOf(const Emitter& emitter) {
    return emitter.emissionTime + (emitter.pulse.empty() ? 0.0 : emitter.pulse.times.front());
}

/// Between arrival and record, at least.
double leastDelay(const Scene& scene) {
    return scene.transport.delay.empty() ? 0.0 : scene.transport.delay.times.front();
}

double firstPulse(const Scene& scene) {
    double first = Never;
    for (const Emitter& emitter : scene.emitters) first = std::min(first, startOf(emitter));
    return first;
}

/// Of an image that is black: whether the way to the camera is what takes too long.
std::string unwarpedHint(const Scene& scene, double end) {
    if (scene.transport.cameraUnwarped || firstPulse(scene) > end) return "";
    return "; times count the way to the camera: if the scene's gate leaves that out, as those of Liu et al. 2022 do, "
           "it needs \"camera_unwarped\": true";
}

void excludeEmitters(const Scene& scene, const std::vector<double>& earliest, double end, SceneFacts& facts,
                     Features& features) {
    const std::string until = "the sensor closes at " + brief(end);
    SceneElements late;
    for (size_t i = 0; i < earliest.size(); ++i)
        if (earliest[i] > end)
            late.add(nameOf(scene.emitters[i].name, i) + " not before " + brief(earliest[i]), scene.emitters[i].path);
    facts.nothingArrives = late.count() == earliest.size() && !facts.everything;
    // Where all are late nothing is rendered, and integrators need no emitter to be left.
    const bool leaves = late.any() && !facts.nothingArrives && !facts.everything;
    if (leaves)
        for (const double time : earliest) facts.excludedEmitters.push_back(time > end);
    features.describe(feature::LateEmitters, leaves,
                      !late.any()            ? "light of every emitter may arrive: " + until
                      : facts.everything     ? "nothing shall be left out"
                      : facts.nothingArrives ? "light of no emitter arrives: " + until
                                             : until + ", light of " + late.names(),
                      late.paths());
    features.describe(feature::BlackImage, facts.nothingArrives,
                      facts.nothingArrives
                          ? "no light can arrive: " + until + ", light of " + late.names() + unwarpedHint(scene, end)
                          : "some light may arrive",
                      late.paths());
}

void excludeFrames(const Scene& scene, double first, SceneFacts& facts, Features& features) {
    const TimeGate& gate = scene.transport.gate;
    int dark = 0;
    while (dark < gate.frames && gate.frameStart(dark + 1) < first) ++dark;
    const bool some = gate.frames > 1 && dark > 0;
    facts.emptyFrames = some && !facts.everything ? std::min(dark, gate.frames - 1) : 0;
    features.describe(feature::EmptyFrames, some,
                      some ? "the first " + std::to_string(dark) + " frames end before " + brief(first) +
                                 ", when light can arrive at the soonest"
                      : gate.frames > 1 ? "light may arrive in the first frame"
                                        : "a single image",
                      {"integrator.start_time"});
}

void excludeMedia(const Scene& scene, double end, SceneFacts& facts, Features& features) {
    const std::vector<double> earliest = earliestThroughMedia(scene, facts);
    const std::string until = "the sensor closes at " + brief(end);
    SceneElements scattering, late;
    for (const int index : reachableMedia(scene)) {
        const auto i = size_t(index);
        const Medium& medium = scene.media[i];
        const std::string name = nameOf(medium.name, i);
        if (!medium.scatters()) continue;
        scattering.add(name, medium.path);
        if (earliest[i] > end) late.add(name + " not before " + brief(earliest[i]), medium.path);
    }
    const bool leaves = late.any() && !facts.everything;
    if (leaves)
        for (const double time : earliest) facts.excludedMedia.push_back(time > end);
    const bool some = scattering.any() && (!leaves || late.count() < scattering.count());
    facts.mediumScattering = some;
    features.describe(feature::MediaInTime, some,
                      !scattering.any() ? "no reachable medium scatters"
                      : !late.any()     ? "light may get into every scattering medium and arrive: " + until
                      : !leaves         ? "nothing shall be left out"
                                        : until + ", light by way of " + late.names(),
                      scattering.paths());
}

} // namespace

std::vector<double> earliestThroughMedia(const Scene& scene, const SceneFacts& facts) {
    const double first = firstPulse(scene);
    std::vector<double> earliest(scene.media.size(), Never);
    const auto lower = [&](int medium, double time) {
        if (medium >= 0) earliest[size_t(medium)] = std::min(earliest[size_t(medium)], time);
    };
    lower(scene.cameraRegion.medium, first);
    for (const Emitter& emitter : scene.emitters) lower(emitter.medium, first);
    for (const Primitive& primitive : scene.primitives) {
        if (!primitive.boundsMedium) continue;
        const Imath::Box3f box = boundsOf(primitive.shape);
        if (box.isEmpty()) continue;
        const double onward = gapToSensor(scene, box);
        for (const Emitter& emitter : scene.emitters) {
            const double start = startOf(emitter), gap = gapToEmitter(scene, emitter, box) + onward;
            const double time = start + gap / double(facts.highestSpeed) - Slack * std::abs(start);
            lower(primitive.inside.medium, time);
            lower(primitive.outside.medium, time);
        }
    }
    return earliest;
}

std::vector<double> earliestArrivals(const Scene& scene, const SceneFacts& facts) {
    std::vector<double> earliest;
    for (const Emitter& emitter : scene.emitters) {
        const BoundingSphere sphere = boundingSphere(emitter);
        const double gap =
            emitter.isInfinite() ? 0.0 : gapToSensor(scene, Imath::Box3f(sphere.centre), double(sphere.radius));
        const double start = startOf(emitter);
        earliest.push_back(start + gap / double(facts.highestSpeed) - Slack * std::abs(start));
    }
    return earliest;
}

double earliestFromSurfaces(const Scene& scene, const SceneFacts& facts) {
    double gap = Never;
    for (const Primitive& primitive : scene.primitives)
        gap = std::min(gap, gapToSensor(scene, boundsOf(primitive.shape)));
    const double start = firstPulse(scene);
    return start == Never || gap == Never ? Never : start + gap / double(facts.highestSpeed) - Slack * std::abs(start);
}

double lastTime(const Scene& scene) {
    const TimeGate& gate = scene.transport.gate;
    if (gate.steadyState) return Never;
    const TimeProfile& response = scene.transport.response;
    for (size_t i = response.times.size(); i-- > 1;)
        if (response.values[i] > 0.0 || response.values[i - 1] > 0.0) return std::min(response.times[i], gate.end());
    return gate.delta ? gate.start : gate.end() - leastDelay(scene);
}

void excludeLate(const Scene& scene, double end, SceneFacts& facts, Features& features) {
    if (!facts.timeResolved) {
        for (const FeatureName& name : {feature::LateEmitters, feature::BlackImage, feature::EmptyFrames})
            features.describe(name, false, "steady state");
        features.describe(feature::SurfacesInTime, !scene.primitives.empty(),
                          scene.primitives.empty() ? "there is no surface" : "steady state: all count", {"primitives"});
        features.describe(feature::MediaInTime, facts.mediumScattering,
                          facts.mediumScattering ? "steady state: all count" : "no reachable medium scatters",
                          {"media"});
        return;
    }
    const std::vector<double> earliest = earliestArrivals(scene, facts);
    excludeEmitters(scene, earliest, end, facts, features);
    const double first = earliest.empty() ? Never : *std::min_element(earliest.begin(), earliest.end());
    excludeFrames(scene, first + leastDelay(scene), facts, features);
    const double surfaces = earliestFromSurfaces(scene, facts);
    facts.surfacesOutOfTime = surfaces > end && !facts.everything;
    const bool some = !scene.primitives.empty() && !facts.surfacesOutOfTime;
    features.describe(feature::SurfacesInTime, some,
                      scene.primitives.empty() ? "there is no surface"
                      : some ? "what the nearest surface shows may arrive before the sensor closes at " + brief(end)
                             : "what surfaces show does not arrive before " + brief(surfaces) +
                                   ", the sensor closes at " + brief(end),
                      {"primitives"});
    excludeMedia(scene, end, facts, features);
}

} // namespace tungsten
