#include "path/StepsToEmitter.h"

#include "path/Tuning.h"

#include "transport/GuidancePlan.h"
#include "transport/PlainSteps.h"

namespace tungsten::path {

PathGuides PathGuides::of(const Scene& scene, const transport::Policy& policy, const SceneFacts& facts,
                          const ProgressToken& watch) {
    PathGuides guides;
    watch.stage("guides of media", scene.media.size());
    for (size_t i = 0; i < scene.media.size(); ++i) {
        watch.advance();
        const Medium& medium = scene.media[i];
        darts::Settings settings = transport::settingsIn(medium, policy, darts::Mode::Path);
        if (!medium.scatters() || facts.isExcluded(i)) settings.direction = darts::Direction::Phase;
        const darts::Medium coefficients{darts::vec3(medium.sigmaA()), darts::vec3(medium.sigmaS()), medium.phase.g()};
        guides.media.emplace_back(settings, coefficients);
        darts::Settings diffuse = settings, glossy = settings;
        if (!policy.sampling.published) {
            diffuse.alpha = std::max(diffuse.alpha, darts::DirectionSampler::RoughAlpha);
            glossy.alpha = std::max(glossy.alpha, tuning::GlossyAlpha);
        }
        guides.diffuse.emplace_back(diffuse, coefficients);
        guides.glossy.emplace_back(glossy, coefficients);
    }
    return guides;
}

using transport::Ahead;
using transport::Flight;
using transport::logOfQuotient;
using transport::WalkVertex;
using Event = transport::Flight::Event;

namespace {

/// A surface whose lobes are all smooth and reflect. Directions into it stand for absorption: their density is 0.
struct SurfaceScatterer {
    const SurfaceInteraction& surface;
    Sampler& random; ///< chooses among lobes

    [[nodiscard]] darts::Vec3 sample(float u, float v) const {
        const BsdfRandom numbers{{u, v}, random.next1D()};
        const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance), surface.wi, numbers);
        return darts::vec3(sample ? surface.frame.toWorld(sample->wo).normalized() : -surface.frame.n);
    }
    [[nodiscard]] float pdf(const darts::Vec3& direction) const {
        return surface.bsdf->pdf(surface.query(TransportMode::Radiance), surface.wi,
                                 surface.frame.toLocal(darts::to<Vec3f>(direction)));
    }
};

} // namespace

bool endsGlossySubpath(LobeMask lobes) {
    return (lobes & lobe::Smooth) != 0 && (lobes & (lobe::Specular | lobe::AnyTransmission)) == 0;
}

const darts::Guide* StepsToEmitter::guideFor(const transport::Vertex& vertex, const Vec3f& back,
                                             const Region& region) const {
    if (!endsGlossySubpath(vertex.lobes())) return nullptr;
    const Region ahead = vertex.regionTowards(back, region);
    const Medium* medium = context_.scene.medium(ahead);
    if (!medium || !medium->scatters()) return nullptr;
    const bool diffuse = (vertex.lobes() & lobe::DiffuseReflection) != 0;
    const auto& guides = diffuse ? guided_->guides.diffuse : guided_->guides.glossy;
    const darts::Guide& guide = guides[size_t(ahead.medium)];
    return guide.settings().direction == darts::Direction::Phase ? nullptr : &guide;
}

darts::ResponseAt StepsToEmitter::response(double time) const {
    return {guided_->sensor.response.get(), time + target_.start, double(start_.region.speed)};
}

darts::ConnectionSample StepsToEmitter::drawConnection(PathState& path, const darts::Guide& guide,
                                                       const darts::TimeBudget& budget, const float* h) const {
    const darts::ResponseAt at{guided_->sensor.response.get(), path.time + target_.start, double(path.region.speed)};
    const float u = path.random.next1D();
    return h ? guide.sampleConnectionAlong(budget, *h, u, at) : guide.sampleConnection(budget, u, at);
}

// ---- Looking

void StepsToEmitter::setTimeBudgetFrom(const PathState& path, const Vec3f& position) {
    const transport::TimeWindow& gate = window();
    const PathTarget& target = target_;
    const float speed = path.region.speed;
    const darts::TimeGate open{gate.begin - target.start, gate.end - target.start};
    const auto range = darts::LengthInterval::of(open, path.time, double(speed));
    const float faster = guided_->bound.oneSpeed() ? 0.0f : guided_->bound.highestSpeed() / speed - 1.0f;
    // From media only the target's own point is looked for; from the camera, and by surfaces, its emitter may be met.
    const bool meets = !path.scattered || guided_->bound.surfacesTurn();
    setTimeBudget(darts::TimeBudget::of(darts::vec3(target.vertex.position() - position), range),
                  (meets ? target.emitterRadius : 0.0f) + faster * std::max(float(range.high), 0.0f));
}

void StepsToEmitter::setEscapeModelFrom(const PathState& path, const transport::FlightStart& start) {
    if (hasEscapeModel() || !guided_->escapeModels) return;
    const PathTarget& target = target_;
    const transport::EscapeTarget aim{target.vertex.position(), target.vertex.region().medium, target.vertex.margin()};
    setEscapeModel(*guided_->escapeModels, start, path.region, aim, context_.counters.rays);
}

bool StepsToEmitter::canArrive(PathState& path, const WalkVertex& vertex) {
    surfaceGuide_ = nullptr;
    if (guided_->balance.endsGuided(path.logRatio)) return false;
    if (vertex.medium || (vertex.surface->bsdf->lobes() & lobe::Smooth) != 0) choosesPoint_ = false;
    if (path.timed) {
        setTimeBudgetFrom(path, vertex.position);
        if (!choosesPoint_ && !reachable().alive()) return false;
    }
    if (vertex.medium) {
        setEscapeModelFrom(path, {vertex.position});
        return true;
    }
    const SurfaceInteraction& surface = *vertex.surface;
    surfaceGuide_ = guideFor(vertex.connectible(context_.scene, TransportMode::Radiance), -vertex.before, path.region);
    if (!surfaceGuide_) return true;
    // It scatters back, into the region there.
    path.timed = path.scattered = true;
    path.region = regionBeyond(surface, -vertex.before, path.region);
    setTimeBudgetFrom(path, vertex.position);
    if (budget().alive()) setEscapeModelFrom(path, {vertex.position, surface.hit.margin()});
    return true;
}

// ---- Flights

std::optional<SurfaceHit> StepsToEmitter::see(const Ray& ray, const SurfaceHit* known) {
    if (known) return known->t < ray.tMax ? std::optional(*known) : std::nullopt;
    ++context_.counters.rays;
    return context_.scene.geometry->intersect(ray);
}

Ahead StepsToEmitter::ahead(PathState& path, Asks asks, const SurfaceHit* known) {
    if (std::exchange(startsAnew_, false) && path.timed) setTimeBudgetFrom(path, path.ray.origin);
    const Medium* medium = context_.scene.medium(path.region);
    const Ahead ahead = !medium || !medium->scatters() ? aheadInEmpty(path, medium, known)
                        : path.timed                   ? aheadInMedium(path, *medium, asks, known)
                                                       : aheadUntimed(path, *medium, known);
    start_ = path;
    medium_ = medium;
    reach_ = ahead.reach();
    return ahead;
}

Ahead StepsToEmitter::aheadInEmpty(PathState& path, const Medium* medium, const SurfaceHit* known) {
    passage_ = Passage::Empty;
    if (path.timed && !choosesPoint_) {
        if (!reachable().alive()) return {};
        path.ray.tMax = bound(path.ray.direction);
    }
    Ahead ahead{true, medium, see(path.ray, known)};
    ahead.flies = ahead.hit.has_value();
    if (medium && ahead.flies) context_.counters.fly(*medium);
    return ahead;
}

float StepsToEmitter::logImportanceOfTarget(const PathState& path) {
    constexpr float Never = transport::StrategyBalance::Never;
    const Vec3f back = path.ray.origin - target_.vertex.position();
    const float light = meanComponent(target_.intensity(back.normalized())) / back.length2();
    if (!(light > 0.0f)) return Never;
    setTimeBudgetFrom(path, path.ray.origin);
    if (!budget().alive()) return Never;
    setEscapeModelFrom(path, transport::FlightStart::along(path.ray));
    ++context_.counters.points;
    return guideOf(path.region).logExpectedContribution(budget(), light);
}

void StepsToEmitter::choosePoint(PathState& path, Asks asks) {
    constexpr size_t Points = TargetChoice::Points;
    choosesPoint_ = false;
    if (!guided_->escapeModels->isBounded(path.region.medium, target_.emitter->medium)) return;
    const PathTarget given = target_;
    const auto other = [&](size_t k) {
        return guided_->targets->at(size_t(given.index), TargetChoice::otherPoint(*given.u, k));
    };
    std::array<float, Points> odds; // against those that every point has without a choice
    for (size_t k = 0; k < Points; ++k) {
        if (k > 0) target_ = other(k);
        odds[k] = logImportanceOfTarget(path);
    }
    const float most = *std::max_element(odds.begin(), odds.end());
    float sum = 0.0f;
    for (float& each : odds) sum += each = most > transport::StrategyBalance::Never ? std::exp(each - most) : 1.0f;
    // One choice in so many leaves the point that the path has.
    for (float& each : odds) each = (1.0f + float(Points) * float(Points - 1) / sum * each) / float(Points);
    size_t chosen = 0;
    if (asks == Asks::Path) {
        path.random.at(path.interactions, Draw::EmitterPoint);
        float rest = path.random.next1D() * float(Points);
        while (chosen + 1 < Points && (rest -= odds[chosen]) >= 0.0f) ++chosen;
    }
    path.throughput = path.throughput / odds[chosen];
    target_ = chosen == 0 ? given : other(chosen);
    logOfPoint_ = std::log(odds[chosen]);
    if (hasDensities()) path.logRatio += logOfPoint_;
    setTimeBudgetFrom(path, path.ray.origin);
}

Ahead StepsToEmitter::aheadInMedium(PathState& path, const Medium& medium, Asks asks, const SurfaceHit* known) {
    passage_ = Passage::Medium;
    if (!transport::BounceLimits::fly(path.flights, medium)) return {};
    if (choosesPoint_) choosePoint(path, asks);
    setEscapeModelFrom(path, transport::FlightStart::along(path.ray));
    if (!reachable().alive()) return {};
    const darts::Guide& guide = guideOf(path.region);
    startRoulette(guide, path.region.medium, meanComponent(path.throughput));
    heading_ = headingOf(path.ray.direction);
    path.ray.tMax = bound(guide, heading_.h);
    const Ahead ahead{true, &medium, see(path.ray, known)};
    if (!hasDensities()) return ahead;
    distances_.emplace(guide.distance().density(reachable(), heading_, ahead.reach(), darts::vec3(path.throughput)));
    return ahead;
}

Ahead StepsToEmitter::aheadUntimed(PathState& path, const Medium& medium, const SurfaceHit* known) {
    passage_ = Passage::Untimed;
    choosesPoint_ = false;
    if (!transport::BounceLimits::fly(path.flights, medium)) return {};
    setTimeBudgetFrom(path, path.ray.origin);
    return {true, &medium, see(path.ray, known)};
}

Flight StepsToEmitter::flight(PathState& path, const Ahead& ahead) {
    Flight flight = passage_ == Passage::Untimed ? flyUntimed(path, ahead)
                    : passage_ == Passage::Medium
                        ? flyGuided(path, ahead)
                        : Flight{Event::Surface, ahead.reach(),
                                 ahead.medium ? ahead.medium->transmittance(ahead.reach()) : Rgb(1.0f)};
    if (hasDensities() && flight.event != Event::Nothing) {
        const FlightSample plain = this->plain().like(flight);
        path.logRatio = start_.logRatio + logOfQuotient(flight.pdf, plain.pdf);
        path.channels = plain.channels;
    }
    return flight;
}

Flight StepsToEmitter::flyGuided(PathState& path, const Ahead& ahead) {
    const darts::Guide& guide = guideOf(path.region);
    path.random.at(path.interactions + 1, Draw::Distance);
    const auto random = [&] { return path.random.next1D(); };
    darts::DistanceSample sample;
    if (hasDensities()) {
        const float event = random(), choice = random();
        sample = guide.distance().sample(*distances_, ahead.reach(), event, choice);
    } else {
        sample = sampleDistance(guide, heading_, ahead.reach(), path.throughput, random);
    }
    const Rgb weight = darts::to<Rgb>(sample.transmittanceOverPdf);
    if (sample.surface) return {Event::Surface, ahead.reach(), weight, sample.pdf};
    return {Event::Collision, sample.distance, weight * ahead.medium->sigmaS(), sample.pdf};
}

/// Only vertices in the medium must lie in the ball from which light is in time: mirrors farther away still count.
StepsToEmitter::Untimed::Untimed(const Vec3f& toTarget, const Vec3f& direction, double reach, const Medium& medium,
                                 float distance)
    : chord(toTarget, direction, 0.0, reach, double(distance)), medium_(&medium) {
    if (distance < Infinity) surface = chord.empty() ? 1.0f : meanComponent(medium.transmittance(distance));
}

double StepsToEmitter::Untimed::sample(double u, float half) const {
    return half < 0.5f ? chord.begin() + flights().sample(u).offset : chord.sample(u);
}

double StepsToEmitter::Untimed::pdf(double t) const {
    return chord.empty() ? 0.0 : (0.5 * flights().pdf(t - chord.begin()) + 0.5 * chord.pdf(t)) * double(1.0f - surface);
}

StepsToEmitter::Untimed StepsToEmitter::untimed(const Ray& ray, const Medium& medium, float distance) const {
    return {target_.vertex.position() - ray.origin, ray.direction, double(reachable().C) + double(reachable().excess),
            medium, distance};
}

/// The surface by its transmittance; in the medium a distance from which light may still arrive, half of them by
/// transmittance, half by angle.
Flight StepsToEmitter::flyUntimed(PathState& path, const Ahead& ahead) {
    const Medium& medium = *ahead.medium;
    const Untimed distances = untimed(path.ray, medium, ahead.reach());
    if (ahead.hit) {
        path.random.at(path.interactions + 1, Draw::Flight);
        if (path.random.next1D() < distances.surface)
            return {Event::Surface, ahead.reach(), medium.transmittance(ahead.reach()) / distances.surface,
                    distances.surface};
    }
    if (distances.chord.empty()) return {};
    path.random.at(path.interactions + 1, Draw::Distance);
    const double u = path.random.nextDouble(), t = distances.sample(u, path.random.next1D()), pdf = distances.pdf(t);
    if (!(pdf > 0.0)) return {};
    const auto distance = float(t);
    return {Event::Collision, distance, medium.sigmaS() * medium.transmittance(distance) * float(1.0 / pdf),
            float(pdf)};
}

// ---- Densities of the flight at hand

float StepsToEmitter::vertexDensity(float distance) const {
    if (passage_ == Passage::Medium) return distances_->pdf(distance);
    return passage_ == Passage::Untimed ? float(untimed(start_.ray, *medium_, reach_).pdf(double(distance))) : 0.0f;
}

float StepsToEmitter::surfaceProbability() const {
    if (passage_ == Passage::Medium) return distances_->surface();
    return passage_ == Passage::Untimed ? untimed(start_.ray, *medium_, reach_).surface : 1.0f;
}

float StepsToEmitter::controlVertexDensity(float distance) const {
    const darts::Guide& guide = guideOf(start_.region);
    if (!drawsControlVertices() || guided_->sensor.gate.delta) return 0.0f;
    const Vec3f place = start_.ray.at(distance);
    float density = 0.0f;
    if (passage_ == Passage::Untimed) {
        density = float(controlChord(start_.ray, start_.region, reach_).pdf(double(distance)));
    } else if (passage_ == Passage::Medium && budget().alive()) {
        const darts::TimeBudget before = darts::Guide::beforeSurface(budget(), heading_.h, reach_);
        if (before.alive()) density = guide.pdfControlVertex(before, heading_.h, distance, response(start_.time));
    }
    const auto way = transport::connectionSegment(place, target_.vertex.position());
    if (!(density > 0.0f) || !way) return 0.0f;
    return density * shadowRayProbability({distance, way->distance, 1.0f / density}, way->direction);
}

float StepsToEmitter::shadowRayProbability(const darts::ControlVertex& vertex, const Vec3f& onward) const {
    const Vec3f& direction = start_.ray.direction;
    return guideOf(start_.region)
        .shadowRayProbability(budget(), darts::vec3(direction), vertex, medium_->phase.eval(direction, onward));
}

ShellChord StepsToEmitter::controlChord(const Ray& ray, const Region& region, float surface) const {
    const transport::TimeWindow& gate = window();
    const double speed = double(region.speed);
    return {target_.vertex.position() - ray.origin, ray.direction, speed * (gate.begin - target_.start),
            speed * (gate.end - target_.start), double(surface)};
}

auto StepsToEmitter::inMedium(float distance) const -> InMedium {
    return inMedium(distance, controlVertexDensity(distance));
}

auto StepsToEmitter::inMedium(float distance, float control) const -> InMedium {
    const float plain = this->plain().pdf(distance);
    InMedium ending{ownVerticesConnect() ? vertexDensity(distance) : 0.0f, control};
    // Own vertices that guided paths do not go on from do not connect either.
    if (ending.own > 0.0f && guided_->balance.endsGuided(start_.logRatio + logOfQuotient(ending.own, plain)))
        ending.own = 0.0f;
    ending.logRatio = start_.logRatio + logOfQuotient(ending.own + ending.control, plain);
    return ending;
}

float StepsToEmitter::logRatioOnSurface() const {
    return start_.logRatio - logOfQuotient(plain().surface());
}

float StepsToEmitter::logRatioThere(const Flight& flight) const {
    const float own = flight.event == Event::Collision ? vertexDensity(flight.distance) : surfaceProbability();
    return start_.logRatio + logOfQuotient(own, flight.pdf);
}

// ---- Roulette, splitting, directions

auto StepsToEmitter::onward(const PathState& path, const WalkVertex& vertex) -> Onward {
    if (vertex.surface && !guidesSurface()) return {};
    const darts::Guide& guide = vertex.surface ? *surfaceGuide_ : guideOf(path.region);
    Onward onward;
    onward.survival = GuidedSteps::survival(guide, path.region.medium, meanComponent(path.throughput));
    if (vertex.medium) onward.copies = copiesBy(guide);
    return onward;
}

int StepsToEmitter::copies(PathState& path, const WalkVertex& vertex) {
    const auto [survival, copies] = onward(path, vertex);
    if (survival < 1.0f) {
        path.random.at(path.interactions, Draw::Roulette);
        if (!(path.random.next1D() < survival)) return 0;
        path.throughput = path.throughput / survival;
    }
    const float mean = survival * float(copies);
    if (hasDensities() && mean != 1.0f) path.logRatio += std::log(mean);
    return copies;
}

float StepsToEmitter::expectedCopies(const PathState& path, const WalkVertex& vertex) {
    const auto [survival, copies] = onward(path, vertex);
    return survival * float(copies);
}

bool StepsToEmitter::survives(PathState& path) {
    if (hasDensities() && guided_->settings.russianRoulette)
        path.logRatio -= logOfQuotient(transport::survivalByThroughput(
            path.throughput * std::exp(std::min(path.logRatio, 80.0f)), path.interactions));
    return true;
}

template <typename Scatterer>
darts::DirectionSample StepsToEmitter::draw(PathState& path, const darts::Guide& guide, const Scatterer& scatterer) {
    const bool lengthFirst = guide.settings().lengthFirst;
    path.random.at(path.interactions, Draw::Connection);
    if (lengthFirst) connect(drawConnection(path, guide, budget()));
    path.random.at(path.interactions, Draw::GuidedDirection);
    const darts::DirectionSample sample = sampleDirection(guide, scatterer, [&] { return path.random.next1D(); });
    if (lengthFirst && drawsControlVertices())
        place({guide, sample.h, path.time, sharesConnections()});
    else
        startWay();
    return sample;
}

std::optional<transport::Way> StepsToEmitter::way(PathState& path, const WalkVertex& vertex) {
    if (vertex.medium) return leaveMedium(path, vertex);
    return guidesSurface() ? leaveGuided(path, vertex) : leavePlainly(path, vertex);
}

transport::Way StepsToEmitter::leaveMedium(PathState& path, const WalkVertex& vertex) {
    const darts::Guide& guide = guideOf(path.region);
    startWay();
    if (!budget().alive() || guide.settings().direction == darts::Direction::Phase)
        return transport::sampleMediumWay(path, vertex);
    const PhaseFunction& phase = vertex.medium->phase;
    const darts::DirectionSample sample = draw(path, guide, darts::PhaseScatterer{phase, vertex.before});
    const Vec3f direction = darts::to<Vec3f>(sample.direction);
    const float own = phase.eval(vertex.before, direction);
    if (hasDensities()) path.logRatio -= logOfQuotient(own * sample.inversePdf);
    return {Ray{vertex.position, direction}, path.region, Rgb(own * sample.inversePdf), own};
}

transport::Way StepsToEmitter::leaveGuided(PathState& path, const WalkVertex& vertex) {
    startWay();
    const darts::DirectionSample sample = draw(path, *surfaceGuide_, SurfaceScatterer{*vertex.surface, path.random});
    const Ray ray = vertex.surface->hit.spawnRay(darts::to<Vec3f>(sample.direction));
    const transport::Vertex here = vertex.connectible(context_.scene, TransportMode::Radiance);
    const float own = here.pdf(ray.direction);
    if (hasDensities()) path.logRatio -= logOfQuotient(own * sample.inversePdf);
    return {ray, path.region, here.scattering(ray.direction) * sample.inversePdf, own, lobe::DiffuseReflection};
}

std::optional<transport::Way> StepsToEmitter::leavePlainly(PathState& path, const WalkVertex& vertex) {
    const auto way =
        transport::sampleSurfaceWay(path, vertex, TransportMode::Radiance, context_.scene.transport.consistencyChecks);
    if (!way) return way;
    // A connection drawn before goes on through a boundary that light passes straight at its speed.
    if (way->straight() && way->region.speed == path.region.speed)
        crossIndexMatched(vertex.surface->hit.t);
    else
        startWay();
    startsAnew_ = true;
    return way;
}

void StepsToEmitter::leaveAlong(PathState& path, const WalkVertex& vertex, const transport::Way& way) {
    if (vertex.surface && !guidesSurface()) {
        if (way.straight() && way.region.speed == path.region.speed)
            crossIndexMatched(vertex.surface->hit.t);
        else
            startWay();
        startsAnew_ = true;
        return;
    }
    startWay();
    const auto pdf = [&](const darts::Guide& guide, const auto& scatterer) {
        return guide.pdfDirection(budget(), {}, darts::vec3(way.ray.direction), scatterer);
    };
    if (vertex.surface) {
        path.logRatio += logOfQuotient(pdf(*surfaceGuide_, SurfaceScatterer{*vertex.surface, path.random}), way.pdf);
        return;
    }
    const darts::Guide& guide = guideOf(path.region);
    if (!budget().alive() || guide.settings().direction == darts::Direction::Phase) return;
    path.logRatio += logOfQuotient(pdf(guide, darts::PhaseScatterer{vertex.medium->phase, vertex.before}), way.pdf);
}

} // namespace tungsten::path
