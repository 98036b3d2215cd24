#include "photon/primitives/sliced/SystematicShadowRays.h"

#include <limits>

namespace tungsten::photon {

namespace {

using LaneArray = std::array<float, size_t(Lanes)>;

LaneArray stored(const Batch& batch) {
    alignas(64) LaneArray values;
    batch.store_unaligned(values.data());
    return values;
}

} // namespace

void SystematicShadowRays::begin(float part, float number, Sampler& sampler) {
    for (size_t i = 0; i < dose_.size(); ++i) {
        dose_[i] = std::max(filled_[i] / (part * number), 1e-30f);
        filled_[i] = sampler.next1D();
    }
    begun_ = true;
}

Batch SystematicShadowRays::tested(const SliceEstimate& estimate, const LaneRecord& record, const LaneRays& rays,
                                   const LaneHit& hit, const Batch& brightness, size_t first) {
    const Batch filled = Batch::load_unaligned(filled_.data() + first);
    if (!begun_) {
        (filled + brightness).store_unaligned(filled_.data() + first);
        return Batch(0.0f);
    }
    const Batch dose = Batch::load_unaligned(dose_.data() + first);
    const Batch sum = filled + brightness / dose, whole = xsimd::floor(sum);
    (sum - whole).store_unaligned(filled_.data() + first);
    if (!xsimd::any(whole > 0.0f)) return Batch(0.0f);
    const Batch lit = xsimd::max(brightness, Batch(std::numeric_limits<float>::min()));
    LaneArray factors = stored(xsimd::select(whole > 0.0f, whole * dose / lit, Batch(0.0f)));
    const Lanes3 at = rays.toOrigin + rays.direction * hit.alongRay;
    const LaneArray x = stored(at.x), y = stored(at.y), z = stored(at.z);
    std::array<LaneArray, 4> lengths;
    for (size_t k = 0; k < 4; ++k) lengths[k] = stored(hit.lengths[k]);
    const SliceRecord& flights = *record.flights;
    for (size_t lane = 0; lane < size_t(Lanes); ++lane) {
        if (!(factors[lane] > 0.0f)) continue;
        std::array<double, 4> t;
        for (size_t k = 0; k < 4; ++k) t[k] = double(lengths[k][lane]);
        const bool open = flights.shape == FlightShape::Ball
                              ? estimate.unoccluded(flights, flights.base + Vec3f(x[lane], y[lane], z[lane]))
                              : estimate.unoccluded(flights, t.data(), flights.flights());
        if (!open) factors[lane] = 0.0f;
    }
    return Batch::load_unaligned(factors.data());
}

} // namespace tungsten::photon
