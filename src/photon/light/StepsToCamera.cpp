#include "photon/light/StepsToCamera.h"

#include "transport/BounceLimits.h"

namespace tungsten::photon {

using transport::Ahead;
using transport::Flight;
using transport::logOfQuotient;
using transport::PathState;
using transport::WalkVertex;
using transport::Way;
using Event = Flight::Event;

// ---- Looking

bool StepsToCamera::setTimeBudgetFrom(const PathState& path, const transport::FlightStart& start) {
    setTimeBudgetAndModel(guidance_->budget(start, path.region, path.time, gate_, context_.counters.rays));
    return budget().alive();
}

bool StepsToCamera::canArrive(PathState& path, const WalkVertex& vertex) {
    if (rules_.balance.endsGuided(path.logRatio)) return false;
    forget();
    return vertex.surface || setTimeBudgetFrom(path, {vertex.position});
}

// ---- Flights

Ahead StepsToCamera::ahead(PathState& path, const std::optional<SurfaceHit>* known) {
    medium_ = context_.scene.medium(path.region);
    guide_ = guidance_->guide(path.region);
    if (guide_) {
        if (!transport::BounceLimits::fly(path.flights, *medium_)) return {};
        if (!hasTimeBudget()) {
            // After a surface.
            if (!setTimeBudgetFrom(path, transport::FlightStart::along(path.ray))) return {};
            if (known)
                path.logRatio += logOfQuotient(survival(path, *guide_));
            else if (!passesRoulette(path, *guide_))
                return {};
        }
        heading_ = headingOf(path.ray.direction);
        path.ray.tMax = bound(*guide_, heading_.h);
    }
    Ahead ahead{true, medium_};
    if (known) {
        if (*known && (*known)->t < path.ray.tMax) ahead.hit = *known;
    } else {
        if (medium_) context_.counters.fly(*medium_);
        ++context_.counters.rays;
        ahead.hit = context_.scene.geometry->intersect(path.ray);
    }
    path.ray.tMax = Infinity;
    if (!hasDensities()) return ahead;
    start_ = path;
    reach_ = ahead.reach();
    if (guide_)
        distances_.emplace(guide_->distance().density(reachable(), heading_, reach_, darts::vec3(path.throughput)));
    return ahead;
}

Flight StepsToCamera::flight(PathState& path, const Ahead& ahead) {
    Flight flight;
    if (!guide_) {
        if (!ahead.hit) return {Event::Escape};
        flight = {Event::Surface, ahead.hit->t, ahead.medium ? ahead.medium->transmittance(ahead.hit->t) : Rgb(1.0f)};
    } else {
        path.random.at(path.interactions + 1, Draw::Distance);
        const auto random = [&] { return path.random.next1D(); };
        darts::DistanceSample sample;
        if (hasDensities()) {
            const float event = random(), choice = random();
            sample = guide_->distance().sample(*distances_, reach_, event, choice);
        } else {
            sample = sampleDistance(*guide_, heading_, ahead.reach(), path.throughput, random);
        }
        const Rgb weight = darts::to<Rgb>(sample.transmittanceOverPdf);
        if (sample.surface) {
            flight = {Event::Surface, ahead.hit->t, weight, sample.pdf};
        } else {
            // As it is stored, so that times are those of the path that is gathered.
            const double length = transport::distanceBetween(path.ray.origin, path.ray.at(sample.distance));
            flight = {Event::Collision, sample.distance, weight * ahead.medium->sigmaS(), sample.pdf, length};
        }
    }
    if (hasDensities()) {
        const FlightSample plain = this->plain().like(flight);
        path.logRatio = start_.logRatio + logOfQuotient(flight.pdf, plain.pdf);
        path.channels = plain.channels;
    }
    return flight;
}

// ---- Densities of the flight at hand

auto StepsToCamera::inMedium(float distance) const -> InMedium {
    if (!guide_) return {};
    InMedium ending{distances_->pdf(distance)};
    const darts::TimeBudget before = darts::Guide::beforeSurface(budget(), heading_.h, reach_);
    if (rules_.storesVertices && guidance_->drawsControlVertices() && before.alive())
        ending.control = guide_->pdfControlVertex(before, heading_.h, distance, guidance_->response(start_.time));
    ending.logRatio = start_.logRatio + logOfQuotient(ending.own + ending.control, plain().pdf(distance));
    return ending;
}

float StepsToCamera::logRatioThere(const Flight& flight) const {
    const bool collision = flight.event == Flight::Event::Collision;
    const float own = !guide_     ? (collision ? 0.0f : 1.0f)
                      : collision ? distances_->pdf(flight.distance)
                                  : distances_->surface();
    return start_.logRatio + logOfQuotient(own, flight.pdf);
}

// ---- Roulette and splitting

bool StepsToCamera::passesRoulette(PathState& path, const darts::Guide& guide) {
    const float survival = this->survival(path, guide);
    if (survival >= 1.0f) return true;
    path.random.at(path.interactions, Draw::Roulette);
    if (path.random.next1D() >= survival) return false;
    path.throughput = path.throughput / survival;
    if (hasDensities()) path.logRatio += std::log(survival);
    return true;
}

int StepsToCamera::copies(PathState& path, const WalkVertex& vertex) {
    if (vertex.surface) return 1; // where the next flight starts
    if (!passesRoulette(path, *guide_)) return 0;
    const int copies = copiesBy(*guide_);
    if (hasDensities()) path.logRatio += std::log(float(copies));
    return copies;
}

void StepsToCamera::copyAlong(PathState& path, const WalkVertex& vertex) {
    if (vertex.surface) return;
    const float survival = this->survival(path, *guide_);
    path.logRatio += logOfQuotient(survival * float(copiesBy(*guide_)));
}

// ---- Directions

template <typename Scatterer>
std::optional<darts::DirectionSample> StepsToCamera::draw(PathState& path, const darts::Guide& guide,
                                                          const Scatterer& scatterer) {
    if (guide.settings().lengthFirst) {
        path.random.at(path.interactions, Draw::Connection);
        const darts::ConnectionSample connection = drawConnection(path, guide, budget());
        connect(connection);
        // A density of 0: the response is over, or the delta gate, but surfaces may still be seen in its kernel.
        if (!(connection.inversePdf > 0.0f) && !guidance_->meetsDeltaGate()) return std::nullopt;
    }
    path.random.at(path.interactions, Draw::GuidedDirection);
    return sampleDirection(guide, scatterer, [&] { return path.random.next1D(); });
}

const darts::Guide* StepsToCamera::guideOfEmission(const Region& region) const {
    const darts::Guide* guide = guidance_->guide(region);
    return guide && guide->settings().preset == darts::Preset::Best ? guide : nullptr;
}

std::optional<Way> StepsToCamera::emit(PathState& path, const Emitter& emitter, const SurfaceSample& start) {
    const darts::Guide* guide = guideOfEmission(path.region);
    const EmissionDirections directions = emission(emitter, start, guide != nullptr);
    Vec3f direction;
    float inversePdf = 0.0f;
    if (guide) {
        if (!setTimeBudgetFrom(path, {start.position, start.margin()})) return std::nullopt;
        const auto drawn = draw(path, *guide, directions);
        if (!drawn) return std::nullopt;
        direction = darts::to<Vec3f>(drawn->direction);
        inversePdf = drawn->inversePdf;
    } else {
        path.random.at(0, Draw::EmissionDirection);
        const float u = path.random.next1D(), v = path.random.next1D();
        const darts::Vec3 drawn = directions.sample(u, v);
        direction = darts::to<Vec3f>(drawn);
        inversePdf = 1.0f / directions.pdf(drawn);
    }
    const float own = EmissionDirections(emitter, start).pdf(darts::vec3(direction));
    if (hasDensities()) path.logRatio -= logOfQuotient(own * inversePdf);
    const Ray ray = start.spawnRay(direction);
    return Way{ray, path.region, emittedIntensity(emitter, start, ray.direction) * inversePdf, own};
}

bool StepsToCamera::emitAlong(PathState& path, const Emitter& emitter, const SurfaceSample& start,
                              const Vec3f& direction) {
    const darts::Guide* guide = guideOfEmission(path.region);
    const EmissionDirections directions = emission(emitter, start, guide != nullptr);
    if (guide && !setTimeBudgetFrom(path, {start.position, start.margin()})) return false;
    const darts::Vec3 along = darts::vec3(direction);
    path.logRatio += logOfQuotient(guide ? pdf(*guide, directions, direction) : directions.pdf(along),
                                   EmissionDirections(emitter, start).pdf(along));
    return true;
}

std::optional<Way> StepsToCamera::way(PathState& path, const WalkVertex& vertex) {
    if (vertex.surface)
        return transport::sampleSurfaceWay(path, vertex, TransportMode::Photons,
                                           context_.scene.transport.consistencyChecks);
    const PhaseFunction& phase = vertex.medium->phase;
    const auto drawn = draw(path, *guide_, darts::PhaseScatterer{phase, vertex.before});
    if (!drawn) return std::nullopt;
    const Vec3f direction = darts::to<Vec3f>(drawn->direction);
    const float own = phase.eval(vertex.before, direction);
    if (hasDensities()) path.logRatio -= logOfQuotient(own * drawn->inversePdf);
    return Way{Ray{vertex.position, direction}, path.region, Rgb(own * drawn->inversePdf), own};
}

void StepsToCamera::leaveAlong(PathState& path, const WalkVertex& vertex, const Way& way) {
    if (vertex.surface) return;
    path.logRatio += logOfQuotient(
        pdf(*guide_, darts::PhaseScatterer{vertex.medium->phase, vertex.before}, way.ray.direction), way.pdf);
}

// ---- Control vertices

darts::ConnectionSample StepsToCamera::drawConnection(PathState& path, const darts::Guide& guide,
                                                      const darts::TimeBudget& budget) const {
    if (guidance_->meetsDeltaGate() && rules_.storesVertices) return guidance_->onDeltaGate(budget);
    return guide.sampleConnection(budget, path.random.next1D(), guidance_->response(path.time));
}

auto StepsToCamera::controlVertex(PathState& path, const Ahead& ahead, bool shares) -> std::optional<OnWay> {
    const auto draw = [&](const darts::TimeBudget& budget) {
        path.random.at(path.interactions + 1, Draw::FlightConnection);
        return drawConnection(path, *guide_, budget);
    };
    return meetControlVertex({*guide_, heading_.h, path.time, shares}, ahead.reach(), draw);
}

} // namespace tungsten::photon
