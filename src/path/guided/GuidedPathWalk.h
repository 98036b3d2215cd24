#pragma once
// One path from the camera, guided towards one target (docs/method.md, sections 3 to 6): elliptical control vertices in
// media, resampled distances and directions, ordinary connections from surfaces.
//
// Every path is found in one way or by weighted ways, told apart by the last vertex before the emitter: in a medium
// with a straight connection at one speed: a control vertex; in a medium otherwise: an ordinary connection; on a
// surface: an ordinary connection from where the walk meets it, a light vertex, or, glossy, reflected light one vertex
// before, weighted against each other and against emitters that the walk meets; specular, or none: emitters that the
// walk meets.

#include "path/ArrivalBound.h"
#include "path/CameraPath.h"
#include "path/PathSettings.h"
#include "path/PathTarget.h"
#include "path/techniques/LightPaths.h"

#include "darts/Guide.h"

#include "transport/WaysOut.h"

namespace tungsten::path {

/// Sampling by medium.
struct PathGuides {
    std::vector<darts::Guide> media;    ///< for scattering in it, and flights
    std::vector<darts::Guide> surfaces; ///< for leaving a surface into it
    std::vector<darts::Guide> glossy;   ///< the same for surfaces without diffuse lobes
    std::vector<darts::Guide> view;     ///< for flights from the camera
    std::vector<darts::Guide> plain;    ///< bounds in time alone, where refraction hides where light goes
};

/// What guided walks share.
struct GuidedContext {
    const Scene& scene;
    const PathSettings& settings;
    const transport::Sensor& sensor;
    const PathGuides& guides;
    const LightPaths& lightPaths;
    const ArrivalBound& arrival;
    const transport::WaysOut* waysOut; ///< null: media are taken for infinite
    bool forwardBoundaries;            ///< connections must look through index-matched surfaces
};

class ShellChord;

class GuidedPathWalk : private CameraPath {
  public:
    GuidedPathWalk(const GuidedContext& context, PixelSink& sink, PathCounters& counters, Sampler sampler)
        : CameraPath(context.scene, sink, counters, sampler), context_(context) {}

    void run(const Ray& ray, const PathTarget& target);

  private:
    /// The last vertex before what comes next, for emitters that the walk meets.
    enum class Last { Specular, Surface, Medium };
    /// The control vertex of a connection drawn before the direction that was to suit it. It holds for the whole
    /// straight way, through boundaries too.
    struct Pending {
        darts::ControlVertex vertex; ///< at a distance from the ray's origin
        double arrival = 0.0;        ///< total time of flight of its connection
    };
    /// How the control vertex of a straight way was drawn, where ordinary connections share with it (balance
    /// heuristic): in bodies that light must leave, whose directions do not follow the connections' weights so closely.
    struct Drawn {
        const darts::Guide* guide = nullptr; ///< none: it does not share
        darts::Residual residual;            ///< of the connection's length
        float h = 0.0f;
        float behind = 0.0f; ///< distance from where it was drawn to the ray's origin
    };
    /// From a vertex to the target.
    struct Straight {
        Vec3f direction;
        float distance;
    };
    /// A vertex's scattering towards a direction (cosine included) and the density of its own sampling, per solid
    /// angle.
    struct Scattering {
        Rgb value{0.0f};
        float pdf = 0.0f;
    };

    // Flights. False ends the path.
    void goOn();
    bool crossMedium(const Medium& medium);
    bool crossUntimed(const Medium& medium);
    bool crossEmpty();
    std::optional<float> sampleUntimed(const Medium& medium, const ShellChord& inTime);
    [[nodiscard]] bool mayFly(const Medium* medium) const { return !medium || flights_ < medium->maxBounces; }
    /// What may still come from `position`, at the present time and in the present region.
    void lookAhead(const Vec3f& position);
    /// How light gets from here to the target; once, before anything is sampled.
    void lookOut(const transport::Start& start);
    void startRoulette(const darts::Guide& guide);
    bool roulette(const darts::Guide& guide);
    /// See darts::Splits; the copies share the throughput, goOn(copy) is each one's rest.
    template <typename GoOn>
    void split(const darts::Guide& guide, GoOn&& goOn);

    // Vertices. False ends the path.
    bool scatterInMedium(const Medium& medium, float distance);
    /// From a vertex in the medium, reached in the direction `before`.
    bool leaveInMedium(const Medium& medium, const Vec3f& before);
    bool scatterOnSurface(const SurfaceHit& hit);
    [[nodiscard]] const darts::Guide* guideFor(const SurfaceInteraction& surface, const Vec3f& back) const;
    bool leavePlainly(const SurfaceInteraction& surface);
    bool leaveGuided(const SurfaceInteraction& surface, const darts::Guide& guide);
    void passBoundary(const SurfaceInteraction& surface, const Vec3f& direction, bool straight);
    darts::ConnectionSample drawConnection(const darts::Guide& guide, const darts::Residual& residual);
    /// Draws the next direction, and before it, where the settings say so, the control vertex on it.
    template <typename Scatterer>
    darts::DirectionSample sampleDirection(const darts::Guide& guide, const Scatterer& scatterer);
    /// A straight way starts whose control vertex has not been drawn.
    void forgetConnection() {
        connectionDrawn_ = false;
        pending_.reset();
        drawn_.guide = nullptr;
    }

    // Ways to find light.
    void connectElliptically(const Medium& medium, const darts::Guide& guide, float h, float surface);
    void connectUntimed(const Medium& medium, float surface);
    void addControlVertex(const Medium& medium, const darts::ControlVertex& vertex, double arrival);
    /// An ordinary connection from the ray's origin, less the part that control vertices bring.
    void connectFromMedium(const Medium& medium, float controlShare);
    /// The part of a path with a vertex in the medium at `distance` along the ray that control vertices bring.
    [[nodiscard]] float shareOfControlVertex(const Medium& medium, float distance) const;
    /// Light by way of a light vertex, and by way of light that a glossy surface reflects, from the ray's origin: on
    /// `surface`, or in the medium if there is none.
    void connectToLightPaths(const SurfaceInteraction* surface);
    void connectToLightVertex(const SurfaceInteraction* surface);
    void connectToReflectedLight(const SurfaceInteraction* surface);
    [[nodiscard]] Scattering scatteringTowards(const Vec3f& direction, const SurfaceInteraction* surface) const;
    /// Light that the surface at the end of the ray emits or scatters straight from the target; `throughput` includes
    /// the way there.
    void findAt(const SurfaceHit& hit, const Rgb& throughput);
    void connectFromSurface(const SurfaceInteraction& surface, const Straight& way, const Rgb& throughput);
    void addEmission(const SurfaceHit& hit, const Rgb& throughput);
    /// The part of a connection from the surface that is not left to light vertices and reflected light.
    [[nodiscard]] float shareOfWalk(const SurfaceInteraction& surface, const Straight& way) const;
    /// Density of the reflected light tried one vertex before, at the ray's origin and a light vertex of density
    /// `areaPdf` at distance `flight` in direction `direction`, over the walk's density at the ray's origin.
    [[nodiscard]] float reflectedDensity(const SurfaceInteraction& glossy, const Vec3f& direction, float flight,
                                         const Vec3f& toLight, float areaPdf) const;

    [[nodiscard]] Straight straightFrom(const Vec3f& position) const;
    /// The part of a ray to the target on which something may be in the way.
    [[nodiscard]] Ray toTarget(Ray ray, const Straight& way) const;
    /// From the ray's origin, on `surface` if there is one, up to `reach`.
    [[nodiscard]] Ray leave(const SurfaceInteraction* surface, const Vec3f& direction, float reach) const;
    [[nodiscard]] bool mayConnect(double time, float distance) const {
        return distance > 0.0f && context_.arrival.mayConnect(time, distance, target_->start);
    }
    /// Total time of flight of a connection from the ray's origin.
    [[nodiscard]] double arrivalOf(const darts::ConnectionSample& connection) const;
    [[nodiscard]] double timeAfter(float length) const {
        return timed() ? time_ + double(length) / double(region_.speed) : time_;
    }
    [[nodiscard]] const darts::Guide& guideOf(const Region& region) const {
        return (residual_.exit.connects ? context_.guides.media : context_.guides.plain)[size_t(region.medium)];
    }
    [[nodiscard]] bool sharesConnections() const {
        return residual_.way != darts::Way::Through && !context_.sensor.gate.delta;
    }
    [[nodiscard]] bool elliptical(const darts::Guide& guide) const { return guide.settings().elliptical; }
    /// Whether a path with this many further interactions and medium scatters counts.
    [[nodiscard]] bool counts(int interactions, int mediumScatters) const;
    [[nodiscard]] float next() { return sampler_.next1D(); }

    const GuidedContext& context_;
    const PathTarget* target_ = nullptr;
    Last last_ = Last::Specular;
    float scatteringPdf_ = 0.0f;    ///< of the last vertex's own sampling, for the present direction
    Vec3f vertex_{0.0f};            ///< the last vertex on a surface
    bool lightVertexTried_ = false; ///< at the ray's origin
    bool reflectedTried_ = false;   ///< there
    /// The walk's own density at the ray's origin, per area or volume, if reflected light was tried at the vertex
    /// before and may end here; else 0.
    float arrivalPdf_ = 0.0f;
    Vec3f arrivalNormal_{0.0f};    ///< of the surface at the ray's origin, on the side of the vertex before; 0 in media
    darts::Residual residual_;     ///< at the ray's origin, towards the target
    darts::Residual reachable_;    ///< the same for everything the walk may find: whole emitters, at the highest speed
    bool connectionDrawn_ = false; ///< this straight way's control vertex is pending, behind, or void
    std::optional<Pending> pending_;
    Drawn drawn_;
    float surplus_ = 0.0f;         ///< of reachable_ over residual_, a length
    bool lookedOut_ = false;       ///< residual_.way is chosen
    float firstUsefulness_ = 0.0f; ///< logarithm, since the model of what comes is the present one
    bool rouletteStarted_ = false;
    darts::Splits splits_;
    int rouletteMedium_ = -1;
    darts::Way rouletteWay_ = darts::Way::Through;
};

} // namespace tungsten::path
