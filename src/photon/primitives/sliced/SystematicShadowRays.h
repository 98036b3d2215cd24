#pragma once
// Shadow rays of slices that are drawn a register of rays at a time.

#include "photon/primitives/sliced/SliceEstimate.h"
#include "photon/primitives/sliced/SliceLanes.h"

namespace tungsten::photon {

/// Whole doses in place of weights: shadow rays cost a hundred times what weights do. Whenever what a ray has been
/// given fills another dose, by the record at hand, that one is tested and stands for the dose; evenly from a random
/// start, so that every record brings what it weighs on average, whatever the doses are.
class SystematicShadowRays {
  public:
    /// For so many rays. Until begin() all is counted and nothing let through: a pilot over a part of the records.
    void reserve(size_t rays) {
        dose_.assign(rays, 1.0f);
        filled_.assign(rays, 0.0f);
        begun_ = false;
    }
    /// The pilot has shown `part` of what comes: about `number` doses for each ray.
    void begin(float part, float number, Sampler& sampler);

    /// Factors on weights of this brightness at rays `first`...: 0 for what is not tested, or not seen. The rays'
    /// origins are relative to the base.
    [[nodiscard]] Batch tested(const SliceEstimate& estimate, const LaneRecord& record, const LaneRays& rays,
                               const LaneHit& hit, const Batch& brightness, size_t first);

  private:
    std::vector<float> dose_, filled_;
    bool begun_ = false;
};

} // namespace tungsten::photon
