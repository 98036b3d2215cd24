#pragma once
// Which photons can still be seen inside the time gate.

#include "transport/TimeSensor.h"

#include "tungsten/scene/Scene.h"

namespace tungsten::photon {

/// Distances along a flight, start < end unless empty.
struct FlightPart {
    double start, end;
};

/// Exact tests by time of flight: what they reject can contribute to no pixel of any frame.
class ArrivalCulling {
  public:
    /// What camera subpaths can do between scattering and the camera.
    struct CameraSubpaths {
        bool redirected = false, oneSpeed = true;
        float highestSpeed = 1.0f;
    };
    ArrivalCulling(const Scene& scene, const CameraSubpaths& paths);

    /// A deposit at `position` and `time` may be gathered, with a weight above 0. In direct view (one straight segment
    /// chain at one speed from one point) its arrival is known exactly; otherwise only what arrives too late can be
    /// dropped.
    [[nodiscard]] bool mayCount(const Vec3f& position, double time) const;
    /// A light path that has got to `position` at `time` may still contribute.
    [[nodiscard]] bool mayContinue(const Vec3f& position, double time) const;
    [[nodiscard]] bool directView() const { return directView_; }
    /// Camera subpaths start at one point and run at one speed, so that a straight one's time is known; some may be
    /// redirected.
    [[nodiscard]] bool straightTimesKnown() const { return straightTimesKnown_; }
    /// With straightTimesKnown: a camera subpath without mirror or refraction can see this deposit inside the gate.
    [[nodiscard]] bool seenStraight(const Vec3f& position, double time) const;

    /// The part of a flight, from `position` at `time` with `speed`, on which a deposit mayCount: an interval, since
    /// the arrival never falls along a flight. Holds a little more than that part, never less.
    [[nodiscard]] FlightPart countingPart(const Vec3f& position, const Vec3f& direction, double time,
                                          double speed) const;
    /// The part that is seenStraight.
    [[nodiscard]] FlightPart straightPart(const Vec3f& position, const Vec3f& direction, double time,
                                          double speed) const;
    /// Tests against this gate from now on instead of the scene's.
    void setGate(const TimeGate& gate);
    [[nodiscard]] const TimeGate& gate() const { return sensor_.gate; }
    /// Light paths start with a delay of their own, so that everything later has the time of its record.
    [[nodiscard]] const transport::RecordingDelays& delays() const { return sensor_.delays; }
    /// The test for one frame of the gate, for paths that aim at it alone. Inner frame edges have no tolerance, so that
    /// with directView a deposit counts in exactly one frame.
    [[nodiscard]] ArrivalCulling ofFrame(int frame) const;

  private:
    /// With or without the gate's start.
    [[nodiscard]] FlightPart part(const Vec3f& position, const Vec3f& direction, double time, double speed,
                                  bool testStart) const;
    [[nodiscard]] bool insideGate(double arrival, bool testStart) const;
    [[nodiscard]] double soonestArrival(const Vec3f& position, double time) const;

    transport::TimeSensor sensor_;
    bool straightTimesKnown_ = false;
    bool directView_ = false;
    bool unwarped_ = false;
    Vec3d camera_{0, 0, 0};
    double slack_ = 0.0; ///< distance by which camera rays can start nearer than the camera's position
    double highestSpeed_ = 1.0;
    double begin_ = 0.0, end_ = 0.0; ///< of arrivals that pass, half open
};

} // namespace tungsten::photon
