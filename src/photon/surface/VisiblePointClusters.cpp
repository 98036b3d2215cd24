#include "photon/surface/VisiblePointClusters.h"

#include "photon/raster/Registers.h"

#include <numeric>

namespace tungsten::photon {

VisiblePointClusters::VisiblePointClusters(const std::vector<VisibleClusterPoint>& points, Sampler sampler) {
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (order_.size() > MostPoints) {
        for (size_t i = 0; i < MostPoints; ++i) {
            const size_t left = order_.size() - i;
            std::swap(order_[i], order_[i + std::min(size_t(double(sampler.next1D()) * double(left)), left - 1)]);
        }
        order_.resize(MostPoints);
    }
    begin_.push_back(0);
    if (order_.empty()) return;
    split(0, order_.size(), std::clamp<size_t>(order_.size() / LeastSize, 1, MostClusters), points);
    addNeighbourhoods();
    // Whole registers can be read from any place.
    size_.resize(size_.size() + size_t(Lanes), 0.0f);
    for (auto* v : {&cx_, &cy_, &cz_, &squaredSize_, &centreLength_, &reach_, &x_, &y_, &z_, &cameraLength_, &spread_,
                    &nx_, &ny_, &nz_, &ux_, &uy_, &uz_, &uLength_})
        v->resize(v->size() + size_t(Lanes), 1.0f);
}

void VisiblePointClusters::split(size_t first, size_t last, size_t parts,
                                 const std::vector<VisibleClusterPoint>& points) {
    if (parts <= 1) {
        addCluster(first, last, points);
        return;
    }
    const auto coordinate = [&](uint32_t i, int axis) {
        return axis < 3 ? points[i].position[axis] : points[i].cameraLength;
    };
    int widest = 0;
    float width = -1.0f;
    for (int axis = 0; axis < 4; ++axis) {
        float low = Infinity, high = -Infinity;
        for (size_t i = first; i < last; ++i) {
            low = std::min(low, coordinate(order_[i], axis));
            high = std::max(high, coordinate(order_[i], axis));
        }
        if (high - low > width) {
            width = high - low;
            widest = axis;
        }
    }
    const size_t left = parts / 2, middle = first + (last - first) * left / parts;
    std::nth_element(order_.begin() + ptrdiff_t(first), order_.begin() + ptrdiff_t(middle),
                     order_.begin() + ptrdiff_t(last),
                     [&](uint32_t a, uint32_t b) { return coordinate(a, widest) < coordinate(b, widest); });
    split(first, middle, left, points);
    split(middle, last, parts - left, points);
}

void VisiblePointClusters::addCluster(size_t first, size_t last, const std::vector<VisibleClusterPoint>& points) {
    Vec3f low(Infinity), high(-Infinity);
    float shortest = Infinity, longest = -Infinity, squaredSpreads = 0.0f;
    for (size_t i = first; i < last; ++i) {
        const VisibleClusterPoint& point = points[order_[i]];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], point.position[axis]);
            high[axis] = std::max(high[axis], point.position[axis]);
        }
        shortest = std::min(shortest, point.cameraLength);
        longest = std::max(longest, point.cameraLength);
        x_.push_back(point.position.x);
        y_.push_back(point.position.y);
        z_.push_back(point.position.z);
        nx_.push_back(point.normal.x);
        ny_.push_back(point.normal.y);
        nz_.push_back(point.normal.z);
        cameraLength_.push_back(point.cameraLength);
        spread_.push_back(point.spread);
        squaredSpreads += point.spread * point.spread;
    }
    const Vec3f centre = (low + high) * 0.5f;
    const float radius = (high - low).length() * 0.5f;
    cx_.push_back(centre.x);
    cy_.push_back(centre.y);
    cz_.push_back(centre.z);
    squaredSize_.push_back(radius * radius + squaredSpreads / float(last - first));
    centreLength_.push_back(0.5f * (shortest + longest));
    // Wide enough for rounding.
    const float scale = std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z) + longest;
    reach_.push_back(1.0001f * radius + 0.5f * (longest - shortest) + 1e-5f * scale + 1e-20f);
    size_.push_back(float(last - first));
    begin_.push_back(uint32_t(last));
}

void VisiblePointClusters::addNeighbourhoods() {
    const size_t count = cx_.size();
    for (size_t first = 0; first < count; first += size_t(Lanes)) {
        const size_t last = std::min(first + size_t(Lanes), count), middle = (first + last) / 2;
        const Vec3f centre(cx_[middle], cy_[middle], cz_[middle]);
        float reach = 0.0f;
        for (size_t i = first; i < last; ++i)
            reach = std::max(reach, (Vec3f(cx_[i], cy_[i], cz_[i]) - centre).length() +
                                        std::abs(centreLength_[i] - centreLength_[middle]) + reach_[i]);
        ux_.push_back(centre.x);
        uy_.push_back(centre.y);
        uz_.push_back(centre.z);
        uLength_.push_back(centreLength_[middle]);
        uReach_.push_back(1.0001f * reach);
    }
    uReach_.resize(uReach_.size() + size_t(Lanes), -Infinity);
}

} // namespace tungsten::photon
