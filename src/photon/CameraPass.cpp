#include "photon/CameraPass.h"

#include "photon/Tuning.h"

#include "transport/BounceLimits.h"

#include "tungsten/integrator/Names.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

constexpr size_t TileSide = 8;

// ---- What a camera path gathers on its way, and in which frame that is seen

struct CameraGatherCounters {
    CameraSubpathCounters steps;
    uint64_t gathered = 0, gatheredInVolumes = 0, nonFinite = 0;
};

/// Buffers that a worker reuses from pixel to pixel.
struct Workspace {
    FrameSums volume, sums; ///< of the segment at hand; of the pixel
    std::vector<NearestPhotons::Neighbour> neighbours;
};

/// Visits a camera path (CameraSubpath.h), as it is traced or as it was recorded, and adds to the workspace's sums: on
/// segments what media scatter, on surfaces what photons bring, what shines, and the highlights of glossy ones.
class CameraGather {
  public:
    /// `lights` draws lights. `oversampled`: what highlight paths find is left to them.
    CameraGather(const Scene& scene, const GatherStructures& structures, const Sampler& lights, bool oversampled,
                 Workspace& workspace, CameraGatherCounters& counters)
        : scene_(scene), structures_(structures), lights_(lights), oversampled_(oversampled), workspace_(workspace),
          counters_(counters) {}

    void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit);
    void surface(const CameraSubpath& state, const SurfaceInteraction& surface);
    void escaped(const CameraSubpath& state);

    /// Highlight path `part`: a part of what redirected rays meet in media.
    void segmentPart(const CameraSubpath& state, const std::optional<SurfaceHit>& hit, uint32_t part);
    /// Light from the lights by way of glossy surfaces; `share`: of the path in its pixel.
    void highlight(const CameraSubpath& state, const SurfaceInteraction& surface, float share);

  private:
    /// visit(gather, segment) fills workspace_.volume and returns how many records it met.
    template <typename Visit>
    void gatherVolume(const CameraSubpath& state, const std::optional<SurfaceHit>& hit, const Visit& visit);
    void addVolume(const Rgb& scale, uint64_t gathered);
    /// Density estimate with a constant kernel over the photons nearer than the k-th (docs/scene-format.md, section
    /// 10.4), or over those of them that a narrower kernel holds.
    void gatherSurface(const CameraSubpath& state, const SurfaceInteraction& surface);
    void addEmission(const CameraSubpath& state, const SurfaceInteraction& surface, float weight);
    /// `time` is that of its record: photons and connections were delayed.
    void add(const Rgb& radiance, double time);
    void add(const Rgb& radiance, int frame);
    [[nodiscard]] bool rendered(int interactions) const {
        return transport::BounceLimits(scene_.transport).renders(interactions);
    }

    const Scene& scene_;
    const GatherStructures& structures_;
    Sampler lights_;
    bool oversampled_;
    Workspace& workspace_;
    CameraGatherCounters& counters_;
};

void CameraGather::add(const Rgb& radiance, double time) {
    const int frame = structures_.sensor.frameOf(time);
    if (frame >= 0) add(radiance * structures_.sensor.weight(time), frame);
}
void CameraGather::add(const Rgb& radiance, int frame) {
    workspace_.sums[size_t(frame)] += Vec3d(radiance);
}

void CameraGather::addVolume(const Rgb& scale, uint64_t gathered) {
    counters_.gatheredInVolumes += gathered;
    const Vec3d weight(scale);
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

// ---- The pass

void report(const CameraGatherCounters& counters, const VolumeGathers& volume, Statistics& statistics) {
    report(counters.steps, statistics);
    statistics.add("gathered photons", counters.gathered);
    statistics.add(counter::GatheredOnSurfaces, counters.gathered);
    statistics.add(counter::GatheredRecords, counters.gatheredInVolumes);
    std::visit(
        Overloaded{[](std::monostate) {},
                   [&](const auto& gather) { statistics.add(gather.GatheredCounter, counters.gatheredInVolumes); }},
        volume);
    statistics.add(counter::NonFiniteSamples, counters.nonFinite);
}

/// Follows a highlight path.
struct HighlightGather {
    CameraGather& gather;
    uint32_t part;

    void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
        gather.segmentPart(state, hit, part);
    }
    void surface(const CameraSubpath& state, const SurfaceInteraction& surface) {
        gather.highlight(state, surface, 1.0f / float(tuning::HighlightPaths));
    }
    void escaped(const CameraSubpath&) const {}
};

/// Pixel by pixel, tiles in parallel.
class CameraPass {
  public:
    CameraPass(const Scene& scene, const GatherStructures& structures, const CameraRecord* record, const PassInfo& pass,
               Film& film)
        : scene_(scene), structures_(structures), record_(record), pass_(pass), film_(film),
          first_(record ? record->sample : uint32_t(pass.firstSample)), samples_(record ? 1 : pass.samples),
          scale_(1.0 / (double(pass.samples) * (gate().steadyState ? 1.0 : gate().frameWidth))) {}

    void run(Statistics& statistics) const {
        const auto width = size_t(scene_.camera.resolution.x), height = size_t(scene_.camera.resolution.y);
        pass_.watch.stage("gather", width * height);
        tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
            CameraGatherCounters counters;
            Workspace workspace{FrameSums(size_t(gate().frames)), FrameSums(size_t(gate().frames)), {}};
            for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y) {
                for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x)
                    renderPixel(int(x), int(y), workspace, counters);
                pass_.watch.advance(tile.cols().size());
            }
            report(counters, structures_.volume, statistics);
        });
    }

    /// Of what one path of a pixel brings, summed over pixels and frames: half the squares of what two differ by, in so
    /// many pairs, about.
    [[nodiscard]] double variance(size_t pairs) const {
        const auto width = size_t(scene_.camera.resolution.x);
        const size_t pixels = width * size_t(scene_.camera.resolution.y), stride = (pixels + pairs - 1) / pairs,
                     rounds = (pairs + pixels - 1) / pixels;
        CameraGatherCounters unreported;
        Workspace first{FrameSums(size_t(gate().frames)), FrameSums(size_t(gate().frames)), {}}, second = first;
        double sum = 0.0;
        for (size_t round = 0; round < rounds; ++round)
            for (size_t pixel = 0; pixel < pixels; pixel += stride) {
                const Vec2i at(int(pixel % width), int(pixel / width));
                std::fill(first.sums.begin(), first.sums.end(), Vec3d(0.0));
                std::fill(second.sums.begin(), second.sums.end(), Vec3d(0.0));
                addSample(at, uint32_t(2 * round), first, unreported);
                addSample(at, uint32_t(2 * round + 1), second, unreported);
                for (size_t frame = 0; frame < first.sums.size(); ++frame) {
                    const Rgb difference(first.sums[frame] - second.sums[frame]);
                    sum += 0.5 * double(sqr(meanComponent(difference)));
                }
            }
        return sum * double(stride) / double(rounds);
    }

  private:
    [[nodiscard]] const TimeGate& gate() const { return structures_.sensor.gate; }

    void renderPixel(int x, int y, Workspace& workspace, CameraGatherCounters& counters) const {
        std::fill(workspace.sums.begin(), workspace.sums.end(), Vec3d(0.0));
        for (uint32_t s = 0; s < samples_; ++s) {
            pass_.watch.advanceWithin(1, s);
            addSample({x, y}, first_ + s, workspace, counters);
        }
        for (int frame = 0; frame < gate().frames; ++frame) {
            const Vec3d value = workspace.sums[size_t(frame)] * scale_;
            const Rgb pixel(value);
            if (isFinite(pixel))
                film_.add(frame, x, y, pixel);
            else
                ++counters.nonFinite;
        }
    }

    /// One camera path, and the highlight paths of pixels that have them.
    void addSample(const Vec2i& at, uint32_t sample, Workspace& workspace, CameraGatherCounters& counters) const {
        const size_t pixel = size_t(at.y) * size_t(scene_.camera.resolution.x) + size_t(at.x);
        const Sampler lights(pass_.seed, RandomStream::Emitter, sample, pixel);
        const bool oversampled = structures_.glossy && structures_.glossy->oversampled(pixel);
        CameraGather gather(scene_, structures_, lights, oversampled, workspace, counters);
        if (record_) {
            record_->replay(scene_, pixel, gather);
        } else {
            Sampler sampler(pass_.seed, RandomStream::Camera, sample, pixel);
            follow(at, sampler, gather, counters);
        }
        if (!oversampled) return;
        const Sampler paths(pass_.seed, RandomStream::Highlight, sample, pixel);
        for (uint32_t k = 0; k < tuning::HighlightPaths; ++k) {
            Sampler sampler = paths.branch(RandomStream::Highlight, k);
            follow(at, sampler, HighlightGather{gather, k}, counters);
        }
    }

    template <typename Shown>
    void follow(const Vec2i& at, Sampler& sampler, Shown&& shown, CameraGatherCounters& counters) const {
        const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
        const Ray ray = scene_.camera.generateRay(at, uFilter, uLens);
        counters.steps += followCameraSubpath(scene_, ray, structures_.rules, sampler, shown, pass_.watch);
    }

    const Scene& scene_;
    const GatherStructures& structures_;
    const CameraRecord* record_;
    const PassInfo& pass_;
    Film& film_;
    uint32_t first_, samples_; ///< of a pixel
    double scale_;             ///< of a pixel's sum
};

} // namespace

void renderCameraPass(const Scene& scene, const GatherStructures& structures, const CameraRecord* record,
                      const PassInfo& pass, Film& film, Statistics& statistics) {
    CameraPass(scene, structures, record, pass, film).run(statistics);
}

double varianceOfLightsInView(const Scene& scene, const GatherStructures& structures, const PassInfo& pass) {
    constexpr size_t Pairs = 4096;
    Film none(1, 1, 1);
    return CameraPass(scene, structures, nullptr, pass, none).variance(Pairs);
}

} // namespace tungsten::photon
