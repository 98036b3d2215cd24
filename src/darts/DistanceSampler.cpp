#include "darts/DistanceSampler.h"

#include "darts/CandidateKernel.h"
#include "darts/FastMath.h"
#include "darts/Lanes.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace darts {

namespace {

/// Towards the bound in time importance falls to nothing; the last node's logarithm is this much below the one before
/// it: half of it, which the mean over the interval then is, about.
constexpr float FallToBound = 0.7f;
/// Logarithm of importance, relative to the highest: what is farther down stays possible. Transmittance may be lower
/// yet: slopes that end there would be too gentle, and most draws in thick media in vain.
constexpr float LeastLog = -57.5f;
/// Least part of all mass that the uniform numbers of a draw can resolve.
constexpr float LeastMass = 0x1p-24f;
/// CandidateDraw::power out of bodies. Diffusion errs within a mean free path of the boundary and about other faces,
/// and a walk multiplies the errors of hundreds of flights: by the square root the logarithm of its weight varies half
/// as much. (Variance x CPU of best paths over that at 1, 3 seeds, at 0.5 and 0.7: dense cubes 10, 60, 300 0.92 and
/// 0.74, 0.91 and 0.96, 0.57 and 0.95, layered tissue 1.3 and 1.4 within twice of either.) Bench: study bodies
constexpr float PowerOutside = 0.5f;

template <typename Batch, Shape G, int Channels>
void logImportanceOf(const CandidateDraw& draw, const float* distances, float* logs) {
    using std::max;
    constexpr int Width = lanes::Width<Batch>;
    // What is reachable of the gate is a length: a part of it has no unit, and logarithms are rounded alike in any.
    const float part = G != Shape::FirstPassage && draw.overlap ? 1.0f / draw.gateWidth : 1.0f;
    for (int first = 0; first < LogLinearDistance::Nodes; first += Width) {
        const Batch d = lanes::get<Batch>(distances + first);
        const PlaceOf<G, Batch> place(draw, d);
        std::array<Batch, size_t(Channels)> exponents, factors;
        Batch top(-std::numeric_limits<float>::max());
        for (int i = 0; i < Channels; ++i) {
            const CandidateImportance<G> channel(draw, i, Channels == 1);
            exponents[size_t(i)] = channel.exponent(d, place, factors[size_t(i)]);
            top = max(top, exponents[size_t(i)]);
        }
        Batch sum = factors[0];
        if constexpr (Channels > 1) {
            sum = Batch(0.0f);
            for (size_t i = 0; i < Channels; ++i) sum = sum + factors[i] * lanes::exp(Batch(exponents[i] - top));
        }
        lanes::put(logs + first, Batch(top + lanes::log(max(Batch(place.reachable * part * sum), Batch(1e-30f)))));
    }
}

template <Shape G>
LogLinearDistance::LogImportance importanceOf(bool grey, bool scalar) {
    if (scalar) return grey ? logImportanceOf<float, G, 1> : logImportanceOf<float, G, 3>;
    using Batch = RegisterOf<LogLinearDistance::Nodes>;
    return grey ? logImportanceOf<Batch, G, 1> : logImportanceOf<Batch, G, 3>;
}

} // namespace

LogLinearDistance::LogImportance LogLinearDistance::logImportance(Shape shape, bool grey, bool scalar) {
    switch (shape) {
    case Shape::TimeBound:
        return importanceOf<Shape::TimeBound>(grey, scalar);
    case Shape::Diffusion:
        return importanceOf<Shape::Diffusion>(grey, scalar);
    case Shape::Causal:
        return importanceOf<Shape::Causal>(grey, scalar);
    case Shape::FirstPassage:
        return importanceOf<Shape::FirstPassage>(grey, scalar);
    }
    throw std::invalid_argument("unknown shape of importance");
}

LogLinearDistance::LogLinearDistance(const CandidateDraw& draw, LogImportance importance) {
    using Register = RegisterOf<Nodes>;
    const float end = draw.bound;
    // A surface ends what is in time; else importance falls to nothing there.
    const bool endsInTime = !(end < draw.firstLeg);
    const float kink = draw.kink > 1e-6f * end && draw.kink < end * (1.0f - 1e-6f) ? draw.kink : 0.95f * end;
    const float left = 1.0f - kink / end;
    const bool near = endsInTime && left < 0.2f / float(Nodes);
    alignas(64) std::array<float, Nodes> log;
    // Uniform distances, the kink, and in short ranges behind it a place where importance falls; or the surface.
    const float each = end * (endsInTime && !near ? 1.0f / 4 : 1.0f / 3);
    const float last = !endsInTime ? end : near ? end * (1.0f - std::sqrt(left / float(Nodes))) : 3.0f * each;
    constexpr float None = std::numeric_limits<float>::max();
    static_assert(Nodes == 8);
    std::array<float, Nodes> at{0.0f, each, 2.0f * each, last, None, None, None, None};
    const auto add = [&at](float d) { // into ascending ones, of which the first stays
        for (size_t i = Nodes - 1; i > 0; --i) at[i] = std::max(at[i - 1], std::min(at[i], d));
    };
    add(kink);
    // Quantiles of the free flight, within a few per cent. In thin media they would be those of the uniform distance:
    // these fill the places between.
    const float sigmaT = mean(draw.medium->sigmaT()), depth = sigmaT * end;
    constexpr std::array<float, 3> Deep{0.28768207f, 0.69314718f, 1.38629436f}; // in mean free paths, if all end
    for (size_t j = 0; j < 3; ++j) {
        const float even = float(j + 1) / 4.0f;
        add(end *
            (depth < 0.3f ? even - 0.125f : Deep[j] / std::sqrt(depth * depth + (Deep[j] / even) * (Deep[j] / even))));
    }
    std::copy(at.begin(), at.end(), nodes_.begin());
    importance(draw, nodes_.data(), log.data());
    intervals_ = endsInTime ? Nodes : Nodes - 1;
    const Register here = lanes::get<Register>(nodes_.data());
    const Register powers = draw.power * lanes::get<Register>(log.data()) - ((1.0f - draw.power) * sigmaT) * here;
    const Register least = min(Register(LeastLog), -smallest(draw.medium->sigmaT()) * here);
    lanes::put(logs_.data(), Register(max(powers - lanes::most(powers), least)));
    nodes_[Nodes] = end;
    logs_[Nodes] = logs_[Nodes - 1] - (draw.falls ? FallToBound : sigmaT * (end - nodes_[Nodes - 1]));
    // Behind a surface the last interval has no width.
    const Register logs = lanes::get<Register>(logs_.data()), nextLogs = Register::load_unaligned(&logs_[1]);
    const Register value = lanes::exp(logs), next = lanes::exp(nextLogs), rise = nextLogs - logs;
    const Register series =
        1.0f + rise * (1.0f / 2 + rise * (1.0f / 6 + rise * (1.0f / 24 + rise * (1.0f / 120 + rise * (1.0f / 720)))));
    const Register means = select(abs(rise) < 0.3f, Register(value * series), Register((next - value) / rise));
    const Register masses = (Register::load_unaligned(&nodes_[1]) - here) * means;
    lanes::put(masses_.data(), masses);
    sum_ = lanes::sum(masses);
}

auto LogLinearDistance::sample(float u) const -> Draw {
    float rest = u * sum_;
    int i = 0;
    while (i < intervals_ - 1 && !(rest < masses_[size_t(i)])) rest -= masses_[size_t(i++)];
    // Rounding leads to intervals that are never meant, and their weights are as large as they are unlikely.
    for (; i > 0 && masses_[size_t(i)] < LeastMass * sum_; --i) rest = sum_;
    const auto k = size_t(i);
    const float part = masses_[k] > 0.0f ? std::clamp(rest / masses_[k], 0.0f, BelowOne) : 0.0f, rise = slope(i);
    // Along the interval e^{rise x} has this part of its integral, and grows in proportion to it.
    const float growth = fastExpm1(rise);
    const float along = std::abs(rise) < 1e-5f ? part : fastLog1p(part * growth) / rise;
    const float d = nodes_[k] + (nodes_[k + 1] - nodes_[k]) * std::clamp(along, 0.0f, 1.0f);
    return {std::min(d, nodes_[size_t(intervals_)] * BelowOne), std::exp(logs_[k]) * (1.0f + part * growth) / sum_};
}

float LogLinearDistance::pdf(float distance) const {
    if (!(distance >= 0.0f && distance < nodes_[size_t(intervals_)])) return 0.0f;
    int i = 0;
    while (i < intervals_ - 1 && !(distance < nodes_[size_t(i) + 1])) ++i;
    const auto k = size_t(i);
    const float width = nodes_[k + 1] - nodes_[k];
    return std::exp(logs_[k] + slope(i) * (distance - nodes_[k]) / width) / sum_;
}

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
    if (shape == Shape::FirstPassage) draw.power = PowerOutside;
    draw.falls = shape != Shape::TimeBound || draw.overlap;
    DistanceDensity density(event.probability, draw, importance_[size_t(shape)]);
    // Photons are gathered where they meet surfaces, too, wherever the camera is.
    const bool unbounded = shape == Shape::Diffusion || shape == Shape::Causal;
    if (unbounded && settings_.lobe == Lobe::Path) density.weighSurface(mean(medium_.sigmaS));
    return density;
}

DistanceSample DistanceSampler::sample(const DistanceDensity& density, float surface, float event, float choice) const {
    if (event < density.surface())
        return {surface, true, transmittance(surface) * (1.0f / density.surface()), density.surface()};
    const auto drawn = density.sample(choice);
    if (!drawn) return {};
    const auto [distance, pdf] = *drawn;
    return {distance, false, transmittance(distance) * (pdf > 0 ? 1.0f / pdf : 0.0f), pdf};
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
