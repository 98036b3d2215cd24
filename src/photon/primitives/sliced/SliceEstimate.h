#pragma once
// What one record of collapsed flights brings to one camera segment.

#include "photon/primitives/sliced/RaySliceQuery.h"
#include "photon/primitives/sliced/VolumeBallMis.h"
#include "transport/TimeSensor.h"

#include "tungsten/scene/Scene.h"

namespace tungsten::photon {

/// Evaluates planes, volumes, balls and hypervolumes, in double; beams have a gather of their own. What it adds is
/// integrated over the gate, or multiplied by its width: the image is divided by that later. At a delta gate slices are
/// those of the gate itself; only planes see it through the sensor's temporal kernel.
class SliceEstimate {
  public:
    SliceEstimate(const Scene& scene, const transport::TimeSensor& sensor);

    /// Returns whether it added anything.
    bool add(const SliceRecord& flights, const CameraSegment& segment, FrameSums& sums) const;

    /// Nothing lies on the first `count` flights of these lengths.
    [[nodiscard]] bool unoccluded(const SliceRecord& flights, const double* lengths, int count) const;
    /// Nothing lies between a ball's centre and this point.
    [[nodiscard]] bool unoccluded(const SliceRecord& ball, const Vec3f& end) const;

  private:
    /// Time of arrival along a ray.
    struct ArrivalLine {
        double offset, slope;
    };

    bool addPlane(const RaySliceQuery& m, FrameSums& sums) const;
    bool addVolume(const RaySliceQuery& m, FrameSums& sums) const;
    bool addVolumeChord(const RaySliceQuery& m, FrameSums& sums) const;
    bool addVolumeSlice(const RaySliceQuery& m, int frame, double time, double width, FrameSums& sums) const;
    bool addHypervolume(const RaySliceQuery& m, int frame, double time, double width, FrameSums& sums) const;
    bool addBall(const RaySliceQuery& m, FrameSums& sums) const;
    bool addBallSlice(const RaySliceQuery& m, int frame, double time, double width, FrameSums& sums) const;
    bool addBallGate(const RaySliceQuery& m, int frame, FrameSums& sums) const;
    /// Where something may be in the way, weigh times (`arrival`; may be null) or share the path: at a point drawn by
    /// the integrand.
    template <size_t K>
    bool addChord(const RaySliceQuery& m, const Chord<double, K>& chord, int frame, double u, double factor,
                  const ArrivalLine* arrival, FrameSums& sums) const;
    [[nodiscard]] SharedPath<double> sharedPath(const RaySliceQuery& m, const std::array<Vec3d, 3>& w,
                                                const std::array<double, 3>& lengths) const;
    /// (16) of a path that balls and volumes share, of a given length.
    [[nodiscard]] double ratio(const RaySliceQuery& m, const std::array<Vec3d, 3>& w,
                               const std::array<double, 3>& lengths) const;
    /// The ratio inside a gate, where both draw a point of the ray. Frames of a sequence are narrow: (16), for which
    /// both draw alike, takes a little more than half the time there.
    [[nodiscard]] double ratioInGate(const RaySliceQuery& m, const std::array<Vec3d, 3>& w,
                                     const std::array<double, 3>& lengths, double alongRay) const;
    /// MIS weight of a ball whose paths volumes make too: ratio(directions, lengths) is that of the path that ends with
    /// this flight.
    template <typename Ratio>
    [[nodiscard]] double ballShareOf(const RaySliceQuery& m, const Vec3d& last, double length,
                                     const Ratio& ratio) const;
    /// Power that leaves a ball's centre along `last`, per steradian; 0 where something is in the way.
    [[nodiscard]] Rgb leavingBall(const RaySliceQuery& m, const BallHit<double>& hit, const Vec3f& last) const;
    /// At the delta gate, or at a random time of every frame: slice(frame, time, width).
    template <typename Slice>
    bool eachSlice(const RaySliceQuery& m, const Slice& slice) const {
        const TimeGate& gate = sensor_.gate;
        if (scene_.transport.gate.delta) return slice(0, scene_.transport.gate.start, gate.frameWidth);
        bool any = false;
        for (int frame = gate.nearestFrame(m.start); frame < gate.frames; ++frame) {
            const double time = gate.frameStart(frame) + m.random(0, frame) * gate.frameWidth;
            any = slice(frame, time, gate.frameWidth * double(sensor_.weight(time))) || any;
        }
        return any;
    }
    static bool deposit(const Vec3d& value, const Rgb& power, double factor, int frame, FrameSums& sums);

    const Scene& scene_;
    transport::TimeSensor sensor_;
    bool warped_, occluders_;
};

} // namespace tungsten::photon
