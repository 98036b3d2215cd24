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

float GuidedSteps::survival(const darts::Guide& guide, int medium, float throughput) {
    if (!(guide.settings().roulette > 0.0f)) return 1.0f;
    useful_ = guide.logUsefulness(reachable_, throughput);
    if (!(first_ && first_->medium == medium && first_->way == reachable_.way))
        first_ = First{useful_, medium, reachable_.way};
    const float survival = guide.survival(reachable_.way, useful_, first_->usefulness);
    lineage_ *= survival;
    return survival;
}

int GuidedSteps::copiesBy(const darts::Guide& guide) {
    int copies = 1;
    if (reachable_.way == darts::Way::Out)
        copies = splits_.copies(guide.splits(reachable_));
    else if (first_)
        copies = guide.copies(useful_, first_->usefulness, tuning::MostCopies / lineage_);
    lineage_ *= float(copies);
    return copies;
}

void GuidedSteps::passBoundary(float distance) {
    if (std::holds_alternative<OnWay>(connection_)) std::get<OnWay>(connection_).vertex.distance -= distance;
    if (shared_) shared_->behind += distance;
}

} // namespace tungsten::transport
