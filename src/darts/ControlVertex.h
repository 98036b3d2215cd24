#pragma once
// Elliptical control vertices: the last scattering before the target, placed so that the path arrives inside the gate.

#include "darts/Ellipse.h"
#include "darts/FastMath.h"

#include <algorithm>

namespace darts {

/// Density of the connection length on [low, low + width): exponential of rate sigmaT, truncated; uniform for sigmaT =
/// 0. Its shape is the transmittance that the whole connection carries.
template <typename Real>
struct ConnectionLength {
    Real low = 0, width = 0, sigmaT = 0;

    struct Draw {
        Real offset, inversePdf; ///< S - low, and 1 / its density per length
    };
    /// u in [0, 1) -> S = low - log(1 - u (1 - e^{-sigmaT width})) / sigmaT.
    [[nodiscard]] Draw sample(Real u) const {
        const Real depth = sigmaT * width;
        if (depth < Shallow) return {u * width, width};
        const Real all = -fastExpm1(-depth), gone = u * all;
        // gone < 1 and sigmaT > 0: never NaN, so std::min serves; fmin would be a call.
        return {std::min(-fastLog1p(-gone) / sigmaT, width), all / (sigmaT * (1 - gone))};
    }
    /// Density per length of S: sigmaT e^{-sigmaT offset} / (1 - e^{-sigmaT width}) at offset = S - low.
    [[nodiscard]] Real pdf(Real offset) const {
        if (!(offset >= 0) || offset > width) return 0;
        const Real depth = sigmaT * width;
        if (depth < Shallow) return 1 / width;
        return sigmaT * std::exp(-sigmaT * offset) / -fastExpm1(-depth);
    }

  private:
    /// Depths of the range below which the density is uniform to as many digits as are kept.
    static constexpr Real Shallow = Real(1e-6);
};

/// Density per length along the ray of the vertex of a connection whose length has density `lengthPdf`:
/// p(t) = p(S) dS/dt = p(S) (S - C cos) / (S - t). (The ratio is printed upside down in He et al. 2024.)
template <typename Real>
Real controlVertexPdf(const Ellipse<Real>& connection, Real lengthPdf) {
    return lengthPdf / connection.firstLegPerLength();
}

} // namespace darts
