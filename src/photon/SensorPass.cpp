#include "photon/SensorPass.h"

#include "tungsten/scene/Interaction.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

constexpr size_t TileSide = 8;

struct SensorCounters {
    uint64_t rays = 0, gathered = 0, gatheredBeams = 0, nonFinite = 0;
};

/// Buffers that a worker reuses from pixel to pixel.
struct Workspace {
    FrameSums volume, sums;
    std::vector<NearestPhotons::Neighbour> neighbours;
};

/// One camera path: straight through forward surfaces and along specular lobes, gathering on the way.
class SensorPath {
  public:
    SensorPath(const Scene& scene, const GatherStructures& structures, Sampler& sampler, Workspace& workspace,
               SensorCounters& counters)
        : scene_(scene), structures_(structures), sampler_(sampler), workspace_(workspace), counters_(counters) {}

    void run(Ray ray) {
        ray_ = ray;
        region_ = scene_.cameraRegion;
        while (interactions_ < scene_.transport.maxBounces) {
            ++counters_.rays;
            const auto hit = scene_.geometry->intersect(ray_);
            crossSegment(hit ? hit->t : Infinity);
            if (!hit) return addEnvironment();
            if (!meetSurface(*hit)) return;
        }
    }

  private:
    void crossSegment(float length) {
        const Medium* medium = scene_.medium(region_);
        if (medium && structures_.points)
            gatherVolume(length, structures_.points, structures_.straightPoints, structures_.maps.volume.scale(),
                         counters_.gathered);
        if (medium && structures_.beams)
            gatherVolume(length, structures_.beams, structures_.straightBeams, structures_.maps.beams.scale(),
                         counters_.gatheredBeams);
        if (medium) throughput_ = throughput_ * medium->transmittance(length);
        time_ += double(length) / double(region_.speed);
    }

    /// Points or beams along the segment; `straight`, if any, while the path has not folded.
    template <typename Gather>
    void gatherVolume(float length, const std::unique_ptr<Gather>& all, const std::unique_ptr<Gather>& straight,
                      float storeScale, uint64_t& counter) {
        std::fill(workspace_.volume.begin(), workspace_.volume.end(), Vec3d(0.0));
        const CameraSegment segment{ray_.origin,   ray_.direction, length, time_, 1.0 / double(region_.speed),
                                    interactions_, region_.medium};
        const Gather& store = straight && !folded_ ? *straight : *all;
        const uint64_t gathered = store.gather(segment, workspace_.volume);
        if (gathered == 0) return;
        counter += gathered;
        const double scale = double(storeScale);
        const Vec3d weight(double(throughput_.x) * scale, double(throughput_.y) * scale, double(throughput_.z) * scale);
        for (size_t frame = 0; frame < workspace_.sums.size(); ++frame)
            workspace_.sums[frame] += workspace_.volume[frame] * weight;
    }

    /// False ends the path.
    bool meetSurface(const SurfaceHit& hit) {
        if (isBlack(throughput_)) return false;
        const SurfaceInteraction surface = makeInteraction(scene_, hit, ray_.direction);
        if (structures_.includeSurfaces) {
            if (surface.primitive->emitter >= 0) addEmission(hit, *surface.primitive);
            if (structures_.surfaces && (surface.bsdf->lobes() & lobe::Smooth) != 0) gatherSurface(surface);
        }
        ++interactions_;
        const LobeMask followed = structures_.includeSurfaces ? lobe::Specular | lobe::Forward : lobe::Forward;
        const BsdfRandom random{sampler_.next2D(), sampler_.next1D()};
        const auto sample = surface.bsdf->sample(surface.query(TransportMode::Radiance, followed), surface.wi, random);
        if (!sample) return false;
        const Vec3f direction = surface.frame.toWorld(sample->wo).normalized();
        if (sample->lobe != lobe::Forward && !surface.consistent(direction, scene_.transport.consistencyChecks))
            return false;
        folded_ = folded_ || sample->lobe != lobe::Forward;
        throughput_ = throughput_ * sample->weight;
        region_ = regionBeyond(*surface.primitive, hit, direction, region_);
        ray_ = Ray{hit.position, direction, scene_.rayEpsilon};
        return true;
    }

    void add(const Rgb& radiance, double time) {
        const TimeGate& gate = structures_.gate;
        const int frame = gate.steadyState ? 0 : gate.frameOf(time);
        if (frame >= 0)
            workspace_.sums[size_t(frame)] += Vec3d(double(radiance.x), double(radiance.y), double(radiance.z));
    }

    [[nodiscard]] bool rendered(int interactions) const {
        return interactions >= scene_.transport.minBounces && interactions < scene_.transport.maxBounces;
    }

    void addEmission(const SurfaceHit& hit, const Primitive& primitive) {
        if (!rendered(interactions_)) return;
        const Emitter& emitter = scene_.emitters[size_t(primitive.emitter)];
        const Rgb radiance = emittedRadiance(emitter, hit.uv, hit.ng, -ray_.direction);
        add(throughput_ * radiance, emitter.emissionTime + (scene_.transport.cameraUnwarped ? 0.0 : time_));
    }

    void addEnvironment() {
        if (!structures_.includeSurfaces || scene_.infiniteEmitters.empty() || scene_.medium(region_) ||
            !rendered(interactions_))
            return;
        add(throughput_ * environmentRadiance(scene_.emitters[size_t(scene_.infiniteEmitters.back())], ray_.direction),
            Infinity);
    }

    /// Density estimate with a constant kernel over the k nearest photons (scene format, section 10.4).
    void gatherSurface(const SurfaceInteraction& surface) {
        const auto& photons = structures_.maps.surface.photons;
        const float squaredRadius = structures_.surfaces->find(surface.hit.position, structures_.surfaceRadius,
                                                               structures_.gatherCount, workspace_.neighbours);
        if (!(squaredRadius > 0.0f)) return;
        counters_.gathered += workspace_.neighbours.size();
        const float scale = structures_.maps.surface.scale() * InvPi / squaredRadius;
        const BsdfQuery query = surface.query(TransportMode::Radiance, lobe::Smooth);
        // Camera time up to the start of this segment; each photon adds its own distance to it.
        const double cameraTime = time_ - double(surface.hit.t) / double(region_.speed);
        for (const auto& neighbour : workspace_.neighbours) {
            const Photon& photon = photons[neighbour.index];
            if (!rendered(interactions_ + photon.bounce)) continue;
            const Vec3f wo = surface.frame.toLocal(-photon.direction);
            if (wo.z == 0.0f) continue;
            const Rgb scattering = surface.bsdf->eval(query, surface.wi, wo) / std::abs(wo.z);
            const double own = double((photon.position - ray_.origin).length()) / double(region_.speed);
            add(throughput_ * photon.power * scattering * scale,
                photon.time + (scene_.transport.cameraUnwarped ? 0.0 : cameraTime + own));
        }
    }

    const Scene& scene_;
    const GatherStructures& structures_;
    Sampler& sampler_;
    Workspace& workspace_;
    SensorCounters& counters_;
    Ray ray_;
    Region region_;
    Rgb throughput_{1.0f};
    double time_ = 0.0;
    int interactions_ = 0;
    bool folded_ = false; ///< a mirror or refraction lies behind
};

} // namespace

void renderSensorPass(const Scene& scene, const GatherStructures& structures, const PassInfo& pass, Film& film,
                      Statistics& statistics) {
    const auto width = size_t(scene.camera.resolution.x), height = size_t(scene.camera.resolution.y);
    const TimeGate& gate = structures.gate;
    const double scale = 1.0 / (double(pass.samples) * (gate.steadyState ? 1.0 : gate.frameWidth));
    const auto renderPixel = [&](int x, int y, Workspace& workspace, SensorCounters& counters) {
        std::fill(workspace.sums.begin(), workspace.sums.end(), Vec3d(0.0));
        for (uint32_t s = 0; s < pass.samples; ++s) {
            Sampler sampler(pass.seed, RandomStream::Camera, uint32_t(pass.firstSample + s),
                            size_t(y) * width + size_t(x));
            const Vec2f uFilter = sampler.next2D(), uLens = sampler.next2D();
            SensorPath(scene, structures, sampler, workspace, counters)
                .run(scene.camera.generateRay({x, y}, uFilter, uLens));
        }
        for (int frame = 0; frame < gate.frames; ++frame) {
            const Vec3d value = workspace.sums[size_t(frame)] * scale;
            const Rgb pixel{float(value.x), float(value.y), float(value.z)};
            if (isFinite(pixel))
                film.passPixel(frame, x, y) = pixel;
            else
                ++counters.nonFinite;
        }
    };
    tbb::parallel_for(tbb::blocked_range2d<size_t>(0, height, TileSide, 0, width, TileSide), [&](const auto& tile) {
        SensorCounters counters;
        Workspace workspace{FrameSums(size_t(gate.frames)), FrameSums(size_t(gate.frames)), {}};
        for (size_t y = tile.rows().begin(); y < tile.rows().end(); ++y)
            for (size_t x = tile.cols().begin(); x < tile.cols().end(); ++x)
                renderPixel(int(x), int(y), workspace, counters);
        statistics.add("rays", counters.rays);
        statistics.add("gathered photons", counters.gathered);
        statistics.add("gathered beams", counters.gatheredBeams);
        statistics.add("non-finite samples", counters.nonFinite);
    });
}

} // namespace tungsten::photon
