#pragma once
// Fresnel reflectances of smooth interfaces, unpolarised.

#include "tungsten/core/Types.h"

namespace tungsten {

/// Dielectric: eta = n_incident / n_transmitted for cosTheta > 0; negative cosines invert it. `cosTransmitted` is the
/// (positive) cosine beyond the interface, 0 under total internal reflection.
inline float fresnelDielectric(float eta, float cosTheta, float& cosTransmitted) {
    if (cosTheta < 0.0f) {
        eta = 1.0f / eta;
        cosTheta = -cosTheta;
    }
    const float sinSquared = eta * eta * std::max((1.0f - cosTheta) * (1.0f + cosTheta), 0.0f);
    if (sinSquared >= 1.0f) {
        cosTransmitted = 0.0f;
        return 1.0f;
    }
    cosTransmitted = std::sqrt(std::max(1.0f - sinSquared, 0.0f));
    const float rs = (eta * cosTheta - cosTransmitted) / (eta * cosTheta + cosTransmitted);
    const float rp = (eta * cosTransmitted - cosTheta) / (eta * cosTransmitted + cosTheta);
    return 0.5f * (rs * rs + rp * rp);
}

inline float fresnelDielectric(float eta, float cosTheta) {
    float ignored = 0.0f;
    return fresnelDielectric(eta, cosTheta, ignored);
}

/// Conductor with complex index eta + i k seen from vacuum; exact (docs/scene-format.md, section 8.1).
Rgb fresnelConductor(const Rgb& eta, const Rgb& k, float cosTheta);

/// Hemispherical average 2 ∫ F(eta, c) c dc.
float averageFresnel(float eta);

} // namespace tungsten
