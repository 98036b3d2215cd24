// Drawing visible points in time: as often as expectation() says, nothing in time left out, sums unbiased.

#include "photon/surface/SurfaceConnections.h"
#include "photon/surface/VisiblePointClusters.h"

#include "support/ChiSquare.h"

#include <gtest/gtest.h>

#include <set>

namespace tungsten::photon {
namespace {

/// Points scattered over a floor and a wall, seen from (0, 3, -4).
struct Corner {
    std::vector<VisibleClusterPoint> points;

    explicit Corner(size_t count) {
        Sampler sampler(7, RandomStream::Test, 0, 0);
        for (size_t i = 0; i < count; ++i) {
            const float u = 4.0f * sampler.next1D() - 2.0f, v = 4.0f * sampler.next1D();
            const Vec3f position = i % 2 ? Vec3f(u, 0.0f, v - 2.0f) : Vec3f(u, v, 2.0f);
            points.push_back({position, i % 2 ? Vec3f(0.0f, 1.0f, 0.0f) : Vec3f(0.0f, 0.0f, -1.0f),
                              (position - Vec3f(0.0f, 3.0f, -4.0f)).length(), 0.01f});
        }
    }
    [[nodiscard]] VisiblePointClusters clusters() const { return {points, Sampler(1, RandomStream::Resample, 0, 0)}; }
    [[nodiscard]] bool inTime(const ClusterQuery& query, uint32_t point) const {
        const float length = (points[point].position - query.position).length() + points[point].cameraLength;
        return std::any_of(query.open.begin(), query.open.end(),
                           [&](const LengthRange& r) { return length >= r.least && length < r.most; });
    }
    [[nodiscard]] double value(const ClusterQuery& query, uint32_t point) const {
        return 1.0 / double((points[point].position - query.position).length2() + sqr(points[point].spread));
    }
};

struct Place {
    const char* name;
    Vec3f position;
    std::vector<LengthRange> open;
    float each; ///< target relative to the weight of all
};

void PrintTo(const Place& place, std::ostream* out) {
    *out << place.name;
}

class VisiblePointClustersAt : public testing::TestWithParam<Place> {};

TEST_P(VisiblePointClustersAt, DrawAsOftenAsExpected) {
    const Place& place = GetParam();
    const Corner corner(3000);
    const VisiblePointClusters clusters = corner.clusters();
    const ClusterQuery query{place.position, place.open};
    const float target = place.each * clusters.weight(query);

    std::vector<size_t> rankOf(corner.points.size());
    for (size_t rank = 0; rank < clusters.order().size(); ++rank) rankOf[clusters.order()[rank]] = rank;
    constexpr int Runs = 4000;
    std::vector<double> observed(corner.points.size()), expected(corner.points.size());
    double exact = 0.0, sum = 0.0, squares = 0.0;
    size_t inTime = 0;
    for (uint32_t i = 0; i < corner.points.size(); ++i) {
        const float expectation = clusters.expectation(query, target, rankOf[i]);
        EXPECT_EQ(expectation > 0.0f, corner.inTime(query, i)) << i;
        expected[i] = Runs * double(expectation);
        if (!corner.inTime(query, i)) continue;
        exact += corner.value(query, i);
        ++inTime;
    }
    ASSERT_GT(inTime, 5u);

    std::vector<VisiblePointSample> draws;
    for (int run = 0; run < Runs; ++run) {
        Sampler sampler(3, RandomStream::Test, 1, uint64_t(run));
        clusters.draw(query, target, sampler, draws);
        double estimate = 0.0;
        for (const VisiblePointSample& draw : draws) {
            ++observed[draw.point];
            estimate += corner.value(query, draw.point) * double(draw.inverseExpectation);
            ASSERT_NEAR(draw.inverseExpectation * clusters.expectation(query, target, rankOf[draw.point]), 1.0f, 2e-3f);
            ASSERT_NEAR((place.position + draw.direction * draw.distance - corner.points[draw.point].position).length(),
                        0.0f, 1e-5f);
        }
        sum += estimate;
        squares += estimate * estimate;
    }
    EXPECT_GT(test::chiSquarePValue(observed, expected), test::SmallestPValue);
    const double mean = sum / Runs, error = std::sqrt(std::max(squares / Runs - mean * mean, 0.0) / Runs);
    EXPECT_NEAR(mean, exact, 4.5 * error);
    EXPECT_LT(error, 0.05 * exact);
    EXPECT_GT(clusters.weight(query), 0.2 * exact);
    EXPECT_LT(clusters.weight(query), 5.0 * exact);
}

INSTANTIATE_TEST_SUITE_P(Places, VisiblePointClustersAt,
                         testing::Values(Place{"InTheRoom", {0.3f, 1.0f, 0.5f}, {{7.0f, 7.3f}}, 0.1f},
                                         Place{"CloseToTheFloor", {0.5f, 0.02f, -1.0f}, {{4.3f, 5.6f}}, 0.05f},
                                         Place{"FewDraws", {-1.0f, 2.0f, 0.0f}, {{7.0f, 7.5f}}, 3.0f},
                                         Place{"TwoRanges", {1.0f, 1.0f, 1.0f}, {{6.5f, 6.6f}, {7.5f, 7.6f}}, 0.02f},
                                         Place{"NoTarget", {0.3f, 1.0f, 0.5f}, {{7.0f, 7.3f}}, 0.0f},
                                         Place{"EveryPoint", {0.0f, 3.0f, -4.0f}, {{0.0f, 100.0f}}, 0.01f}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(VisiblePointClusters, DrawNothingOutOfTime) {
    const Corner corner(500);
    const VisiblePointClusters clusters = corner.clusters();
    const std::vector<LengthRange> early{{0.1f, 1.0f}};
    const ClusterQuery query{{0.0f, 1.0f, 0.0f}, early};
    EXPECT_EQ(clusters.weight(query), 0.0f);
    std::vector<VisiblePointSample> draws(3);
    Sampler sampler(1, RandomStream::Test, 0, 0);
    clusters.draw(query, 1.0f, sampler, draws);
    EXPECT_TRUE(draws.empty());
}

/// Equal contributions are what draws are for: far and near vertices bring about `target` with each.
TEST(VisiblePointClusters, BringAboutTheTargetWithEachDraw) {
    const Corner corner(3000);
    const VisiblePointClusters clusters = corner.clusters();
    const std::vector<LengthRange> open{{5.0f, 9.0f}};
    std::vector<VisiblePointSample> draws;
    for (const Vec3f& position : {Vec3f(0.0f, 2.0f, 0.0f), Vec3f(0.2f, 0.05f, 0.2f)}) {
        const ClusterQuery query{position, open};
        Sampler sampler(1, RandomStream::Test, 0, 0);
        clusters.draw(query, 20.0f, sampler, draws);
        ASSERT_GT(draws.size(), 10u);
        for (const VisiblePointSample& draw : draws) {
            const VisibleClusterPoint& point = corner.points[draw.point];
            const RegularisedConnection seen =
                regularisedConnection(-draw.direction * draw.distance, point.normal, point.spread);
            const double cosine = double(std::max(seen.from.dot(point.normal), 0.05f));
            const double brought = cosine * double(seen.weight) * double(draw.inverseExpectation);
            EXPECT_NEAR(brought, 20.0, 0.1);
        }
    }
}

TEST(VisiblePointClusters, ListARandomPartOfVeryManyPoints) {
    Corner corner(8);
    corner.points.resize(VisiblePointClusters::MostPoints * 3 / 2, corner.points[0]);
    const VisiblePointClusters clusters = corner.clusters();
    ASSERT_EQ(clusters.order().size(), VisiblePointClusters::MostPoints);
    EXPECT_EQ(std::set<uint32_t>(clusters.order().begin(), clusters.order().end()).size(),
              VisiblePointClusters::MostPoints);
    const auto late = std::count_if(clusters.order().begin(), clusters.order().end(),
                                    [](uint32_t i) { return i >= VisiblePointClusters::MostPoints; });
    // Hypergeometric: a third of the points, two thirds drawn.
    const double n = double(VisiblePointClusters::MostPoints);
    EXPECT_NEAR(double(late), n / 3.0, 5.0 * std::sqrt(n * (1.0 / 3.0) * (2.0 / 3.0) * (1.0 / 3.0)));
}

TEST(CommonTarget, SharesDrawsButNotForOneVertexAlone) {
    EXPECT_FLOAT_EQ(lightPerConnection({1.0f, 2.0f, 3.0f}, 12.0), 0.5f);
    // 64 for the greatest, 36 for the rest, worth 9.
    EXPECT_FLOAT_EQ(lightPerConnection({4.0f, 1e6f, 5.0f}, 100.0), 0.25f);
    EXPECT_FLOAT_EQ(lightPerConnection({1e6f, 2e6f}, 50.0), 3e6f / 50.0f);
    EXPECT_EQ(lightPerConnection({0.0f, 0.0f}, 50.0), 0.0f);
    EXPECT_EQ(lightPerConnection({}, 50.0), 0.0f);
    // More than all can do together: each as often as it may.
    EXPECT_FLOAT_EQ(lightPerConnection({64.0f, 128.0f}, 1000.0), 1.0f);
}

} // namespace
} // namespace tungsten::photon
