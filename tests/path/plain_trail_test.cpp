// What guided steps say of a way afterwards is what they summed while they drew it.

#include "path/guided_setup.h"
#include "support/PlainState.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

using transport::Ahead;
using transport::Flight;
using transport::WalkVertex;
using transport::Way;

/// Follows a guided path as if it were a plain one, and compares.
class Replay : public transport::VisitorBase {
  public:
    Replay(const GuidedContext& context, const TargetChoice& targets, PixelAccumulator& sink, PathCounters& counters,
           const PathTarget& target, const Sampler& light)
        : context_(&context) {
        emitter_ = size_t(target.index);
        point_ = *target.u;
        const SurfaceMargin margin = target.vertex.margin();
        met_.position = target.vertex.position();
        met_.ng = margin.normal;
        met_.error = margin.error;
        trail_.start(context, targets, sink, counters, light);
    }

    [[nodiscard]] bool mayGoOn(const PathState& path) const {
        return context_->settings.limits.mayGoOn(path.interactions) && path.interactions < 60;
    }
    bool ahead(PathState& path, StepsToEmitter&, const Ahead& ahead) {
        before_ = path.channels;
        trail_.fly(test::plainly(path), ahead);
        return true;
    }
    bool arrive(PathState& path, StepsToEmitter& steps, const Ahead& ahead, const Flight& flight) {
        if (!(steps.target().u == point_)) return false; // it has chosen another one of its emitter's points
        const bool collided = flight.event == Flight::Event::Collision;
        Flight plain = flight;
        plain.pdf = transport::PlainFlight{ahead.medium, ahead.reach(), before_}.like(flight).pdf;
        if (collided) {
            const ChannelDensities channels = flightThatCollides(*ahead.medium, flight.distance, before_).channels;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(path.channels[c], channels[c], 1e-5f);
        }
        const float ending = collided ? steps.inMedium(flight.distance).logRatio : steps.logRatioOnSurface();
        trail_.arrive(test::plainly(path), ahead, plain);
        const float tolerance = 1e-4f * float(1 + path.interactions) * (1.0f + std::abs(path.logRatio));
        EXPECT_NEAR(trail_.atVertex(emitter_, 0.0, false), ending, tolerance) << path.interactions;
        EXPECT_NEAR(trail_.there(emitter_), path.logRatio, tolerance) << path.interactions;
        // Met, the target is connected to as densely; where guided paths nearly always have ended, nothing counts.
        if (collided && path.logRatio > -6.0f) {
            EXPECT_NEAR(std::log(trail_.connectionsOverPlain(emitter_, met_, 0.0)),
                        std::log(trail_.connectionsOverPlain(emitter_, 0.0)), tolerance)
                << path.interactions;
        }
        ++compared;
        largest = std::max(largest, std::abs(path.logRatio));
        return true;
    }
    void leave(PathState&, StepsToEmitter&, const WalkVertex& vertex, const Way& way) {
        Way plain = way;
        if (vertex.medium) plain.weight = Rgb(1.0f);
        trail_.leave(plain);
    }

    static inline int compared = 0;
    static inline float largest = 0.0f;

  private:
    const GuidedContext* context_;
    PlainTrail trail_; ///< a value: copies of a path that is split have one each
    size_t emitter_ = 0;
    Vec2f point_;
    SurfaceHit met_; ///< the target
    ChannelDensities before_{1.0f};
};

std::string sceneOf(const std::string& medium, const std::string& more, const std::string& integrator) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", )" + medium + R"(}],
      "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"rotation": [10, 20, 0]}},
                     {"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                      "transform": {"position": [1.2, 0.9, 0.8], "scale": 0.3}})" +
           more + R"(],
      "camera": {"resolution": 1, "fov": 15, "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
      "integrator": {"type": "path_tracer", "max_bounces": 128, "darts": "best", )" +
           integrator + R"(}, "renderer": {}})";
}

void replay(const std::string& json) {
    const GuidedSetup setup(json);
    const Scene& scene = setup.scene;
    const GuidedContext context = setup.guided();
    Replay::compared = 0;
    Replay::largest = 0.0f;
    for (uint64_t i = 0; i < 2400; ++i) {
        PathCounters counters;
        SharePilot pilot;
        PixelAccumulator sink(pilot, setup.sensor, counters);
        const Sampler sampler(1, RandomStream::Test, 0, i);
        Sampler light = sampler.branch(RandomStream::Target, 0);
        const auto target = setup.targets.of(0, light, setup.watch, counters);
        ASSERT_TRUE(target);
        Sampler lens = sampler;
        const Ray ray = scene.camera.generateRay({0, 0}, lens.next2D(), lens.next2D());
        transport::Walk walk{
            PathState{
                .random = sampler, .ray = ray, .region = scene.cameraRegion, .timed = !scene.transport.cameraUnwarped},
            StepsToEmitter(context, counters, *target),
            Replay(context, setup.targets, sink, counters, *target, sampler)};
        walk.run();
    }
    EXPECT_GT(Replay::compared, 500);
    EXPECT_GT(Replay::largest, 1.0f) << "guided paths go as plain ones do: nothing is tested";
}

const std::string Gate = R"("transient_time_center": 7.6, "transient_time_width": 1.5)",
                  Floor = R"(, {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.6},
                      "transform": {"position": [0, -0.9, 0], "scale": 6}})",
                  Glossy = R"(, {"type": "quad", "bsdf": {"type": "plastic", "albedo": 0.5},
                      "transform": {"position": [0, -0.9, 0], "scale": 6}})";

TEST(PlainTrail, AsksForWhatGuidedPathsHaveSummed) {
    for (const std::string& medium :
         {std::string(R"("sigma_s": 4, "sigma_a": 0.1)"), std::string(R"("sigma_s": 60, "sigma_a": 0)"),
          std::string(R"("sigma_s": [2, 4, 8], "sigma_a": [0.3, 0.1, 0])"),
          std::string(R"("sigma_s": 20, "sigma_a": 0, "phase_function": {"type": "henyey_greenstein", "g": 0.9})"),
          std::string(R"("sigma_s": 4, "sigma_a": 0, "phase_function": {"type": "henyey_greenstein", "g": 0.4})")}) {
        SCOPED_TRACE(medium);
        replay(sceneOf(medium, "", Gate));
    }
}

TEST(PlainTrail, AsksOnSurfacesToo) {
    for (const std::string& surface : {Floor, Glossy})
        replay(sceneOf(R"("sigma_s": 4, "sigma_a": 0.1)", surface, Gate));
}

TEST(PlainTrail, AsksWhereTimeStartsAtTheFirstVertex) {
    replay(sceneOf(R"("sigma_s": 4, "sigma_a": 0.1)", "",
                   R"("camera_unwarped": true, "transient_time_center": 2.6, "transient_time_width": 1.5)"));
}

TEST(PlainTrail, AsksWithRoulette) {
    replay(sceneOf(R"("sigma_s": 4, "sigma_a": 3)", "", Gate + R"(, "enable_rr": true)"));
}

/// Points of a lamp that guided paths choose, in 64 squares of their random numbers, against the densities that plain
/// paths are told.
TEST(PlainTrail, DensitiesOfPointsAreThoseTheyAreChosenBy) {
    constexpr int Side = 8, Paths = 40000;
    const GuidedSetup setup(
        sceneOf(R"("sigma_s": 60, "sigma_a": 0)", "", R"("transient_time_center": 6.5, "transient_time_width": 0.2)"));
    const GuidedContext context = setup.guided();
    PathCounters counters;
    std::array<double, Side * Side> chosen{}, expected{}, squares{};
    const auto square = [](const Vec2f& u) { return size_t(u.y * Side) * Side + size_t(u.x * Side); };
    for (uint64_t i = 0; i < 2 * Paths; ++i) {
        const bool guides = i % 2 == 0;
        Sampler light(1, RandomStream::Test, 1, i);
        const auto target = setup.targets.of(0, light, setup.watch, counters);
        ASSERT_TRUE(target);
        PathState path{.random = Sampler(1, RandomStream::Test, 2, i),
                       .ray = setup.scene.camera.generateRay({0, 0}, {0.5f, 0.5f}, {0.5f, 0.5f}),
                       .region = setup.scene.cameraRegion,
                       .timed = true};
        StepsToEmitter steps(context, counters, *target);
        const Ahead empty = steps.ahead(path);
        ASSERT_TRUE(empty.flies && empty.hit);
        path.ray.origin = empty.hit->position;
        path.time += double(empty.hit->t);
        path.region = setup.scene.primitives[0].inside;
        const float before = path.logRatio;
        if (guides) {
            steps.ahead(path);
            chosen[square(*steps.target().u)] += 1.0;
        } else {
            steps.ahead(path, nullptr);
            ASSERT_EQ(steps.target().u, target->u);
            const double density = std::exp(double(path.logRatio - before));
            expected[square(*target->u)] += density;
            squares[square(*target->u)] += density * density;
        }
    }
    double chi2 = 0.0, least = Paths, most = 0.0;
    for (size_t i = 0; i < chosen.size(); ++i) {
        const double difference = chosen[i] - expected[i];
        chi2 += difference * difference / (chosen[i] + squares[i]);
        least = std::min(least, expected[i]);
        most = std::max(most, expected[i]);
    }
    EXPECT_LT(chi2, 64.0 + 4.5 * std::sqrt(2.0 * 64.0));
    EXPECT_GT(most, 4.0 * least) << "points are alike: nothing is tested";
}

} // namespace
} // namespace tungsten::path
