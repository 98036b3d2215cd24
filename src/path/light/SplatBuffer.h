#pragma once
// Contributions to any place of the image, in an order that does not depend on the threads.

#include "tungsten/camera/ReconstructionFilter.h"
#include "tungsten/film/Film.h"
#include "tungsten/integrator/ProgressToken.h"

#include <vector>

namespace tungsten::path {

struct Splat {
    Vec2f raster; ///< in pixels; whole numbers are pixels' centres
    int32_t frame;
    Rgb radiance;
};

/// Adds splats to the pass image, weighed by the filter's density about each pixel.
class SplatBuffer {
  public:
    SplatBuffer(Film& film, const ReconstructionFilter& filter, float scale)
        : film_(film), filter_(filter), scale_(scale) {}

    /// Order within a batch in which add() takes it; batches can be prepared in parallel.
    static void sortByRow(std::vector<Splat>& batch);
    /// Batches in their order. Rows of the image are filled in parallel, each pixel by one thread.
    void add(const std::vector<std::vector<Splat>>& batches, const ProgressToken& watch) const;

  private:
    void addToRow(int y, const std::vector<Splat>& batch) const;

    Film& film_;
    const ReconstructionFilter& filter_;
    float scale_;
};

} // namespace tungsten::path
