#include "photon/primitives/sliced/SliceBuilder.h"

#include "tungsten/emitter/Emitter.h"

namespace tungsten::photon {

void SliceBuilder::beginAt(const Scene& scene, const Emitter& emitter, float probability, const Vec2f& u) {
    flights_ = 0;
    emitter_ = -1;
    if (emitter.isDelta() || emitter.isInfinite()) return;
    const ptrdiff_t index = &emitter - scene.emitters.data();
    if (index > std::numeric_limits<int16_t>::max()) return;
    emitter_ = int(index);
    inverseProbability_ = 1.0f / probability;
    light_ = sampleEmissionPoint(emitter, u);
}

void SliceBuilder::fly(const Rules& rules, const BaseVertex& vertex, int medium, Sampler& sampler,
                       DepositList<SliceRecord>& list) {
    medium_ = medium;
    vertices_[size_t(flights_ % Most)] = vertex;
    directions_[size_t(flights_ % Most)] = vertex.direction;
    ++flights_;
    if (flights_ == 1) {
        if (emitter_ >= 0 && rules.classes.lights) {
            if (!rules.counts) depositLight(rules, vertex, sampler, list);
        } else if (rules.classes.beams && counts(rules, vertex, medium_, 0, 1)) {
            const bool ball = vertex.direction.dot(ballSide_) > 0.0f;
            depositBeam(rules, vertex, ball ? rules.classes.shortBeams : Infinity, sampler, list);
        }
    } else if (rules.classes.shortBeams > 0.0f && rules.classes.hasSingleBall(flights_ - 1) &&
               counts(rules, vertex, medium_, flights_ - 1, 1)) {
        depositBeam(rules, vertex, rules.classes.shortBeams, sampler, list);
    }
    if (rules.counts)
        branch(rules, sampler, list);
    else
        complete(rules, flights_ - 1, sampler, list);
}

void SliceBuilder::depositBeam(const Rules& rules, const BaseVertex& start, float most, Sampler& sampler,
                               DepositList<SliceRecord>& list) const {
    const auto speed = double(rules.scene.media[size_t(medium_)].speedOfLight);
    const FlightPart part = rules.arrival.countingPart(start.position, start.direction, start.time, speed);
    SliceRecord beam = record(rules, start, FlightShape::Beam, sampler);
    beam.reach = std::min({beam.reach, most, float(part.end)});
    beam.lengths[0] = float(part.start);
    if (beam.lengths[0] < beam.reach) list.records.push_back(beam);
}

void SliceBuilder::recordLight(const Rules& rules, const Emitter& emitter, float probability,
                               const SurfaceSample& light, const BaseVertex& start, int medium, Sampler& sampler,
                               DepositList<SliceRecord>& list) {
    end();
    const ptrdiff_t index = &emitter - rules.scene.emitters.data();
    if (!rules.classes.lights || index > std::numeric_limits<int16_t>::max()) return;
    emitter_ = int(index);
    inverseProbability_ = 1.0f / probability;
    light_ = light;
    medium_ = medium;
    depositLight(rules, start, sampler, list);
}

void SliceBuilder::depositLight(const Rules& rules, BaseVertex start, Sampler& sampler,
                                DepositList<SliceRecord>& list) const {
    start.position = light_.position;
    start.power = Rgb(inverseProbability_);
    if (!counts(rules, start, medium_, 0, 1)) return;
    SliceRecord ball = record(rules, start, FlightShape::Ball, sampler);
    ball.reach = 0.0f;
    ball.emitter = int16_t(emitter_);
    ball.directions[0] = light_.normal;
    ball.directions[1].x = light_.error;
    ball.lengths = {light_.uv.x, light_.uv.y};
    thin(rules, ball, sampler, list);
}

void SliceBuilder::recordSurface(const Rules& rules, const SurfaceInteraction& surface, const BaseVertex& at,
                                 const Region& region, Sampler& sampler, DepositList<SliceRecord>& list) {
    // Others are left to the chain's other records: only where f is one value do balls know it for every direction.
    if (rules.classes.shortBeams == 0.0f || !surface.bsdf->isLambertian()) return;
    const Vec3f &ng = surface.hit.ng, &ns = surface.frame.n;
    const Vec3f side = ng.dot(ns) < 0.0f ? -ng : ng;
    const float arriving = -at.direction.dot(side);
    const int medium = regionBeyond(surface, side, region).medium;
    if (!(arriving > 0.0f) || medium < 0 || !rules.scene.media[size_t(medium)].scatters()) return;
    ballSide_ = side;
    // Along the normal f |cos| is the albedo / pi; SurfaceInteraction::photonShadingFactor, but for what the way out
    // brings to it.
    const Rgb albedo = surface.bsdf->eval(surface.query(TransportMode::Photons), surface.wi, Vec3f(0, 0, 1)) * Pi;
    BaseVertex centre = at;
    centre.position = surface.hit.position;
    centre.power = at.power * albedo * std::abs(at.direction.dot(ns) / arriving);
    if (!counts(rules, centre, medium, 0, 1)) return;
    medium_ = medium;
    SliceRecord ball = record(rules, centre, FlightShape::Ball, sampler);
    ball.onSurface = true;
    ball.reach = rules.classes.shortBeams;
    ball.directions = {side, Vec3f(surface.hit.error, 0.0f, 0.0f), ns, Vec3f(0.0f)};
    thin(rules, ball, sampler, list);
}

void SliceBuilder::scatter(const Rules& rules, const BaseVertex& vertex, Sampler& sampler,
                           DepositList<SliceRecord>& list) {
    const int centre = flights_; // that many flights led here
    if (centre < rules.classes.firstBall || centre > rules.classes.lastBall) return;
    if (!counts(rules, vertex, medium_, centre, 1)) return;
    SliceRecord ball = record(rules, vertex, FlightShape::Ball, sampler);
    ball.reach = rules.classes.hasSingleBall(centre) ? rules.classes.shortBeams : 0.0f;
    ball.directions[1] = direction(centre - 1);
    if (centre >= 2) {
        const Vec3f& before = at(centre - 1).position;
        ball.directions[0] = direction(centre - 2);
        ball.lengths = {(before - at(centre - 2).position).length(), (vertex.position - before).length()};
        ball.shared = rules.classes.shared;
    }
    thin(rules, ball, sampler, list);
}

void SliceBuilder::complete(const Rules& rules, int last, Sampler& sampler, DepositList<SliceRecord>& list) const {
    using Bases = SliceClasses::Bases;
    for (int k = 2; k <= Most; ++k) {
        const Bases bases = rules.classes.flights[size_t(k)];
        const int first = last - k + 1;
        if (bases == Bases::None || first < 0 || first >= flights_ || (bases == Bases::First && first > 0)) continue;
        if (!counts(rules, at(first), medium_, first, k)) continue;
        SliceRecord flights = record(rules, at(first), FlightShape(k), sampler);
        for (int i = 0; i < k; ++i) flights.directions[size_t(i)] = direction(first + i);
        flights.shared = k == 3 && rules.classes.shared;
        thin(rules, flights, sampler, list);
    }
}

void SliceBuilder::branch(const Rules& rules, Sampler& sampler, DepositList<SliceRecord>& list) const {
    using Bases = SliceClasses::Bases;
    const int base = flights_ - 1;
    const PhaseFunction& phase = rules.scene.media[size_t(medium_)].phase;
    for (int k = 2; k <= Most; ++k) {
        const Bases bases = rules.classes.flights[size_t(k)];
        if (bases == Bases::None || (bases == Bases::First && base > 0)) continue;
        if (!counts(rules, at(base), medium_, base, k)) continue;
        SliceRecord flights = record(rules, at(base), FlightShape(k), sampler);
        flights.shared = k == 3 && rules.classes.shared;
        const float expected = rules.counts->expected(flights);
        flights.power = flights.power / expected;
        const int count = int(expected + sampler.next1D());
        for (int i = 0; i < count; ++i) {
            // Each relative to the one before it, and numbers of its own.
            for (size_t j = 1; j < size_t(k); ++j)
                flights.directions[j] = phase.sample(flights.directions[j - 1], sampler.next2D());
            const uint32_t bits = sampler.nextBits();
            flights.random = {uint16_t(bits >> 16), uint16_t(bits)};
            list.records.push_back(flights);
        }
    }
}

void SliceBuilder::end(const Rules& rules, Sampler& sampler, DepositList<SliceRecord>& list) {
    if (flights_ > 0) {
        int most = 0;
        for (int k = 2; k <= Most; ++k)
            if (rules.classes.flights[size_t(k)] != SliceClasses::Bases::None) most = k;
        const PhaseFunction& phase = rules.scene.media[size_t(medium_)].phase;
        for (int ghost = flights_; ghost < flights_ + most - 1; ++ghost) {
            // Each relative to the one before it.
            directions_[size_t(ghost % Most)] = phase.sample(direction(ghost - 1), sampler.next2D());
            complete(rules, ghost, sampler, list);
        }
    }
    end();
}

void SliceBuilder::thin(const Rules& rules, SliceRecord flights, Sampler& sampler, DepositList<SliceRecord>& list) {
    const float share = rules.counts ? rules.counts->expected(flights) : rules.classes.shareOf(flights);
    if (share < 1.0f) {
        if (sampler.next1D() >= share) return;
        flights.power = flights.power / share;
    }
    list.records.push_back(flights);
}

/// `chain`: the base's index among the chain's vertices.
bool SliceBuilder::counts(const Rules& rules, const BaseVertex& base, int medium, int chain, int flights) {
    if (!isFinite(base.power) || isBlack(base.power)) return false;
    const TransportSettings& transport = rules.scene.transport;
    if (base.bounce + flights >= transport.maxBounces) return false;
    // Without surfaces camera subpaths add no interactions.
    if (rules.scene.primitives.empty() && base.bounce + flights < transport.minBounces) return false;
    if (chain + flights > rules.scene.media[size_t(medium)].maxBounces) return false;
    return rules.arrival.mayContinue(base.position, base.time);
}

SliceRecord SliceBuilder::record(const Rules& rules, const BaseVertex& base, FlightShape shape,
                                 Sampler& sampler) const {
    SliceRecord flights{};
    flights.time = base.time;
    flights.base = base.position;
    flights.directions[0] = base.direction;
    flights.power = base.power;
    flights.reach = base.reach;
    const uint32_t bits = sampler.nextBits();
    flights.random = {uint16_t(bits >> 16), uint16_t(bits)};
    flights.bounce = uint16_t(base.bounce);
    flights.medium = int16_t(medium_);
    flights.emitter = -1;
    flights.shape = shape;
    flights.shortFlights = rules.classes.shortFlights;
    return flights;
}

} // namespace tungsten::photon
