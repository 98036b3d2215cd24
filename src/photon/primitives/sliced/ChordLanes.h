#pragma once
// Chord.h for a register of rays: where all lengths, linear in one unknown, are flights'.

#include "photon/primitives/sliced/SliceLanes.h"

namespace tungsten::photon {

template <size_t K>
struct ChordLanes {
    std::array<Batch, K> offset, slope; ///< lengths t_i = offset + slope t
    Batch start, end;                   ///< of the unknown t; empty unless start < end

    [[nodiscard]] LaneMask holds() const { return start < end; }
    [[nodiscard]] Batch length(size_t i, const Batch& t) const { return offset[i] + slope[i] * t; }
    [[nodiscard]] Batch offsetSum() const {
        Batch sum = offset[0];
        for (size_t i = 1; i < K; ++i) sum += offset[i];
        return sum;
    }
    [[nodiscard]] Batch slopeSum() const {
        Batch sum = slope[0];
        for (size_t i = 1; i < K; ++i) sum += slope[i];
        return sum;
    }
    /// Keeps the part where p + q t >= 0.
    void keepPositive(const Batch& p, const Batch& q) {
        const Batch root = -(p / q);
        const LaneMask rises = q >= 0.0f;
        start = xsimd::select(rises, xsimd::max(start, root), start);
        end = xsimd::select(rises, end, xsimd::min(end, root));
    }
    void keep(const Batch& p, const Batch& q, const Batch& least, const Batch& most) {
        keepPositive(p - least, q);
        keepPositive(most - p, -q);
    }
    /// Keeps what lies inside every flight, the first of which ends at `reach`.
    void keepFlights(float reach) {
        for (size_t i = 0; i < K; ++i) keepPositive(offset[i], slope[i]);
        if (reach < Infinity) keepPositive(reach - offset[0], -slope[0]);
    }
    /// With t the distance along the ray: (10) and (15) for long flights, or at a point drawn by their integrand.
    /// `factor`: without lengths.
    [[nodiscard]] LaneHit hit(const LaneRecord& record, const LaneMask& met, const Batch& factor,
                              const Batch& u) const {
        const Batch first = xsimd::select(met, start, Batch(0.0f)), last = xsimd::select(met, end, Batch(0.0f));
        const Batch rise = slopeSum() + 1.0f, fall = xsimd::abs(rise), chord = last - first;
        const LaneMask falls = rise >= 0.0f;
        Batch t = xsimd::select(falls, first, last);
        LaneHit hit{met, t, offsetSum() + rise * t, factor};
        if (!record.drawsPoints) {
            hit.integrated = true;
            hit.chord = chord;
            hit.fall = fall;
            return hit;
        }
        const Batch sigma(meanComponent(record.sigmaT)), z = sigma * fall * chord;
        const Batch v = xsimd::select(falls, u, 1.0f - u); // from the bright end, as drawn from the start
        // u = 0 stands for what is below 2^-24: v is 1 there, and all of a long chord's light would be left of nothing.
        const Batch left = xsimd::max(1.0f - v * (1.0f - xsimd::exp(-z)), Batch(0x1p-25f));
        const Batch exact = -xsimd::log(left) / xsimd::max(sigma * fall, Batch(1e-30f));
        const Batch along = xsimd::min(xsimd::select(z < 1e-3f, v * chord, exact), chord);
        t = xsimd::select(falls, first + along, last - along);
        hit.alongRay = t;
        hit.length = offsetSum() + rise * t;
        hit.factor = factor * chord * meanOfFall(z) / left;
        for (size_t i = 0; i < K; ++i) hit.lengths[i] = xsimd::max(length(i, t), Batch(0.0f));
        return hit;
    }
};

} // namespace tungsten::photon
