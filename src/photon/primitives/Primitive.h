#pragma once
// What the operations of every primitive speak of: settings of kernels, and how their radii shrink from pass to pass.

#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Selection.h"

#include <cmath>
#include <cstdint>
#include <string>

namespace tungsten {
class Film;
class ObjectReader;
} // namespace tungsten

namespace tungsten::photon {

struct PhotonSettings;
struct CameraRecord;
using CameraRecords = std::vector<const CameraRecord*>; ///< of several samples of a pass

/// What primitives know of the integrator's settings.
struct KernelSettings {
    float volumeRadius = 1e30f;     ///< radius of the point kernel, when fixed, and of the beam kernel
    bool fixedVolumeRadius = false; ///< false: the radius follows the photons' density
    bool boundaryKernels = true;    ///< false: kernels reach beyond surfaces, where nothing gathers them
    float alpha = 0.3f;             ///< surface radius reduction
    float volumeAlpha = 0.3f;       ///< volume radius reduction
};

/// gamma_i = prod_{k=1..i} (k + alpha) / (k + 1), pass i from 0: = Gamma(i+1+alpha) / (Gamma(1+alpha) Gamma(i+2)).
inline double radiusScale(uint32_t pass, double alpha) {
    // std::lgamma leaves the sign in a variable that all threads share.
    int sign = 0;
    const double i = double(pass);
    return std::exp(::lgamma_r(i + 1.0 + alpha, &sign) - ::lgamma_r(1.0 + alpha, &sign) - ::lgamma_r(i + 2.0, &sign));
}

/// Surface radii shrink with the square root of gamma(alpha).
inline float surfaceRadiusFactor(uint32_t pass, float alpha) {
    return float(std::sqrt(radiusScale(pass, double(alpha))));
}
/// Volume point radii shrink with the cube root of gamma(volume_alpha): the published schedule, kept for its images.
inline float pointRadiusFactor(uint32_t pass, float volumeAlpha) {
    return float(std::cbrt(radiusScale(pass, double(volumeAlpha))));
}
/// Beam radii shrink with gamma(alpha) itself: their kernel has one dimension.
inline float beamRadiusFactor(uint32_t pass, float alpha) {
    return float(radiusScale(pass, double(alpha)));
}
/// At a delta gate the radius and the half-width of the temporal kernel share gamma(volume_alpha): a square root each.
inline double deltaGateFactor(uint32_t pass, float volumeAlpha) {
    return std::sqrt(radiusScale(pass, double(volumeAlpha)));
}
/// Radius of beams, as that of the first pass is 1: at delta gates it narrows with the temporal kernel.
inline double flightRadiusFactor(const KernelSettings& settings, bool deltaGate, uint32_t pass) {
    return deltaGate ? deltaGateFactor(pass, settings.volumeAlpha) : double(beamRadiusFactor(pass, settings.alpha));
}

} // namespace tungsten::photon
