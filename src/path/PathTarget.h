#pragma once
// What a whole path connects to: one point that sends light, chosen before the path starts.

#include "path/PixelAccumulator.h"
#include "path/Tuning.h"

#include "transport/Balance.h"
#include "transport/Vertex.h"
#include "transport/Walk.h"

#include <optional>

namespace tungsten::path {

using transport::PathState;

/// Probabilities with which an emitter is chosen.
struct EmitterChoice {
    float ofPath = 1.0f;   ///< by a guided path, for all its vertices
    float ofVertex = 1.0f; ///< by a vertex of plain paths beside guided ones; 1 without these
};

/// The last vertex of light's own path: a point of an emitter; for light that starts in a single direction, the first
/// vertex that scatters it: a virtual point source.
struct PathTarget : transport::SubpathEnd {
    const Emitter* emitter;
    int index;                  ///< of the emitter; -1 for virtual sources, which cannot be hit
    EmitterChoice choice;       ///< of the emitter
    double start;               ///< when light leaves the vertex
    std::optional<Vec2f> u;     ///< random numbers that drew the point; none: it has been met
    float emitterRadius = 0.0f; ///< distance from the vertex to the emitter's farthest point
    int interactions = 0;       ///< of the light's own path so far, the virtual source included
    int mediumScatters = 0;     ///< of these, in media

    /// Density per solid angle, seen from `receiver`, of points that a vertex chooses (0 for points without a surface).
    [[nodiscard]] float pdfFrom(const Vec3f& receiver, const Vec3f& position, const Vec3f& ng) const {
        return index >= 0 ? choice.ofVertex * pdfDirect(*emitter, receiver, position, ng) : 0.0f;
    }
    /// MIS weight of light that arrives at `receiver` from the target's vertex: the part that is not left to paths
    /// that meet the emitter, if they leave in directions of this density. `overPlain`: how much denser connections are
    /// than those of plain paths alone (StrategyBalance::overPlain).
    [[nodiscard]] transport::TechniqueShare shareOfConnection(const Vec3f& receiver, float ownPdf,
                                                              float overPlain = 1.0f) const {
        const float pdf = pdfFrom(receiver, vertex.position(), vertex.margin().normal);
        if (!(pdf > 0.0f)) return {};
        return transport::TechniqueShare::of({pdf, ownPdf}, {pdf * overPlain, ownPdf});
    }
};

/// Chooses targets among the emitters it is made for (emitterDistribution).
class TargetChoice {
  public:
    enum class Emitters { All, SingleDirections };
    /// `leftOut`: by emitter; empty: none. `ofVertices`: plain paths choose at each vertex, too.
    TargetChoice(const Scene& scene, Emitters emitters, const std::vector<bool>& leftOut = {}, bool ofVertices = false);

    /// Several emitters to choose from.
    [[nodiscard]] bool several() const { return count_ > 1; }
    [[nodiscard]] bool any() const { return distribution_.total() > 0.0; }
    [[nodiscard]] float probability(size_t emitter) const { return distribution_.probability(emitter); }
    [[nodiscard]] EmitterChoice choice(size_t emitter) const {
        return {probability(emitter), ofVertices_ ? probability(emitter) : 1.0f};
    }
    /// Those of these emitters whose light starts in a single direction.
    [[nodiscard]] const std::vector<size_t>& singleDirections() const { return singleDirections_; }
    /// `u` chooses the emitter, if there is any().
    [[nodiscard]] size_t choose(float u) const { return distribution_.sample(u).index; }
    /// A point of this emitter, as its choice has it. None when light that starts in a single direction is absorbed or
    /// escapes.
    [[nodiscard]] std::optional<PathTarget> of(size_t emitter, Sampler& sampler, const ProgressToken& watch,
                                               PathCounters& counters) const;
    /// The point of an emitter that these random numbers draw.
    [[nodiscard]] PathTarget at(size_t emitter, const Vec2f& u) const {
        PathTarget target = at(emitter, sampleEmissionPoint(scene_.emitters[emitter], u));
        target.u = u;
        return target;
    }
    /// This point of an emitter.
    [[nodiscard]] PathTarget at(size_t emitter, const SurfaceSample& point) const;
    /// Guided paths choose among points of its emitter. Not for virtual sources.
    [[nodiscard]] bool hasOtherPoints(const PathTarget& target) const;
    /// The k-th of so many points of a lattice of rank 1 on the unit square that starts at u, modulo 1. From each of
    /// them the lattice has the same points, so that a choice among these has a density that is known.
    static constexpr size_t Points = tuning::EntryPoints;
    [[nodiscard]] static Vec2f otherPoint(const Vec2f& u, size_t k);
    [[nodiscard]] std::optional<PathTarget> sample(float u, Sampler& sampler, const ProgressToken& watch,
                                                   PathCounters& counters) const {
        return any() ? of(choose(u), sampler, watch, counters) : std::nullopt;
    }

  private:
    std::optional<PathTarget> scatterLaser(PathTarget target, const EmissionSample& emission, const Sampler& sampler,
                                           const ProgressToken& watch, PathCounters& counters) const;

    const Scene& scene_;
    Distribution1D distribution_;
    std::vector<float> radii_; ///< of a ball about any of its points that holds the emitter, by emitter
    bool ofVertices_;
    int count_ = 0;
    std::vector<size_t> singleDirections_;
};

} // namespace tungsten::path
