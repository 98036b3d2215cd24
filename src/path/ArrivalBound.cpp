#include "path/ArrivalBound.h"

#include "transport/TimeSensor.h"

namespace tungsten::path {

namespace {

constexpr size_t MostSources = 8;

} // namespace

ArrivalBound::Source ArrivalBound::sourceOf(const Emitter& emitter) {
    const BoundingSphere sphere = boundingSphere(emitter);
    return {sphere.centre, sphere.radius, emitter.emissionTime};
}

ArrivalBound::Source ArrivalBound::merged(const std::vector<Source>& sources) {
    Source all{Vec3f(0.0f), 0.0f, std::numeric_limits<double>::infinity()};
    for (const Source& source : sources) {
        all.centre += source.centre / float(sources.size());
        all.emissionTime = std::min(all.emissionTime, source.emissionTime);
    }
    for (const Source& source : sources)
        all.radius = std::max(all.radius, (source.centre - all.centre).length() + source.radius);
    return all;
}

ArrivalBound::ArrivalBound(const Scene& scene, const SceneFacts& facts)
    : bounds_(transport::RecordingDelays::of(scene).arrivals(scene.transport.gate), facts),
      highestSpeed_(facts.highestSpeed), surfacesTurn_(facts.surfaceScattering || facts.specularCameraSubpaths) {
    // Environments never arrive; single directions are never found.
    for (size_t i = 0; i < scene.emitters.size(); ++i) {
        const Emitter& emitter = scene.emitters[i];
        const bool late = !facts.excludedEmitters.empty() && facts.excludedEmitters[i];
        if (!late && !emitter.isInfinite() && !emitter.isDelta()) sources_.push_back(sourceOf(emitter));
    }
    if (sources_.size() > MostSources) sources_ = {merged(sources_)};
    for (Source& source : sources_) source.radius += 1e-6f * (source.centre.length() + source.radius);
}

bool ArrivalBound::mayArrive(const Vec3f& position, double time) const {
    for (const Source& source : sources_) {
        const float gap = std::max((position - source.centre).length() - source.radius, 0.0f);
        if (beforeEnd(time, gap, source.emissionTime)) return true;
    }
    return false;
}

} // namespace tungsten::path
