#pragma once
// What slices bring to a register of rays: (7), (11) and the shares of (16), in floats.

#include "photon/primitives/sliced/CollapsedFlights.h"
#include "photon/primitives/sliced/SliceLanes.h"

namespace tungsten::photon {

/// A record for registers of rays: a volume or a ball in a grey medium with Henyey-Greenstein scattering.
struct LaneRecord {
    const CollapsedFlights* flights;
    VolumeLanes volume; ///< of its directions
    float g, sigmaT;
    float phasePdf; ///< a volume: of its third direction
    float pdfs;     ///< a ball: of the two flights that led to it
    bool isotropic; ///< a ball on a light that shines alike everywhere
};

/// Change of path length along the ray.
inline Batch lengthPerLength(const Lanes3& last, const Lanes3& ray, bool warped) {
    const Lanes3 sum = last + ray;
    return warped ? 0.5f * sum.dot(sum) : xsimd::abs(last.dot(ray));
}

/// a / (a + b)
inline Batch shareOf(const Batch& a, const Batch& b) {
    return a / xsimd::max(a + b, Batch(1e-37f));
}

/// Without the power and the collapsed collisions.
inline Batch volumeWeight(const LaneRecord& record, const LaneRays& rays, const LaneSlice& met, bool warped) {
    const Lanes3 last(record.flights->directions[2]);
    const Batch flights = met.t1 + met.t2 + met.t3;
    Batch weight = henyeyGreenstein(record.g, last, -rays.direction) / met.jacobian *
                   xsimd::exp(-record.sigmaT * (flights + met.alongRay));
    if (record.flights->shared) {
        const Batch pdfs = record.sigmaT * record.sigmaT * xsimd::exp(-record.sigmaT * (met.t1 + met.t2));
        weight = weight * shareOf(record.phasePdf * met.jacobian,
                                  pdfs * met.t3 * met.t3 * lengthPerLength(last, rays.direction, warped));
    }
    return weight;
}

/// At one of its reaches. Without the power (light of its own included) and the collision.
inline Batch ballWeight(const LaneRecord& record, const LaneRays& rays, const BallLanes& met, const Batch& alongRay,
                        bool warped) {
    const auto& w = record.flights->directions;
    const Lanes3 last = (rays.toOrigin + rays.direction * alongRay) * (1.0f / met.length);
    const Batch first = record.isotropic ? Batch(1.0f) : henyeyGreenstein(record.g, Lanes3(w[1]), last);
    Batch weight = first * henyeyGreenstein(record.g, last, -rays.direction) / met.jacobian *
                   xsimd::exp(-record.sigmaT * (met.length + alongRay));
    if (record.flights->shared) {
        const Lanes3 a(w[0]), b(w[1]);
        const Lanes3& c = rays.direction;
        const Batch volume =
            xsimd::abs(warped ? (a + c).dot((b + c).cross(last + c)) : (a - last).dot((b - last).cross(c)));
        weight = weight * shareOf(record.pdfs * met.jacobian, first * volume);
    }
    return weight;
}

} // namespace tungsten::photon
