#include "path/PathTarget.h"

#include "transport/PlainSteps.h"

#include "tungsten/scene/LightChoice.h"

namespace tungsten::path {

namespace {

Distribution1D targetDistribution(const Scene& scene, TargetChoice::Emitters emitters,
                                  const std::vector<bool>& leftOut) {
    if (emitters == TargetChoice::Emitters::SingleDirections)
        return emitterDistribution(
            scene, [](const Emitter& emitter) { return emitter.isDelta(); }, leftOut);
    return emitterDistribution(
        scene, [](const Emitter& emitter) { return !emitter.isInfinite(); }, leftOut);
}

} // namespace

TargetChoice::TargetChoice(const Scene& scene, Emitters emitters, const std::vector<bool>& leftOut, bool ofVertices)
    : scene_(scene), distribution_(targetDistribution(scene, emitters, leftOut)), ofVertices_(ofVertices) {
    for (const Emitter& emitter : scene.emitters) radii_.push_back(2.0f * boundingSphere(emitter).radius);
    for (size_t i = 0; any() && i < radii_.size(); ++i) {
        if (!(probability(i) > 0.0f)) continue;
        ++count_;
        if (scene.emitters[i].isDelta()) singleDirections_.push_back(i);
    }
}

bool TargetChoice::hasOtherPoints(const PathTarget& target) const {
    return target.u && target.index >= 0 && !target.emitter->isDelta() && radii_[size_t(target.index)] > 0.0f;
}

/// A lattice of rank 1: k / Points (1, 5) modulo 1.
Vec2f TargetChoice::otherPoint(const Vec2f& u, size_t k) {
    const auto shifted = [](float x, size_t steps) {
        const float shift = float(steps % Points) / float(Points);
        return x < 1.0f - shift ? x + shift : x - (1.0f - shift); // no digit is lost
    };
    return {shifted(u.x, k), shifted(u.y, 5 * k)};
}

PathTarget TargetChoice::at(size_t index, const SurfaceSample& point) const {
    const Emitter& emitter = scene_.emitters[index];
    return {{transport::Vertex(scene_, emitter, point), Rgb(1.0f / probability(index))},
            &emitter,
            int(index),
            choice(index),
            emitter.emissionTime,
            std::nullopt,
            radii_[index]};
}

std::optional<PathTarget> TargetChoice::of(size_t index, Sampler& sampler, const ProgressToken& watch,
                                           PathCounters& counters) const {
    const Emitter& emitter = scene_.emitters[index];
    const Vec2f uPosition = sampler.next2D();
    PathTarget target = at(index, uPosition);
    if (!emitter.isDelta()) return target;
    target.emitterRadius = 0.0f;
    return scatterLaser(target, sampleEmission(emitter, uPosition, {0.5f, 0.5f}), sampler, watch, counters);
}

namespace {

/// Light on its straight or specular way from an emitter becomes a virtual source where it scatters first; where it may
/// also go on along a specular or forward lobe, by chance.
struct FirstScattering : transport::VisitorBase {
    FirstScattering(const Scene& scene, PathTarget& target)
        : scene_(&scene), limits_(scene.transport), target_(&target) {}

    [[nodiscard]] bool mayGoOn(const PathState& path) const { return limits_.mayGoOn(path.interactions + 1); }
    bool vertex(PathState& path, auto& steps, const transport::WalkVertex& at) {
        if (at.surface) {
            const LobeMask lobes = at.surface->bsdf->lobes();
            steps.lobes = lobes & (lobe::Specular | lobe::Forward);
            const float scatters = (lobes & lobe::Smooth) == 0 ? 0.0f : steps.lobes == 0 ? 1.0f : 0.5f;
            path.random.at(path.interactions, Draw::Roulette);
            if (!(path.random.next1D() < scatters)) {
                path.throughput = path.throughput / (1.0f - scatters);
                return steps.lobes != 0;
            }
            path.throughput = path.throughput / scatters;
        }
        target_->vertex = at.connectible(*scene_, TransportMode::Photons);
        target_->power = path.throughput;
        target_->start = path.time;
        target_->interactions = path.interactions;
        target_->mediumScatters = path.mediumScatters;
        found = true;
        return false;
    }

    bool found = false;

  private:
    const Scene* scene_;
    transport::BounceLimits limits_;
    PathTarget* target_;
};

} // namespace

std::optional<PathTarget> TargetChoice::scatterLaser(PathTarget target, const EmissionSample& emission,
                                                     const Sampler& sampler, const ProgressToken& watch,
                                                     PathCounters& counters) const {
    target.index = -1;
    const PathState start{.random = sampler,
                          .ray = emission.ray,
                          .region = scene_.regionOf(*target.emitter),
                          .throughput = emission.power / target.choice.ofPath,
                          .time = target.start};
    if (isBlack(start.throughput)) return std::nullopt;
    transport::StepCounters own; // what happens on light's own path is not counted
    transport::PlainLightSteps onward({scene_, own, watch});
    onward.checks = false;
    transport::Walk walk{start, onward, FirstScattering(scene_, target)};
    walk.run();
    counters.rays += own.rays;
    return walk.visitor.found ? std::optional(target) : std::nullopt;
}

} // namespace tungsten::path
