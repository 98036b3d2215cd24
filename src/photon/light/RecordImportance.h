#pragma once
// What records of light paths bring to the image, about: what a pilot judges plain and guided paths by.

#include "photon/PhotonSettings.h"
#include "photon/surface/PathReuse.h"
#include "photon/surface/SurfaceConnections.h"
#include "photon/view/CameraRecord.h"
#include "transport/TimeSensor.h"

namespace tungsten::photon {

/// A contribution to the image: the root of its squares' sum over the pixels that it covers, and where it is, so that
/// those of a path which meet in a pixel can be told from others.
struct Contribution {
    float value = 0.0f;
    int cell = 0;
};

/// Seen along the segment to the camera, through whatever lets light pass. A guess in mirrors and behind
/// refraction: images by shares that are chosen by it are right all the same.
class RecordImportance {
  public:
    RecordImportance(const Scene& scene, const PhotonSettings& settings, const transport::TimeSensor& sensor);

    static constexpr size_t Parts = 4; ///< of a beam
    using Contributions = std::array<Contribution, Parts>;

    [[nodiscard]] Contributions of(const Photon& photon) const;
    [[nodiscard]] Contributions of(const PhotonBeam& beam) const;
    [[nodiscard]] Contributions of(const SliceRecord& flights) const;
    [[nodiscard]] Contribution onSurface(const Photon& photon) const;
    /// No mirror or refraction is in the way, nor shows what lies beside the view.
    [[nodiscard]] bool seesDirectly() const { return direct_; }
    [[nodiscard]] Contribution ofConnection(const ConnectionRecord& light, const VisiblePoint& point) const;

  private:
    /// Contribution of light that leaves a point towards the camera; `power` in that direction per solid angle. It
    /// covers an area across the view.
    [[nodiscard]] Contribution at(const Vec3f& position, double time, const Region& region, float power,
                                  float area) const;
    /// Whether the image shows a point, or what is so many pixels from it.
    [[nodiscard]] bool inView(const Vec3f& position, float margin) const;
    struct Segment {
        float transmittance = 1.0f;
        double time = 0.0;
    };
    /// None behind something opaque.
    [[nodiscard]] std::optional<Segment> segmentToCamera(Ray ray, float reach, Region region) const;
    [[nodiscard]] Region regionOf(int medium) const { return {medium, scene_.media[size_t(medium)].speedOfLight}; }
    [[nodiscard]] Vec3f toCamera(const Vec3f& position) const;

    const Scene& scene_;
    transport::TimeSensor sensor_;
    Vec3f camera_{0.0f};
    Frame frame_;
    float radius_;        ///< of the volume kernel; 0: unknown
    float surfaceRadius_; ///< of gathers on surfaces
    ReuseKernel reuse_;   ///< of what connections bring, in a middle pass
    float pixel_;         ///< solid angle of one
    bool placed_;         ///< the camera has one position
    bool direct_;         ///< seesDirectly()
};

} // namespace tungsten::photon
