#include "path/light/SplatBuffer.h"

#include <tbb/parallel_for.h>

namespace tungsten::path {

void SplatBuffer::sortByRow(std::vector<Splat>& batch) {
    std::stable_sort(batch.begin(), batch.end(),
                     [](const Splat& a, const Splat& b) { return std::floor(a.raster.y) < std::floor(b.raster.y); });
}

void SplatBuffer::add(const std::vector<std::vector<Splat>>& batches, const ProgressToken& watch) const {
    tbb::parallel_for(0, film_.height(), [&](int y) {
        watch.advance(0);
        for (const auto& batch : batches) addToRow(y, batch);
    });
}

void SplatBuffer::addToRow(int y, const std::vector<Splat>& batch) const {
    const float reach = filter_.reach(), first = std::floor(float(y) - reach), last = float(y) + reach;
    auto splat = std::partition_point(batch.begin(), batch.end(), [&](const Splat& s) { return s.raster.y < first; });
    for (; splat != batch.end() && std::floor(splat->raster.y) <= last; ++splat) {
        const float weight = filter_.pdf(splat->raster.y - float(y)) * scale_;
        if (!(weight > 0.0f)) continue;
        const int from = std::max(int(std::ceil(splat->raster.x - reach)), 0),
                  to = std::min(int(std::floor(splat->raster.x + reach)), film_.width() - 1);
        for (int x = from; x <= to; ++x)
            film_.add(splat->frame, x, y, splat->radiance * (weight * filter_.pdf(splat->raster.x - float(x))));
    }
}

} // namespace tungsten::path
