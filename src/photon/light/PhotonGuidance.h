#pragma once
// What guides the photon pass: the camera as the target of every light path, and what it can see.

#include "photon/PhotonPlan.h"
#include "photon/Tuning.h"
#include "photon/store/ArrivalCulling.h"

#include "transport/EscapeModels.h"
#include "transport/TimeSensor.h"

#include "darts/Guide.h"
#include "darts/Vec3.h"

#include "tungsten/camera/Camera.h"
#include "tungsten/integrator/ProgressToken.h"
#include "tungsten/scene/Scene.h"

#include <memory>

namespace tungsten::photon {

/// What pinhole and thin-lens cameras see.
class CameraView {
  public:
    explicit CameraView(const Camera& camera);

    /// False when no camera ray comes within `radius` of the point. Margins hold the pixel filter and the aperture.
    [[nodiscard]] bool sees(const Vec3f& point, float radius) const;
    /// The part of a ray whose points it sees: an interval, as what a pinhole sees is convex. A thin lens: all of it.
    [[nodiscard]] FlightPart seenPart(const Vec3f& origin, const Vec3f& direction, float radius) const;

    /// Outward unit normals of the planes through the position inside which points are seen.
    [[nodiscard]] std::array<Vec3f, 4> sides() const;

  private:
    Vec3f position_;
    Frame frame_;
    float marginX_, marginY_; ///< half the image's width and height at distance 1, with the filter's reach
    float slantX_, slantY_;   ///< sqrt(1 + margin^2): a sphere's reach beyond a slanted plane
    float aperture_ = 0.0f;
};

class PhotonGuidance {
  public:
    /// Where plan.guidance is on. Polls `watch` before each medium, whose table may take a fraction of a second.
    PhotonGuidance(const Scene& scene, const transport::Policy& policy, const PhotonPlan& plan,
                   const ProgressToken& watch);

    /// Null in regions where nothing scatters.
    [[nodiscard]] const darts::Guide* guide(const Region& region) const {
        return region.medium < 0 ? nullptr : guides_[size_t(region.medium)].get();
    }
    /// What is left of a path at the start of a flight (transport::EscapeModels::choose) through `region` at `elapsed`,
    /// for arrival inside `gate`. Adds the rays traced to `rays`.
    [[nodiscard]] darts::TimeBudget budget(const transport::FlightStart& start, const Region& region, double elapsed,
                                           const darts::TimeGate& gate, uint64_t& rays) const;

    /// Bodies that light from outside is sent towards.
    [[nodiscard]] const std::vector<transport::MediumSphere>& bodies() const { return bodies_; }

    /// Every camera subpath is one straight chain at one speed: control vertices alone are complete.
    [[nodiscard]] bool directView() const { return directView_; }
    /// Flights have control vertices.
    [[nodiscard]] bool drawsControlVertices() const { return drawsControlVertices_; }
    /// Ordinary photons share the work with control vertices, by the balance heuristic.
    [[nodiscard]] bool storesPhotons() const { return storesPhotons_; }
    /// Each light path aims at one frame; otherwise at all of them as one gate.
    [[nodiscard]] bool choosesFrames() const { return choosesFrames_; }
    /// Where light paths choose frames: without the first ones, which no light reaches.
    [[nodiscard]] int emptyFrames() const { return darkFrames_; }
    [[nodiscard]] const darts::FrameSequence& frames() const { return frames_; }
    /// The gate of paths that aim at all frames, with the aperture's slack.
    [[nodiscard]] const darts::TimeGate& gate() const { return gate_; }
    /// Number of tables of directions in use: one for every medium that has one.
    [[nodiscard]] uint64_t tables() const;
    /// Aims at this gate from now on (a delta gate's temporal kernel) instead of the scene's.
    void setGate(const TimeGate& gate);
    /// For connections from a vertex reached at `elapsed`, where a straight way to the camera's one position tells the
    /// time of arrival. None elsewhere, nor where photons share with control vertices (darts::Guide::pdfControlVertex):
    /// there only the gather weighs.
    [[nodiscard]] darts::ResponseAt response(double elapsed) const {
        return {drawsByResponse_ ? sensor_.response.get() : nullptr, elapsed, lengthPerTime()};
    }
    /// Control vertices lie on the delta gate itself, not anywhere in its temporal kernel: where response() would tell
    /// the time.
    [[nodiscard]] bool meetsDeltaGate() const { return meetsDeltaGate_; }
    /// The connection that arrives at the delta gate, to be averaged over the kernel; 1 / density is 0 if there is
    /// none.
    [[nodiscard]] darts::ConnectionSample onDeltaGate(const darts::TimeBudget& budget) const {
        const double kernel = lengthPerTime() * frames_.width;
        const float excess = budget.excess - float(0.5 * kernel);
        return excess > 0.0f ? darts::ConnectionSample{excess, float(kernel)}
                             : darts::ConnectionSample{budget.excess, 0.0f};
    }
    [[nodiscard]] const CameraView& view() const { return view_; }

  private:
    /// Length of connections per time of arrival: without camera segments budget() has twice the length.
    [[nodiscard]] double lengthPerTime() const { return unwarped_ ? 2.0 * speed_ : speed_; }

    std::vector<std::unique_ptr<darts::Guide>> guides_; ///< by medium
    CameraView view_;
    std::array<Vec3f, 4> sides_; ///< of the view
    std::unique_ptr<const transport::EscapeModels>
        escapeModels_; ///< null: media are taken for infinite, or bounds in time do
    std::vector<transport::MediumSphere> bodies_;
    int cameraMedium_;
    Vec3f camera_;
    double speed_;
    double slack_; ///< of arrival times, from the aperture
    bool unwarped_, directView_, drawsControlVertices_, storesPhotons_, choosesFrames_, drawsByResponse_,
        meetsDeltaGate_;
    int darkFrames_;
    transport::TimeSensor sensor_;
    darts::FrameSequence frames_;
    darts::TimeGate gate_;
};

} // namespace tungsten::photon
