#include "path/techniques/RefractiveConnections.h"

#include "path/Tuning.h"

#include "transport/PlainSteps.h"
#include "transport/TimeSensor.h"

#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/scene/Interaction.h"
#include "tungsten/scene/LightChoice.h"

#include <algorithm>

namespace tungsten::path {

using transport::BoundedMedium;

namespace {

/// Points of a light in a pass. Scenes with more lights have none of these: a bound on the points, and on what a vertex
/// looks through. Variance x CPU of milk behind glass and of a ball of it: 0.121 and 0.33 at 64 points, 0.127 and 0.42
/// at 1024, 0.120 and 0.42 at 4096: no difference beyond noise. Bench: study bodies
constexpr size_t LampPoints = 1024, MostLamps = 64;

} // namespace

bool RefractiveConnections::helpsWith(const Scene& scene) {
    const std::vector<BoundedMedium> bodies = transport::boundedMediaOf(scene);
    const auto boxOf = [](const Emitter& emitter) {
        if (const AreaEmitter* area = emitter.surface()) return boundsOf(*area->shape);
        const BoundingSphere sphere = boundingSphere(emitter);
        return Imath::Box3f(sphere.centre - Vec3f(sphere.radius), sphere.centre + Vec3f(sphere.radius));
    };
    const auto lies = [&](const Emitter& emitter) {
        return std::any_of(bodies.begin(), bodies.end(), [&](const BoundedMedium& body) {
            return body.scatters() && body.box.intersects(boxOf(emitter));
        });
    };
    return scene.emitters.size() <= MostLamps &&
           std::any_of(scene.emitters.begin(), scene.emitters.end(), RefractedEmitter::isOne) &&
           std::none_of(scene.emitters.begin(), scene.emitters.end(), lies);
}

void RefractiveConnections::trace(const PassInfo& pass) {
    // Any neighbours in the sequence are spread evenly (Roberts 2018).
    constexpr double StepU = 0.7548776662466927, StepV = 0.5698402909980532;
    for (RefractedEmitter& lamp : lamps_) {
        Sampler sampler(pass.seed, RandomStream::RefractedLight, pass.index, uint64_t(lamp.index));
        const double u = sampler.nextDouble(), v = sampler.nextDouble();
        lamp.points.fill(LampPoints, "emitter points", pass.watch,
                         [&](size_t i, std::vector<RefractedEmitter::Point>& points) {
                             const auto part = [&](double start, double step) {
                                 const double at = start + double(i) * step;
                                 return std::min(float(at - std::floor(at)), 0x1.fffffep-1f);
                             };
                             points.push_back({lamp.area().samplePoint({part(u, StepU), part(v, StepV)})});
                         });
    }
}

size_t RefractiveConnections::faces(int medium) const {
    const BoundedMedium& body = bodies_[size_t(medium)];
    return body.sphere ? 1 : body.faces.size();
}

BoundedMedium::Face RefractiveConnections::face(const Vec3f& position, const Region& region, size_t index,
                                                size_t lamp) const {
    const BoundedMedium& body = bodies_[size_t(region.medium)];
    if (!body.sphere) return body.faces[index];
    // The plane that touches the sphere about where the way to the light's middle leaves it.
    const RefractedEmitter& to = lamps_[lamp];
    const BoundedMedium::Face touching =
        body.intersectBoundary(position, (to.bounds.centre - position).normalized()).face;
    const RefractedView seen(position, touching, pair(region.medium, lamp).index, region.speed, to);
    const auto direction = seen.directionTo(to.bounds.centre);
    return direction ? body.intersectBoundary(position, *direction).face : touching;
}

size_t RefractiveConnections::faceOf(int medium, const Vec3f& normal) const {
    const BoundedMedium& body = bodies_[size_t(medium)];
    size_t best = 0;
    for (size_t i = 1; !body.sphere && i < body.faces.size(); ++i)
        if (body.faces[i].normal.dot(normal) > body.faces[best].normal.dot(normal)) best = i;
    return best;
}

RefractedView RefractiveConnections::view(const Vec3f& position, const Region& region, size_t faceIndex,
                                          size_t lamp) const {
    return {position, face(position, region, faceIndex, lamp), pair(region.medium, lamp).index, region.speed,
            lamps_[lamp]};
}

auto RefractiveConnections::oddsOf(const Vec3f& position, const Region& region, size_t lamp) const -> Odds {
    const float sigmaT = meanComponent(scene_->media[size_t(region.medium)].sigmaT());
    Odds odds;
    odds.count = faces(region.medium);
    const BoundingSphere& bounds = lamps_[lamp].bounds;
    const BoundedMedium& body = bodies_[size_t(region.medium)];
    for (size_t i = 0; i < odds.count; ++i) {
        const BoundedMedium::Face at =
            body.sphere ? body.intersectBoundary(position, (bounds.centre - position).normalized()).face
                        : body.faces[i];
        const float depth = (at.point - position).dot(at.normal);
        const bool lit = (bounds.centre - at.point).dot(at.normal) + bounds.radius > 0.0f;
        if (!lit || !(depth > 0.0f)) continue;
        odds.faces[i] = std::exp(-sigmaT * depth);
        odds.sum += odds.faces[i];
    }
    if (!(odds.sum > 0.0f)) return odds;
    const float all = std::min(odds.sum, 1.0f);
    for (float& each : odds.faces) each *= all / odds.sum;
    odds.sum = all;
    return odds;
}

std::pair<float, float> RefractiveConnections::window(const SealedVertex& vertex, const RefractedEmitter& lamp) const {
    const double soFar = vertex.time + lamp.emitter->emissionTime;
    return {float(gate_.start - soFar), float(gate_.end() - soFar)};
}

auto RefractiveConnections::draw(const SealedVertex& vertex, Sampler& sampler) const -> std::optional<Drawn> {
    size_t emitter = size_t(lamps_.front().index);
    if (lamps_.size() > 1) emitter = choice_.sample(sampler.next1D()).index;
    const auto lamp = size_t(lampOf_[emitter]);
    const Odds odds = oddsOf(vertex.position, vertex.region, lamp);
    if (!(odds.sum > 0.0f)) return std::nullopt;
    float u = sampler.next1D();
    if (u >= odds.sum) return std::nullopt;
    size_t chosen = 0;
    for (; chosen + 1 < odds.count; ++chosen) {
        u -= odds.faces[chosen];
        if (u < 0.0f) break;
    }
    if (!(odds.faces[chosen] > 0.0f)) return std::nullopt;
    const RefractedView seen = view(vertex.position, vertex.region, chosen, lamp);
    const Delays& delays = pair(vertex.region.medium, lamp).delays[chosen];
    const auto [low, high] = window(vertex, lamps_[lamp]);
    size_t which = 0;
    if (delays.size() > 1) which = std::min(size_t(sampler.next1D() * float(delays.size())), delays.size() - 1);
    const Vec2f uPoint = sampler.next2D();
    auto drawn = choose(seen, vertex, low - delays[which].most, high - delays[which].least, uPoint);
    if (drawn) drawn->face = chosen;
    return drawn;
}

auto RefractiveConnections::choose(const RefractedView& view, const SealedVertex& vertex, float low, float high,
                                   const Vec2f& u) const -> std::optional<Drawn> {
    const RefractedEmitter& lamp = view.lamp;
    const float from = (low - view.depth / (view.leastCosine * view.speedInside)) * lamp.speed - view.widest;
    const float to = (high - view.depth / view.speedInside) * lamp.speed + view.widest;
    const float centre = (lamp.bounds.centre - view.foot).length();
    if (to < centre - lamp.bounds.radius || from > centre + lamp.bounds.radius) return std::nullopt;
    const Medium& medium = scene_->media[size_t(vertex.region.medium)];
    const float sigmaT = meanComponent(medium.sigmaT());
    const auto importance = [&](const RefractedEmitter::Point& point, const Vec3f&, float) {
        const auto aim = view.towards(point.at.position, point.at.normal);
        if (!aim || aim->time < low || aim->time >= high) return 0.0f;
        const float through = 1.0f - fresnelDielectric(view.index, aim->way.cosInside);
        return medium.phase.eval(vertex.before, aim->direction) * through *
               std::exp(-sigmaT * (aim->way.inside() - view.depth)) / aim->density;
    };
    const auto choice = lamp.points.choose(view.foot, from, to, u, importance, tuning::RefractedCandidates);
    if (!choice.vertex) return std::nullopt;
    const auto aim = view.towards(choice.vertex->at.position, choice.vertex->at.normal);
    return Drawn{aim->direction, choice.weight, 0, lamp.index};
}

float RefractiveConnections::density(const SealedVertex& vertex, const Vec3f& direction, size_t faceIndex,
                                     int emitter) const {
    if (emitter < 0 || lampOf_[size_t(emitter)] < 0) return 0.0f;
    const auto lamp = size_t(lampOf_[size_t(emitter)]);
    const Odds odds = oddsOf(vertex.position, vertex.region, lamp);
    if (!(odds.faces[faceIndex] > 0.0f)) return 0.0f;
    const Delays& delays = pair(vertex.region.medium, lamp).delays[faceIndex];
    const std::pair<float, float> open = window(vertex, lamps_[lamp]);
    float sum = 0.0f;
    view(vertex.position, vertex.region, faceIndex, lamp)
        .eachAlong(direction, [&](const RefractedView::RefractedTarget& aim) {
            const auto inTime = std::count_if(delays.begin(), delays.end(), [&](const Delay& delay) {
                return delay.covers(aim.time, open.first, open.second);
            });
            sum += aim.density * float(inTime) / float(delays.size());
        });
    return sum * odds.faces[faceIndex] * choice_.probability(size_t(emitter));
}

// ---- What is between the faces of sealed bodies and the lights: found out before the first pass

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
        const float relative = scene_->bsdfOf(*hit).relativeIndex();
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
