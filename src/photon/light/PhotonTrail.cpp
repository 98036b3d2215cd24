#include "photon/light/PhotonTrail.h"

namespace tungsten::photon {

using transport::Ahead;
using transport::PathState;
using transport::WalkRecord;
using transport::WalkVertex;
using Event = transport::Flight::Event;

namespace {

constexpr float Never = transport::StrategyBalance::Never;

} // namespace

void PhotonTrail::start(const StepsToCamera& steps, uint64_t& densities) {
    steps_.emplace(steps);
    emission_.reset();
    record_.clear();
    densities_ = &densities;
    flown_ = reached_ = stopped_ = 0;
    alive_ = true;
    onFlight_ = logRatio_ = 0.0f;
}

PathState PhotonTrail::guided(const PathState& plain) const {
    PathState path = plain;
    path.logRatio = logRatio_;
    path.throughput = WalkRecord::throughputOfGuided(plain.throughput, logRatio_);
    path.ray.tMax = Infinity;
    return path;
}

void PhotonTrail::follow() {
    while (alive_ && flown_ < record_.size()) {
        if (flown_ > 0) {
            reach(record_[flown_ - 1]);
            stop(flown_ - 1);
            pass(flown_ - 1);
        }
        if (alive_) fly(record_[flown_]);
        ++flown_;
    }
}

void PhotonTrail::fly(const WalkRecord::Step& step) {
    if (flown_ == 0 && emission_) {
        PathState path = guided(emission_->start);
        alive_ = steps_->emitAlong(path, *emission_->emitter, emission_->from, emission_->direction);
        logRatio_ = path.logRatio;
        if (!alive_) return;
    }
    ++*densities_;
    PathState path = guided(step.start);
    // The plain path has counted the flight.
    const Medium* medium = steps_->context().scene.medium(path.region);
    if (medium && medium->scatters()) --path.flights;
    alive_ = steps_->ahead(path, &step.hit).flies;
    onFlight_ = path.logRatio;
}

void PhotonTrail::reach(const WalkRecord::Step& step) {
    if (!alive_ || reached_ == flown_) return;
    reached_ = flown_;
    logRatio_ = steps_->logRatioThere(step.flight);
    // Beyond the bound in time guided paths do not fly.
    if (!(logRatio_ > Never)) alive_ = false;
}

void PhotonTrail::stop(size_t index) {
    if (!alive_ || stopped_ > index) return;
    stopped_ = index + 1;
    const WalkRecord::Step& step = record_[index];
    PathState path = guided(step.at);
    surface_.reset();
    if (!step.medium) surface_.emplace(makeInteraction(steps_->context().scene, *step.hit, path.ray.direction));
    alive_ = steps_->canArrive(
        path, {step.medium, surface_ ? &*surface_ : nullptr, path.ray.origin, path.ray.direction, path.region});
}

void PhotonTrail::pass(size_t index) {
    if (!alive_) return;
    const WalkRecord::Step& step = record_[index];
    PathState path = guided(step.at);
    const WalkVertex vertex{step.medium, surface_ ? &*surface_ : nullptr, path.ray.origin, path.ray.direction,
                            path.region};
    steps_->copyAlong(path, vertex);
    steps_->leaveAlong(path, vertex, *step.way);
    logRatio_ = path.logRatio;
}

float PhotonTrail::onFlight() {
    follow();
    return alive_ ? onFlight_ : Never;
}

float PhotonTrail::there() {
    follow();
    reach(record_[record_.size() - 1]);
    return alive_ ? logRatio_ : Never;
}

float PhotonTrail::inMedium() {
    follow();
    if (!alive_) return Never;
    return std::max(steps_->inMedium(record_[record_.size() - 1].flight.distance).logRatio, Never);
}

float PhotonTrail::atVertex() {
    follow();
    reach(record_[record_.size() - 1]);
    stop(record_.size() - 1);
    return alive_ ? logRatio_ : Never;
}

} // namespace tungsten::photon
