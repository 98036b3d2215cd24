#include "photon/store/RedirectedSelection.h"

#include "photon/Tuning.h"

#include <cmath>

namespace tungsten::photon {

double ExpectedHits::share() const {
    // Area of the box about everything seen from far away, averaged over directions: a quarter of its surface (Cauchy).
    const Vec3f size = high_ - low_;
    const double shadow =
        0.5 * (double(size.x) * double(size.y) + double(size.y) * double(size.z) + double(size.z) * double(size.x));
    const double met = area_ / shadow;
    return met > tuning::RedirectedHits && std::isfinite(met) ? tuning::RedirectedHits / met : 1.0;
}

} // namespace tungsten::photon
