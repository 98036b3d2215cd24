#pragma once
// Participating media: a closed set of models, and what a region filled with one has besides.

#include "tungsten/core/Overloaded.h"
#include "tungsten/core/Random.h"
#include "tungsten/medium/PhaseFunction.h"

#include <string>

namespace tungsten {

/// The same everywhere. Coefficients per scene unit of length (density already multiplied in), per RGB channel.
class Homogeneous {
  public:
    Homogeneous() : Homogeneous(Rgb(0.0f), Rgb(0.0f)) {}
    Homogeneous(const Rgb& sigmaA, const Rgb& sigmaS)
        : sigmaA_(sigmaA), sigmaS_(sigmaS), grey_(hasEqualChannels(sigmaA) && hasEqualChannels(sigmaS)) {}

    [[nodiscard]] const Rgb& sigmaA() const { return sigmaA_; }
    [[nodiscard]] const Rgb& sigmaS() const { return sigmaS_; }
    [[nodiscard]] Rgb sigmaT() const { return sigmaA_ + sigmaS_; }
    [[nodiscard]] bool scatters() const { return !isBlack(sigmaS_); }
    [[nodiscard]] bool isVacuum() const { return isBlack(sigmaT()); }
    [[nodiscard]] bool isGrey() const { return grey_; }
    /// e^{-sigmaT d}; zero at infinity unless the medium is empty.
    [[nodiscard]] Rgb transmittance(float distance) const;

  private:
    [[nodiscard]] static bool hasEqualChannels(const Rgb& sigma) { return sigma.x == sigma.y && sigma.y == sigma.z; }

    Rgb sigmaA_, sigmaS_;
    bool grey_; ///< asked in every flight
};

using MediumModel = std::variant<Homogeneous>;

struct Medium {
    std::string name;
    MediumModel model;
    PhaseFunction phase;
    float speedOfLight = 1.0f;
    int maxBounces = 1024;    ///< distances sampled since the last surface before a path ends
    bool guided = false;      ///< `guided_homo`: asks for DARTS distance sampling
    bool guidedPhase = false; ///< phase function `ida` / `integrated_da`: asks for EDA direction sampling
    std::string path = {};    ///< in the scene file, as problems have it

    /// Its coefficients are the same everywhere. Guidance, splats and photon beams take that for granted: plans decline
    /// them elsewhere.
    [[nodiscard]] bool isHomogeneous() const {
        return std::visit(Overloaded{[](const Homogeneous&) { return true; }}, model);
    }
    [[nodiscard]] bool scatters() const {
        return std::visit([](const auto& m) { return m.scatters(); }, model);
    }
    [[nodiscard]] bool isVacuum() const {
        return std::visit([](const auto& m) { return m.isVacuum(); }, model);
    }
    /// Equal coefficients in all channels.
    [[nodiscard]] bool isGrey() const {
        return std::visit([](const auto& m) { return m.isGrey(); }, model);
    }
    /// Of a straight way of this length.
    [[nodiscard]] Rgb transmittance(float distance) const {
        return std::visit([&](const auto& m) { return m.transmittance(distance); }, model);
    }

    /// Where isHomogeneous().
    [[nodiscard]] const Homogeneous& homogeneous() const { return std::get<Homogeneous>(model); }
    [[nodiscard]] const Rgb& sigmaA() const { return homogeneous().sigmaA(); }
    [[nodiscard]] const Rgb& sigmaS() const { return homogeneous().sigmaS(); }
    [[nodiscard]] Rgb sigmaT() const { return homogeneous().sigmaT(); }
};

/// How dense the flights of a path so far would be, were each drawn by one channel's coefficients: by channel, over
/// their mean, with which the path is weighed. No contribution to a channel then exceeds three times what paths drawn
/// by that channel alone would bring (balance heuristic over whole paths: Wilkie et al. 2014). Even at a path's start,
/// and as long as all media are grey.
using ChannelDensities = Rgb;

/// Outcome of a plain free flight up to `tMax`.
struct FlightSample {
    float distance;            ///< of the collision, or tMax
    bool exited;               ///< reached tMax
    Rgb weight;                ///< sigmaS T / pdf at a collision; T / probability when exited
    float pdf;                 ///< per length at a collision; probability when exited
    ChannelDensities channels; ///< of the path with this flight
};

/// Draws a free flight after those of `channels`: by one channel, chosen in proportion to these densities, as if one
/// had been chosen for the whole path at its start. Absorbing-only media always exit.
FlightSample sampleFlight(const Medium& medium, float tMax, const ChannelDensities& channels, Sampler& sampler);
/// The same flight without a collision up to `distance`, where its end is known to lie beyond.
FlightSample flightThatExits(const Medium& medium, float distance, const ChannelDensities& channels);
/// The same flight with a collision at `distance`.
FlightSample flightThatCollides(const Medium& medium, float distance, const ChannelDensities& channels);
/// Density per length of a collision at `distance`.
float pdfFlight(const Medium& medium, float distance, const ChannelDensities& channels = ChannelDensities(1.0f));
/// Probability of passing `distance` without collision.
float probabilityFlightExits(const Medium& medium, float distance, const ChannelDensities& channels);

} // namespace tungsten
