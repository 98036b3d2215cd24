#pragma once
// Elliptical control vertices: the last scattering before the target, placed so that the path arrives inside the gate.

#include "darts/Ellipse.h"
#include "darts/FastMath.h"

#include <algorithm>

namespace darts {

/// Density of the connection length on [low, low + width): exponential of rate sigmaT, truncated; uniform for sigmaT =
/// 0. Its shape is the transmittance that the whole connection carries. With a `needle` above 0 half of the lengths are
/// drawn in proportion to 1 / (needle + low + offset), low an excess over the straight way: light that a forward peak
/// hardly turns arrives within about that excess.
template <typename Real>
struct ConnectionLength {
    Real low = 0, width = 0, sigmaT = 0, needle = 0;

    struct Draw {
        Real offset, inversePdf; ///< S - low, and 1 / its density per length
    };
    /// u in [0, 1) -> S = low - log(1 - u (1 - e^{-sigmaT width})) / sigmaT.
    [[nodiscard]] Draw sample(Real u) const {
        if (!(needle > 0)) return sampleExponential(u);
        const Real start = needle + low;
        const Real offset =
            u < Real(0.5) ? sampleExponential(2 * u).offset : start * fastExpm1((2 * u - 1) * fastLog1p(width / start));
        return {std::min(offset, width), 1 / pdf(std::min(offset, width))};
    }
    /// Density per length of S = low + offset.
    [[nodiscard]] Real pdf(Real offset) const {
        if (!(offset >= 0) || offset > width) return 0;
        const Real exponential = pdfExponential(offset);
        if (!(needle > 0)) return exponential;
        const Real start = needle + low;
        return Real(0.5) * exponential + Real(0.5) / ((start + offset) * fastLog1p(width / start));
    }
    /// Half of the lengths are shorter; with a needle to about a hundredth.
    [[nodiscard]] Real median() const {
        const Real exponential = sampleExponential(Real(0.5)).offset;
        if (!(needle > 0)) return exponential;
        const Real start = needle + low, range = fastLog1p(width / start);
        const Real peaked = std::min(start * fastExpm1(range / 2), width);
        const Real least = std::min(exponential, peaked), most = std::max(exponential, peaked);
        Real below = start + least, above = start + most;
        for (int i = 0; i < 10; ++i) {
            const Real middle = std::sqrt(below * above);
            const Real part = partExponential(middle - start) + std::log(middle / start) / range;
            (part < 1 ? below : above) = middle;
        }
        return std::clamp(std::sqrt(below * above) - start, least, most);
    }

  private:
    /// Depths of the range below which the density is uniform to as many digits as are kept.
    static constexpr Real Shallow = Real(1e-6);

    [[nodiscard]] Draw sampleExponential(Real u) const {
        const Real depth = sigmaT * width;
        if (depth < Shallow) return {u * width, width};
        const Real all = -fastExpm1(-depth), gone = u * all;
        // gone < 1 and sigmaT > 0: never NaN, so std::min serves; fmin would be a call.
        return {std::min(-fastLog1p(-gone) / sigmaT, width), all / (sigmaT * (1 - gone))};
    }
    /// sigmaT e^{-sigmaT offset} / (1 - e^{-sigmaT width}).
    [[nodiscard]] Real pdfExponential(Real offset) const {
        const Real depth = sigmaT * width;
        if (depth < Shallow) return 1 / width;
        return sigmaT * std::exp(-sigmaT * offset) / -fastExpm1(-depth);
    }
    [[nodiscard]] Real partExponential(Real offset) const {
        const Real depth = sigmaT * width;
        return depth < Shallow ? offset / width : fastExpm1(-sigmaT * offset) / fastExpm1(-depth);
    }
};

/// Lengths of connections whose direction is known: half of them are drawn in proportion to 1 / (low + offset + a)^2,
/// which is that of 1 / ((low + offset)^2 + a^2) within a factor of two; the weight of a connection at 1 - cos = h goes
/// with this and a^2 = 2 S C h.
template <typename Real>
struct LengthAlong {
    ConnectionLength<Real> lengths;
    Real a; ///< above 0

    /// u in [0, 1).
    [[nodiscard]] typename ConnectionLength<Real>::Draw sample(Real u) const {
        const Real first = lengths.low + a, part = (2 * u - 1) * lengths.width;
        const Real offset = u < Real(0.5) ? lengths.sample(2 * u).offset
                                          : std::min(first * part / (first + lengths.width - part), lengths.width);
        return {offset, 1 / pdf(offset)};
    }
    /// Density per length.
    [[nodiscard]] Real pdf(Real offset) const {
        if (!(offset >= 0) || offset > lengths.width) return 0;
        const Real first = lengths.low + a, part = first / (first + offset);
        return Real(0.5) * (lengths.pdf(offset) + part * part * (1 / first + 1 / lengths.width));
    }
};

/// Density per length along the ray of the vertex of a connection whose length has density `lengthPdf`:
/// p(t) = p(S) dS/dt = p(S) (S - C cos) / (S - t). (The ratio is printed upside down in He et al. 2024.)
template <typename Real>
Real controlVertexPdf(const Ellipse<Real>& connection, Real lengthPdf) {
    return lengthPdf / connection.firstLegPerLength();
}

} // namespace darts
