#include "transport/GuidedStep.h"

#include "tungsten/core/Types.h"

namespace tungsten::transport {

void GuidedStep::look(const darts::Residual& residual) {
    looked_ = Looked::Out;
    residual_ = residual;
    reachable_ = residual;
    surplus_ = 0.0f;
}

void GuidedStep::lookAhead(const darts::Residual& residual, float surplus) {
    looked_ = Looked::Ahead;
    residual_ = residual;
    reachable_ = residual;
    reachable_.excess += surplus;
    reachable_.width += surplus;
    surplus_ = surplus;
}

void GuidedStep::lookOut(const WaysOut& waysOut, const Start& start, const Region& region, const Aim& aim,
                         uint64_t& rays) {
    looked_ = Looked::Out;
    waysOut.look(start, region, aim, residual_, rays);
    reachable_.way = residual_.way;
    reachable_.exit = residual_.exit;
    // What cannot be connected to is met by chance, anywhere on the emitter.
    if (reachable_.exit.connects) reachable_.exit.surplus = surplus_;
}

void GuidedStep::startRoulette(const darts::Guide& guide, int medium, float throughput) {
    if (!(guide.settings().roulette > 0.0f)) return;
    if (first_ && first_->medium == medium && first_->way == reachable_.way) return;
    first_ = First{guide.logUsefulness(reachable_, throughput), medium, reachable_.way};
}

float GuidedStep::survival(const darts::Guide& guide, int medium, float throughput) {
    if (!(guide.settings().roulette > 0.0f)) return 1.0f;
    const float useful = guide.logUsefulness(reachable_, throughput);
    if (first_ && first_->medium == medium && first_->way == reachable_.way)
        return guide.survival(useful, first_->usefulness);
    first_ = First{useful, medium, reachable_.way};
    return 1.0f;
}

std::optional<GuidedStep::OnWay> GuidedStep::onWay(const Way& way, const darts::ConnectionSample& connection,
                                                   float surface) const {
    const auto vertex = way.guide.controlVertex(residual_, connection, way.h, surface);
    if (!vertex) return std::nullopt;
    return OnWay{*vertex, residual_.shortest + double(connection.excess - residual_.low), way.elapsed};
}

void GuidedStep::place(const Way& way) {
    if (!std::holds_alternative<darts::ConnectionSample>(connection_)) return;
    const auto placed = onWay(way, std::get<darts::ConnectionSample>(connection_), Infinity);
    if (way.shares) shared_ = Shared{&way.guide, residual_, way.h, 0.0f};
    if (placed)
        connection_ = *placed;
    else
        connection_ = Over{};
}

std::optional<GuidedStep::OnWay> GuidedStep::takeControlVertex(float surface) {
    if (!std::holds_alternative<OnWay>(connection_)) return std::nullopt;
    const OnWay ahead = std::get<OnWay>(connection_);
    if (!(ahead.vertex.distance < surface)) return std::nullopt;
    connection_ = Over{};
    if (!(ahead.vertex.distance >= 0.0f)) return std::nullopt;
    return ahead;
}

void GuidedStep::passBoundary(float distance) {
    if (std::holds_alternative<OnWay>(connection_)) std::get<OnWay>(connection_).vertex.distance -= distance;
    if (shared_) shared_->behind += distance;
}

} // namespace tungsten::transport
