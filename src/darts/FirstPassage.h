#pragma once
// Light that diffuses in a body and must leave it in time: the probability that it does, as the importance of
// candidates.

#include "darts/Ellipse.h"
#include "darts/EscapeGeometry.h"
#include "darts/Lanes.h"
#include "darts/Settings.h"

namespace darts {

/// A place on a flight inside a body, from where light goes on in the flight's direction by `persistenceLength` on the
/// average before it has forgotten it.
template <typename Batch>
struct EscapePoint {
    const EscapeGeometry& exit;
    Vec3 direction;
    float persistenceLength; ///< 0: light leaves evenly in all directions
    Batch d;                 ///< along the flight
    Batch rho;               ///< from the target
    Batch excess;            ///< longest connection in time at the speed inside, over rho; may be negative
    Batch squaredOutside;    ///< distance from what lies inside all sides, squared

    /// At the distance `along`; `latest` is of the latest arrival.
    [[gnu::always_inline]] EscapePoint(const EscapeGeometry& out, const Ellipse<float>& latest, const Vec3& flight,
                                       const Batch& along, float onward = 0.0f)
        : exit(out), direction(flight), persistenceLength(onward), d(along), squaredOutside(Batch(0.0f)) {
        using std::max;
        using std::sqrt;
        const Batch toCentre = d - latest.C, left = (2.0f * latest.denominator()) * (latest.firstLeg() - d);
        rho = sqrt(toCentre * toCentre + (2.0f * latest.C * latest.h) * d);
        excess = left / (latest.length() - d + rho) - exit.extraLength;
        for (size_t i = 0; i < exit.sides.size(); i += 2) {
            const EscapeGeometry::Side &a = exit.sides[i], &b = exit.sides[i + 1];
            const Batch beside =
                max(Batch(a.outside + d * dot(direction, a.normal)), Batch(b.outside + d * dot(direction, b.normal)));
            squaredOutside = squaredOutside + max(beside, Batch(0.0f)) * max(beside, Batch(0.0f));
        }
    }
    /// The way to a face: depth, the longest path left for it, and by how much it may be shorter inside the gate.
    struct RemainingLength {
        Batch depth, longest, reachable;
    };
    [[nodiscard, gnu::always_inline]] RemainingLength to(const EscapeGeometry::Face& face) const {
        using std::max;
        using std::min;
        using std::sqrt;
        const float cosine = dot(direction, face.normal);
        Batch depth = max(Batch(face.depth - d * cosine), Batch(0.0f));
        // The target is `outside` away from the foot on the boundary: rho - outside without a difference of lengths.
        const Batch above = depth * (depth + 2.0f * face.height), outside = sqrt(max(rho * rho - above, Batch(0.0f)));
        // What the way outside takes more than one as long inside: negative where light is faster there. Over the
        // straight way at both speeds nothing less than 0 is left: importance is not 0 where only the extra length
        // allows an arrival.
        const Batch slower = (exit.outerSpeed - 1.0f) * outside;
        const Batch left = max(Batch(excess - min(slower, Batch(0.0f))), Batch(0.0f));
        const Batch longest = max(Batch(left - max(slower, Batch(0.0f)) + above / (rho + outside)), Batch(0.0f));
        if (persistenceLength > 0.0f) { // mean displacement of persistent walks (Fuerth 1920)
            const Batch onward = persistenceLength * (1.0f - lanes::exp(Batch(longest * (-1.0f / persistenceLength))));
            depth = max(Batch(depth - cosine * onward), Batch(0.0f));
        }
        // And at least 1 % of the gate as reachable.
        return {depth, longest, min(max(left, Batch(0.01f * exit.gate)), min(longest, Batch(exit.gate)))};
    }
};

/// First passage of diffusing light through a plane boundary, index-matched or not, of a half-space or slab, over all
/// of the boundary: what meets it either leaves or is reflected (partial-current condition, Haskell et al. 1994:
/// docs/method.md, section 10.1). With D = 1 / (3 (sigmaA + sigmaS')), z_b = 2 A D, depth z, p = z / sqrt(4 D s),
/// w = sqrt(D s) / z_b and S(x) = e^{x^2} erfc(x), light has left after the length s with the probability
///   F(s) = e^{-p^2} (S(p) - S(p + w))  times e^{-sigmaA s},
/// and leaves in the gate with F(its end) - F(its start). In a slab times 1 - exp(-L (L - y) / (D s)), y = z + z_b,
/// L = thickness + 2 z_b: the first image source, and later on the slope of the lowest mode. Several faces add up. It
/// shapes sampling only: diffusion knows nothing within a mean free path, hence the lengths s are longer by `allowance`
/// of them.
class FirstPassage {
  public:
    /// `reducedS` = sigmaS (1 - g) > 0.
    FirstPassage(float absorption, float reducedS, const EscapeGeometry& exit, float allowance = 1.0f)
        : exit_(exit), sigmaA_(absorption), fourthInverseD_(0.75f * (absorption + reducedS)),
          margin_(0.5f * std::min(exit.reflectionA, MostMismatch) / fourthInverseD_),
          leak_(0.5f / (std::sqrt(fourthInverseD_) * margin_)), meanFreePath_(1.0f / reducedS), allowance_(allowance) {}
    FirstPassage(const Medium& medium, const EscapeGeometry& exit, float allowance = 1.0f)
        : FirstPassage(mean(medium.sigmaA), medium.reducedSigmaS(), exit, allowance) {}

    /// 1 / sigmaS'
    [[nodiscard]] float meanFreePath() const { return meanFreePath_; }

    /// The probability of leaving in time from a place, as an exponential, whose exponent is returned, times `factor`.
    template <typename Batch>
    Batch exponent(const EscapePoint<Batch>& at, Batch& factor) const {
        using std::max;
        const typename EscapePoint<Batch>::RemainingLength first = at.to(exit_.faces[0]);
        Batch exponent = through(exit_.faces[0], first, factor);
        for (size_t i = 1; i < exit_.faces.size(); ++i) {
            const EscapeGeometry::Face& face = exit_.faces[size_t(i)];
            Batch otherFactor(0.0f);
            const Batch other = through(face, at.to(face), otherFactor);
            add(other, otherFactor, exponent, factor);
        }
        exponent = exponent - at.squaredOutside * fourthInverseD_ / (max(at.excess, Batch(0.0f)) + meanFreePath_);
        return exponent;
    }
    /// Its logarithm, never below that of 1e-37.
    [[nodiscard]] float log(const EscapePoint<float>& at) const {
        float factor = 0;
        const float power = exponent(at, factor);
        return power + std::log(std::max(factor, 1e-37f));
    }
    /// The gradient of the logarithm in space, time running on, and its slope with the lengths left.
    struct Slopes {
        Vec3 pull;
        float later = 0;
    };
    [[nodiscard]] Slopes slopes(const EscapePoint<float>& at, const Vec3& towardsTarget) const;

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
    Batch through(const EscapeGeometry::Face& face, const typename EscapePoint<Batch>::RemainingLength& left,
                  Batch& factor) const {
        using lanes::all;
        using lanes::select;
        using std::max;
        using std::sqrt;
        const Batch z = left.depth + face.outerDepth;
        const Batch end = left.longest + allowance_ * meanFreePath_, shortest = left.longest - left.reachable;
        // Gates that begin at once reach down to (nearly) nothing.
        const Batch settled = allowance_ * meanFreePath_ / (shortest + meanFreePath_);
        const Batch start = max(Batch(shortest * (1.0f + settled)), Batch(1e-4f * end));
        const Batch span = left.reachable + settled * meanFreePath_; // end - start but for its bound
        const Batch middle = 0.5f * (start + end), root = sqrt(middle), overRoot = 1.0f / root, atEnd = 1.0f / end;
        const Batch scaled = z * std::sqrt(fourthInverseD_), p2 = scaled * scaled * atEnd;
        // In short gates, the usual ones, the integrand in their middle, where p^2 is `more` than at the end, times
        // their length.
        const Batch more = p2 * (end - middle) * (overRoot * overRoot);
        const auto brief = max(more, Batch(0.25f * span * atEnd)) < 0.05f;
        factor = 0.5641896f * leak_ * span * overRoot * (1.0f - more * (1.0f - 0.5f * more)) *
                 leaving(Batch(scaled * overRoot), Batch(leak_ * root));
        if (!all(brief)) factor = select(brief, factor, inLongGate(scaled, start, end));
        if (face.thickness < EscapeGeometry::Infinite) {
            const float slab = face.thickness + 2.0f * margin_ + face.outerDepth;
            const Batch wall = max(slab - margin_ - z, Batch(margin_));
            const Batch kept = 1.0f - lanes::exp(Batch(-4.0f * fourthInverseD_ * slab * wall * atEnd));
            factor = factor * max(kept, Batch(1e-6f)); // never 0: that would be a bias
        }
        return -sigmaA_ * left.longest - p2;
    }
    /// F(end) - F(start), over e^{-p^2}; `scaled` is z / sqrt(4 D).
    template <typename Batch>
    Batch inLongGate(const Batch& scaled, const Batch& start, const Batch& end) const {
        using lanes::select;
        using std::max;
        using std::sqrt;
        const Batch rootEnd = sqrt(end), rootStart = sqrt(start), p = scaled / rootEnd, q = scaled / rootStart;
        const Batch between = q * q - p * p, fall = lanes::exp(Batch(-between));
        // erfc(p) - erfc(q), where they are small or alike by its second order, ...
        const Batch way = q - p, square = way * (q + 2.0f * p) * (1.0f / 3.0f);
        const Batch reached =
            select(between < 0.02f, Batch(1.12837917f * way * (1.0f - square * (1.0f - 0.5f * square))),
                   Batch(scaledErfc(p) - scaledErfc(q) * fall));
        // ... less what was reflected.
        const Batch reflected =
            scaledErfc(Batch(p + leak_ * rootEnd)) - scaledErfc(Batch(q + leak_ * rootStart)) * fall;
        return max(Batch(reached - reflected), Batch(1e-9f));
    }
    /// S(x) = e^{x^2} erfc(x), x >= 0, within 4e-5 of its value: a polynomial in 1 / (1 + c x) whose first three
    /// coefficients are those of the asymptotic series, the others fitted to the smallest largest relative error of S
    /// and, a tenth as heavy, of `leaving`.
    template <typename Batch>
    static Batch scaledErfc(const Batch& x) {
        const Batch t = 1.0f / (1.0f + 0.425f * x);
        return t * (0.239780573f +
                    t * (0.239780573f +
                         t * (0.218125398f +
                              t * (0.175362066f + t * (0.106390218f + t * (0.0977190513f - t * 0.077160072f))))));
    }
    /// 1 - sqrt(pi) w S(p + w) = (1 - sqrt(pi) x S(x)) + sqrt(pi) p S(x), x = p + w, without a difference: sqrt(pi D s)
    /// times the density of light at the boundary over that at one which reflects all, within 4e-4 of its value.
    template <typename Batch>
    static Batch leaving(const Batch& p, const Batch& w) {
        const Batch x = p + w, t = 1.0f / (1.0f + 0.425f * x);
        const Batch rest =
            t * t *
            (0.0903125f +
             t * (0.178343572f + t * (0.287645687f + t * (0.0361629261f + t * (0.729329825f - t * 0.32179451f)))));
        return rest + 1.77245385f * p * scaledErfc(x);
    }
    [[nodiscard]] float logThrough(const EscapeGeometry::Face& face,
                                   const EscapePoint<float>::RemainingLength& left) const {
        float factor = 0;
        const float power = through<float>(face, left, factor);
        return power + std::log(std::max(factor, 1e-37f));
    }

    /// Beyond, what leaves is less, but in the same places and times.
    static constexpr float MostMismatch = 100.0f;

    const EscapeGeometry& exit_;
    float sigmaA_;
    float fourthInverseD_; ///< 1 / (4 D)
    float margin_;         ///< z_b
    float leak_;           ///< sqrt(D) / z_b
    float meanFreePath_;   ///< transport: 1 / sigmaS'
    float allowance_;
};

} // namespace darts
