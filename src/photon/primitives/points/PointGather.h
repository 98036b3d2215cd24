#pragma once
// Gathering volume photons along a camera segment with the two-dimensional kernel.

#include "photon/primitives/CameraSegment.h"
#include "photon/primitives/Selection.h"
#include "photon/store/EmbreeScene.h"
#include "photon/store/Store.h"
#include "transport/TimeSensor.h"

#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/scene/Scene.h"

#include <optional>

namespace tungsten::photon {

/// Normalised biweight kernel on a disc: 3 / (pi r^2) (1 - d^2/r^2)^2.
inline float biweight(float squaredDistance, float squaredRadius) {
    const float x = 1.0f - squaredDistance / squaredRadius;
    return x > 0.0f ? 3.0f * InvPi / squaredRadius * x * x : 0.0f;
}

class PointGather {
  public:
    /// `photons` must stay alive. `sensor` has the pass's gate: a delta gate's temporal kernel is a narrow box. Few
    /// rays or many need the same structure.
    PointGather(const Scene& scene, const transport::TimeSensor& sensor, const std::vector<Photon>& photons,
                const Radii& radii, bool fewRays = false);

    /// Adds sum of power K f_p T, weighed by the sensor, over the photons near the segment to the frames they fall in.
    /// Returns how many were gathered.
    uint64_t gather(const CameraSegment& segment, FrameSums& sums) const;

  private:
    const Scene& scene_;
    transport::TimeSensor sensor_;
    const std::vector<Photon>& photons_;
    std::vector<float> squaredRadii_;
    std::vector<KernelEdges> edges_; ///< by photon, or none
    /// Ray-facing discs, exactly the support of the two-dimensional kernel; none without photons.
    std::optional<EmbreeScene> discs_;
    float largestRadius_ = 0.0f;
};

/// Radii that follow the density: r^2 = d_m^2 0.05 sqrt(N) / m, d_m the distance to the m-th nearest photon, m =
/// min(30, N) (docs/scene-format.md, section 10.4).
std::vector<float> adaptiveRadii(const std::vector<Photon>& photons, const ProgressToken& watch = {});

} // namespace tungsten::photon
