#include "path/MissedLight.h"

#include "path/PathTarget.h"

#include "tungsten/core/Warp.h"
#include "tungsten/render/EarliestArrival.h"
#include "tungsten/render/SceneUses.h"

#include <algorithm>

namespace tungsten::path {

namespace {

constexpr uint32_t SearchPaths = 4096;

bool isSpecularAlone(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::Specular) != 0 && (bsdf.lobes() & lobe::Smooth) == 0;
}

std::vector<const Primitive*> specularSurfaces(const Scene& scene) {
    std::vector<const Primitive*> surfaces;
    for (const Primitive& primitive : scene.primitives)
        if (std::any_of(primitive.bsdfs.begin(), primitive.bsdfs.end(),
                        [](const BsdfPtr& bsdf) { return isSpecularAlone(*bsdf); }))
            surfaces.push_back(&primitive);
    return surfaces;
}

Vec3f pointIn(const Imath::Box3f& box, Sampler& sampler) {
    const Vec3f u(sampler.next1D(), sampler.next1D(), sampler.next1D());
    return box.min + u * (box.max - box.min);
}

class MissedLightSearch {
  public:
    explicit MissedLightSearch(const Scene& scene)
        : scene_(scene), targets_(scene, TargetChoice::Emitters::All), surfaces_(specularSurfaces(scene)),
          end_(scene.transport.gate.steadyState ? Infinity : lastTime(scene)) {}

    std::optional<MissedLight> run() const {
        if (surfaces_.empty() || std::none_of(scene_.emitters.begin(), scene_.emitters.end(),
                                              [](const Emitter& emitter) { return emitter.isPointLike(); }))
            return {};
        uint32_t polls = 0; // paths between mirrors may be endless
        PassMonitor monitor([&] { return ++polls > SearchPaths; });
        try {
            return search(PassWatch(monitor));
        } catch (const PassBrokenOff&) {
            return {};
        }
    }

  private:
    [[nodiscard]] std::optional<MissedLight> search(const PassWatch& watch) const {
        PathCounters counters;
        for (uint32_t i = 0; i < SearchPaths; ++i) {
            Sampler sampler(0, RandomStream::Pilot, i, 0);
            const auto from = targets_.sample(sampler.next1D(), sampler, watch, counters);
            if (!from || !from->emitter->isPointLike()) continue;
            Sampler onward = sampler.branch(RandomStream::Aimed, 0);
            const auto direction = directionFrom(*from, i, onward);
            if (!direction || isBlack(from->intensity(*direction))) continue;
            if (const auto found = follow(*from, *direction, onward, watch, counters)) return found;
        }
        return {};
    }
    /// By turns as light starts (after a scattering: evenly), and towards a surface that mirrors or refracts.
    [[nodiscard]] std::optional<Vec3f> directionFrom(const PathTarget& from, uint32_t path, Sampler& sampler) const {
        if (path % 2 == 1) {
            const Primitive& surface = *surfaces_[path / 2 % surfaces_.size()];
            const auto way = transport::straightWay(from.vertex.position(), pointIn(boundsOf(surface.shape), sampler));
            return way ? std::optional(way->direction) : std::nullopt;
        }
        const Vec2f uPosition = sampler.next2D(), uDirection = sampler.next2D();
        if (from.index < 0) return warp::squareToSphere(uDirection);
        return sampleEmission(*from.emitter, uPosition, uDirection).ray.direction;
    }

    /// Along specular and forward lobes to the next vertex that scatters.
    [[nodiscard]] std::optional<MissedLight> follow(const PathTarget& from, const Vec3f& direction, Sampler& sampler,
                                                    const PassWatch& watch, PathCounters& counters) const {
        Ray ray = from.vertex.leave(direction);
        Region region = from.vertex.regionTowards(direction);
        double time = from.start;
        std::optional<MissedLight> way;
        // What scatters is an interaction, too.
        for (int met = from.interactions; met + 1 < scene_.transport.maxBounces; ++met) {
            counters.step(watch);
            const Medium* medium = scene_.medium(region);
            FlightSample flight{Infinity, true, Rgb(1.0f), 1.0f};
            sampler.at(met + 1, Draw::Flight);
            if (medium) flight = sampleFlight(*medium, Infinity, sampler);
            ray.tMax = flight.distance;
            const auto hit = scene_.geometry->intersect(ray);
            if (!hit && flight.exited) return std::nullopt;
            if (!hit)
                return inTime(ray.at(flight.distance), time + double(flight.distance) / double(region.speed))
                           ? way
                           : std::nullopt;
            if (medium && isBlack(medium->transmittance(hit->t))) return std::nullopt;
            time += double(hit->t) / double(region.speed);
            const SurfaceInteraction surface = makeInteraction(scene_, *hit, ray.direction);
            const LobeMask lobes = surface.bsdf->lobes();
            if (way && (lobes & lobe::Smooth) != 0) return inTime(hit->position, time) ? way : std::nullopt;
            const LobeMask onward =
                isSpecularAlone(*surface.bsdf) ? lobe::Specular | lobe::Forward : LobeMask(lobe::Forward);
            if ((lobes & onward) == 0) return std::nullopt;
            sampler.at(met + 1, Draw::Direction);
            const auto exit = sampleExit(surface, surface.query(TransportMode::Photons, onward), false, sampler);
            if (!exit || isBlack(exit->weight)) return std::nullopt;
            if (!exit->straight() && !way)
                way = MissedLight{from.emitter, surface.primitive, exit->lobe == lobe::SpecularTransmission};
            region = regionBeyond(surface, exit->direction, region);
            ray = hit->leave(exit->direction);
        }
        return std::nullopt;
    }

    [[nodiscard]] bool inTime(const Vec3f& position, double time) const {
        const Camera& camera = scene_.camera;
        const bool anywhere = scene_.transport.cameraUnwarped || !camera.hasSinglePosition();
        const float left = anywhere ? 0.0f : (position - camera.position()).length();
        return time + double(left) / double(reachableSpeeds(scene_).highest) < end_;
    }

    const Scene& scene_;
    TargetChoice targets_;
    std::vector<const Primitive*> surfaces_;
    double end_;
};

} // namespace

std::string MissedLight::description() const {
    const std::string light = emitter->name.empty() ? "a light" : "'" + emitter->name + "'";
    const std::string by = surface->name.empty() ? "a smooth surface" : "'" + surface->name + "'";
    return "light of " + light + " that " + by + (refracts ? " refracts" : " mirrors") +
           (emitter->isDelta() ? " between its first two scatterings" : " before anything scatters it");
}

std::optional<MissedLight> findMissedLight(const Scene& scene) {
    return MissedLightSearch(scene).run();
}

} // namespace tungsten::path
