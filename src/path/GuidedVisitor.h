#pragma once
// What guided camera paths do on their way: everything is connected to one target (docs/method.md, sections 3 to 6).
//
// Every path is found in one way or by weighted ways, told apart by the last vertex before the emitter: in a medium
// with a straight connection at one speed: a control vertex; in a medium otherwise: an ordinary connection; on a
// surface: an ordinary connection from where the walk meets it, a light vertex, or, glossy, reflected light one vertex
// before, weighted against each other and against emitters that the walk meets; specular, or none: emitters that the
// walk meets. Each way is a technique in src/path/techniques.

#include "path/GuidedPath.h"

namespace tungsten::path {

class GuidedVisitor : public transport::VisitorBase {
  public:
    GuidedVisitor(const GuidedContext& context, PixelAccumulator& sink, PathCounters& counters)
        : context_(&context), sink_(&sink), counters_(&counters) {}

    [[nodiscard]] bool mayGoOn(const PathState& path) const { return limits().mayGoOn(path.interactions); }
    bool ahead(PathState& path, StepsToEmitter& steps, const transport::Ahead& ahead);
    bool arrive(PathState& path, StepsToEmitter& steps, const transport::Ahead& ahead, const transport::Flight& flight);
    bool vertex(PathState& path, StepsToEmitter& steps, const transport::WalkVertex& vertex);

  private:
    [[nodiscard]] const transport::BounceLimits& limits() const { return context_->settings.limits; }
    [[nodiscard]] GuidedPath at(PathState& path, StepsToEmitter& steps) const {
        return {*context_, *sink_, *counters_, path, steps, behind_};
    }
    /// Connects the vertex at the ray's origin to light vertices and reflected light.
    void connectToLightCaches(const GuidedPath& path, const transport::Vertex& here);

    const GuidedContext* context_;
    PixelAccumulator* sink_;
    PathCounters* counters_;
    WayBehind behind_;
    StepsToEmitter::InMedium inMedium_{}; ///< of paths whose last vertex is where the walk is
};

/// Traces one camera path along `ray`, guided towards the target, at the window that the sink has been told.
void traceGuidedPath(const GuidedContext& context, PixelAccumulator& sink, PathCounters& counters,
                     const Sampler& sampler, const PathTarget& target, const Ray& ray, size_t window = 0);

} // namespace tungsten::path
