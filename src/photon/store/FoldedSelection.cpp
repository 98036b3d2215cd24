#include "photon/store/FoldedSelection.h"

#include "photon/Tuning.h"

#include <cmath>

namespace tungsten::photon {

double FoldedMeeting::share() const {
    // Area of the box about everything seen from far away, averaged over directions: a quarter of its surface (Cauchy).
    const Vec3f size = high_ - low_;
    const double shadow =
        0.5 * (double(size.x) * double(size.y) + double(size.y) * double(size.z) + double(size.z) * double(size.x));
    const double met = area_ / shadow;
    return met > tuning::FoldedMeetings && std::isfinite(met) ? tuning::FoldedMeetings / met : 1.0;
}

} // namespace tungsten::photon
