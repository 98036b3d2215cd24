#include "darts/DirectionsOut.h"

namespace darts {

namespace {

// Bench: study bodies, layered tissue, paths.
constexpr float MostConnectionShare = 0.3f;
/// Of a connection, relative to the first passage: the diffusing light's forward peak is a rougher guess.
constexpr float MostFromConnection = 1.0f;
/// The displacement is known, so less remains unknown: FirstPassage's allowance.
constexpr float Allowance = 0.5f;
constexpr float MostLog = 20.0f;

Departure<float> departure(const Residual& residual, float persistence, const Heading& ray) {
    return {residual.exit, residual.latest(ray.h), ray.direction, 0.0f, persistence};
}

} // namespace

DirectionsOut::DirectionsOut(const Residual& residual, float excess, const Medium& medium)
    : residual_(residual), medium_(medium), excess_(excess), sigmaT_(mean(medium.sigmaT())),
      connectionLobe_(ConnectionLobe<float>::photon(
          std::max(std::min(residual.exit.inside, 1.0f / sigmaT_), 1e-6f * residual.C), excess)),
      driftLobe_(ConnectionLobe<float>::drift(1.0f, 0.5f)) {
    const FirstPassage passage(medium, residual.exit);
    const Departure<float> here = departure(residual, 0.0f, {residual.axis, 0.0f});
    here_ = passage.log(here);
    gate_ = std::max(residual.exit.gate, 1e-6f * residual.C) * mean(medium.sigmaS);
    if (residual.exit.connects) {
        const float transmittance = -sigmaT_ * (residual.exit.inside + excess);
        connectionShare_ = std::min(MostConnectionShare, gate_ * std::exp(std::min(transmittance - here_, MostLog)));
    }
    const FirstPassage::Slopes slopes = passage.slopes(here, residual.axis);
    const float strength = length(slopes.pull), rate = mean(medium.sigmaA) + medium.reducedSigmaS() + slopes.later;
    drift_ = strength > 0 ? slopes.pull * (1.0f / strength) : residual.axis;
    // Diffusion's slopes know no bound in time: light cannot be pulled faster than it flies.
    driftLobe_ = ConnectionLobe<float>::drift(std::max(rate, 1.1f * strength), std::max(strength, 1e-6f * rate));
}

Vec3 DirectionsOut::sample(float choice, float u, float v) const {
    return choice < connectionShare_ ? directionAbout(residual_.axis, connectionLobe_.sample(u), v)
                                     : directionAbout(drift_, driftLobe_.sample(u), v);
}

float DirectionsOut::pdf(const Vec3& direction, float h) const {
    return connectionShare_ * connectionLobe_.pdf(h) +
           (1.0f - connectionShare_) * driftLobe_.pdf(oneMinusCosine(direction, drift_));
}

float DirectionsOut::usefulness(const Heading& ray, float, float last) const {
    const FirstPassage passage(medium_, residual_.exit, Allowance);
    const float onward = passage.log(departure(residual_, passage.meanFreePath(), ray));
    return std::exp(std::min(onward - here_, MostLog)) + connectionUsefulness(ray, last);
}

float DirectionsOut::connectionUsefulness(const Heading& ray, float last) const {
    const Exit& exit = residual_.exit;
    const Exit::Face& face = exit.faces[0];
    const auto legs = Ellipse<float>{residual_.C, excess_, ray.h}.legs();
    const float depth = face.depth - legs.first * dot(ray.direction, face.normal);
    if (!exit.connects || !(depth > 0.0f)) return 0.0f;
    const float inside = legs.first + depth * exit.slant;
    const float transmittance = std::exp(std::min(-sigmaT_ * inside - here_, MostLog));
    return std::min(gate_ * legs.firstPerLength * 4.0f * Pi * last * transmittance, MostFromConnection);
}

} // namespace darts
