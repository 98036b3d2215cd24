#pragma once
// What paths from the camera connect to besides emitters: the light vertices and the reflected light of a pass.

#include "path/techniques/GlossyLightVertices.h"

namespace tungsten::path {

/// Caches for every emitter that shines in more than one direction.
class LightCaches {
  public:
    /// Few enough emitters, and one among them that shines in more than one direction.
    [[nodiscard]] static bool helpWith(const Scene& scene);
    /// Light is followed beyond the first surface.
    [[nodiscard]] static bool reflectedIn(const Scene& scene);

    void prepare(const Scene& scene, const TargetChoice& targets, const ProgressToken& watch, Statistics& statistics);
    /// A quarter as many light paths as guided paths of the pass, within limits of Tuning.h, and no more than those.
    void trace(const Scene& scene, const TargetChoice& targets, size_t guidedPaths, const PassInfo& pass,
               Statistics& statistics);
    /// None for emitters without light vertices.
    [[nodiscard]] const LightVertexCache* vertices(int emitter) const {
        return emitter >= 0 && size_t(emitter) < vertices_.size() ? &vertices_[size_t(emitter)] : nullptr;
    }
    /// None for emitters whose light is not followed.
    [[nodiscard]] const GlossyVertexCache* reflected(int emitter) const {
        if (emitter < 0 || size_t(emitter) >= reflected_.size()) return nullptr;
        return reflected_[size_t(emitter)].empty() ? nullptr : &reflected_[size_t(emitter)];
    }
    [[nodiscard]] const Flights& flights() const { return flights_; }

  private:
    std::vector<LightVertexCache> vertices_;   ///< by emitter
    std::vector<GlossyVertexCache> reflected_; ///< by emitter
    Flights flights_;
};

} // namespace tungsten::path
