// What is between the faces of sealed bodies and the lights: found out before the first pass.

#include "path/techniques/RefractiveConnections.h"

#include "path/Tuning.h"

#include "transport/RecordingDelays.h"
#include "transport/StraightSteps.h"

#include "tungsten/scene/Interaction.h"
#include "tungsten/scene/LightChoice.h"

#include <algorithm>

namespace tungsten::path {

using transport::BoundedMedium;
using transport::PathState;

namespace {

/// Ways from under the boundary of a body that tell how late its light arrives through what else is in between, of
/// which so many quantiles are kept, and so many that hold them all, for rare ways; boundaries on one of them. Little
/// depends on them: variance x CPU of milk behind glass 0.096, 0.111, 0.100 with 256, 2048, 16384 ways, 0.116, 0.116,
/// 0.108 with 1, 4, 32 that hold all. Bench: study bodies
constexpr size_t DelayPilots = 2048, DelayQuantiles = 32, WholeDelays = 4;
constexpr int MostBoundaries = 16;

/// When a walk that starts in a body and leaves it by refraction meets an emitter, nothing between scattering in media.
struct ArrivalTime : transport::VisitorBase {
    ArrivalTime(const Scene& wholeScene, int wanted) : scene(&wholeScene), emitter(wanted) {}

    [[nodiscard]] bool mayGoOn(const PathState& path) const { return path.interactions < MostBoundaries; }
    bool ahead(PathState& path, auto&, const transport::Ahead& ahead) {
        return path.interactions == 0 || !ahead.medium || !ahead.medium->scatters();
    }
    bool arrive(PathState& path, auto&, const transport::Ahead& ahead, const transport::Flight&) {
        if (path.interactions == 1 || scene->primitives[ahead.hit->shape].emitter != emitter) return true;
        time = path.time;
        return false;
    }
    bool vertex(PathState& path, auto& steps, const transport::WalkVertex&) {
        steps.lobes = path.interactions == 1 ? lobe::SpecularTransmission : lobe::All;
        return true;
    }

    const Scene* scene;
    int emitter;
    std::optional<double> time;
};

} // namespace

auto RefractiveConnections::quantiles(std::vector<float>& delays, const Delay& all) -> Delays {
    constexpr size_t Count = DelayQuantiles;
    std::sort(delays.begin(), delays.end());
    Delays result;
    if (delays.size() < Count) {
        result.push_back(all);
    } else {
        const auto at = [&](size_t k) { return delays[k * (delays.size() - 1) / Count]; };
        for (size_t k = 0; k < Count; ++k) result.push_back({at(k), at(k + 1)});
        result.resize(Count + WholeDelays, all);
    }
    return result;
}

void RefractiveConnections::prepare(const Scene& scene, const std::vector<bool>& leftOut, const ProgressToken& watch) {
    scene_ = &scene;
    gate_ = transport::RecordingDelays::of(scene).arrivals(scene.transport.gate);
    bodies_ = transport::boundedMediaOf(scene);
    choice_ = emitterDistribution(scene, RefractedEmitter::isOne, leftOut);
    lampOf_.assign(scene.emitters.size(), -1);
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        if (!(choice_.probability(i) > 0.0f)) continue;
        lampOf_[i] = int(lamps_.size());
        lamps_.push_back({&emitter, int(i), scene.regionOf(emitter).speed, boundingSphere(emitter), {}});
    }
    trace({.watch = watch}); // points for the pilot
    pairs_.resize(bodies_.size());
    watch.stage("refractive connections", bodies_.size() * lamps_.size());
    for (size_t medium = 0; medium < bodies_.size(); ++medium) {
        if (!bodies_[medium].scatters()) continue;
        pairs_[medium].resize(lamps_.size());
        for (size_t lamp = 0; lamp < lamps_.size(); ++lamp) {
            watch.advance();
            Pair& pair = pairs_[medium][lamp];
            pair.index = indexTowards(int(medium), lamps_[lamp]);
            pair.delays.resize(faces(int(medium)), {Delay{}});
            pair.delays = delaysOf(int(medium), lamp, {0, RandomStream::RefractedLight, uint32_t(medium), ~lamp});
        }
    }
}

/// Along a straight way from the body's middle.
float RefractiveConnections::indexTowards(int medium, const RefractedEmitter& lamp) const {
    const BoundedMedium& body = bodies_[size_t(medium)];
    const Vec3f from = body.box.center(), offset = lamp.bounds.centre - from;
    const float distance = offset.length();
    float index = 1.0f;
    Ray ray{from, distance > 0.0f ? offset / distance : Vec3f(0.0f, 1.0f, 0.0f), 0.0f, distance};
    for (int i = 0; i < MostBoundaries; ++i) {
        const auto hit = scene_->geometry->intersect(ray);
        if (!hit || scene_->primitives[hit->shape].emitter == lamp.index) break;
        const float relative = relativeIndex(scene_->bsdfOf(*hit));
        index *= ray.direction.dot(hit->ng) >= 0.0f ? relative : 1.0f / relative;
        ray = hit->rest(ray);
    }
    return index;
}

std::optional<double> RefractiveConnections::timeTo(const RefractedEmitter& lamp, const Ray& ray, const Region& region,
                                                    const Sampler& sampler) const {
    transport::StepCounters counters;
    transport::Walk walk{PathState{.random = sampler, .ray = ray, .region = region},
                         transport::StraightSteps<TransportMode::Radiance>({*scene_, counters, {}}),
                         ArrivalTime(*scene_, lamp.index)};
    walk.steps.checks = walk.steps.attenuated = false;
    walk.run();
    return walk.visitor.time;
}

auto RefractiveConnections::delaysOf(int medium, size_t lamp, const Sampler& sampler) const -> std::vector<Delays> {
    const BoundedMedium& body = bodies_[size_t(medium)];
    const float mfp = 1.0f / meanComponent(scene_->media[size_t(medium)].sigmaT());
    const Region region = body.primitive->inside;
    std::vector<std::vector<float>> found(faces(medium));
    for (size_t i = 0; i < DelayPilots; ++i) {
        Sampler own = sampler.branch(RandomStream::Pilot, i);
        const Vec2f u = own.next2D(), uPoint = own.next2D();
        const float z = 1.0f - 2.0f * u.x, r = std::sqrt(std::max(1.0f - sqr(z), 0.0f));
        const Vec3f outward(r * std::cos(2.0f * Pi * u.y), r * std::sin(2.0f * Pi * u.y), z);
        const BoundedMedium::Face exit = body.intersectBoundary(body.box.center(), outward).face;
        const Vec3f position = body.box.center() +
                               outward * body.intersectBoundary(body.box.center(), outward).distance -
                               exit.normal * std::min(mfp, 0.1f * body.box.size().length());
        const size_t through = faceOf(medium, exit.normal);
        const RefractedView seen = view(position, region, through, lamp);
        const SealedVertex vertex{position, outward, 0.0, region};
        const auto drawn = choose(seen, vertex, -Infinity, Infinity, uPoint);
        if (!drawn) continue;
        const auto time = timeTo(lamps_[lamp], {position, drawn->direction}, region, own);
        if (!time) continue;
        seen.eachAlong(drawn->direction, [&](const RefractedView::RefractedTarget& aim) {
            found[through].push_back(float(*time) - aim.time);
        });
    }
    Delay all; // of any face: through few ways that one has all may be late
    for (const auto& each : found)
        for (const float delay : each) all = {std::min(all.least, delay), std::max(all.most, delay)};
    std::vector<Delays> delays;
    for (auto& each : found) delays.push_back(quantiles(each, all));
    return delays;
}

} // namespace tungsten::path
