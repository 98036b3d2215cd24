#pragma once
// Directions drawn for the connection that is to follow, mixed with what the scatterer prefers.

#include "darts/ConnectionLobe.h"
#include "darts/EdaTable.h"
#include "darts/FastMath.h"
#include "darts/FirstPassage.h"
#include "darts/PhaseFunction.h"
#include "darts/Settings.h"
#include "darts/TimeBudget.h"

#include <array>
#include <memory>
#include <optional>

namespace darts {

/// Directions by the product of a forward peak and what a guide prefers, with a density that is known.
///
/// Two distributions of directions, a phase function's (Henyey-Greenstein) and a guide's about its own axis, are each
/// cut into strata that are equally likely: by the angle to the axis, and in halves towards and away from the other
/// axis. One direction in each tells the importance of its stratum; W_cj = importance / mixture there. A
/// stratum is chosen in proportion to W and a direction drawn in it by its own distribution q_c:
///   p(w) = sum over c of M q_c(w) W_{c, j_c(w)} / sum W.
/// A Guide has axis, pdf(h) per solid angle, quantile(f) -> h = 1 - cos and part(h) -> f, its inverse.
template <typename Guide>
class DirectionStrata {
  public:
    /// `importance(direction, h, own, guided)`: up to a factor; h from the guide's axis, both densities there.
    template <typename Importance>
    DirectionStrata(const HenyeyGreenstein& phase, const Guide& guide, const Importance& importance)
        : phase_(phase), guide_(guide), aboutPhase_(phase.peak(), guide.axis), aboutGuide_(guide.axis, phase.peak()) {
        for (size_t c = 0; c < 2; ++c)
            for (int j = 0; j < Strata; ++j) {
                const Vec3 direction = at(c, j, 0.5f, 0.5f);
                const float h = oneMinusCosine(direction, guide.axis), own = phase.pdf(direction),
                            guided = guide.pdf(h);
                const float weight = importance(direction, h, own, guided) / (0.5f * (own + guided));
                weights_[c * Strata + size_t(j)] = weight;
                sum_ += weight;
            }
    }

    /// choice, v in [0, 1) -> unit direction.
    [[nodiscard]] Vec3 sample(float choice, float, float v) const {
        float rest = choice * sum_;
        size_t i = 0;
        while (i < weights_.size() - 1 && !(rest < weights_[i])) rest -= weights_[i++];
        const float within = std::clamp(rest / weights_[i], 0.0f, BelowOne);
        return at(i / Strata, int(i % Strata), within, v);
    }
    /// Per solid angle.
    [[nodiscard]] float pdf(const Vec3& direction, float h) const {
        const float ownH = oneMinusCosine(direction, aboutPhase_.axis);
        const float own = phase_.pdf(direction) * weights_[size_t(stratum(phase_.part(ownH), aboutPhase_, direction))];
        const float guided = guide_.pdf(h) * weights_[size_t(Strata + stratum(guide_.part(h), aboutGuide_, direction))];
        return float(Strata) * (own + guided) / sum_;
    }

  private:
    static constexpr int Angles = 4, Strata = 2 * Angles; ///< of each distribution

    /// Directions about an axis, by their angle to the half-plane that holds the other axis.
    struct Frame {
        Vec3 axis, towards, across;

        Frame(const Vec3& about, const Vec3& other) : axis(about) {
            const Vec3 off = other - about * dot(other, about);
            const float size = length(off);
            // Axes that are parallel define no half-plane: any will do.
            towards = size > 1e-6f ? off * (1.0f / size) : directionAbout(about, 1.0f, 0.0f);
            across = {axis.y * towards.z - axis.z * towards.y, axis.z * towards.x - axis.x * towards.z,
                      axis.x * towards.y - axis.y * towards.x};
        }
    };

    /// In the stratum j of distribution c, from numbers in [0, 1): along its angles, and within half a turn.
    [[nodiscard]] Vec3 at(size_t c, int j, float along, float turn) const {
        const float f = std::min((float(j >> 1) + along) * (1.0f / Angles), BelowOne);
        const float h = c == 0 ? phase_.quantile(f) : guide_.quantile(f);
        const Frame& frame = c == 0 ? aboutPhase_ : aboutGuide_;
        const float sine = std::sqrt(std::max(h * (2.0f - h), 0.0f)), angle = Pi * (turn - 0.5f);
        const float side = (j & 1) == 0 ? std::cos(angle) : -std::cos(angle);
        return frame.towards * (sine * side) + frame.across * (sine * std::sin(angle)) + frame.axis * (1.0f - h);
    }
    [[nodiscard]] static int stratum(float part, const Frame& frame, const Vec3& direction) {
        const int angle = std::clamp(int(part * float(Angles)), 0, Angles - 1);
        return 2 * angle + (dot(direction, frame.towards) - dot(frame.axis, frame.towards) < 0.0f ? 1 : 0);
    }

    HenyeyGreenstein phase_;
    Guide guide_;
    Frame aboutPhase_, aboutGuide_;
    std::array<float, 2 * Strata> weights_;
    float sum_ = 0.0f;
};

/// Directions at a vertex of a body that light must leave to reach its target.
///
/// The lobe of the connection, and one about the drift of walks that diffuse to the boundary in time. The drift knows
/// nothing of the phase function: only where that is even does it stand in for it.
class EscapeDirections {
  public:
    /// `excess` > 0: of the connection drawn for the coming control vertex.
    EscapeDirections(const TimeBudget& budget, float excess, const Medium& medium);

    /// Probability that a direction at the vertex is drawn from these lobes; the rest are the scatterer's own.
    [[nodiscard]] float share() const { return share_; }
    /// choice, u, v in [0, 1) -> unit direction.
    [[nodiscard]] Vec3 sample(float choice, float u, float v) const;
    /// Density per solid angle; h = 1 - cos between the direction and budget.axis.
    [[nodiscard]] float pdf(const Vec3& direction, float h) const;

  private:
    Vec3 axis_;                            ///< towards the target
    float share_, connectionShare_ = 1.0f; ///< of these directions, that of connectionLobe_
    ConnectionLobe<float> connectionLobe_, driftLobe_;
    Vec3 drift_; ///< unit axis of driftLobe_
};

/// Directions of the last few scatterings before light leaves a body of forward scattering medium for good: in so few
/// turns it must come round to the target's. Henyey-Greenstein functions of mean cosine g, convolved n times, are one
/// of g^n; n is the number of mean free paths that the earliest arrival has left inside.
class ConvolvedPhaseLobe {
  public:
    /// None where directions are forgotten before, or were never kept.
    static std::optional<ConvolvedPhaseLobe> of(const TimeBudget& budget, const Medium& medium);

    Vec3 axis; ///< towards the target

    [[nodiscard]] Vec3 sample(float, float u, float v) const { return peak_.sample(u, v); }
    /// Density per solid angle; h = 1 - cos to the axis.
    [[nodiscard]] float pdf(float h) const { return peak_.pdfAt(h); }
    [[nodiscard]] float pdf(const Vec3&, float h) const { return pdf(h); }
    [[nodiscard]] float quantile(float f) const { return peak_.quantile(f); }
    [[nodiscard]] float part(float h) const { return peak_.part(h); }
    /// Importance of a direction of this density, normalised to a mean of about 1 over the sphere.
    template <typename Last>
    [[nodiscard]] static float importance(float pdf, const Last&) {
        return 4.0f * Pi * pdf + Floor;
    }

  private:
    /// Lower means are not followed; a floor of 0.05 does the same. (Layered tissue, variance x CPU of paths: 18.9
    /// without, 7.5 with 0.2, 7.8 with 0.05.) Bench: study bodies.
    static constexpr float LeastPeak = 0.5f, Forgotten = 0.1f, Floor = 0.2f;

    explicit ConvolvedPhaseLobe(const HenyeyGreenstein& peak) : axis(peak.before), peak_(peak) {}

    HenyeyGreenstein peak_;
};

/// A direction and what the estimate is divided by.
struct DirectionSample : Heading {
    /// 1 / density per solid angle; for resampled directions an unbiased estimate of it.
    float inversePdf = 0;
};

/// Directions about the target's: a Lobe has sample(u) -> h and pdf(h) per solid angle (a connection lobe, a row of an
/// EDA table).
template <typename Lobe>
struct AboutTarget {
    Lobe lobe;
    Vec3 axis;

    [[nodiscard]] Vec3 sample(float, float u, float v) const { return directionAbout(axis, lobe.sample(u), v); }
    [[nodiscard]] float quantile(float f) const { return lobe.sample(f); }
    [[nodiscard]] float part(float h) const { return lobe.part(h); }
    [[nodiscard]] float pdf(float h) const { return lobe.pdf(h); }
    [[nodiscard]] float pdf(const Vec3&, float h) const { return lobe.pdf(h); }
    /// What a direction of this density is good for, about 1 on the average over the sphere; last() is the density of
    /// its connection's last turn per solid angle.
    template <typename Last>
    [[nodiscard]] static float importance(float pdf, const Last& last) {
        constexpr float Uniform = 1.0f / (4.0f * Pi), Floor = 0.2f * Uniform;
        return pdf * last() * (1.0f / Uniform) + Floor;
    }
};
template <typename Lobe>
AboutTarget(Lobe, Vec3) -> AboutTarget<Lobe>; // Clang before 17 does not deduce an aggregate's

/// Mixtures of a guided distribution with a scatterer's own. A scatterer has sample(u, v) -> unit direction and
/// pdf(direction) per solid angle (a phase function, an emitter's or a surface's distribution).
class DirectionSampler {
  public:
    /// Least Settings::alpha where the lobe is a rougher guess: boundaries of unknown kind lie between, or a surface
    /// scatters, whose cosine it does not know. Bench: study bodies and scattering, paths
    static constexpr float RoughAlpha = 0.5f;

    /// Direction::Eda uses `table`; without one that of the medium's mean albedo and g, built here unless another
    /// sampler in the process holds it already.
    DirectionSampler(const Settings& settings, const Medium& medium, std::shared_ptr<const EdaTable> table = nullptr)
        : settings_(settings), medium_(medium), g_(medium.g), sigmaT_(mean(medium.sigmaT())) {
        if (settings.direction != Direction::Eda) return;
        if (!table && sigmaT_ > 0) table = EdaTable::shared(mean(medium.sigmaS) / sigmaT_, g_);
        table_ = std::move(table);
        if (!table_) settings_.direction = Direction::Phase; // an empty medium: nothing to approximate
    }

    /// `excess`: of the connection drawn for the coming control vertex (S = C + excess). `random()` is uniform in
    /// [0, 1).
    template <typename Scatterer, typename Random>
    [[nodiscard]] DirectionSample sample(const TimeBudget& budget, float excess, const Scatterer& scatterer,
                                         Random&& random) const {
        if (settings_.direction == Direction::Phase || isBehindRefraction(budget))
            return fromScatterer(budget, scatterer, random);
        if (budget.model == EscapeModel::Bounded) {
            if (const auto turns = ConvolvedPhaseLobe::of(budget, medium_)) {
                if (const auto phase = peakOf(scatterer))
                    return draw(budget, strata(*phase, *turns, budget, excess), random);
                return mix(budget, TurnsShare, scatterer, *turns, random);
            }
            const EscapeDirections out(budget, least(budget, excess), medium_);
            return mix(budget, out.share(), scatterer, out, random);
        }
        if (const auto phase = peakOf(scatterer)) {
            const float delta = least(budget, excess);
            return draw(budget, multiplied(*phase, budget, delta), random);
        }
        return withGuided(budget, excess, [&](const auto& guided) {
            if (settings_.direction == Direction::Ris) return resample(budget, excess, scatterer, guided, random);
            return mix(budget, guideShare(budget, excess), scatterer, guided, random);
        });
    }

    /// Density per solid angle of sample(); for Direction::Ris, of its candidates.
    template <typename Scatterer>
    [[nodiscard]] float pdf(const TimeBudget& budget, float excess, const Vec3& direction,
                            const Scatterer& scatterer) const {
        if (settings_.direction == Direction::Phase || isBehindRefraction(budget)) return scatterer.pdf(direction);
        const float h = oneMinusCosine(direction, budget.axis);
        const auto mixture = [&](float share, const auto& guided) {
            return share * guided.pdf(direction, h) + (1.0f - share) * scatterer.pdf(direction);
        };
        if (budget.model == EscapeModel::Bounded) {
            if (const auto turns = ConvolvedPhaseLobe::of(budget, medium_)) {
                if (const auto phase = peakOf(scatterer))
                    return strata(*phase, *turns, budget, excess).pdf(direction, h);
                return mixture(TurnsShare, *turns);
            }
            const EscapeDirections out(budget, least(budget, excess), medium_);
            return mixture(out.share(), out);
        }
        if (const auto phase = peakOf(scatterer))
            return multiplied(*phase, budget, least(budget, excess)).pdf(direction, h);
        const float share = settings_.direction == Direction::Ris ? 0.5f : guideShare(budget, excess);
        return withGuided(budget, excess, [&](const auto& guided) { return mixture(share, guided); });
    }

    /// gamma = (C / S) / (C / S + alpha).
    [[nodiscard]] float guideShare(const TimeBudget& budget, float excess) const {
        const float ratio = budget.C / (budget.C + excess);
        const float alpha =
            budget.model == EscapeModel::Infinite ? settings_.alpha : std::max(settings_.alpha, RoughAlpha);
        return ratio > 0 ? ratio / (ratio + alpha) : 0.0f;
    }

  private:
    static constexpr int MostDirections = 8;
    static constexpr float TurnsShare = 0.5f; ///< of ConvolvedPhaseLobe, the rest the scatterer's own
    /// Behind refraction light leaves in more directions than the guide knows; phase functions do better alone. (Bench:
    /// study bodies, milk behind glass, beams: MSE x CPU 1.6, with a guided share of 0.3 3.3, of 0.8 7.7.)
    [[nodiscard]] static bool isBehindRefraction(const TimeBudget& budget) {
        return budget.model == EscapeModel::Bounded && !budget.escape.straightExit;
    }
    /// Excess lengths of 0 have no lobe.
    [[nodiscard]] static float least(const TimeBudget& budget, float excess) {
        return std::max(excess, 1e-6f * budget.C);
    }
    /// The scatterer as a peaked phase function, if directions are to be its product with the guide.
    template <typename Scatterer>
    [[nodiscard]] std::optional<HenyeyGreenstein> peakOf(const Scatterer& scatterer) const {
        if constexpr (requires { scatterer.asHenyeyGreenstein(); })
            if (settings_.direction == Direction::Product) return scatterer.asHenyeyGreenstein();
        return std::nullopt;
    }
    /// The density, per solid angle, of the last turn of a connection that leaves in this direction.
    [[nodiscard]] auto lastTurn(const TimeBudget& budget, float excess, const Vec3& direction, float h) const {
        return [=, this, &budget] {
            const Ellipse<float> e{budget.C, excess, h};
            const Vec3 onward = budget.axis * budget.C - direction * e.firstLeg();
            return HenyeyGreenstein{direction, g_}.pdf(onward * (1.0f / std::max(length(onward), 1e-30f)));
        };
    }
    template <typename Guided>
    [[nodiscard]] DirectionStrata<Guided> strata(const HenyeyGreenstein& phase, const Guided& guided,
                                                 const TimeBudget& budget, float excess) const {
        return {phase, guided, [&](const Vec3& direction, float h, float own, float guide) {
                    return own * guided.importance(guide, lastTurn(budget, excess, direction, h));
                }};
    }
    /// Strata for the product of the phase function and the connection's lobe.
    [[nodiscard]] DirectionStrata<AboutTarget<ConnectionLobe<float>>>
    multiplied(const HenyeyGreenstein& phase, const TimeBudget& budget, float excess) const {
        const AboutTarget lobe{connectionLobe(budget.C, excess), budget.axis};
        return strata(phase, lobe, budget, excess);
    }
    template <typename Guided, typename Random>
    static DirectionSample draw(const TimeBudget& budget, const Guided& guided, Random& random) {
        const float choice = random(), u = random(), v = random();
        const Vec3 direction = guided.sample(choice, u, v);
        const float h = oneMinusCosine(direction, budget.axis), pdf = guided.pdf(direction, h);
        return {{direction, h}, pdf > 0 ? 1.0f / pdf : 0.0f};
    }
    [[nodiscard]] ConnectionLobe<float> connectionLobe(float C, float excess) const {
        return settings_.lobe == Lobe::Path ? ConnectionLobe<float>::path(C, excess)
                                            : ConnectionLobe<float>::photon(C, excess);
    }
    /// use(the vertex's guided distribution).
    template <typename Use>
    [[nodiscard]] auto withGuided(const TimeBudget& budget, float excess, Use&& use) const {
        const float C = budget.C, delta = least(budget, excess);
        const auto about = [&](const auto& lobe) { return use(AboutTarget{lobe, budget.axis}); };
        if (settings_.direction == Direction::Eda) return about(table_->row(C, delta, sigmaT_));
        // All lengths at once, of which `excess` is the median.
        if (settings_.preset == Preset::Best && settings_.lobe == Lobe::Path && budget.model == EscapeModel::Infinite &&
            excess > budget.low)
            return about(GateLobe<float>(C, budget.low, 2.0f * (excess - budget.low)));
        return about(connectionLobe(C, delta));
    }
    template <typename Scatterer, typename Random>
    static DirectionSample fromScatterer(const TimeBudget& budget, const Scatterer& scatterer, Random& random) {
        const float u = random(), v = random();
        const Vec3 direction = scatterer.sample(u, v);
        const float pdf = scatterer.pdf(direction);
        return {{direction, oneMinusCosine(direction, budget.axis)}, pdf > 0 ? 1.0f / pdf : 0.0f};
    }
    template <typename Scatterer, typename Guided, typename Random>
    static DirectionSample mix(const TimeBudget& budget, float share, const Scatterer& scatterer, const Guided& guided,
                               Random& random) {
        const float choice = random(), u = random(), v = random();
        const Vec3 direction =
            choice < share ? guided.sample(std::min(choice / share, BelowOne), u, v) : scatterer.sample(u, v);
        const float h = oneMinusCosine(direction, budget.axis);
        const float pdf = share * guided.pdf(direction, h) + (1.0f - share) * scatterer.pdf(direction);
        return {{direction, h}, pdf > 0 ? 1.0f / pdf : 0.0f};
    }
    /// Weighed by scatterer's density x importance.
    template <typename Scatterer, typename Guided, typename Random>
    [[nodiscard]] DirectionSample resample(const TimeBudget& budget, float excess, const Scatterer& scatterer,
                                           const Guided& guided, Random& random) const {
        const int count = std::min(settings_.directionCandidates, MostDirections), owns = count / 2;
        const float ownShare = float(owns) / float(count);
        std::array<DirectionSample, MostDirections> candidates;
        std::array<float, MostDirections> weights{};
        float sum = 0.0f;
        for (int i = 0; i < count; ++i) {
            DirectionSample& c = candidates[size_t(i)];
            const float choice = random(), u = random(), v = random();
            c.direction = i < owns ? scatterer.sample(u, v) : guided.sample(choice, u, v);
            c.h = oneMinusCosine(c.direction, budget.axis);
            const float own = scatterer.pdf(c.direction), guide = guided.pdf(c.direction, c.h);
            const float wanted = own * guided.importance(guide, lastTurn(budget, excess, c.direction, c.h));
            const float mixture = ownShare * own + (1.0f - ownShare) * guide;
            weights[size_t(i)] = mixture > 0 ? wanted / mixture : 0.0f;
            c.inversePdf = wanted > 0 ? 1.0f / wanted : 0.0f;
            sum += weights[size_t(i)];
        }
        if (!(sum > 0)) return {{budget.axis, 0}, 0};
        float rest = random() * sum;
        int chosen = 0;
        for (; chosen < count - 1; ++chosen) {
            rest -= weights[size_t(chosen)];
            if (rest < 0) break;
        }
        while (chosen > 0 && !(weights[size_t(chosen)] > 0)) --chosen; // rounding at the end
        DirectionSample result = candidates[size_t(chosen)];
        result.inversePdf *= sum / float(count);
        return result;
    }

    Settings settings_;
    Medium medium_;
    float g_, sigmaT_;
    std::shared_ptr<const EdaTable> table_; ///< null unless Direction::Eda
};

} // namespace darts
