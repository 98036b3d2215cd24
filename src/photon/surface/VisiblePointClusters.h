#pragma once
// Visible points in clusters of neighbours, to draw those that light from some place reaches in time.

#include "tungsten/core/Random.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace tungsten::photon {

/// A point that the camera sees; `cameraLength` is what it adds to the length of a flight, `spread` that of
/// regularisedConnection().
struct VisibleClusterPoint {
    Vec3f position, normal;
    float cameraLength, spread;
};

/// Range of lengths of a flight from a vertex by way of a visible point to where time ends: the camera, or the point
/// itself.
struct LengthRange {
    float least, most;
};

/// From where to draw; flights count whose length is in one of the ranges.
struct ClusterQuery {
    Vec3f position;
    std::span<const LengthRange> open;
};

/// A visible point in time, with 1 / the expected number of its draws.
struct VisiblePointSample {
    uint32_t point; ///< index
    float distance;
    Vec3f direction; ///< from the vertex
    float inverseExpectation;
};

/// At most MostPoints of the points are kept, at random; each stands for (points) / (points kept).
class VisiblePointClusters {
  public:
    static constexpr size_t MostPoints = size_t(1) << 18;

    VisiblePointClusters(const std::vector<VisibleClusterPoint>& points, Sampler sampler);

    /// About the sum over the points in time of 1 / (d^2 + spread^2), whatever their cosines.
    [[nodiscard]] float weight(const ClusterQuery& query) const;
    /// Draws points in time, with probability about proportional to cosine / d^2 from the vertex lifted by the spread
    /// (regularisedConnection), so many that each stands for `weightPerDraw` of the sum of that: first clusters by an
    /// estimate, then points in them by their true weights. With 0 about DefaultDraws.
    void draw(const ClusterQuery& query, float weightPerDraw, Sampler& sampler,
              std::vector<VisiblePointSample>& draws) const;
    /// How often draw() is expected to draw a kept point (by its rank in order()).
    [[nodiscard]] float expectation(const ClusterQuery& query, float weightPerDraw, size_t rank) const;
    /// Kept points, cluster by cluster.
    [[nodiscard]] const std::vector<uint32_t>& order() const { return order_; }

  private:
    static constexpr size_t MostClusters = 1024, LeastSize = 8, MostSize = MostPoints / MostClusters + 8;
    static constexpr float MostVisits = 32.0f, MostPerVisit = 64.0f; ///< of clusters, of points in one
    static constexpr float DefaultDraws = 8.0f;

    template <size_t Capacity>
    struct Weights;
    using ClusterWeights = Weights<MostClusters>;
    using PointWeights = Weights<MostSize>;

    // How clusters are made.
    void split(size_t first, size_t last, size_t parts, const std::vector<VisibleClusterPoint>& points);
    void addCluster(size_t first, size_t last, const std::vector<VisibleClusterPoint>& points);
    void addNeighbourhoods();

    // How points are drawn.
    /// Calls `visit` with the first cluster of every register that may hold one in time.
    template <typename Visit>
    void eachNeighbourhood(const ClusterQuery& query, const Visit& visit) const;
    [[nodiscard]] ClusterWeights weighClusters(const ClusterQuery& query) const;
    /// Weights of the points of a cluster, counted from its first.
    [[nodiscard]] PointWeights weighPoints(const ClusterQuery& query, size_t cluster) const;
    [[nodiscard]] static int visitsFor(float wanted);

    std::vector<uint32_t> order_, begin_; ///< begin_[c]: rank of cluster c's first point; one more entry
    std::vector<float> x_, y_, z_, cameraLength_, spread_, nx_, ny_, nz_;         ///< of points, by rank
    std::vector<float> cx_, cy_, cz_, squaredSize_, centreLength_, reach_, size_; ///< of clusters
    std::vector<float> ux_, uy_, uz_, uLength_, uReach_; ///< that hold a register of neighbouring clusters each
};

} // namespace tungsten::photon
