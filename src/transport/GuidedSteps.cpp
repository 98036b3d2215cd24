#include "transport/GuidedSteps.h"

#include "transport/Tuning.h"

namespace tungsten::transport {

void GuidedSteps::lookOut(const WaysOut& waysOut, const Start& start, const Region& region, const Aim& aim,
                          uint64_t& rays) {
    looked_ = Looked::Out;
    waysOut.look(start, region, aim, residual_, rays);
    reachable_.way = residual_.way;
    reachable_.exit = residual_.exit;
    // What cannot be connected to is met by chance, anywhere on the emitter.
    if (reachable_.exit.connects) reachable_.exit.surplus = surplus_;
}

void GuidedSteps::startRoulette(const darts::Guide& guide, int medium, float throughput) {
    if (!(guide.settings().roulette > 0.0f)) return;
    if (first_ && first_->medium == medium && first_->way == reachable_.way) return;
    first_ = First{guide.logUsefulness(reachable_, throughput), medium, reachable_.way};
}

float GuidedSteps::survival(const darts::Guide& guide, int medium, float throughput, float others) {
    if (!(guide.settings().roulette > 0.0f)) return 1.0f;
    useful_ = guide.logUsefulness(reachable_, throughput);
    if (!(first_ && first_->medium == medium && first_->way == reachable_.way))
        first_ = First{std::max(useful_, others), medium, reachable_.way};
    const float survival = guide.survival(reachable_.way, useful_, first_->usefulness);
    lineage_ *= survival;
    return survival;
}

int GuidedSteps::copiesBy(const darts::Guide& guide) {
    const bool out = reachable_.way == darts::Way::Out;
    int copies = out ? splits_.copies(guide.splits(reachable_)) : 1;
    const bool byUsefulness = out ? guide.settings().splitsHeavyOut : reachable_.way != darts::Way::Unknown;
    if (byUsefulness && first_)
        copies *= guide.copies(useful_ - std::log(float(copies)), first_->usefulness, tuning::MostCopies / lineage_);
    lineage_ *= float(copies);
    return copies;
}

void GuidedSteps::passBoundary(float distance) {
    if (std::holds_alternative<OnWay>(connection_)) std::get<OnWay>(connection_).vertex.distance -= distance;
    if (shared_) shared_->behind += distance;
}

} // namespace tungsten::transport
