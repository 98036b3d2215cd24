#pragma once
// Light that diffuses in a body and must leave it in time: the probability that it does, as the usefulness of
// candidates.

#include "darts/Ellipse.h"
#include "darts/Exit.h"
#include "darts/Lanes.h"
#include "darts/Settings.h"

namespace darts {

/// A place on a flight inside a body, from where light goes on in the flight's direction by `persistence` on the
/// average before it has forgotten it.
template <typename Batch>
struct Departure {
    const Exit& exit;
    Vec3 direction;
    float persistence;    ///< 0: light leaves evenly in all directions
    Batch d;              ///< along the flight
    Batch rho;            ///< from the target
    Batch excess;         ///< longest connection in time, over rho
    Batch squaredOutside; ///< distance from what lies inside all sides, squared

    /// At the distance `along`; `latest` is of the latest arrival.
    [[gnu::always_inline]] Departure(const Exit& out, const Ellipse<float>& latest, const Vec3& flight,
                                     const Batch& along, float onward = 0.0f)
        : exit(out), direction(flight), persistence(onward), d(along), squaredOutside(Batch(0.0f)) {
        using std::max;
        using std::sqrt;
        const Batch toCentre = d - latest.C, left = (2.0f * latest.denominator()) * (latest.firstLeg() - d);
        rho = sqrt(toCentre * toCentre + (2.0f * latest.C * latest.h) * d);
        excess = max(Batch(left / (latest.length() - d + rho) - exit.surplus), Batch(0.0f));
        for (size_t i = 0; i < exit.sides.size(); i += 2) {
            const Exit::Side &a = exit.sides[i], &b = exit.sides[i + 1];
            const Batch beside =
                max(Batch(a.outside + d * dot(direction, a.normal)), Batch(b.outside + d * dot(direction, b.normal)));
            squaredOutside = squaredOutside + max(beside, Batch(0.0f)) * max(beside, Batch(0.0f));
        }
    }
    /// The way to a face: depth, the longest path left for it, and by how much it may be shorter inside the gate.
    struct Left {
        Batch depth, longest, reachable;
    };
    [[nodiscard, gnu::always_inline]] Left to(const Exit::Face& face) const {
        using std::max;
        using std::min;
        using std::sqrt;
        const float cosine = dot(direction, face.normal);
        Batch depth = max(Batch(face.depth - d * cosine), Batch(0.0f));
        // The target is `outside` away from the foot on the boundary: rho - outside without a difference of lengths.
        const Batch above = depth * (depth + 2.0f * face.height), outside = sqrt(max(rho * rho - above, Batch(0.0f)));
        const Batch longest =
            max(Batch(excess + above / (rho + outside) - (exit.outerSpeed - 1.0f) * outside), Batch(0.0f));
        if (persistence > 0.0f) { // mean displacement of persistent walks (Fuerth 1920)
            const Batch onward = persistence * (1.0f - lanes::exp(Batch(longest * (-1.0f / persistence))));
            depth = max(Batch(depth - cosine * onward), Batch(0.0f));
        }
        // What only the surplus can reach keeps a little.
        return {depth, longest, min(max(excess, Batch(0.01f * exit.gate)), min(longest, Batch(exit.gate)))};
    }
};

/// First passage of diffusing light through a plane boundary, index-matched or not, of a half-space or slab (Patterson,
/// Chance and Wilson 1989, extrapolated boundary: docs/method.md, section 10.1), over all of the boundary. The density
/// per length of leaving after the length s from depth z is
///   y / sqrt(4 pi D s^3) exp(-y^2 / (4 D s) - sigmaA s),  y = z + z_b,  z_b = 2 A D,  D = 1 / (3 (sigmaA + sigmaS'));
/// its integral over the gate, but for absorption, erfc(p) - erfc(q) with p, q = y / sqrt(4 D s) at the gate's end and
/// start. In a slab times 1 - exp(-L (L - y) / (D s)), L = thickness + 2 z_b: the first image source, and later on the
/// slope of the lowest mode. Several faces add up. It shapes sampling only: diffusion knows nothing within a mean free
/// path, hence the lengths s are longer by `allowance` of them.
class FirstPassage {
  public:
    /// `reducedS` = sigmaS (1 - g) > 0.
    FirstPassage(float absorption, float reducedS, const Exit& exit, float allowance = 1.0f)
        : exit_(exit), sigmaA_(absorption), fourthInverseD_(0.75f * (absorption + reducedS)),
          margin_(0.5f * std::min(exit.mismatch, MostMismatch) / fourthInverseD_), meanFreePath_(1.0f / reducedS),
          allowance_(allowance) {}
    FirstPassage(const Medium& medium, const Exit& exit, float allowance = 1.0f)
        : FirstPassage(mean(medium.sigmaA), medium.reducedSigmaS(), exit, allowance) {}

    /// 1 / sigmaS'
    [[nodiscard]] float meanFreePath() const { return meanFreePath_; }

    /// The probability of leaving in time from a place, as an exponential, whose exponent is returned, times `factor`.
    template <typename Batch>
    Batch exponent(const Departure<Batch>& at, Batch& factor) const {
        using std::max;
        const typename Departure<Batch>::Left first = at.to(exit_.faces[0]);
        Batch exponent = through(exit_.faces[0], first, factor);
        for (size_t i = 1; i < exit_.faces.size(); ++i) {
            const Exit::Face& face = exit_.faces[size_t(i)];
            Batch otherFactor(0.0f);
            const Batch other = through(face, at.to(face), otherFactor);
            add(other, otherFactor, exponent, factor);
        }
        exponent = exponent - at.squaredOutside * fourthInverseD_ / (at.excess + meanFreePath_);
        if (exit_.elsewhere > 0.0f)
            add(Batch(-sigmaA_ * first.longest),
                Batch(exit_.elsewhere * (first.reachable + 1e-4f * meanFreePath_) / (first.longest + meanFreePath_)),
                exponent, factor);
        return exponent;
    }
    /// Its logarithm, never below that of 1e-37.
    [[nodiscard]] float log(const Departure<float>& at) const {
        float factor = 0;
        const float power = exponent(at, factor);
        return power + std::log(std::max(factor, 1e-37f));
    }
    /// The gradient of the logarithm in space, time running on, and its slope with the lengths left.
    struct Slopes {
        Vec3 pull;
        float later = 0;
    };
    [[nodiscard]] Slopes slopes(const Departure<float>& at, const Vec3& towardsTarget) const;

  private:
    /// e^exponent factor += e^other otherFactor
    template <typename Batch>
    static void add(const Batch& other, const Batch& otherFactor, Batch& exponent, Batch& factor) {
        using std::max;
        const Batch top = max(exponent, other);
        factor = factor * lanes::exp(Batch(exponent - top)) + otherFactor * lanes::exp(Batch(other - top));
        exponent = top;
    }
    /// Through one face.
    template <typename Batch>
    Batch through(const Exit::Face& face, const typename Departure<Batch>::Left& left, Batch& factor) const {
        using lanes::select;
        using std::max;
        using std::sqrt;
        const float extra = margin_ + face.beyond;
        const Batch y = left.depth + extra;
        const Batch end = left.longest + allowance_ * meanFreePath_, shortest = left.longest - left.reachable;
        // Gates that begin at once reach down to (nearly) nothing.
        const Batch settled = allowance_ * meanFreePath_ / (shortest + meanFreePath_);
        const Batch start = max(Batch(shortest * (1.0f + settled)), Batch(1e-4f * end));
        const Batch span = left.reachable + settled * meanFreePath_; // end - start but for its bound
        const Batch inverseEnd = 1.0f / end, atEnd = sqrt(inverseEnd), atStart = 1.0f / sqrt(start);
        const Batch scaled = y * std::sqrt(fourthInverseD_), p = scaled * atEnd, q = scaled * atStart;
        const Batch p2 = p * p, between = q * q - p2;
        // erfc(p) - erfc(q) over e^{-p^2}; in short gates the integrand in their middle times their length.
        const Batch length = scaled * span * atEnd * atStart / (1.0f / atEnd + 1.0f / atStart);
        const Batch brief = 1.12837917f * length * lanes::exp(Batch(-0.5f * between));
        const Batch whole = scaledErfc(p) - scaledErfc(q) * lanes::exp(Batch(-between));
        factor = select(between < 0.1f, brief, whole);
        if (face.thickness < Exit::Infinite) {
            const float slab = face.thickness + margin_ + extra;
            const Batch wall = max(slab - y, Batch(margin_));
            const Batch kept = 1.0f - lanes::exp(Batch(-4.0f * fourthInverseD_ * slab * wall * inverseEnd));
            factor = factor * max(kept, Batch(1e-6f)); // never 0: that would be a bias
        }
        return -sigmaA_ * left.longest - p2;
    }
    /// e^{x^2} erfc(x), x >= 0, within 1e-4 of its value: the form of Abramowitz and Stegun 7.1.26, fitted to the
    /// smallest largest relative error.
    template <typename Batch>
    static Batch scaledErfc(const Batch& x) {
        const Batch t = 1.0f / (1.0f + 0.56375f * x);
        return t * (0.3180358f + t * (0.32034829f + t * (0.23812922f + t * (0.29354765f - t * 0.17015036f))));
    }
    [[nodiscard]] float logThrough(const Exit::Face& face, const Departure<float>::Left& left) const {
        float factor = 0;
        const float power = through<float>(face, left, factor);
        return power + std::log(std::max(factor, 1e-37f));
    }

    /// Where boundaries reflect nearly all light, leaving takes many tries, the next as likely as the last; a boundary
    /// extrapolated by as much would seem out of reach for whatever is about to leave. (Milk behind
    /// glass with the jar's index at 3, best points, image over that of paths: 5e-4 without; 0.87 +- 0.04 by six seeds,
    /// still noisier than plain ones.)
    static constexpr float MostMismatch = 8.5f;

    const Exit& exit_;
    float sigmaA_;
    float fourthInverseD_; ///< 1 / (4 D)
    float margin_;         ///< z_b
    float meanFreePath_;   ///< transport: 1 / sigmaS'
    float allowance_;
};

} // namespace darts
