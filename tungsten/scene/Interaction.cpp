#include "tungsten/scene/Interaction.h"

#include "tungsten/bsdf/ShadingFrame.h"

namespace tungsten {

Region Scene::regionOf(const Emitter& emitter) const {
    if (emitter.medium >= 0) return {emitter.medium, media[size_t(emitter.medium)].speedOfLight};
    return {-1, emitter.vacuumSpeed > 0.0f ? emitter.vacuumSpeed : transport.vacuumSpeed};
}

float SurfaceInteraction::photonShadingFactor(const Vec3f& worldWi, const Vec3f& worldWo) const {
    const float numerator = worldWo.dot(hit.ng) * worldWi.dot(frame.n);
    const float denominator = worldWi.dot(hit.ng) * worldWo.dot(frame.n);
    return denominator == 0.0f ? 0.0f : std::abs(numerator / denominator);
}

bool SurfaceInteraction::consistent(const Vec3f& worldWo, bool checksOn) const {
    if (!checksOn) return true;
    // The frame may be flipped toward the ray; compare with the geometric normal flipped in the same sense.
    const float side = hit.ng.dot(frame.n) < 0.0f ? -1.0f : 1.0f;
    return (worldWo.dot(frame.n) >= 0.0f) == (side * worldWo.dot(hit.ng) >= 0.0f);
}

SurfaceInteraction makeInteraction(const Scene& scene, const SurfaceHit& hit, const Vec3f& rayDirection) {
    SurfaceInteraction interaction;
    interaction.hit = hit;
    interaction.primitive = &scene.primitives[hit.shape];
    interaction.bsdf = &scene.bsdfOf(hit);
    interaction.frame = interaction.bsdf->bump
                            ? bumpedFrame(*interaction.bsdf, hit.ns, scene.geometry->tangents(hit), hit.uv)
                            : Frame(hit.ns);
    const bool transmissive = (interaction.bsdf->lobes() & lobe::Transmissive) != 0;
    if (scene.transport.twoSidedShading && !transmissive && rayDirection.dot(hit.ng) > 0.0f) {
        interaction.frame.n = -interaction.frame.n;
        interaction.frame.s = -interaction.frame.s;
    }
    interaction.wi = interaction.frame.toLocal(-rayDirection);
    return interaction;
}

std::optional<BsdfDirection> sampleBsdf(const SurfaceInteraction& surface, const BsdfQuery& query, bool checksOn,
                                        Sampler& sampler) {
    const BsdfRandom random{sampler.next2D(), sampler.next1D()};
    const auto sample = surface.bsdf->sample(query, surface.wi, random);
    if (!sample) return std::nullopt;
    const BsdfDirection exit{surface.frame.toWorld(sample->wo).normalized(), sample->weight, sample->pdf, sample->lobe};
    if (!exit.straight() && !surface.consistent(exit.direction, checksOn)) return std::nullopt;
    return exit;
}

namespace {

Region regionOnSide(const Primitive& primitive, bool inside, const Region& current) {
    if (!primitive.boundsRegion) return current;
    if (!primitive.boundsMedium && current.medium >= 0) return current;
    return inside ? primitive.inside : primitive.outside;
}

} // namespace

Region regionBeyond(const SurfaceInteraction& surface, const Vec3f& direction, const Region& current) {
    const bool inside = direction.dot(surface.hit.ng) < 0.0f;
    const Region region = regionOnSide(*surface.primitive, inside, current);
    const bool cameFromInside = surface.frame.toWorld(surface.wi).dot(surface.hit.ng) < 0.0f;
    return region.medium < 0 && inside == cameFromInside ? current : region;
}

Visibility traceVisibility(const Scene& scene, Ray ray, float distance, Region region, uint64_t& rays) {
    Visibility result;
    result.transmittance = Rgb(1.0f);
    const float speed = region.speed;
    const auto advance = [&](float length) {
        if (const Medium* medium = scene.medium(region))
            result.transmittance = result.transmittance * medium->transmittance(length);
        result.time += double(length) / double(region.speed);
        result.oneSpeed = result.oneSpeed && region.speed == speed;
        distance -= length;
    };
    constexpr int MostCrossings = 4096; // a guard against what is no scene
    while (ray.tMin < ray.tMax) {
        ++rays;
        const auto hit = scene.geometry->intersect(ray);
        if (!hit) break;
        const Rgb through = scene.bsdfOf(*hit).forwardWeight(hit->uv);
        if (isBlack(through) || ++result.crossings > MostCrossings) {
            result.transmittance = Rgb(0.0f);
            return result;
        }
        advance(hit->t);
        result.transmittance = result.transmittance * through;
        region = regionOnSide(scene.primitives[hit->shape], ray.direction.dot(hit->ng) < 0.0f, region);
        ray = hit->rest(ray);
    }
    advance(distance);
    return result;
}

} // namespace tungsten
