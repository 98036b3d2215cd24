#pragma once
// A camera subpath of the camera pass: straight through forward surfaces and along specular lobes. Its segments are
// shown to what gathers photons, or records where photons are wanted.

#include "transport/PlainSteps.h"

#include "tungsten/integrator/Names.h"
#include "tungsten/scene/Interaction.h"

namespace tungsten::photon {

/// Surfaces with glossy lobes alone: almost mirrors.
inline bool isGlossyOnly(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::Smooth) != 0 && (bsdf.lobes() & lobe::DiffuseReflection) == 0;
}

/// Surfaces that connections end on. Through a glossy lobe alone they find its peak too rarely: photons are left to it.
inline bool receivesConnections(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::DiffuseReflection) != 0;
}

/// What a camera path follows besides going straight on.
struct CameraSubpathRules {
    bool specular = true; ///< mirrors and refraction
    /// Surfaces that are glossy only, along a sampled direction. They look for light themselves; photons bring only
    /// what comes from lights through mirrors and refraction, or from lights of a single direction.
    bool glossy = false;

    [[nodiscard]] LobeMask followed(const Bsdf& bsdf) const {
        if (glossy && isGlossyOnly(bsdf)) return lobe::All;
        return specular ? lobe::Specular | lobe::Forward : lobe::Forward;
    }
};

/// Where a camera path has got to.
struct CameraSubpath {
    Ray ray;
    Region region;
    Rgb throughput{1.0f};
    double time = 0.0; ///< of flight from the camera to the ray's origin
    int interactions = 0;
    bool redirected = false; ///< a mirror, refraction or glossy surface lies behind
    bool glossy = false;     ///< a glossy surface lies behind
    float glossyPdf = 0.0f; ///< of the ray's direction, per solid angle, if the path has only gone straight since there
    Vec3f glossyVertex{0.0f};
};

/// What following a path took.
struct CameraSubpathCounters : transport::StepCounters {
    uint64_t glossy = 0; ///< glossy: surfaces left along a glossy lobe

    CameraSubpathCounters& operator+=(const CameraSubpathCounters& other) {
        StepCounters::operator+=(other);
        glossy += other.glossy;
        return *this;
    }
};

/// Shows what lies ahead of `state`, up to `hit` if there is one. What is shown it has
///   segment(state, hit): the ray ahead, up to the surface if there is one, in state.region
///   surface(state, interaction): the end of the segment; the throughput includes the way there, the time does not
///   escaped(state)
template <typename Shown>
void visitSegment(const Scene& scene, CameraSubpath& state, const std::optional<SurfaceHit>& hit, Shown&& shown) {
    shown.segment(state, hit);
    if (const Medium* medium = scene.medium(state.region))
        state.throughput = state.throughput * medium->transmittance(hit ? hit->t : Infinity);
    if (!hit) shown.escaped(state);
    if (!hit || isBlack(state.throughput)) return;
    shown.surface(state, makeInteraction(scene, *hit, state.ray.direction));
}

/// Shows the same of the legs of a walk, as it goes on.
template <typename Shown>
class SegmentVisitor : public transport::VisitorBase {
  public:
    SegmentVisitor(const Scene& scene, const CameraSubpathRules& rules, CameraSubpathCounters& counters, Shown& shown)
        : limits_(scene.transport), rules_(rules), counters_(&counters), shown_(&shown) {}

    [[nodiscard]] bool mayGoOn(const transport::PathState& path) const { return limits_.mayGoOn(path.interactions); }
    bool ahead(transport::PathState& path, auto&, const transport::Ahead& ahead) {
        state_.ray = path.ray;
        state_.region = path.region;
        state_.throughput = path.throughput;
        state_.time = path.time;
        state_.interactions = path.interactions;
        shown_->segment(state_, ahead.hit);
        return true;
    }
    void escape(transport::PathState& path) {
        state_.throughput = path.throughput;
        shown_->escaped(state_);
    }
    bool vertex(transport::PathState& path, auto& steps, const transport::WalkVertex& at) {
        state_.throughput = path.throughput;
        shown_->surface(state_, *at.surface);
        steps.lobes = rules_.followed(*at.surface->bsdf);
        return true;
    }
    void leave(transport::PathState&, auto&, const transport::WalkVertex& at, const transport::Way& way) {
        if (way.straight()) return;
        state_.redirected = true;
        state_.glossyPdf = way.pdf;
        if (!way.smooth()) return;
        ++counters_->glossy;
        state_.glossy = true;
        state_.glossyVertex = at.position;
    }

  private:
    transport::BounceLimits limits_;
    CameraSubpathRules rules_;
    CameraSubpathCounters* counters_;
    Shown* shown_;
    CameraSubpath state_; ///< of the leg
};

/// Follows a path along `ray` from the camera, and shows its legs (visitSegment).
template <typename Shown>
CameraSubpathCounters followCameraSubpath(const Scene& scene, const Ray& ray, const CameraSubpathRules& rules,
                                          const Sampler& sampler, Shown&& shown, const ProgressToken& watch = {}) {
    CameraSubpathCounters counters;
    transport::Walk walk{transport::PathState{.random = sampler, .ray = ray, .region = scene.cameraRegion},
                         transport::StraightSteps<TransportMode::Radiance>({scene, counters, watch}),
                         SegmentVisitor(scene, rules, counters, shown)};
    walk.run();
    return counters;
}

inline void report(const CameraSubpathCounters& steps, Statistics& statistics) {
    statistics.add(counter::Rays, steps.rays);
    statistics.add(counter::GlossyCameraReflections, steps.glossy);
    transport::reportSteps(steps, statistics);
}

/// Looks at surfaces alone: `visit(state, interaction)`.
template <typename Visit>
struct SurfaceVisitor {
    Visit visit;
    void segment(const CameraSubpath&, const std::optional<SurfaceHit>&) const {}
    void surface(const CameraSubpath& state, const SurfaceInteraction& surface) const { visit(state, surface); }
    void escaped(const CameraSubpath&) const {}
};
template <typename Visit>
SurfaceVisitor(Visit) -> SurfaceVisitor<Visit>;

} // namespace tungsten::photon
