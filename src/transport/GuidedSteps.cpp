#include "transport/GuidedSteps.h"

#include "transport/Tuning.h"

namespace tungsten::transport {

void GuidedSteps::setEscapeModel(const EscapeModels& escapeModels, const FlightStart& start, const Region& region,
                                 const EscapeTarget& aim, uint64_t& rays) {
    known_ = Known::EscapeModel;
    escapeModels.choose(start, region, aim, budget_, rays);
    reachable_.model = budget_.model;
    reachable_.escape = budget_.escape;
    // What cannot be connected to is met by chance, anywhere on the emitter.
    if (reachable_.escape.straightExit) reachable_.escape.extraLength = extraLength_;
}

void GuidedSteps::startRoulette(const darts::Guide& guide, int medium, float throughput) {
    if (!(guide.settings().roulette > 0.0f)) return;
    if (first_ && first_->medium == medium && first_->model == reachable_.model) return;
    first_ = First{guide.logExpectedContribution(reachable_, throughput), medium, reachable_.model};
}

float GuidedSteps::survival(const darts::Guide& guide, int medium, float throughput) {
    if (!(guide.settings().roulette > 0.0f)) return 1.0f;
    logContribution_ = guide.logExpectedContribution(reachable_, throughput);
    if (!(first_ && first_->medium == medium && first_->model == reachable_.model))
        first_ = First{logContribution_, medium, reachable_.model};
    const float survival = guide.survival(reachable_.model, logContribution_, first_->logContribution);
    expectedOffspring_ *= survival;
    return survival;
}

int GuidedSteps::copiesBy(const darts::Guide& guide) {
    int copies = 1;
    if (reachable_.model == darts::EscapeModel::Bounded) copies = splits_.copies(guide.splits(reachable_));
    expectedOffspring_ *= float(copies);
    if (!first_) return copies;
    // Of those, what is still too heavy splits once more.
    const float each = logContribution_ - std::log(float(copies));
    const int heavy =
        guide.copies(reachable_.model, each, first_->logContribution, tuning::MostCopies / expectedOffspring_);
    expectedOffspring_ *= float(heavy);
    return copies * heavy;
}

void GuidedSteps::crossIndexMatched(float distance) {
    if (std::holds_alternative<OnWay>(connection_)) std::get<OnWay>(connection_).vertex.distance -= distance;
    if (shared_) shared_->behind += distance;
}

} // namespace tungsten::transport
