#include "darts/DistanceSampler.h"

#include "darts/CandidateKernel.h"

#include <stdexcept>

namespace darts {

namespace {

using Kernel = float (*)(const CandidateDraw&, const DistanceRandom&, Vec3&);

template <Shape G, int N>
Kernel kernelFor(bool grey) {
    return grey ? resample<RegisterOf<N>, G, N, 1> : resample<RegisterOf<N>, G, N, 3>;
}

template <Shape G>
Kernel kernelFor(int candidates, bool grey, bool scalar) {
    if (scalar && candidates == 8) return grey ? resample<float, G, 8, 1> : resample<float, G, 8, 3>;
    switch (candidates) {
    case 1:
        return kernelFor<G, 1>(grey);
    case 4:
        return kernelFor<G, 4>(grey);
    case 8:
        return kernelFor<G, 8>(grey);
    case 16:
        return kernelFor<G, 16>(grey);
    default:
        throw std::invalid_argument("the number of candidates must be 1, 4, 8 or 16");
    }
}

Kernel kernelFor(Shape shape, int candidates, bool grey, bool scalar) {
    switch (shape) {
    case Shape::TimeBound:
        return kernelFor<Shape::TimeBound>(candidates, grey, scalar);
    case Shape::Diffusion:
        return kernelFor<Shape::Diffusion>(candidates, grey, scalar);
    case Shape::Causal:
        return kernelFor<Shape::Causal>(candidates, grey, scalar);
    case Shape::FirstPassage:
        return kernelFor<Shape::FirstPassage>(candidates, grey, scalar);
    }
    throw std::invalid_argument("unknown shape of importance");
}

Shape shapeOf(Greens greens) {
    return greens == Greens::None ? Shape::TimeBound : greens == Greens::Diffusion ? Shape::Diffusion : Shape::Causal;
}

} // namespace

DistanceSampler::DistanceSampler(const Settings& settings, const Medium& medium, bool scalar)
    : settings_(settings), medium_(medium), sigmaT_(medium.sigmaT()), meanSigmaT_(mean(sigmaT_)),
      grey_(medium.isGrey()), scatters_(largest(medium.sigmaS) > 0) {
    for (const Shape shape : {Shape::TimeBound, Shape::Diffusion, Shape::Causal, Shape::FirstPassage}) {
        kernels_[size_t(shape)] = kernelFor(shape, settings.candidates, grey_, scalar);
        importance_[size_t(shape)] = LogLinearDistance::logImportance(shape, grey_, scalar);
    }
}

Vec3 DistanceSampler::transmittance(float distance) const {
    if (grey_) {
        const float x = std::exp(-sigmaT_.x * distance);
        return {x, x, x};
    }
    return {std::exp(-sigmaT_.x * distance), std::exp(-sigmaT_.y * distance), std::exp(-sigmaT_.z * distance)};
}

Shape DistanceSampler::shapeFor(const TimeBudget& budget) const {
    // Without a Green's function nothing but the bound in time is wanted.
    if (settings_.greens == Greens::None) return Shape::TimeBound;
    if (budget.model == EscapeModel::Infinite) return shapeOf(settings_.greens);
    // Behind refraction light leaves where it is not known.
    return budget.escape.straightExit ? Shape::FirstPassage : Shape::TimeBound;
}

auto DistanceSampler::surfaceEvent(float surface, float firstLeg, const Vec3& throughput) const -> SurfaceEvent {
    if (!((surface < firstLeg || !settings_.bounded) && surface < std::numeric_limits<float>::infinity())) return {};
    const Vec3 reaching = transmittance(surface);
    const float total = throughput.x + throughput.y + throughput.z;
    const float natural = !scatters_ ? 1.0f : grey_ || !(total > 0) ? reaching.x : dot(throughput, reaching) / total;
    return {natural, reaching};
}

CandidateDraw DistanceSampler::drawOf(const TimeBudget& budget, const Heading& ray, const Ellipse<float>& latest,
                                      float bound, const Vec3& throughput) const {
    CandidateDraw draw;
    draw.latest = latest;
    draw.firstLeg = latest.firstLeg();
    draw.bound = bound;
    draw.gateWidth = std::max(budget.width, 1e-6f * draw.latest.length());
    draw.proposals = settings_.proposals;
    draw.overlap = settings_.preset == Preset::Best && settings_.greens != Greens::None;
    draw.throughput = throughput;
    draw.medium = &medium_;
    draw.escape = &budget.escape;
    draw.direction = ray.direction;
    return draw;
}

DistanceDensity DistanceSampler::density(const TimeBudget& budget, const Heading& ray, float surface,
                                         const Vec3& throughput) const {
    const Ellipse<float> latest = budget.latest(ray.h);
    const float firstLeg = latest.firstLeg(), bound = std::min(surface, firstLeg);
    const SurfaceEvent event = surfaceEvent(surface, firstLeg, throughput);
    if (!scatters_ || !(event.probability < 1.0f) || !(bound > 0)) return DistanceDensity(event.probability);
    CandidateDraw draw = drawOf(budget, ray, latest, bound, throughput);
    if (budget.low > 0) draw.kink = Ellipse<float>{budget.C, budget.low, ray.h}.firstLeg();
    const Shape shape = shapeFor(budget);
    draw.falls = shape != Shape::TimeBound || draw.overlap;
    return {event.probability, draw, importance_[size_t(shape)]};
}

DistanceSample DistanceSampler::sample(const DistanceDensity& density, float surface, float event, float choice) const {
    if (event < density.surface())
        return {surface, true, transmittance(surface) * (1.0f / density.surface()), density.surface()};
    const auto drawn = density.sample(choice);
    if (!drawn) return {};
    const float pdf = density.pdf(*drawn);
    return {*drawn, false, transmittance(*drawn) * (pdf > 0 ? 1.0f / pdf : 0.0f), pdf};
}

DistanceSample DistanceSampler::sample(const TimeBudget& budget, const Heading& ray, float surface,
                                       const Vec3& throughput, const DistanceRandom& random) const {
    DistanceSample sample;
    if (settings_.preset == Preset::Best && settings_.bounded)
        return this->sample(density(budget, ray, surface, throughput), surface, random.event, random.choice);
    const Ellipse<float> latest = budget.latest(ray.h);
    const float firstLeg = latest.firstLeg();
    const SurfaceEvent event = surfaceEvent(surface, firstLeg, throughput);
    if (event.probability > 0 && random.event < event.probability)
        return {surface, true, event.reaching * (1.0f / event.probability)};
    const float bound = settings_.bounded ? std::min(surface, firstLeg) : surface;
    if (!scatters_ || !(event.probability < 1.0f) || !(bound > 0)) return sample;
    CandidateDraw draw = drawOf(budget, ray, latest, bound, throughput);
    draw.probability = 1.0f - event.probability;
    sample.distance = kernels_[size_t(shapeFor(budget))](draw, random, sample.transmittanceOverPdf);
    return sample;
}

} // namespace darts
