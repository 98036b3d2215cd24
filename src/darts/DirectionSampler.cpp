#include "darts/DirectionSampler.h"

namespace darts {

namespace {

// Bench: study bodies.
/// Share of directions that suit the connection, at most.
constexpr float MostConnectionShare = 0.3f;
/// Share of both lobes where the phase function is even: |g| at most MostEven. (Amber half-space, g 0.3, points and
/// beams: variance x CPU 2 to 5 times as large with drift as without; lamp in fog, g 0, points: a third.)
constexpr float GuidedShare = 0.65f, MostEven = 0.1f;
constexpr float MostLog = 20.0f;

} // namespace

EscapeDirections::EscapeDirections(const TimeBudget& budget, float excess, const Medium& medium)
    : axis_(budget.axis), share_(0.0f),
      connectionLobe_(ConnectionLobe<float>::photon(
          std::max(std::min(budget.escape.inside, 1.0f / mean(medium.sigmaT())), 1e-6f * budget.C), excess)),
      driftLobe_(ConnectionLobe<float>::drift(1.0f, 0.5f)), drift_(budget.axis) {
    const bool even = std::abs(medium.g) <= MostEven;
    const FirstPassage passage(medium, budget.escape);
    const EscapePoint<float> here{budget.escape, budget.latest(0.0f), budget.axis, 0.0f};
    if (budget.escape.straightExit) {
        const float reachable = here.to(budget.escape.faces[0]).reachable,
                    gate = std::max(reachable, 1e-6f * budget.C) * mean(medium.sigmaS);
        const float transmittance = -mean(medium.sigmaT()) * (budget.escape.inside + excess);
        const float log = std::min(transmittance - passage.log(here), MostLog);
        share_ = std::min(MostConnectionShare, gate * std::exp(log));
    }
    if (!even) return;
    connectionShare_ = share_;
    share_ = GuidedShare;
    const FirstPassage::Slopes slopes = passage.slopes(here, budget.axis);
    const float strength = length(slopes.pull), rate = mean(medium.sigmaA) + medium.reducedSigmaS() + slopes.later;
    if (strength > 0) drift_ = slopes.pull * (1.0f / strength);
    // Diffusion's slopes know no bound in time: light cannot be pulled faster than it flies.
    driftLobe_ = ConnectionLobe<float>::drift(std::max(rate, 1.1f * strength), std::max(strength, 1e-6f * rate));
}

Vec3 EscapeDirections::sample(float choice, float u, float v) const {
    return choice < connectionShare_ ? directionAbout(axis_, connectionLobe_.sample(u), v)
                                     : directionAbout(drift_, driftLobe_.sample(u), v);
}

float EscapeDirections::pdf(const Vec3& direction, float h) const {
    const float drift = connectionShare_ < 1.0f ? driftLobe_.pdf(oneMinusCosine(direction, drift_)) : 0.0f;
    return connectionShare_ * connectionLobe_.pdf(h) + (1.0f - connectionShare_) * drift;
}

std::optional<ConvolvedPhaseLobe> ConvolvedPhaseLobe::of(const TimeBudget& budget, const Medium& medium) {
    if (!(medium.g >= LeastPeak)) return std::nullopt;
    const float shortest = std::max(budget.excess - budget.width, 0.0f) + budget.escape.inside;
    const float turns = std::max(shortest * mean(medium.sigmaS), 1.0f), kept = std::pow(medium.g, turns);
    if (!(kept > Forgotten)) return std::nullopt;
    return ConvolvedPhaseLobe({budget.axis, kept});
}

} // namespace darts
