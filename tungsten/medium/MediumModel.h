#pragma once
// What a participating medium answers.

#include "tungsten/core/ModelSet.h"
#include "tungsten/core/Random.h"

#include <concepts>

namespace tungsten {

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

class ObjectReader;

template <typename M>
concept MediumModel = std::copyable<M> &&
    requires(const M& m, float length, const ChannelDensities& channels, Sampler& sampler, const ObjectReader& fields) {
    { M::Type } -> std::convertible_to<std::string>; // of the scene file
    { M::read(fields) } -> std::same_as<M>;
    { M::IsHomogeneous } -> std::convertible_to<bool>;
    { m.scatters() } -> std::same_as<bool>;
    { m.isVacuum() } -> std::same_as<bool>;
    { m.isGrey() } -> std::same_as<bool>; // equal coefficients in all channels
    { m.transmittance(length) } -> std::same_as<Rgb>;
    // As the functions of these names say (Medium.h).
    { m.sampleFlight(length, channels, sampler) } -> std::same_as<FlightSample>;
    { m.flightThatExits(length, channels) } -> std::same_as<FlightSample>;
    { m.flightThatCollides(length, channels) } -> std::same_as<FlightSample>;
    { m.pdfFlight(length, channels) } -> std::same_as<float>;
    { m.probabilityFlightExits(length, channels) } -> std::same_as<float>;
};
template <MediumModel M>
using CheckedMedium = M;
template <typename... M>
using MediumSet = ModelSet<CheckedMedium<M>...>;

} // namespace tungsten
