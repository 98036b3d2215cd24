#pragma once
// What a walk asks at each of its vertices: the length of the next connection, a direction for it, the control vertex
// on the way, the distance to go, and whether to go on.

#include "darts/ControlVertex.h"
#include "darts/DirectionSampler.h"
#include "darts/DistanceSampler.h"
#include "darts/GreensFunction.h"
#include "darts/TemporalResponse.h"

#include <optional>

namespace darts {

/// A connection's length S = C + excess, with 1 / its density per length (1 at a delta gate; 0: nothing can arrive).
struct ConnectionSample {
    float excess = 0;
    float inversePdf = 0;
};

/// The last scattering before the target, at `distance` along the ray.
struct ControlVertex {
    float distance = 0;
    float toTarget = 0;   ///< second leg
    float inversePdf = 0; ///< 1 / density per length along the ray
};

/// A sensor's response at a vertex: when it was reached and how fast light goes on.
struct ResponseAt {
    const TemporalResponse* response = nullptr;
    double elapsed = 0, speed = 1;
};

/// Walks that diffuse out of a body are split in two whenever the length left for it has halved: most of the variance
/// is in the last few scatterings, most of the time in those before. Copies share the throughput, so that roulette ends
/// those that are good for little.
class SplittingSchedule {
  public:
    /// Into how many copies a walk goes on that should have been split `count` times by now (Guide::splits).
    [[nodiscard]] int copies(int count) {
        const int more = done_ < 0 ? 0 : std::max(count - done_, 0);
        done_ = std::max(count, done_);
        return 1 << more;
    }

  private:
    int done_ = -1; ///< none before the first vertex in a body: what starts with little left has nothing to make up for
};

/// Sampling in one medium towards one kind of target. Immutable; a walk keeps the state: position, elapsed time,
/// throughput and the expected contribution it started with.
class Guide {
  public:
    /// `edaTable`: for Direction::Eda, instead of the one that is built (about 0.2 s) and shared by guides in media of
    /// one albedo and g.
    Guide(const Settings& settings, const Medium& medium, std::shared_ptr<const EdaTable> edaTable = nullptr)
        : settings_(settings), medium_(medium), connectionSigmaT_(smallest(medium.sigmaT())),
          meanSigmaA_(mean(medium.sigmaA)), meanSigmaS_(mean(medium.sigmaS)), distance_(settings, medium),
          direction_(settings, medium, std::move(edaTable)) {
        // Two scatterings inside the forward peak (1 - cos = (1 - g)^2 / 2 g) lengthen the path by about that part of a
        // mean free path.
        if (settings.preset == Preset::Best && medium.g >= LeastPeak)
            needle_ = (1.0f - medium.g) * (1.0f - medium.g) / (2.0f * medium.g * mean(medium.sigmaT()));
    }

    [[nodiscard]] const Settings& settings() const { return settings_; }
    [[nodiscard]] const Medium& medium() const { return medium_; }
    [[nodiscard]] const DistanceSampler& distance() const { return distance_; }

    /// Length of the next connection: exponential of rate sigmaT on the range of excess lengths, or by the sensor's
    /// response.
    [[nodiscard]] ConnectionSample sampleConnection(const TimeBudget& budget, float u,
                                                    const ResponseAt& at = {}) const {
        if (at.response) return sampleResponse(budget, u, at);
        if (!(budget.width > 0)) return {budget.low, 1.0f};
        const auto [offset, inversePdf] = lengths(budget).sample(u);
        return {budget.low + offset, inversePdf};
    }
    /// Length of the next connection along a ray, h = 1 - cos of its angle to the target's direction: for lengths drawn
    /// after the direction.
    [[nodiscard]] ConnectionSample sampleConnectionAlong(const TimeBudget& budget, float h, float u,
                                                         const ResponseAt& at = {}) const {
        if (at.response || !suitsDirection(budget)) return sampleConnection(budget, u, at);
        const auto [offset, inversePdf] = lengthsAlong(budget, h).sample(u);
        return {budget.low + offset, inversePdf};
    }
    /// The part of the excess lengths whose connections along the ray end before the surface: for lengths drawn after
    /// the direction.
    [[nodiscard]] static TimeBudget beforeSurface(const TimeBudget& budget, float h, float surface) {
        TimeBudget limited = budget;
        const auto beyond = float(excessBeyond(budget, h, surface));
        if (!(beyond > 0)) return limited;
        limited.width = std::max(budget.width - beyond, 0.0f);
        if (budget.width > 0 && !(limited.width > 0)) limited.excess = 0; // nothing left
        return limited;
    }
    /// The vertex of a connection drawn by sampleConnection; none beyond the surface or on the needle.
    [[nodiscard]] std::optional<ControlVertex>
    controlVertex(const TimeBudget& budget, const ConnectionSample& connection, float h, float surface) const {
        const Ellipse<float> e{budget.C, connection.excess, h};
        if (!(connection.inversePdf > 0) || e.isDegenerate()) return std::nullopt;
        const auto legs = e.legs();
        if (!(legs.first < surface)) return std::nullopt;
        return ControlVertex{legs.first, legs.second, legs.firstPerLength * connection.inversePdf};
    }

    /// The probability with which a control vertex is traced: its expected contribution, about, relative to all that is
    /// still to come from the vertex it was drawn at, but never below a tenth, since light may leave through nearer
    /// parts of the boundary than the one known. What diffuses in a body has most of its connections end deep under it.
    /// `last` is the density of its turn to the target per solid angle.
    [[nodiscard]] float shadowRayProbability(const TimeBudget& budget, const Vec3& direction,
                                             const ControlVertex& vertex, float last) const {
        if (budget.model != EscapeModel::Bounded) return 1.0f;
        const EscapeGeometry::Face& face = budget.escape.faces[0];
        const float depth = std::max(face.depth - vertex.distance * dot(direction, face.normal), 0.0f);
        const float inside = vertex.distance + depth * budget.escape.lengthPerDepth;
        const float logged = -mean(medium_.sigmaT()) * inside - logWayOut(budget);
        const float useful = meanSigmaS_ * vertex.inversePdf * 4.0f * Pi * last * std::exp(std::min(logged, 20.0f));
        return std::clamp(useful / AlwaysTraced, LeastChance, 1.0f);
    }
    /// How often a walk that must leave a body, with so much length left for it, has been split: see SplittingSchedule.
    [[nodiscard]] int splits(const TimeBudget& budget) const {
        if (budget.model != EscapeModel::Bounded || settings_.greens == Greens::None) return 0;
        const float left = departure(budget).to(budget.escape.faces[0]).longest * medium_.reducedSigmaS();
        int count = 0;
        for (float least = FirstSplit; count < MostSplits && left < least; least *= 0.5f) ++count;
        return count;
    }

    /// Density per length along the ray of controlVertex() at `distance`, of a connection drawn along it where the
    /// direction comes first; a function of the ray alone, for the balance heuristic.
    [[nodiscard]] float pdfControlVertex(const TimeBudget& budget, float h, float distance,
                                         const ResponseAt& at = {}) const {
        // Offset, from budget.low, of the connection through the point. The ends have the rounding of the excess
        // lengths.
        const double rounding = 2e-7 * double(budget.excess);
        const double exact = double(budget.excess) - excessBeyond(budget, h, distance) - double(budget.low);
        if (!(exact >= -rounding && exact <= double(budget.width) + rounding)) return 0.0f;
        const float offset = std::clamp(float(exact), 0.0f, budget.width);
        const Ellipse<float> connection{budget.C, budget.low + offset, h};
        return controlVertexPdf(connection, at.response              ? pdfResponse(budget, offset, at)
                                            : suitsDirection(budget) ? lengthsAlong(budget, h).pdf(offset)
                                                                     : lengths(budget).pdf(offset));
    }

    /// The next direction; see DirectionSampler. Without lengthFirst the lobe is that of the median length, or of the
    /// latest arrival (Preset::Published).
    template <typename Scatterer, typename Random>
    [[nodiscard]] DirectionSample sampleDirection(const TimeBudget& budget, const ConnectionSample& connection,
                                                  const Scatterer& scatterer, Random&& random) const {
        return direction_.sample(budget, directionExcess(budget, connection), scatterer, random);
    }
    template <typename Scatterer>
    [[nodiscard]] float pdfDirection(const TimeBudget& budget, const ConnectionSample& connection,
                                     const Vec3& direction, const Scatterer& scatterer) const {
        return direction_.pdf(budget, directionExcess(budget, connection), direction, scatterer);
    }

    /// The next vertex along the ray; see DistanceSampler.
    template <typename Random>
    [[nodiscard]] DistanceSample sampleDistance(const TimeBudget& budget, const Heading& ray, float surface,
                                                const Vec3& throughput, Random&& random) const {
        const float row = random(), rotation = random(), choice = random(), event = random();
        return distance_.sample(budget, ray, surface, throughput, {row, rotation, choice, event});
    }

    /// Logarithm of throughput x Phi(C, S_hi) x reachable gate: what a walk at this vertex is good for, and by what it
    /// is ended at random. Never by throughput alone.
    [[nodiscard]] float logExpectedContribution(const TimeBudget& budget, float throughput) const {
        const float S = budget.C + budget.excess, reach = std::min(budget.excess, std::max(budget.width, 1e-6f * S));
        const float own = std::log(std::max(throughput * reach, 1e-37f));
        if (settings_.greens == Greens::None) return own;
        if (budget.model == EscapeModel::Bounded) return std::log(std::max(throughput, 1e-37f)) + logWayOut(budget);
        if (settings_.greens == Greens::Diffusion)
            return own + DiffusionGreensFunction<float>{meanSigmaA_, meanSigmaS_, medium_.g}.log(budget.C, S);
        if (settings_.greens == Greens::Causal) {
            const CausalGreensFunction<float> phi{meanSigmaA_, meanSigmaS_ * (1.0f - medium_.g)};
            return own + phi.log(budget.excess * (S + budget.C) / (S * S), S);
        }
        return own;
    }
    /// Probability of going on at an expected contribution, given the walk's first one (logarithms).
    [[nodiscard]] float survival(EscapeModel model, float logContribution, float logFirst) const {
        const float roulette = model == EscapeModel::Bounded ? settings_.rouletteOut : settings_.roulette;
        if (!(roulette > 0)) return 1.0f;
        return std::min(std::exp(logContribution - logFirst) / roulette, 1.0f);
    }
    /// Into how many a walk splits whose expected contribution has become larger than at first: the other side of
    /// survival(). At most `most`, and 16 at once.
    [[nodiscard]] int copies(EscapeModel model, float logContribution, float logFirst, float most) const {
        const float gain = logContribution - logFirst;
        const float above = model == EscapeModel::Bounded ? settings_.splitOut : Settings::SplitAbove;
        if (!(settings_.roulette > 0) || !(gain > std::log(above))) return 1;
        return int(
            std::clamp(std::exp(std::min(gain, 10.0f)) / above + 1.0f, 1.0f, std::max(std::min(most, 16.0f), 1.0f)));
    }

  private:
    /// What is left of the latest arrival's excess at a point of the ray; negative beyond it. In double: in short gates
    /// it is a small part of the lengths.
    [[nodiscard]] static double excessBeyond(const TimeBudget& budget, float h, float distance) {
        const Ellipse<double> latest{double(budget.C), double(budget.excess), double(h)};
        const double d = distance, left = latest.firstLeg() - d;
        if (!(left > 0)) return left;
        return 2 * latest.denominator() * left / (latest.length() - d + latest.distanceToTarget(d));
    }
    /// Distribution of connection lengths: it follows the transmittance of the whole connection or, where the second
    /// leg is mostly free flight, half that rate, as boundaries are oblique, with a peak for forward scattering.
    [[nodiscard]] ConnectionLength<float> lengths(const TimeBudget& budget) const {
        if (budget.model == EscapeModel::Infinite) return {budget.low, budget.width, connectionSigmaT_};
        return {budget.low, budget.width, OutsideRate * connectionSigmaT_, needle_};
    }
    /// Camera paths whose directions are drawn first, for all lengths: these suit the direction afterwards.
    [[nodiscard]] bool suitsDirection(const TimeBudget& budget) const {
        return settings_.preset == Preset::Best && settings_.lobe == Lobe::Path && !settings_.lengthFirst &&
               budget.model == EscapeModel::Infinite && budget.width > 0 && !(needle_ > 0);
    }
    [[nodiscard]] LengthAlong<float> lengthsAlong(const TimeBudget& budget, float h) const {
        const float S = budget.C + budget.low + 0.5f * budget.width;
        return {lengths(budget), std::max(std::sqrt(2.0f * S * budget.C * h), 1e-6f * (S - budget.C))};
    }
    // Bench: study bodies, paths.
    static constexpr float OutsideRate = 0.5f;
    static constexpr float LeastPeak = 0.5f;
    static constexpr float AlwaysTraced = 0.01f, LeastChance = 0.1f;
    /// In transport mean free paths. Variance x CPU without the brightest hundredth, 6 seeds: dense cube 60, beams 0.28
    /// without splits, 0.15 with these, 0.16 with 8 from 128 on; dense cube 300, paths 0.72, 0.52, 0.74, points 0.88,
    /// 0.94, 0.90, which is noise. Bench: study bodies.
    static constexpr float FirstSplit = 16.0f;
    static constexpr int MostSplits = 5;
    /// Logarithm of the first passage from the vertex.
    [[nodiscard]] float logWayOut(const TimeBudget& budget) const {
        const FirstPassage passage(medium_, budget.escape);
        return passage.log(departure(budget));
    }
    [[nodiscard]] static EscapePoint<float> departure(const TimeBudget& budget) {
        return {budget.escape, budget.latest(0), budget.axis, 0.0f};
    }
    [[nodiscard]] float directionExcess(const TimeBudget& budget, const ConnectionSample& connection) const {
        if (settings_.lengthFirst) return connection.excess;
        if (settings_.preset == Preset::Published || !(budget.width > 0)) return budget.excess;
        return budget.low + lengths(budget).median();
    }
    /// Density per length of sampleResponse().
    [[nodiscard]] static float pdfResponse(const TimeBudget& budget, float offset, const ResponseAt& at) {
        const double begin = at.elapsed + budget.shortest / at.speed;
        const double low = at.response->distribution(begin),
                     high = at.response->distribution(begin + double(budget.width) / at.speed);
        if (!(high > low)) return 0.0f;
        return float(at.response->pdf(begin + double(offset) / at.speed) / (at.speed * (high - low)));
    }
    [[nodiscard]] static ConnectionSample sampleResponse(const TimeBudget& budget, float u, const ResponseAt& at) {
        const double begin = at.elapsed + budget.shortest / at.speed;
        const double low = at.response->distribution(begin),
                     high = at.response->distribution(begin + double(budget.width) / at.speed);
        if (!(high > low)) return {};
        const double time = at.response->quantile(low + double(u) * (high - low));
        const double density = at.response->pdf(time);
        if (!(density > 0)) return {};
        const double offset = std::clamp(at.speed * (time - begin), 0.0, double(budget.width));
        return {budget.low + float(offset), float(at.speed * (high - low) / density)};
    }

    Settings settings_;
    Medium medium_;
    float connectionSigmaT_, meanSigmaA_, meanSigmaS_;
    float needle_ = 0; ///< see ConnectionLength; 0 without a forward peak
    DistanceSampler distance_;
    DirectionSampler direction_;
};

} // namespace darts
