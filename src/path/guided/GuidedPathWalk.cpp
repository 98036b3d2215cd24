// The walk's flights: through media towards what can still arrive inside the gate, and when it ends.

#include "path/guided/GuidedPathWalk.h"

#include "path/guided/ShellChord.h"

namespace tungsten::path {

void GuidedPathWalk::run(const Ray& ray, const PathTarget& target) {
    target_ = &target;
    ray_ = ray;
    region_ = scene_.cameraRegion;
    ++counters_.paths;
    if (timed()) lookAhead(ray_.origin);
    goOn();
}

void GuidedPathWalk::goOn() {
    while (interactions_ < scene_.transport.maxBounces) {
        const Medium* medium = scene_.medium(region_);
        if (!medium || !medium->scatters()) {
            if (!crossEmpty()) return;
        } else if (timed()) {
            if (!crossMedium(*medium)) return;
        } else if (!crossUntimed(*medium)) {
            return;
        }
    }
}

bool GuidedPathWalk::counts(int interactions, int mediumScatters) const {
    const int total = interactions_ + interactions + target_->interactions;
    const transport::BounceLimits& limits = context_.settings.limits;
    return limits.renders(total) && limits.orderCounts(mediumScatters_ + mediumScatters + target_->mediumScatters);
}

void GuidedPathWalk::lookAhead(const Vec3f& position) {
    const TimeGate& gate = context_.sensor.gate;
    const darts::TimeGate open{gate.start - target_->start, gate.end() - target_->start};
    const auto range = darts::ResidualRange::of(open, time_, double(region_.speed));
    residual_ = darts::Residual::of(darts::vec3(target_->point.position - position), range);
    reachable_ = residual_;
    const float faster = context_.arrival.oneSpeed() ? 0.0f : context_.arrival.highestSpeed() / region_.speed - 1.0f;
    const float more = target_->reach + faster * std::max(float(range.high), 0.0f);
    reachable_.excess += more;
    reachable_.width += more;
    surplus_ = more;
    lookedOut_ = false;
}

void GuidedPathWalk::lookOut(const transport::Start& start) {
    if (lookedOut_ || !context_.waysOut) return;
    lookedOut_ = true;
    const transport::Aim aim{target_->point.position, target_->surrounding, target_->point.margin(), nullptr, true};
    context_.waysOut->look(start, region_, aim, residual_, counters_.rays);
    reachable_.way = residual_.way;
    reachable_.exit = residual_.exit;
    // What cannot be connected to is met by chance, anywhere on the emitter.
    if (reachable_.exit.connects) reachable_.exit.surplus = surplus_;
}

bool GuidedPathWalk::crossEmpty() {
    if (timed()) {
        if (!reachable_.alive()) return false;
        ray_.tMax = reachable_.latest(darts::oneMinusCosine(darts::vec3(ray_.direction), reachable_.axis)).firstLeg();
    }
    ++counters_.rays;
    const auto hit = scene_.geometry->intersect(ray_);
    if (!hit) return false;
    if (const Medium* medium = scene_.medium(region_)) throughput_ = throughput_ * medium->transmittance(hit->t);
    findAt(*hit, throughput_);
    return !isBlack(throughput_) && scatterOnSurface(*hit);
}

bool GuidedPathWalk::crossMedium(const Medium& medium) {
    if (!mayFly(&medium) || !reachable_.alive()) return false;
    ++flights_;
    lookOut(transport::Start::along(ray_));
    const darts::Guide& guide = guideOf(region_);
    startRoulette(guide);
    const darts::Heading heading = residual_.heading(darts::vec3(ray_.direction));
    const float h = heading.h;
    ray_.tMax = guide.distance().bound(reachable_, h);
    ++counters_.rays;
    const auto hit = scene_.geometry->intersect(ray_);
    const float surface = hit ? hit->t : Infinity;
    // What the camera sees beyond the fog, or of lamps there, has been connected to by no vertex.
    if (hit && reachable_.way == darts::Way::Out && reachable_.exit.connects && mediumScatters_ > 0)
        reachable_.exit.leaveOdds = context_.waysOut->leaveOdds(region_, ray_.direction, *hit);
    connectElliptically(medium, guide, h, surface);
    // In expectation, whether or not the walk goes there.
    if (hit) findAt(*hit, throughput_ * medium.transmittance(surface));
    const darts::Guide& flights = mediumScatters_ == 0 ? context_.guides.view[size_t(region_.medium)] : guide;
    const darts::DistanceSample flight =
        flights.sampleDistance(reachable_, heading, surface, darts::vec3(throughput_), [this] { return next(); });
    throughput_ = throughput_ * darts::to<Rgb>(flight.transmittanceOverPdf);
    if (isBlack(throughput_)) return false;
    if (flight.surface) return scatterOnSurface(*hit);
    throughput_ = throughput_ * medium.sigmaS;
    return scatterInMedium(medium, flight.distance);
}

/// A camera segment that does not count: time starts at the vertex on it.
bool GuidedPathWalk::crossUntimed(const Medium& medium) {
    if (!mayFly(&medium)) return false;
    ++flights_;
    lookAhead(ray_.origin);
    const double reach = double(reachable_.C) + double(reachable_.excess);
    ++counters_.rays;
    const auto hit = scene_.geometry->intersect(ray_);
    const float surface = hit ? hit->t : Infinity;
    connectUntimed(medium, surface);
    // Only vertices in the medium must lie in the ball from which light is in time: mirrors farther away still count.
    const Vec3f toTarget = target_->point.position - ray_.origin;
    const ShellChord inTime(toTarget, ray_.direction, 0.0, reach, double(surface));
    if (hit) {
        const Rgb reaching = medium.transmittance(surface);
        findAt(*hit, throughput_ * reaching);
        const float probability = inTime.empty() ? 1.0f : meanComponent(reaching);
        if (next() < probability) {
            throughput_ = throughput_ * reaching / probability;
            return scatterOnSurface(*hit);
        }
        throughput_ = throughput_ / (1.0f - probability);
    }
    const auto distance = sampleUntimed(medium, inTime);
    return distance && !isBlack(throughput_) && scatterInMedium(medium, *distance);
}

/// A distance from which light may still arrive, half of them by transmittance, half by angle; the throughput includes
/// its scattering.
std::optional<float> GuidedPathWalk::sampleUntimed(const Medium& medium, const ShellChord& chord) {
    if (chord.empty()) return std::nullopt;
    const darts::ConnectionLength<double> flights{chord.begin(), chord.end() - chord.begin(),
                                                  double(meanComponent(medium.sigmaT()))};
    const double u = sampler_.nextDouble();
    const double t = next() < 0.5f ? chord.begin() + flights.sample(u).offset : chord.sample(u);
    const double pdf = 0.5 * flights.pdf(t - chord.begin()) + 0.5 * chord.pdf(t);
    if (!(pdf > 0.0)) return std::nullopt;
    throughput_ = throughput_ * medium.sigmaS * medium.transmittance(float(t)) * float(1.0 / pdf);
    return float(t);
}

void GuidedPathWalk::startRoulette(const darts::Guide& guide) {
    // Models do not compare: what one promises, another may keep.
    if (rouletteStarted_ && rouletteMedium_ == region_.medium && rouletteWay_ == reachable_.way) return;
    rouletteMedium_ = region_.medium;
    rouletteWay_ = reachable_.way;
    firstUsefulness_ = guide.logUsefulness(reachable_, meanComponent(throughput_));
    rouletteStarted_ = true;
}

bool GuidedPathWalk::roulette(const darts::Guide& guide) {
    startRoulette(guide);
    const float survival =
        guide.survival(guide.logUsefulness(reachable_, meanComponent(throughput_)), firstUsefulness_);
    if (survival >= 1.0f) return true;
    if (!(next() < survival)) return false;
    throughput_ = throughput_ / survival;
    return true;
}

} // namespace tungsten::path
