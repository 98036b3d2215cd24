#pragma once
// Participating media: the set of models, and what a region filled with one has besides.

#include "tungsten/medium/Homogeneous.h"
#include "tungsten/medium/PhaseFunction.h"

namespace tungsten {

using Media = MediumSet<Homogeneous>;

struct Medium {
    std::string name;
    Media::Variant model;
    PhaseFunction phase;
    float speedOfLight = 1.0f;
    int maxBounces = 1024;    ///< distances sampled since the last surface before a path ends
    bool guided = false;      ///< `guided_homo`: asks for DARTS distance sampling
    bool guidedPhase = false; ///< phase function `ida` / `integrated_da`: asks for EDA direction sampling
    std::string path = {};    ///< in the scene file, as problems have it

    /// Its coefficients are the same everywhere. Guidance, splats and photon beams take that for granted: plans decline
    /// them elsewhere.
    [[nodiscard]] bool isHomogeneous() const {
        return std::visit([](const auto& m) { return m.IsHomogeneous; }, model);
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
