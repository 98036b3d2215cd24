#pragma once
// What a camera path gathers on its way, and in which frame that is seen.

#include "photon/CameraPass.h"

#include "transport/BounceLimits.h"

namespace tungsten::photon {

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

} // namespace tungsten::photon
