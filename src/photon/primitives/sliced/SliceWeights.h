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

/// Of a ball that reaches points of a ray, without jacobian or density.
inline Batch ballScattering(const LaneRecord& record, const LaneRays& rays, const Batch& length, const Batch& alongRay,
                            const Lanes3& last, const Batch& first) {
    return first * henyeyGreenstein(record.g, last, -rays.direction) * xsimd::exp(-record.sigmaT * (length + alongRay));
}
inline Batch leavingBall(const LaneRecord& record, const Lanes3& last) {
    return record.isotropic ? Batch(1.0f) : henyeyGreenstein(record.g, Lanes3(record.flights->directions[1]), last);
}

/// At a point drawn in a gate of this width, averaged over it. As below.
inline Batch ballGateWeight(const LaneRecord& record, const LaneRays& rays, const BallGateLanes& met, float width) {
    const Lanes3 last = (rays.toOrigin + rays.direction * met.alongRay) * (1.0f / met.length);
    return ballScattering(record, rays, met.length, met.alongRay, last, leavingBall(record, last)) * met.density *
           (1.0f / width);
}

/// At one of its reaches. Without the power (light of its own included) and the collision.
inline Batch ballWeight(const LaneRecord& record, const LaneRays& rays, const BallLanes& met, const Batch& alongRay,
                        bool warped) {
    const auto& w = record.flights->directions;
    const Lanes3 last = (rays.toOrigin + rays.direction * alongRay) * (1.0f / met.length);
    const Batch first = leavingBall(record, last);
    Batch weight = ballScattering(record, rays, met.length, alongRay, last, first) / met.jacobian;
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
