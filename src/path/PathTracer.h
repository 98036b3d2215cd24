#pragma once
// The integrators `path_tracer` and `transient_path_tracer`: unbiased, steady state or time-resolved.

#include "path/GuidedPath.h"
#include "path/PathPlan.h"
#include "path/PathVisitor.h"
#include "path/SampleAllocation.h"
#include "path/Tuning.h"
#include "path/techniques/LightCaches.h"
#include "path/techniques/RefractiveConnections.h"
#include "transport/DetectorLight.h"
#include "transport/SharePilot.h"
#include "tungsten/scene/LightChoice.h"

#include "tungsten/integrator/Integrator.h"

namespace tungsten::path {

/// What was counted, by whose work it was: of plain paths, of their densities, of guided paths.
struct StrategyCounters {
    PathCounters plain, densities, guided;
};

class PathTracer : public Integrator {
  public:
    PathTracer(std::shared_ptr<const Scene> scene, const ObjectReader& settings);
    void plan(SceneFacts& facts, Features& features) const override;
    void prepare(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics) override;
    void renderPass(const PassInfo& pass, Film& film, Statistics& statistics) override;

  private:
    void prepareGuides(const SceneFacts& facts, const ProgressToken& watch, Statistics& statistics);
    [[nodiscard]] bool guides() const { return plan_.guidance.on && balance_.guided > 0.0f; }
    /// Points that the paths of the pass aim at.
    [[nodiscard]] const TargetChoice& targets() const { return guides() ? *targets_ : *sources_; }
    /// Measures how much pixels vary, by pairs of paths as they are now, at this part of the cost of a pilot of shares.
    [[nodiscard]] SampleAllocation measureSamples(const ProgressToken& watch, Statistics& statistics,
                                                  double part) const;
    /// Shares samples out, and takes improved plain paths where they are worth more than what was chosen.
    void allocateSamples(const ProgressToken& watch, Statistics& statistics);
    /// Plain paths alone may have lights in view in expectation and weight windows. What a pilot finds better is left
    /// in place; otherwise the chosen balance stays.
    void improvePlainPaths(const ProgressToken& watch, Statistics& statistics);
    /// Some ray of a pilot meets a light through a medium in time.
    [[nodiscard]] bool seesLights(const ProgressToken& watch) const;
    [[nodiscard]] WeightWindows learnWindows(const ProgressToken& watch, Statistics& statistics) const;
    /// use(trace) of the paths that the plan and the shares ask for: trace(ray, sink, counters, sampler, u, strategy)
    /// traces one; u chooses among targets, and strategy, uniform too, among strategies.
    template <typename Use>
    void withPaths(const ProgressToken& watch, const Use& use) const;
    template <typename Use>
    void withPlainPaths(const PathContext& context, const Use& use) const;
    template <bool TimeResolved, bool Media>
    void tracePlain(const PathContext& context, const Ray& ray, PixelAccumulator& sink, PathCounters& counters,
                    Sampler& sampler, float u) const;
    template <typename Use>
    void withGuidedPaths(const ProgressToken& watch, const Use& use) const;
    [[nodiscard]] GuidedContext guidedContext(const ProgressToken& watch) const;
    [[nodiscard]] PathContext plainContext(const ProgressToken& watch) const;
    /// The window of time is chosen by the first number, the target by the second.
    void traceGuided(const GuidedContext& guided, float uWindow, float uTarget, const Ray& ray, PixelAccumulator& sink,
                     PathCounters& counters, Sampler& sampler) const;
    /// How many paths are plain: by a pilot, unless the scene says (darts.plain_share).
    void chooseShare(const ProgressToken& watch, Statistics& statistics);
    /// Cost of what was counted, in nanoseconds.
    [[nodiscard]] double cost(const PathCounters& counters, const tuning::Costs::Walk& each) const;
    [[nodiscard]] PathCosts costs(const StrategyCounters& counters) const;
    /// For every sample of every pixel.
    template <typename Trace>
    void renderTiles(const PassInfo& pass, Film& film, Statistics& statistics, const Trace& trace) const;

    /// Adds, for one sample of a pixel, what its detector gets from lights that rays do not meet: by light that nothing
    /// has scattered, or from where light of a single direction is scattered first.
    void addDetectorLight(int column, float u, PixelAccumulator& sink, const ProgressToken& watch,
                          PathCounters& counters, Sampler sampler) const;

    std::shared_ptr<const Scene> scene_;
    PathSettings settings_;
    transport::TimeSensor sensor_;
    std::optional<LightChoice> lights_; ///< from prepare() on
    PathPlan plan_;
    std::optional<TargetChoice> targets_; ///< of guided paths
    std::optional<TargetChoice> sources_; ///< of plain ones: of light that starts in a single direction
    std::optional<ArrivalBound> bound_;
    std::optional<transport::TimeWindows> windows_; ///< that guided paths aim at
    PathGuides guides_;
    StrategyBalance balance_;
    bool looksThrough_ = false;  ///< connections look through index-matched surfaces
    double gainOfBalance_ = 1.0; ///< variance x cost of plain paths alone over that at this balance, by the pilot
    SampleAllocation allocation_;
    bool lightsInView_ = false;                                   ///< of plain paths alone: in expectation
    WeightWindows weightWindows_;                                 ///< of plain paths alone
    std::unique_ptr<const transport::EscapeModels> escapeModels_; ///< null: media are taken for infinite
    LightCaches lightCaches_;                                     ///< of the pass
    std::optional<RefractiveConnections> refracted_;              ///< of plain paths in sealed scenes
    std::optional<transport::DetectorLight> detectorLight_;       ///< where plan_.detectorLight is on
};

} // namespace tungsten::path
