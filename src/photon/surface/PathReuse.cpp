#include "photon/surface/PathReuse.h"

#include "photon/Tuning.h"
#include "photon/raster/Registers.h"

#include "tungsten/integrator/Names.h"

#include <tbb/parallel_for.h>

namespace tungsten::photon {

namespace {

/// Where each element's group begins in an order by group; one more entry at the end.
template <typename Group>
std::vector<uint32_t> beginnings(size_t groups, size_t elements, const Group& group) {
    std::vector<uint32_t> begin(groups + 1, 0);
    for (size_t i = 0; i < elements; ++i) ++begin[group(i) + 1];
    for (size_t g = 0; g < groups; ++g) begin[g + 1] += begin[g];
    return begin;
}

/// What decides which points have something to say about each other's light, as arrays over the points.
class SurfaceSimilarity {
  public:
    SurfaceSimilarity(const std::vector<VisiblePoint>& points, float distance) : squaredDistance_(sqr(distance)) {
        const size_t count = points.size() + size_t(Lanes); // whole registers can be read from any place
        for (auto* v : {&x_, &y_, &z_, &nx_, &ny_, &nz_, &interactions_, &medium_}) v->resize(count);
        for (size_t i = 0; i < points.size(); ++i) {
            const Vec3f &position = points[i].hit.position, &normal = points[i].hit.ng;
            x_[i] = position.x, y_[i] = position.y, z_[i] = position.z;
            nx_[i] = normal.x, ny_[i] = normal.y, nz_[i] = normal.z;
            interactions_[i] = float(points[i].interactions);
            medium_[i] = float(points[i].region.medium);
        }
    }

    /// Calls `visit` with those of the points `first` to last - 1 that are near point p on one smooth surface and seen
    /// equally; returns how many those are.
    template <typename Visit>
    size_t eachAlike(size_t p, size_t first, size_t last, const Visit& visit) const {
        constexpr float LeastAlignment = 0.95f, MostSlope = 0.2f;
        const auto lanes = Batch::load_aligned(LaneNumbers);
        size_t count = 0;
        for (size_t q = first; q < last; q += size_t(Lanes)) {
            const auto load = [q](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + q); };
            const Batch dx = load(x_) - x_[p], dy = load(y_) - y_[p], dz = load(z_) - z_[p];
            const Batch squared = dx * dx + dy * dy + dz * dz;
            auto alike = squared <= squaredDistance_ && lanes < float(last - q);
            if (!xsimd::any(alike)) continue;
            const Batch nx = load(nx_), ny = load(ny_), nz = load(nz_);
            const Batch own = dx * nx_[p] + dy * ny_[p] + dz * nz_[p], others = dx * nx + dy * ny + dz * nz;
            alike = alike && nx * nx_[p] + ny * ny_[p] + nz * nz_[p] >= LeastAlignment &&
                    xsimd::max(own * own, others * others) <= sqr(MostSlope) * squared &&
                    load(interactions_) == interactions_[p] && load(medium_) == medium_[p];
            eachLane(alike, [&](size_t k) {
                ++count;
                visit(q + k);
            });
        }
        return count;
    }

  private:
    float squaredDistance_;
    std::vector<float> x_, y_, z_, nx_, ny_, nz_, interactions_, medium_;
};

class Sharing {
  public:
    Sharing(const Scene& scene, const CameraRecord& record, const std::vector<ConnectionRecord>& received,
            const ReuseKernel& kernel, double scale, Film& film)
        : scene_(scene), record_(record), likeness_(record.points, kernel.distance), kernel_(kernel), scale_(scale),
          film_(film), reach_(int(std::floor(kernel.pixels))),
          firstPoint_(
              beginnings(record.x.size(), record.points.size(), [&](size_t i) { return record.points[i].pixel; })),
          first_(beginnings(record.points.size(), received.size(), [&](size_t i) { return received[i].point; })) {
        std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
        sorted_.resize(received.size());
        for (const ConnectionRecord& one : received) sorted_[next[one.point]++] = &one;
    }

    /// Returns how many values were not finite.
    [[nodiscard]] uint64_t row(int y, const ProgressToken& watch) const {
        uint64_t nonFinite = 0;
        std::vector<Vec3d> sums(size_t(film_.frames()));
        std::vector<uint32_t> neighbours;
        for (int x = 0; x < record_.width; ++x) {
            watch.advanceWithin(1, uint64_t(x));
            const size_t pixel = size_t(y) * size_t(record_.width) + size_t(x);
            for (uint32_t p = firstPoint_[pixel]; p < firstPoint_[pixel + 1]; ++p) {
                const size_t among = findNeighbours(p, x, y, neighbours);
                if (neighbours.empty()) continue;
                std::fill(sums.begin(), sums.end(), Vec3d(0.0));
                reflect(record_.points[p], neighbours, sums);
                for (size_t frame = 0; frame < sums.size(); ++frame) {
                    const Vec3d value = sums[frame] * (scale_ / double(among));
                    const Rgb radiance(value);
                    if (isFinite(radiance))
                        film_.add(int(frame), x, y, radiance);
                    else
                        ++nonFinite;
                }
            }
        }
        return nonFinite;
    }

  private:
    /// Lists the points in the kernel about `p` at which something arrived; returns how many there are in all.
    size_t findNeighbours(uint32_t p, int x, int y, std::vector<uint32_t>& found) const {
        found.clear();
        size_t among = 0;
        for (int v = std::max(y - reach_, 0); v <= std::min(y + reach_, record_.height - 1); ++v) {
            // Half chord of the disc in this row.
            const int half = int(std::sqrt(std::max(sqr(kernel_.pixels) - sqr(float(v - y)), 0.0f)));
            const size_t start = size_t(v) * size_t(record_.width);
            const uint32_t first = firstPoint_[start + size_t(std::max(x - half, 0))],
                           last = firstPoint_[start + size_t(std::min(x + half, record_.width - 1)) + 1];
            among += likeness_.eachAlike(p, first, last, [&](size_t q) {
                if (first_[q + 1] > first_[q]) found.push_back(uint32_t(q));
            });
        }
        return among;
    }

    void reflect(const VisiblePoint& point, const std::vector<uint32_t>& neighbours, std::vector<Vec3d>& sums) const {
        const transport::Vertex vertex = point.vertex(scene_);
        for (const uint32_t q : neighbours)
            for (uint32_t i = first_[q]; i < first_[q + 1]; ++i) {
                const ConnectionRecord& one = *sorted_[i];
                if (std::abs(one.offCentre) > kernel_.time) continue;
                const Rgb radiance = vertex.scattering(one.from) * one.light * point.throughput;
                sums[size_t(one.frame)] += Vec3d(radiance);
            }
    }

    const Scene& scene_;
    const CameraRecord& record_;
    SurfaceSimilarity likeness_;
    ReuseKernel kernel_;
    double scale_;
    Film& film_;
    int reach_;
    std::vector<uint32_t> firstPoint_; ///< of a pixel
    std::vector<uint32_t> first_;      ///< of a point, in sorted_
    std::vector<const ConnectionRecord*> sorted_;
};

} // namespace

ReuseKernel ReuseKernel::of(float gatherRadius, float factor) {
    return {tuning::SharedPixels * factor, gatherRadius * factor};
}

void reuseAcrossPixels(const Scene& scene, const transport::TimeSensor& sensor, const CameraRecord& record,
                       const std::vector<ConnectionRecord>& received, const ReuseKernel& kernel, double scale,
                       Film& film, Statistics& statistics, const ProgressToken& watch) {
    if (received.empty()) return;
    const double width = sensor.gate.frameWidth * double(kernel.time);
    const Sharing sharing(scene, record, received, kernel, scale / width, film);
    watch.stage("path reuse", uint64_t(record.height));
    tbb::parallel_for(0, record.height, [&](int y) {
        statistics.add(counter::NonFiniteSamples, sharing.row(y, watch));
        watch.advance();
    });
}

} // namespace tungsten::photon
