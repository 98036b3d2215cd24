#pragma once
// One path from the camera, guided towards one target (docs/method.md, sections 3 to 6): elliptical control vertices in
// media, resampled distances and directions, ordinary connections from surfaces.
//
// Every path is found in one way or by weighted ways, told apart by the last vertex before the emitter: in a medium
// with a straight connection at one speed: a control vertex; in a medium otherwise: an ordinary connection; on a
// surface: an ordinary connection from where the walk meets it, a light vertex, or, glossy, reflected light one vertex
// before, weighted against each other and against emitters that the walk meets; specular, or none: emitters that the
// walk meets. Each way is a technique in src/path/techniques.

#include "path/GuidedPath.h"
#include "path/techniques/LightPaths.h"

namespace tungsten::path {

class ShellChord;

class GuidedPathWalk {
  public:
    GuidedPathWalk(const GuidedContext& context, PixelSink& sink, PathCounters& counters, const Sampler& sampler)
        : context_(context), scene_(context.scene), path_(context, sink, counters, sampler) {}

    void run(const Ray& ray, PathTarget target);

  private:
    // Flights. False ends the path.
    void goOn();
    bool crossMedium(const Medium& medium);
    bool crossUntimed(const Medium& medium);
    bool crossEmpty();
    std::optional<float> sampleUntimed(const Medium& medium, const ShellChord& inTime, float probability);
    /// Light that the surface at the end of the ray emits or scatters straight from the target; `throughput` includes
    /// the way there.
    void findAt(const SurfaceHit& hit, const Rgb& throughput);

    // Stages of a step (transport::GuidedSteps).
    /// What may still come from `position`, at the present time and in the present region.
    void lookAhead(const Vec3f& position);
    /// How light gets from here to the target; once, before anything is sampled.
    void lookOut(const transport::Start& start);
    /// A walk that enters a body chooses among points of its emitter by how much of their light gets out to it in time.
    void chooseTarget();
    /// The target's usefulness from the ray's origin, per area of its emitter; logarithm, NoUse if there is none.
    [[nodiscard]] float logUsefulTarget();
    /// False ends the path.
    bool survives(const darts::Guide& guide);
    /// The copies share the throughput, goOn(copy) is each one's rest.
    template <typename GoOn>
    void split(const darts::Guide& guide, GoOn&& goOn);
    /// Draws the next direction, and before it, where the settings say so, the control vertex on it.
    template <typename Scatterer>
    darts::DirectionSample sampleDirection(const darts::Guide& guide, const Scatterer& scatterer);

    // Vertices. False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    /// From a vertex in the medium, reached in the direction `before`.
    bool leaveInMedium(const Medium& medium, const Vec3f& before);
    bool scatterOnSurface(const SurfaceHit& hit);
    bool leavePlainly(const SurfaceInteraction& surface);
    bool leaveGuided(const transport::Vertex& here, const darts::Guide& guide);
    void passBoundary(const SurfaceInteraction& surface, const Vec3f& direction, bool straight);
    /// To a vertex that the walk came to with this density, per area or volume; `normal` as in Approach. What has been
    /// connected to along the way is over.
    void arrive(float pdf, const Vec3f& normal);
    /// By light vertices and reflected light, from the vertex at the ray's origin.
    void connectToLightPaths(const transport::Vertex& here);

    const GuidedContext& context_;
    const Scene& scene_;
    GuidedPath path_;
    PathTarget* target_ = nullptr; ///< path_.target, until it is final
};

} // namespace tungsten::path
