#pragma once
// Short primitives: collapsed flights that end at random lengths, in place of a transmittance
// (docs/photon-primitives.md, section 2).

#include "photon/primitives/sliced/SliceRecord.h"

#include "tungsten/medium/Medium.h"

namespace tungsten::photon {

/// Lengths at which a record's flights end, by the mean coefficient; infinite for long ones. They are drawn by the
/// record's own number: a flight's end need not be where the light path's was, as nothing else of the record depends on
/// it, and ghosts have none.
inline std::array<double, 4> flightEnds(const SliceRecord& flights, const Medium& medium) {
    std::array<double, 4> ends;
    ends.fill(std::numeric_limits<double>::infinity());
    if (!flights.shortFlights) return ends;
    uint64_t state = (uint64_t(flights.random[0]) << 16 | flights.random[1]) + 1;
    for (double& end : ends) {
        // Steele, Lea and Flood 2014, SplitMix64
        uint64_t bits = state += 0x9e3779b97f4a7c15u;
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        bits ^= bits >> 31;
        end = -std::log1p(-double(bits >> 11) * 0x1p-53) / double(meanComponent(medium.sigmaT()));
    }
    return ends;
}

/// What short flights of these lengths are weighed by besides their transmittance: 1 / P(none has ended), or 0 where
/// one has; 1 for long ones.
inline double unended(const SliceRecord& flights, const Medium& medium, const double* lengths, int count) {
    if (!flights.shortFlights) return 1.0;
    const std::array<double, 4> ends = flightEnds(flights, medium);
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        if (lengths[i] > ends[size_t(i)]) return 0.0;
        sum += lengths[i];
    }
    return std::exp(double(meanComponent(medium.sigmaT())) * sum);
}

} // namespace tungsten::photon
