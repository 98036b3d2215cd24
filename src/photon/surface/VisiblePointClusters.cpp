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

// ---- What is drawn: weights by registers, of clusters first, then of the points in one

namespace {

/// Grazing points are drawn a little, too.
constexpr float LeastCosine = 0.05f;

/// A sliver of a cluster's bounds may be all of its points.
constexpr float LeastPart = 0.2f;

} // namespace

/// What can be drawn: registers of consecutive members, those without any weight left out. A register whose weight is
/// lost in the sum's rounding is never drawn: less than 1e-7 of all.
template <size_t Capacity>
struct VisiblePointClusters::Weights {
    static constexpr size_t Most = (Capacity + size_t(Lanes) - 1) / size_t(Lanes);
    alignas(64) std::array<float, Most * size_t(Lanes)> weights;
    std::array<float, Most + 1> sums; ///< of the registers before
    std::array<uint16_t, Most> first; ///< members
    size_t count = 0;                 ///< of registers

    Weights() { sums[0] = 0.0f; }
    void add(size_t member, const Batch& weight) {
        if (!xsimd::any(weight > 0.0f)) return;
        weight.store_aligned(weights.data() + count * size_t(Lanes));
        first[count] = uint16_t(member);
        sums[count + 1] = sums[count] + darts::lanes::sum(weight);
        ++count;
    }
    [[nodiscard]] float total() const { return sums[count]; }
    struct ClusterSample {
        size_t member;
        float weight;
    };
    /// The member in which a part of the total, above 0, falls.
    [[nodiscard]] ClusterSample choose(float part) const {
        const auto begin = sums.begin() + 1;
        const auto found = std::upper_bound(begin, begin + ptrdiff_t(count), part);
        const size_t place = std::min(size_t(found - begin), count - 1);
        const float* own = weights.data() + place * size_t(Lanes);
        float rest = part - sums[place];
        size_t last = 0; // with a weight
        for (size_t k = 0; k < size_t(Lanes); ++k) {
            if (!(own[k] > 0.0f)) continue;
            last = k;
            rest -= own[k];
            if (rest < 0.0f) break;
        }
        return {first[place] + last, own[last]};
    }
    [[nodiscard]] float weightOf(size_t member) const {
        for (size_t i = 0; i < count; ++i)
            if (member >= first[i] && member < first[i] + size_t(Lanes))
                return weights[i * size_t(Lanes) + member - first[i]];
        return 0.0f;
    }
};

int VisiblePointClusters::visitsFor(float wanted) {
    return int(std::clamp(std::ceil(wanted), 1.0f, MostVisits));
}

template <typename Visit>
void VisiblePointClusters::eachNeighbourhood(const ClusterQuery& query, const Visit& visit) const {
    for (size_t i = 0; i * size_t(Lanes) < cx_.size(); i += size_t(Lanes)) {
        const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
        const Batch dx = load(ux_) - query.position.x, dy = load(uy_) - query.position.y,
                    dz = load(uz_) - query.position.z;
        const Batch length = xsimd::sqrt(dx * dx + dy * dy + dz * dz) + load(uLength_), reach = load(uReach_);
        auto open = length < -1.0f;
        for (const LengthRange& range : query.open)
            open = open || (length + reach > range.least && length - reach < range.most);
        eachLane(open, [&](size_t k) { visit((i + k) * size_t(Lanes)); });
    }
}

VisiblePointClusters::ClusterWeights VisiblePointClusters::weighClusters(const ClusterQuery& query) const {
    ClusterWeights weights;
    eachNeighbourhood(query, [&](size_t i) {
        const auto load = [i](const std::vector<float>& v) { return Batch::load_unaligned(v.data() + i); };
        const Batch dx = load(cx_) - query.position.x, dy = load(cy_) - query.position.y,
                    dz = load(cz_) - query.position.z;
        const Batch squared = dx * dx + dy * dy + dz * dz;
        const Batch reach = load(reach_), length = xsimd::sqrt(squared) + load(centreLength_);
        Batch open(0.0f);
        for (const LengthRange& range : query.open) {
            const Batch part =
                xsimd::min(length + reach, Batch(range.most)) - xsimd::max(length - reach, Batch(range.least));
            const Batch least = LeastPart * xsimd::min(2.0f * reach, Batch(range.most - range.least));
            open += xsimd::select(part > 0.0f, xsimd::max(part, least), Batch(0.0f));
        }
        weights.add(i, load(size_) * open / (2.0f * reach * (squared + load(squaredSize_))));
    });
    return weights;
}

VisiblePointClusters::PointWeights VisiblePointClusters::weighPoints(const ClusterQuery& query, size_t cluster) const {
    PointWeights weights;
    const auto lanes = Batch::load_aligned(LaneNumbers);
    const size_t first = begin_[cluster], count = begin_[cluster + 1] - first;
    for (size_t i = 0; i < count; i += size_t(Lanes)) {
        const auto load = [at = first + i](const std::vector<float>& v) {
            return Batch::load_unaligned(v.data() + at);
        };
        const Batch dx = load(x_) - query.position.x, dy = load(y_) - query.position.y,
                    dz = load(z_) - query.position.z;
        const Batch squared = dx * dx + dy * dy + dz * dz;
        const Batch distance = xsimd::sqrt(squared + 1e-30f), length = distance + load(cameraLength_);
        auto inTime = length < -1.0f;
        for (const LengthRange& range : query.open) inTime = inTime || (length >= range.least && length < range.most);
        const Batch height = xsimd::abs(dx * load(nx_) + dy * load(ny_) + dz * load(nz_));
        const Batch lift = xsimd::max(load(spread_) - height, Batch(0.0f));
        const Batch lifted = squared + lift * (2.0f * height + lift) + 1e-30f;
        const Batch weight = xsimd::max((height + lift) / xsimd::sqrt(lifted), Batch(LeastCosine)) / lifted;
        inTime = inTime && lanes < float(count - i);
        weights.add(i, xsimd::select(inTime, weight, Batch(0.0f)));
    }
    return weights;
}

float VisiblePointClusters::weight(const ClusterQuery& query) const {
    return weighClusters(query).total();
}

void VisiblePointClusters::draw(const ClusterQuery& query, float weightPerDraw, Sampler& sampler,
                                std::vector<VisiblePointSample>& draws) const {
    draws.clear();
    const ClusterWeights clusters = weighClusters(query);
    if (!(clusters.total() > 0.0f)) return;
    if (!(weightPerDraw > 0.0f)) weightPerDraw = clusters.total() / DefaultDraws;
    const int visits = visitsFor(clusters.total() / weightPerDraw);
    for (int i = 0; i < visits; ++i) {
        const float part = (float(i) + sampler.next1D()) / float(visits), u = sampler.next1D();
        const auto cluster = clusters.choose(part * clusters.total());
        const PointWeights points = weighPoints(query, cluster.member);
        if (!(points.total() > 0.0f)) continue;
        const float inverseVisits = clusters.total() / (cluster.weight * float(visits));
        const float expected = std::min(points.total() * inverseVisits / weightPerDraw, MostPerVisit);
        const int count = int(expected + u);
        for (int k = 0; k < count; ++k) {
            const auto point = points.choose((float(k) + sampler.next1D()) / float(count) * points.total());
            const size_t rank = begin_[cluster.member] + point.member;
            const Vec3f offset(x_[rank] - query.position.x, y_[rank] - query.position.y, z_[rank] - query.position.z);
            const float distance = offset.length();
            if (!(distance > 0.0f)) continue;
            draws.push_back({order_[rank], distance, offset / distance,
                             inverseVisits * points.total() / (point.weight * expected)});
        }
    }
}

float VisiblePointClusters::expectation(const ClusterQuery& query, float weightPerDraw, size_t rank) const {
    const ClusterWeights clusters = weighClusters(query);
    const size_t cluster = size_t(std::upper_bound(begin_.begin(), begin_.end(), uint32_t(rank)) - begin_.begin()) - 1;
    const float chosen = clusters.weightOf(cluster);
    if (!(chosen > 0.0f)) return 0.0f;
    if (!(weightPerDraw > 0.0f)) weightPerDraw = clusters.total() / DefaultDraws;
    const float visits = float(visitsFor(clusters.total() / weightPerDraw)) * chosen / clusters.total();
    const PointWeights points = weighPoints(query, cluster);
    if (!(points.total() > 0.0f)) return 0.0f;
    return visits * std::min(points.total() / (visits * weightPerDraw), MostPerVisit) *
           points.weightOf(rank - begin_[cluster]) / points.total();
}

} // namespace tungsten::photon
