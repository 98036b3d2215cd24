#pragma once
// Directions by the product of a forward peak and what a guide prefers, with a density that is known.

#include "darts/FastMath.h"
#include "darts/PhaseFunction.h"

#include <array>

namespace darts {

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

} // namespace darts
