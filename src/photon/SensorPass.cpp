#include "photon/SensorPass.h"

#include "photon/Tuning.h"
#include "transport/BounceLimits.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

constexpr size_t TileSide = 8;

struct SensorCounters {
    SensorSteps steps;
    uint64_t gathered = 0, gatheredInVolumes = 0, nonFinite = 0;
};

void report(const SensorCounters& counters, const VolumeGathers& volume, Statistics& statistics) {
    report(counters.steps, statistics);
    statistics.add("gathered photons", counters.gathered);
    statistics.add("photons gathered on surfaces", counters.gathered);
    statistics.add("gathered records", counters.gatheredInVolumes);
    std::visit(
        Overloaded{[](std::monostate) {},
                   [&](const auto& gather) { statistics.add(gather.GatheredCounter, counters.gatheredInVolumes); }},
        volume);
    statistics.add("non-finite samples", counters.nonFinite);
}

/// Buffers that a worker reuses from pixel to pixel.
struct Workspace {
    FrameSums volume, sums;
    std::vector<NearestPhotons::Neighbour> neighbours;
};

/// Gathers on camera paths.
class SensorGather {
  public:
    /// `lights` draws lights. `oversampled`: what highlight paths find is left to them.
    SensorGather(const Scene& scene, const GatherStructures& structures, const Sampler& lights, bool oversampled,
                 Workspace& workspace, SensorCounters& counters)
        : scene_(scene), structures_(structures), lights_(lights), oversampled_(oversampled), workspace_(workspace),
          counters_(counters) {}

    void segment(const SensorState& state, const std::optional<SurfaceHit>& hit) {
        if (structures_.splatted && (!state.folded || oversampled_)) return;
        gatherVolume(state, hit, [&](const auto& gather, const CameraSegment& segment) {
            return gather.gather(segment, state.folded, workspace_.volume);
        });
    }

    void surface(const SensorState& state, const SurfaceInteraction& surface) {
        if (!structures_.includeSurfaces) return;
        if (surface.primitive->emitter >= 0 && !state.glossy) addEmission(state, surface, 1.0f);
        if (structures_.glossy && !oversampled_) highlight(state, surface, 1.0f);
        if (structures_.surfaces && (surface.bsdf->lobes() & lobe::Smooth) != 0) gatherSurface(state, surface);
    }

    void escaped(const SensorState& state) {
        if (!structures_.includeSurfaces || scene_.infiniteEmitters.empty() || scene_.medium(state.region) ||
            state.glossy || !rendered(state.interactions))
            return;
        const Emitter& environment = scene_.emitters[size_t(scene_.infiniteEmitters.back())];
        add(state.throughput * environmentRadiance(environment, state.ray.direction), Infinity);
    }

    /// Highlight path `part`: a part of what folded rays meet in media.
    void segmentPart(const SensorState& state, const std::optional<SurfaceHit>& hit, uint32_t part) {
        if (!structures_.splatted || !state.folded) return;
        gatherVolume(state, hit, [&](const auto& gather, const CameraSegment& segment) {
            return gather.gatherPart(segment, part, workspace_.volume);
        });
    }

    /// Light from the lights by way of glossy surfaces; `share`: of the path in its pixel.
    void highlight(const SensorState& state, const SurfaceInteraction& surface, float share) {
        if (surface.primitive->emitter >= 0 && state.glossy)
            addEmission(state, surface, share * structures_.glossy->emissionWeight(state, surface));
        if (!isGlossyOnly(*surface.bsdf)) return;
        const auto light =
            structures_.glossy->connect(structures_.sensor, state, surface, lights_, counters_.steps.rays);
        if (light) add(light->radiance * share, light->time);
    }

  private:
    /// look(gather, segment) fills workspace_.volume and returns how many records it met.
    template <typename Look>
    void gatherVolume(const SensorState& state, const std::optional<SurfaceHit>& hit, const Look& look) {
        if (!scene_.medium(state.region)) return;
        const CameraSegment segment{state.ray.origin,
                                    state.ray.direction,
                                    hit ? hit->t : Infinity,
                                    state.time,
                                    1.0 / double(state.region.speed),
                                    state.interactions,
                                    state.region.medium};
        std::visit(Overloaded{[](std::monostate) {},
                              [&](const auto& gather) {
                                  std::fill(workspace_.volume.begin(), workspace_.volume.end(), Vec3d(0.0));
                                  const uint64_t gathered = look(gather, segment);
                                  if (gathered > 0) addVolume(state.throughput * gather.scale(), gathered);
                              }},
                   structures_.volume);
    }

    void addVolume(const Rgb& scale, uint64_t gathered) {
        counters_.gatheredInVolumes += gathered;
        const Vec3d weight(double(scale.x), double(scale.y), double(scale.z));
        for (size_t frame = 0; frame < workspace_.sums.size(); ++frame)
            workspace_.sums[frame] += workspace_.volume[frame] * weight;
    }

    /// `time` is that of its record: photons and connections were delayed.
    void add(const Rgb& radiance, double time) {
        const int frame = structures_.sensor.frameOf(time);
        if (frame >= 0) add(radiance * structures_.sensor.weight(time), frame);
    }
    void add(const Rgb& radiance, int frame) {
        workspace_.sums[size_t(frame)] += Vec3d(double(radiance.x), double(radiance.y), double(radiance.z));
    }

    [[nodiscard]] bool rendered(int interactions) const {
        return transport::BounceLimits(scene_.transport).renders(interactions);
    }

    void addEmission(const SensorState& state, const SurfaceInteraction& surface, float weight) {
        if (!rendered(state.interactions)) return;
        const SurfaceHit& hit = surface.hit;
        const Emitter& emitter = scene_.emitters[size_t(surface.primitive->emitter)];
        const Rgb radiance = emittedRadiance(emitter, hit.uv, hit.ng, -state.ray.direction);
        const double time = state.time + double(hit.t) / double(state.region.speed);
        const double arrival = emitter.emissionTime + (scene_.transport.cameraUnwarped ? 0.0 : time);
        const Rgb seen = state.throughput * radiance * (weight * structures_.sensor.weight(arrival));
        structures_.sensor.spread(arrival, emitter, [&](int frame, float share) { add(seen * share, frame); });
    }

    /// Density estimate with a constant kernel over the k nearest photons (docs/scene-format.md, section 10.4), or over
    /// those of them that a narrower kernel holds.
    void gatherSurface(const SensorState& state, const SurfaceInteraction& surface) {
        const auto& photons = structures_.surfacePhotons.records;
        const float squaredRadius =
            sqr(structures_.kernel) * structures_.surfaces->find(surface.hit.position, structures_.surfaceRadius,
                                                                 structures_.gatherCount, workspace_.neighbours);
        if (!(squaredRadius > 0.0f)) return;
        counters_.gathered += workspace_.neighbours.size();
        const float scale = structures_.surfacePhotons.scale() * InvPi / squaredRadius;
        const BsdfQuery query = surface.query(TransportMode::Radiance, lobe::Smooth);
        for (const auto& neighbour : workspace_.neighbours) {
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

    const Scene& scene_;
    const GatherStructures& structures_;
    Sampler lights_;
    bool oversampled_;
    Workspace& workspace_;
    SensorCounters& counters_;
};

/// Follows a highlight path.
struct HighlightVisitor {
    SensorGather& gather;
    uint32_t part;

    void segment(const SensorState& state, const std::optional<SurfaceHit>& hit) {
        gather.segmentPart(state, hit, part);
    }
    void surface(const SensorState& state, const SurfaceInteraction& surface) {
        gather.highlight(state, surface, 1.0f / float(tuning::HighlightPaths));
    }
    void escaped(const SensorState&) const {}
};

} // namespace

void renderSensorPass(const Scene& scene, const GatherStructures& structures, const SensorRecord* record,
                      const PassInfo& pass, Film& film, Statistics& statistics) {
    const auto width = size_t(scene.camera.resolution.x), height = size_t(scene.camera.resolution.y);
    const TimeGate& gate = structures.sensor.gate;
    const double scale = 1.0 / (double(pass.samples) * (gate.steadyState ? 1.0 : gate.frameWidth));
    const auto addSample = [&](int x, int y, uint32_t sample, Workspace& workspace, SensorCounters& counters) {
        const size_t pixel = size_t(y) * width + size_t(x);
        const auto follow = [&](Sampler& sampler, auto&& visitor) {
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            const Ray ray = scene.camera.generateRay({x, y}, uFilter, uLens);
            counters.steps += followSensorPath(scene, {ray, scene.cameraRegion}, structures.rules, sampler, visitor);
        };
        const Sampler lights(pass.seed, RandomStream::Emitter, sample, pixel);
        const bool oversampled = structures.glossy && structures.glossy->oversampled(pixel);
        SensorGather gather(scene, structures, lights, oversampled, workspace, counters);
        if (record) {
            record->replay(scene, pixel, gather);
        } else {
            Sampler sampler(pass.seed, RandomStream::Camera, sample, pixel);
            follow(sampler, gather);
        }
        if (!oversampled) return;
        Sampler sampler(pass.seed, RandomStream::Highlight, sample, pixel);
        for (uint32_t k = 0; k < tuning::HighlightPaths; ++k) follow(sampler, HighlightVisitor{gather, k});
    };
    const uint32_t first = record ? record->sample : uint32_t(pass.firstSample), samples = record ? 1 : pass.samples;
    const auto renderPixel = [&](int x, int y, Workspace& workspace, SensorCounters& counters) {
        std::fill(workspace.sums.begin(), workspace.sums.end(), Vec3d(0.0));
        for (uint32_t s = 0; s < samples; ++s) {
            pass.watch.pollWithin(1, s);
            addSample(x, y, first + s, workspace, counters);
        }
        for (int frame = 0; frame < gate.frames; ++frame) {
            const Vec3d value = workspace.sums[size_t(frame)] * scale;
            const Rgb pixel{float(value.x), float(value.y), float(value.z)};
            if (isFinite(pixel))
                film.add(frame, x, y, pixel);
            else
                ++counters.nonFinite;
        }
    };
    pass.watch.stage("gather", width * height);
    tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
        SensorCounters counters;
        Workspace workspace{FrameSums(size_t(gate.frames)), FrameSums(size_t(gate.frames)), {}};
        for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y) {
            for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x)
                renderPixel(int(x), int(y), workspace, counters);
            pass.watch.poll(tile.cols().size());
        }
        report(counters, structures.volume, statistics);
    });
}

} // namespace tungsten::photon
