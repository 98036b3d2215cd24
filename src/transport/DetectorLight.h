#pragma once
// Light that reaches detectors without being scattered, from lights that rays from a detector meet with probability
// zero: points, spots and those of a single direction.

#include "transport/BounceLimits.h"
#include "transport/GateBounds.h"
#include "transport/StepCounters.h"
#include "transport/Vertex.h"
#include "transport/Walk.h"

#include <functional>

namespace tungsten::transport {

/// Two techniques, which share no path: a point of the light is connected straight to a place of the detector; a ray
/// from the light goes on along specular lobes, and meets the disc within its cone. Lights of a single direction have
/// the second alone, from their start on.
class DetectorLight {
  public:
    /// Adds `radiance`, a sample of the detector's mean, that arrives `time` after 0, emission time included, but for
    /// the emitter's delay.
    using Put = std::function<void(const Rgb& radiance, double time, const Emitter& emitter)>;

    /// `facts` also says whose light is too late. The scene must be one of mayReach(). Nothing is found if `limits`
    /// render no path without scattering.
    DetectorLight(const Scene& scene, const SceneFacts& facts, const BounceLimits& limits);

    /// The scene has detectors, and such lights.
    [[nodiscard]] static bool mayReach(const Scene& scene, const SceneFacts& facts);
    /// One sample of what the detector in `column` gets. Adds the rays traced to `rays`. Throws PassCancelled where the
    /// watch does.
    void sample(size_t column, Sampler& sampler, const ProgressToken& watch, uint64_t& rays, const Put& put) const;
    /// Connects the end of a path from a light, `time` after 0 and so many interactions, to the detector.
    void connect(size_t column, const SubpathEnd& end, const Emitter& emitter, double time, int interactions,
                 Sampler& sampler, uint64_t& rays, const Put& put) const;

  private:
    /// Light that nothing but specular surfaces has changed; its throughput is power.
    void meet(size_t column, const PathState& light, const Emitter& emitter, uint64_t& rays, const Put& put) const;

    const Scene& scene_;
    BounceLimits limits_;
    Connector connector_;
    Distribution1D emitters_;
    bool specular_; ///< surfaces mirror or refract
};

/// Light of so much power along a ray that starts in `region` meets the detector's disc, within its cone and with
/// nothing opaque before it; throughput is power over etendue. None where it does not.
std::optional<Connection> meetDetector(const Connector& connector, const Detector& detector, const Ray& ray,
                                       const Region& region, const Rgb& power, uint64_t& rays);

} // namespace tungsten::transport
