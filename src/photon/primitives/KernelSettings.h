#pragma once
// What primitives know of the integrator's settings: their kernels.

namespace tungsten::photon {

struct KernelSettings {
    float volumeRadius = 1e30f;     ///< radius of the point kernel, when fixed, and of the beam kernel
    bool fixedVolumeRadius = false; ///< false: the radius follows the photons' density
    bool boundaryKernels = true;    ///< false: kernels reach beyond surfaces, where nothing gathers them
    float alpha = 0.3f;             ///< surface radius reduction
    float volumeAlpha = 0.3f;       ///< volume radius reduction
};

} // namespace tungsten::photon
