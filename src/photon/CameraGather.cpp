#include "photon/CameraGather.h"

namespace tungsten::photon {

void CameraGather::add(const Rgb& radiance, double time) {
    const int frame = structures_.sensor.frameOf(time);
    if (frame >= 0) add(radiance * structures_.sensor.weight(time), frame);
}
void CameraGather::add(const Rgb& radiance, int frame) {
    workspace_.sums[size_t(frame)] += Vec3d(double(radiance.x), double(radiance.y), double(radiance.z));
}

void CameraGather::addVolume(const Rgb& scale, uint64_t gathered) {
    counters_.gatheredInVolumes += gathered;
    const Vec3d weight(double(scale.x), double(scale.y), double(scale.z));
    for (size_t frame = 0; frame < workspace_.sums.size(); ++frame)
        workspace_.sums[frame] += workspace_.volume[frame] * weight;
}

template <typename Visit>
void CameraGather::gatherVolume(const CameraSubpath& state, const std::optional<SurfaceHit>& hit, const Visit& visit) {
    if (!scene_.medium(state.region)) return;
    const CameraSegment segment{
        state.ray.origin,   state.ray.direction, hit ? hit->t : Infinity, state.time, 1.0 / double(state.region.speed),
        state.interactions, state.region.medium};
    std::visit(Overloaded{[](std::monostate) {},
                          [&](const auto& gather) {
                              std::fill(workspace_.volume.begin(), workspace_.volume.end(), Vec3d(0.0));
                              const uint64_t gathered = visit(gather, segment);
                              if (gathered > 0) addVolume(state.throughput * gather.scale(), gathered);
                          }},
               structures_.volume);
}

void CameraGather::segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
    if (structures_.splatted && (!state.redirected || oversampled_)) return;
    gatherVolume(state, hit, [&](const auto& gather, const CameraSegment& segment) {
        return gather.gather(segment, state.redirected, workspace_.volume);
    });
}

void CameraGather::segmentPart(const CameraSubpath& state, const std::optional<SurfaceHit>& hit, uint32_t part) {
    if (!structures_.splatted || !state.redirected) return;
    gatherVolume(state, hit, [&](const auto& gather, const CameraSegment& segment) {
        return gather.gatherPart(segment, part, workspace_.volume);
    });
}

void CameraGather::surface(const CameraSubpath& state, const SurfaceInteraction& surface) {
    if (!structures_.includeSurfaces) return;
    if (surface.primitive->emitter >= 0 && !state.glossy) addEmission(state, surface, 1.0f);
    if (structures_.glossy && !oversampled_) highlight(state, surface, 1.0f);
    if (structures_.surfaces && (surface.bsdf->lobes() & lobe::Smooth) != 0) gatherSurface(state, surface);
}

void CameraGather::highlight(const CameraSubpath& state, const SurfaceInteraction& surface, float share) {
    if (surface.primitive->emitter >= 0 && state.glossy)
        addEmission(state, surface, share * structures_.glossy->emissionWeight(state, surface));
    if (!isGlossyOnly(*surface.bsdf)) return;
    const auto light = structures_.glossy->connect(structures_.sensor, state, surface, lights_, counters_.steps.rays);
    if (light) add(light->radiance * share, light->time);
}

void CameraGather::escaped(const CameraSubpath& state) {
    if (!structures_.includeSurfaces || scene_.infiniteEmitters.empty() || scene_.medium(state.region) ||
        state.glossy || !rendered(state.interactions))
        return;
    const Emitter& environment = scene_.emitters[size_t(scene_.infiniteEmitters.back())];
    add(state.throughput * environmentRadiance(environment, state.ray.direction), Infinity);
}

void CameraGather::addEmission(const CameraSubpath& state, const SurfaceInteraction& surface, float weight) {
    if (!rendered(state.interactions)) return;
    const SurfaceHit& hit = surface.hit;
    const Emitter& emitter = scene_.emitters[size_t(surface.primitive->emitter)];
    const Rgb radiance = emittedRadiance(emitter, hit.uv, hit.ng, -state.ray.direction);
    const double time = state.time + double(hit.t) / double(state.region.speed);
    const double arrival = emitter.emissionTime + (scene_.transport.cameraUnwarped ? 0.0 : time);
    const Rgb seen = state.throughput * radiance * (weight * structures_.sensor.weight(arrival));
    structures_.sensor.spread(arrival, emitter, [&](int frame, float share) { add(seen * share, frame); });
}

void CameraGather::gatherSurface(const CameraSubpath& state, const SurfaceInteraction& surface) {
    const auto& photons = structures_.surfacePhotons.records;
    auto& neighbours = workspace_.neighbours;
    const float squaredRadius =
        sqr(structures_.kernel) * structures_.surfaces->find(surface.hit.position, structures_.surfaceRadius,
                                                             structures_.gatherCount, neighbours);
    if (!(squaredRadius > 0.0f)) return;
    // The k-th has set the radius and lies on it: (k - 1) / (pi r^2) is right on average, k / (pi r^2) is k / (k - 1)
    // times that. Where there are fewer the radius is a fixed one.
    if (neighbours.size() == structures_.gatherCount)
        neighbours.erase(std::max_element(neighbours.begin(), neighbours.end()));
    counters_.gathered += neighbours.size();
    const float scale = structures_.surfacePhotons.scale() * InvPi / squaredRadius;
    const BsdfQuery query = surface.query(TransportMode::Radiance, lobe::Smooth);
    for (const auto& neighbour : neighbours) {
        if (structures_.kernel < 1.0f && neighbour.squaredDistance > squaredRadius) continue;
        const Photon& photon = photons[neighbour.index];
        if (isBlack(photon.power) || !rendered(state.interactions + photon.bounce)) continue; // densityPhotons
        const Vec3f wo = surface.frame.toLocal(-photon.direction);
        if (wo.z == 0.0f) continue;
        const Rgb scattering = surface.bsdf->eval(query, surface.wi, wo) / std::abs(wo.z);
        // Camera time up to the start of this segment; each photon adds its own distance to it.
        const double own = double((photon.position - state.ray.origin).length()) / double(state.region.speed);
        add(state.throughput * photon.power * scattering * scale,
            photon.time + (scene_.transport.cameraUnwarped ? 0.0 : state.time + own));
    }
}

} // namespace tungsten::photon
