#pragma once
// Elliptical control vertices: the last scattering before the target, placed so that the path arrives inside the gate.

#include "darts/Ellipse.h"

namespace darts {

/// Density of the connection length on [low, low + width): exponential of rate sigmaT, truncated; uniform for sigmaT =
/// 0. Its shape is the transmittance that the whole connection carries.
template <typename Real>
struct ConnectionLength {
    Real low = 0, width = 0, sigmaT = 0;

    /// u in [0, 1) -> S - low.
    [[nodiscard]] Real sampleOffset(Real u) const {
        const Real depth = sigmaT * width;
        if (depth < Real(1e-6)) return u * width; // the first-order difference is below depth
        return std::fmin(-std::log1p(u * std::expm1(-depth)) / sigmaT, width);
    }
    /// Density per length of S.
    [[nodiscard]] Real pdfOffset(Real offset) const {
        if (!(offset >= 0) || offset > width) return 0;
        const Real depth = sigmaT * width;
        if (depth < Real(1e-6)) return 1 / width;
        return sigmaT * std::exp(-sigmaT * offset) / -std::expm1(-depth);
    }
};

/// Density per length along the ray of the vertex of a connection whose length has density `lengthPdf`:
/// p(t) = p(S) dS/dt = p(S) (S - C cos) / (S - t). (The ratio is printed upside down in He et al. 2024.)
template <typename Real>
Real controlVertexPdf(const Ellipse<Real>& connection, Real lengthPdf) {
    return lengthPdf / connection.firstLegPerLength();
}

} // namespace darts
