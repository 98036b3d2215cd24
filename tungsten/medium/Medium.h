#pragma once
// Homogeneous participating media.

#include "tungsten/core/Random.h"
#include "tungsten/medium/PhaseFunction.h"

#include <string>

namespace tungsten {

/// Coefficients per scene unit of length (density already multiplied in), per RGB channel.
struct Medium {
    std::string name;
    Rgb sigmaA{0.0f}, sigmaS{0.0f};
    PhaseFunction phase;
    float speedOfLight = 1.0f;
    int maxBounces = 1024;    ///< distances sampled since the last surface before a path ends
    bool guided = false;      ///< `guided_homo`: asks for DARTS distance sampling
    bool guidedPhase = false; ///< phase function `ida` / `integrated_da`: asks for EDA direction sampling

    [[nodiscard]] Rgb sigmaT() const { return sigmaA + sigmaS; }
    [[nodiscard]] bool isVacuum() const { return isBlack(sigmaT()); }
    [[nodiscard]] bool scatters() const { return !isBlack(sigmaS); }
    [[nodiscard]] bool isGrey() const;
    /// e^{-sigmaT d}; zero at infinity unless the medium is empty.
    [[nodiscard]] Rgb transmittance(float distance) const;
};

/// Outcome of a plain free flight up to `tMax`.
struct FlightSample {
    float distance; ///< of the collision, or tMax
    bool exited;    ///< reached tMax
    Rgb weight;     ///< sigmaS T / pdf at a collision; T / probability when exited (channel-averaged density)
    float pdf;      ///< per length at a collision; probability when exited
};

/// Draws a free flight: one channel chosen uniformly, weighted by the channel-averaged density. Absorbing-only media
/// always exit.
FlightSample sampleFlight(const Medium& medium, float tMax, Sampler& sampler);
/// Density per length of a collision at `distance` (channel average).
float pdfFlight(const Medium& medium, float distance);
/// Probability of passing `distance` without collision (channel average).
float probabilityFlightExits(const Medium& medium, float distance);

} // namespace tungsten
