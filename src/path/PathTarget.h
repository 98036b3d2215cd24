#pragma once
// What a whole path connects to: one point that sends light, chosen before the path starts.

#include "path/PixelSink.h"

#include "transport/Balance.h"
#include "transport/Connection.h"
#include "transport/PathState.h"

#include <optional>

namespace tungsten::path {

using transport::PathState;

/// The last vertex of light's own path: a point of an emitter; for light that starts in a single direction, the first
/// vertex that scatters it: a virtual point source.
struct PathTarget : transport::PathEnd {
    const Emitter* emitter;
    int index;              ///< of the emitter; -1 for virtual sources, which cannot be hit
    float probability;      ///< of the emitter's choice
    double start;           ///< when light leaves the vertex
    float reach = 0.0f;     ///< distance from the vertex to the emitter's farthest point
    int interactions = 0;   ///< of the light's own path so far, the virtual source included
    int mediumScatters = 0; ///< of these, in media

    /// Density per solid angle, seen from `receiver`, of points chosen like this one (0 for points without a surface).
    [[nodiscard]] float pdfFrom(const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) const {
        return index >= 0 ? pdfDirect(*emitter, receiver, position, ng) : 0.0f;
    }
    /// Of light that arrives at `receiver` from the target's vertex along the unit `direction`: the part that is not
    /// left to paths that meet the emitter, if they leave in directions of this density.
    [[nodiscard]] float shareOfConnection(const Vec3f& receiver, float ownPdf) const {
        const float pdf = pdfFrom(receiver, vertex.position(), vertex.margin().normal);
        return pdf > 0.0f ? transport::powerHeuristic(pdf, ownPdf) : 1.0f;
    }
};

/// Chooses targets among the emitters it is made for (emitterDistribution).
class TargetChoice {
  public:
    enum class Emitters { All, SingleDirections };
    /// `leftOut`: by emitter; empty: none.
    TargetChoice(const Scene& scene, Emitters emitters, const std::vector<bool>& leftOut = {});

    /// Several emitters to choose from.
    [[nodiscard]] bool several() const { return count_ > 1; }
    [[nodiscard]] bool any() const { return distribution_.total() > 0.0; }
    [[nodiscard]] float probability(size_t emitter) const { return distribution_.probability(emitter); }
    /// `u` chooses the emitter. None when light that starts in a single direction is absorbed or escapes.
    [[nodiscard]] std::optional<PathTarget> sample(float u, Sampler& sampler, const PassWatch& watch,
                                                   PathCounters& counters) const;

  private:
    std::optional<PathTarget> scatterLaser(PathTarget target, const EmissionSample& emission, const Sampler& sampler,
                                           const PassWatch& watch, PathCounters& counters) const;

    const Scene& scene_;
    Distribution1D distribution_;
    std::vector<float> radii_; ///< of a ball about any of its points that holds the emitter, by emitter
    int count_ = 0;
};

} // namespace tungsten::path
