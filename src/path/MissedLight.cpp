#include "path/MissedLight.h"

#include "path/PathTarget.h"

#include "transport/PlainSteps.h"

#include "tungsten/core/Warp.h"
#include "tungsten/integrator/EarliestArrival.h"
#include "tungsten/integrator/SceneElements.h"

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

/// Follows light of an emitter to the first vertex that scatters it, should that be in time.
struct SpecularSearch : transport::VisitorBase {
    SpecularSearch(const Scene& wholeScene, const Emitter& from, double lastTime)
        : scene(&wholeScene), emitter(&from), last(lastTime) {}

    // What scatters is an interaction, too.
    [[nodiscard]] bool mayGoOn(const PathState& path) const {
        return transport::BounceLimits(scene->transport).mayGoOn(path.interactions + 1);
    }
    bool vertex(PathState& path, auto& steps, const transport::WalkVertex& at) {
        const LobeMask lobes = at.surface ? at.surface->bsdf->lobes() : lobe::None;
        if (at.medium || (first && (lobes & lobe::Smooth) != 0)) {
            if (inTime(path)) found = first;
            return false;
        }
        steps.lobes = lobes & (isSpecularAlone(*at.surface->bsdf) ? lobe::Specular | lobe::Forward : lobe::Forward);
        return steps.lobes != 0;
    }
    void leave(PathState&, auto&, const transport::WalkVertex& at, const transport::Way& way) {
        if (!way.straight() && !first)
            first = MissedLight{emitter, at.surface->primitive, way.lobe == lobe::SpecularTransmission};
    }
    [[nodiscard]] bool inTime(const PathState& path) const {
        const Camera& camera = scene->camera;
        const bool anywhere = scene->transport.cameraUnwarped || !camera.hasSinglePosition();
        const float left = anywhere ? 0.0f : (path.ray.origin - camera.position()).length();
        return path.time + double(left) / double(reachableSpeeds(*scene).highest) < last;
    }

    const Scene* scene;
    const Emitter* emitter;
    double last;                             ///< time of arrival that counts
    std::optional<MissedLight> first, found; ///< first: by the first surface that mirrors or refracts
};

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
        ProgressMonitor monitor([&] { return ++polls > SearchPaths; });
        try {
            return search(ProgressToken(monitor));
        } catch (const PassCancelled&) {
            return {};
        }
    }

  private:
    [[nodiscard]] std::optional<MissedLight> search(const ProgressToken& watch) const {
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
    /// Directions are drawn by turns as light starts (after a scattering: uniformly), and towards a surface that
    /// mirrors or refracts.
    [[nodiscard]] std::optional<Vec3f> directionFrom(const PathTarget& from, uint32_t path, Sampler& sampler) const {
        if (path % 2 == 1) {
            const Primitive& surface = *surfaces_[path / 2 % surfaces_.size()];
            const auto way =
                transport::connectionSegment(from.vertex.position(), pointIn(boundsOf(surface.shape), sampler));
            return way ? std::optional(way->direction) : std::nullopt;
        }
        const Vec2f uPosition = sampler.next2D(), uDirection = sampler.next2D();
        if (from.index < 0) return warp::squareToSphere(uDirection);
        return sampleEmission(*from.emitter, uPosition, uDirection).ray.direction;
    }

    /// Along specular and forward lobes to the next vertex that scatters.
    [[nodiscard]] std::optional<MissedLight> follow(const PathTarget& from, const Vec3f& direction,
                                                    const Sampler& sampler, const ProgressToken& watch,
                                                    PathCounters& counters) const {
        const PathState start{.random = sampler,
                              .ray = from.vertex.spawnRay(direction),
                              .region = from.vertex.regionTowards(direction),
                              .time = from.start,
                              .interactions = from.interactions};
        transport::PlainLightSteps steps({scene_, counters, watch});
        steps.checks = false;
        transport::Walk walk{start, steps, SpecularSearch(scene_, *from.emitter, end_)};
        walk.run();
        return walk.visitor.found;
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
