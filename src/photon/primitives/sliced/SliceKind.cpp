#include "photon/primitives/sliced/SliceKind.h"

namespace tungsten::photon {

SliceClasses SliceClasses::of(SliceKind kind, bool steadyState, bool lowOrders, bool onlyShared) {
    constexpr int Every = std::numeric_limits<int>::max();
    SliceClasses c;
    c.beams = true;
    // Planes need a temporal kernel at a delta gate, balls do not.
    const bool planes = kind == SliceKind::Planes || steadyState;
    c.lights = !planes;
    switch (kind) {
    case SliceKind::Planes:
        c.flights[2] = Bases::All;
        break;
    case SliceKind::Volumes:
    case SliceKind::VolumesBalls:
        c.flights[3] = Bases::All;
        if (planes) c.flights[2] = Bases::First;
        if (!planes) c.firstBall = c.lastBall = 1;
        break;
    case SliceKind::Balls:
        c.firstBall = 1;
        c.lastBall = Every;
        break;
    case SliceKind::MisVolumesBalls:
        c.flights[3] = Bases::All;
        c.firstBall = 1;
        c.lastBall = Every;
        c.shared = true;
        break;
    case SliceKind::Hypervolumes:
        c.flights[3] = Bases::First;
        c.flights[4] = Bases::All;
        c.firstBall = c.lastBall = 1;
        break;
    }
    if (!lowOrders || onlyShared) c.lights = c.beams = false;
    if (onlyShared) {
        c.firstBall = std::max(c.firstBall, 2);
        if (c.flights[2] == Bases::First) c.flights[2] = Bases::None;
    }
    return c;
}

} // namespace tungsten::photon
