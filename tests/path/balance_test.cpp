// Plain paths beside guided ones: what one of them finds, whoever it is, is weighed by how densely both find it.

#include "path/guided_setup.h"

#include "support/PathsAndPhotons.h"
#include "support/Render.h"
#include "support/SeedShift.h"

#include <gtest/gtest.h>

namespace tungsten::path {
namespace {

TEST(StrategyBalance, WeightsOfBothAddUpToTheContributionOverBothDensities) {
    const StrategyBalance balance{0.25f, 0.75f};
    for (const float logRatio : {-200.0f, -8.0f, -1.0f, 0.0f, 2.0f, 60.0f, 500.0f}) {
        const double ratio = std::exp(std::clamp(double(logRatio), -80.0, 80.0)), both = 0.25 + 0.75 * ratio;
        EXPECT_NEAR(balance.weight(Strategy::Plain, logRatio), 1.0 / both, 1e-5 / both);
        EXPECT_NEAR(balance.weight(Strategy::Guided, logRatio), ratio / both, 1e-5 * ratio / both);
        // In expectation each strategy brings its share of one.
        EXPECT_NEAR(0.25 * double(balance.weight(Strategy::Plain, logRatio)) +
                        0.75 * double(balance.weight(Strategy::Guided, logRatio)),
                    1.0, 1e-5);
        EXPECT_LE(balance.weight(Strategy::Plain, logRatio), 4.0001f);
    }
    EXPECT_EQ(balance.weight(Strategy::Alone, 3.0f), 1.0f);
}

/// Connections, which both strategies find, and lights that plain paths meet: densities of `connects` and `meets`.
TEST(StrategyBalance, TechniquesOfBothAndOfPlainPathsAreBounded) {
    using transport::TechniqueShare;
    for (const float plain : {0.1f, 0.5f, 0.9f})
        for (float logRatio = -20.0f; logRatio <= 40.0f; logRatio += 0.5f)
            for (const float meets : {1e-4f, 0.03f, 0.5f, 1.0f, 2.0f, 30.0f, 1e4f}) {
                const StrategyBalance balance{plain, 1.0f - plain};
                constexpr float Connects = 1.0f;
                const float dense = Connects * balance.overPlain(logRatio);
                const auto connection = TechniqueShare::of({Connects, meets}, {dense, meets}),
                           meeting = TechniqueShare::of({meets, Connects}, {meets, dense});
                EXPECT_NEAR(connection.beside + meeting.beside, 1.0f, 1e-6f);
                EXPECT_NEAR(connection.alone + meeting.alone, 1.0f, 1e-6f);
                const float bound = std::max(connection.alone / Connects, meeting.alone / meets) / plain * 1.00001f;
                EXPECT_LE(connection.beside / Connects * balance.weightOfPlain(logRatio), bound)
                    << plain << " " << logRatio << " " << meets;
                EXPECT_LE(meeting.beside / meets * balance.weightOfPlain(StrategyBalance::Never), bound)
                    << plain << " " << logRatio << " " << meets;
            }
}

TEST(PathCosts, SharesOfTimeAreThoseOfPathsByTheirCosts) {
    const PathCosts costs{1.0, 0.5, 6.0};
    const StrategyBalance balance = costs.ofTime(0.5);
    EXPECT_NEAR(balance.plain * 1.5, balance.guided * 6.0, 1e-6);
    EXPECT_NEAR(balance.plain + balance.guided, 1.0, 1e-6);
    EXPECT_EQ(costs.ofTime(1.0).guided, 0.0f);
    EXPECT_EQ(costs.mean(costs.ofTime(1.0)), 1.0) << "nothing is weighed where all paths are plain";
    EXPECT_NEAR(costs.mean(balance), double(balance.plain) * 1.5 + double(balance.guided) * 6.0, 1e-6);
}

/// A pilot of paths that find X with the densities plain and guided ones have there: by a known distribution. What they
/// bring is the sum of so many contributions on one way.
SharePilot pilotOf(double plainFinds, double guidedFinds, int groups, int parts = 1) {
    SharePilot pilot;
    const auto logRatio = float(std::log(guidedFinds / plainFinds));
    for (int i = 0; i < groups * SharePilot::PathsOfPixel; ++i) {
        Sampler sampler(1, RandomStream::Test, 0, uint64_t(i));
        const bool guided = i % 2 == 1;
        const double finds = guided ? guidedFinds : plainFinds;
        pilot.begin(guided ? Strategy::Guided : Strategy::Plain);
        if (double(sampler.next1D()) >= finds) continue;
        for (int part = 0; part < parts; ++part) pilot.tell(float(1.0 / (finds * parts)), 0, logRatio, Found::OnWay);
    }
    return pilot;
}

TEST(SharePilot, KnowsTheVarianceOfAnyShare) {
    // A contribution of 1 / (a plain + b guided) with the probability a plain + b guided.
    const SharePilot pilot = pilotOf(0.02, 0.3, 40000);
    for (const StrategyBalance balance : {StrategyBalance{1.0f, 0.0f}, {0.5f, 0.5f}, {0.1f, 0.9f}}) {
        const double finds = double(balance.plain) * 0.02 + double(balance.guided) * 0.3;
        EXPECT_NEAR(pilot.variance(balance), 1.0 / finds - 1.0, 0.1 * (1.0 / finds - 1.0));
    }
}

/// What several contributions of one path have in common, too, where plain paths themselves have found none.
TEST(SharePilot, KnowsItOfPathsThatFindMoreThanOnce) {
    constexpr double Plain = 2e-5, Guided = 0.3;
    const SharePilot pilot = pilotOf(Plain, Guided, 40000, 4);
    for (const StrategyBalance balance : {StrategyBalance{1.0f, 0.0f}, {0.5f, 0.5f}, {0.1f, 0.9f}}) {
        const double finds = double(balance.plain) * Plain + double(balance.guided) * Guided;
        // 24000 guided paths find it: 0.65 % of standard error.
        EXPECT_NEAR(pilot.variance(balance), 1.0 / finds - 1.0, 0.03 * (1.0 / finds - 1.0));
    }
}

TEST(SharePilot, ChoosesByVarianceTimesCost) {
    const PathCosts costs{1.0, 0.3, 5.0};
    EXPECT_EQ(pilotOf(0.3, 0.25, 4000).choose(costs), 1.0) << "guides are of no use";
    EXPECT_EQ(pilotOf(0.02, 0.6, 4000).choose(costs), 0.1) << "guides find nearly everything";
    EXPECT_EQ(pilotOf(0.001, 0.6, 4000).choose(costs), 0.1) << "plain paths find hardly anything";
    EXPECT_EQ(pilotOf(0.001, 0.002, 100).choose(costs), 0.5) << "nothing has been found to judge by";
    EXPECT_EQ(SharePilot().choose(costs), 0.5);
}

TEST(SharePilot, IsSureWhereOneChoiceIsMuchBetter) {
    const PathCosts costs{1.0, 0.3, 5.0};
    EXPECT_TRUE(pilotOf(0.3, 0.25, 4000).isSure(costs)) << "guides are of no use";
    EXPECT_TRUE(pilotOf(0.02, 0.6, 4000).isSure(costs)) << "guides find nearly everything";
    EXPECT_FALSE(pilotOf(0.02, 0.1, 100).isSure(costs)) << "what guides find better they cost more";
    EXPECT_FALSE(SharePilot().isSure(costs));
}

/// Fog between a floor and a wall, under a lamp.
std::string roomOf(const std::string& bsdf,
                   const std::string& gate = R"("transient_time_center": 8.5, "transient_time_width": 3)") {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.4, "sigma_a": 0.05}],
      "primitives": [{"type": "quad", "bsdf": )" +
           bsdf + R"(, "transform": {"scale": 4}},
                     {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.7}, "transform": {"position": [0, 2, -1],
                      "rotation": [90, 0, 0], "scale": 4}},
                     {"type": "quad", "emission": 20, "bsdf": {"type": "null"}, "ext_medium": "fog",
                      "transform": {"position": [0.4, 2, 0.3], "rotation": [180, 0, 0], "scale": 0.8}}],
      "camera": {"resolution": 1, "fov": 20, "medium": "fog", "transform": {"position": [0, 1, 4], "look_at": [0, 0.8, 0]}},
      "integrator": {"type": "path_tracer", "max_bounces": 16, "darts": "best", )" +
           gate + R"(}, "renderer": {}})";
}

/// What light paths bring of what plain paths hardly find is random: it tells what these would bring, not what it is.
TEST(SharePilot, JudgesPlainPathsByWhatTheyWouldBring) {
    for (const char* bsdf : {R"({"type": "lambert", "albedo": 0.7})",
                             R"({"type": "rough_conductor", "material": "Al", "roughness": 0.3})"}) {
        GuidedSetup setup(roomOf(bsdf));
        Statistics ignored;
        setup.lightCaches.prepare(setup.scene, setup.targets, setup.watch, ignored);
        setup.lightCaches.trace(setup.scene, setup.targets, 8192, PassInfo{.seed = 1, .watch = setup.watch}, ignored);
        const GuidedContext guided = setup.guided();
        const PathContext plain = setup.plain();
        PathCounters counters;
        SharePilot pilot, alone;
        PlainTrail trail;
        for (uint64_t i = 0; i < 200000; ++i) {
            const bool guides = i % 2 == 1;
            PixelAccumulator sink(pilot, setup.sensor, counters);
            pilot.begin(guides ? Strategy::Guided : Strategy::Plain);
            Sampler sampler(3, RandomStream::Test, 0, i);
            const Vec2f film = sampler.next2D();
            const Ray ray = setup.scene.camera.generateRay({0, 0}, film, sampler.next2D());
            if (guides) {
                Sampler light = sampler.branch(RandomStream::Target, 0);
                const auto target = setup.targets.sample(0.5f, light, setup.watch, counters);
                ASSERT_TRUE(target);
                traceGuidedPath(guided, sink, counters, sampler, *target, ray);
            } else {
                trail.start(guided, setup.targets, sink, counters, sampler);
                tracePlainBesideGuided(plain, {&trail}, sink, counters, sampler, ray);
                PixelAccumulator own(alone, setup.sensor, counters);
                alone.begin(Strategy::Plain);
                tracePath<true, true>(plain, own, counters, sampler, nullptr, ray);
                pilot.tellPairsOfAlone(alone.pairsOfLast());
            }
        }
        EXPECT_GT(counters.lightVertices, 10000u);
        const double own = alone.ownSecondMoment(Strategy::Plain), judged = pilot.secondMoment({1.0f, 0.0f});
        RecordProperty("judged_over_own", std::to_string(judged / own));
        EXPECT_NEAR(judged, own, 0.25 * own) << bsdf;
    }
}

/// Second moments of what paths of one pixel find: of plain ones alone; and pilots of plain and guided ones, one of
/// which is told the pairs of those alone.
struct Pilots {
    SharePilot alone, told, untold;
};

void trace(Pilots& pilots, const GuidedSetup& setup, uint64_t paths) {
    auto& [alone, told, untold] = pilots;
    const GuidedContext guided = setup.guided();
    const PathContext plain = setup.plain();
    PathCounters counters;
    PlainTrail trail;
    for (uint64_t i = 0; i < paths; ++i) {
        const Sampler sampler(3, RandomStream::Test, 1, i);
        Sampler lens = sampler;
        const Ray ray = setup.scene.camera.generateRay({0, 0}, lens.next2D(), lens.next2D());
        PixelAccumulator own(alone, setup.sensor, counters), first(told, setup.sensor, counters),
            second(untold, setup.sensor, counters);
        for (SharePilot* of : {&told, &untold}) of->begin(i % 2 == 0 ? Strategy::Plain : Strategy::Guided);
        if (i % 2 == 1) {
            Sampler light = sampler.branch(RandomStream::Target, 0);
            const auto target = setup.targets.sample(0.5f, light, setup.watch, counters);
            for (PixelAccumulator* to : {&first, &second})
                traceGuidedPath(guided, *to, counters, sampler, *target, ray);
            continue;
        }
        for (PixelAccumulator* to : {&first, &second}) {
            trail.start(guided, setup.targets, *to, counters, sampler);
            tracePlainBesideGuided(plain, {&trail}, *to, counters, sampler, ray);
        }
        alone.begin(Strategy::Plain);
        tracePath<true, true>(plain, own, counters, sampler, nullptr, ray);
        told.tellPairsOfAlone(alone.pairsOfLast());
    }
}

/// Vertices of plain paths choose points of lights by themselves, and share one beside guided paths: what their
/// contributions bring in pairs differs where a point in time is so for all of a path.
TEST(SharePilot, KnowsPlainPathsAsTheyAreAlone) {
    Pilots pilots;
    trace(pilots, GuidedSetup(R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 4, "sigma_a": 0}],
      "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}},
                     {"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                      "transform": {"position": [0.6, 0.6, 2], "scale": 0.9}}],
      "camera": {"resolution": 1, "fov": 8, "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
      "integrator": {"type": "path_tracer", "max_bounces": 32, "darts": "best", "transient_time_center": 7,
                     "transient_time_width": 1}, "renderer": {}})"),
          160000);
    const auto& [alone, told, untold] = pilots;
    const double own = alone.ownSecondMoment(Strategy::Plain);
    EXPECT_NEAR(told.secondMoment({1.0f, 0.0f}), own, 0.16 * own); // 4.5 times the spread of 8 seeds
    EXPECT_GT(untold.secondMoment({1.0f, 0.0f}), 1.3 * own) << "points make no difference: nothing is tested";
    EXPECT_NEAR(told.secondMoment({0.5f, 0.5f}), untold.secondMoment({0.5f, 0.5f}), 1e-9 * own);
}

/// A lamp as large as the body before it is met and connected to. Guided paths aim at one of its points and only
/// connect: what plain paths meet beside them counts little where both together connect densely.
TEST(SharePilot, ConnectionsOfBothShareWithLightsThatAreMet) {
    Pilots pilots;
    trace(pilots, GuidedSetup(R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 6, "sigma_a": 0.01}],
      "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 4}},
                     {"type": "sphere", "emission": 60, "bsdf": {"type": "null"},
                      "transform": {"position": [1, 3.5, 1], "scale": 1}}],
      "camera": {"resolution": 1, "fov": 60, "medium": "fog",
                 "transform": {"position": [0, 0.5, 0.5], "look_at": [0, 0, -1]}},
      "integrator": {"type": "path_tracer", "max_bounces": 256, "darts": "best", "transient_time_center": 4.6,
                     "transient_time_width": 0.4}, "renderer": {}})"),
          40000);
    const auto& [alone, told, untold] = pilots;
    const double own = alone.ownSecondMoment(Strategy::Plain);
    EXPECT_NEAR(told.secondMoment({1.0f, 0.0f}), own, 0.28 * own); // 4.5 times the spread of 6 seeds
    EXPECT_LT(told.secondMoment({0.5f, 0.5f}), 0.1 * own);
}

/// Where guides do not go, or go too densely, or both strategies find light by several techniques: the mean is the same
/// whoever has how many of the paths.
struct BalancedCase {
    const char* name;
    std::string scene;
};

std::string bodies(const std::string& media, const std::string& lights, const std::string& more,
                   const std::string& integrator) {
    return R"({"media": [)" + media +
           R"(], "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
        "transform": {"rotation": [10, 20, 0]}}, )" +
           lights + more + R"(],
      "camera": {"resolution": 1, "fov": 20, "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
      "integrator": {"type": "path_tracer", "max_bounces": 64, )" +
           integrator + R"(}, "renderer": {}})";
}

std::vector<BalancedCase> balancedCases() {
    const std::string Fog = R"({"name": "fog", "type": "homogeneous", "sigma_s": 4, "sigma_a": 0.1})",
                      Peaked = R"({"name": "fog", "type": "homogeneous", "sigma_s": 20, "sigma_a": 0,
                          "phase_function": {"type": "henyey_greenstein", "g": 0.9}})",
                      Thin = R"({"name": "fog", "type": "homogeneous", "sigma_s": 1, "sigma_a": 0,
                          "phase_function": {"type": "henyey_greenstein", "g": 0.95}})",
                      Forward = R"({"name": "fog", "type": "homogeneous", "sigma_s": 1, "sigma_a": 0,
                          "phase_function": {"type": "henyey_greenstein", "g": 0.75}})",
                      Coloured = R"({"name": "fog", "type": "homogeneous", "sigma_s": [2, 4, 8], "sigma_a": 0.1})",
                      Ball = R"({"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                          "transform": {"position": [0.3, 0.4, -1.4], "scale": 0.4}})",
                      Beside = R"({"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                          "transform": {"position": [1.2, 0.9, 0.8], "scale": 0.3}})",
                      Large = R"({"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                          "transform": {"position": [0.8, 1.4, 0], "scale": 0.9}})",
                      Inside =
                          R"({"type": "sphere", "emission": 9, "bsdf": {"type": "null"}, "transform": {"scale": 0.1}})",
                      Floor = R"(, {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.6},
                          "transform": {"position": [0, -0.9, 0], "scale": 6}})",
                      Glossy =
                          R"(, {"type": "quad", "bsdf": {"type": "rough_conductor", "material": "Al", "roughness": 0.2},
                          "transform": {"position": [0, -0.9, 0], "scale": 6}})",
                      Gate = R"("transient_time_center": 7.6, "transient_time_width": 1.5)";
    return {
        {"LampBehindAPeak", bodies(Peaked, Ball, "", R"("transient_time_center": 6.7, "transient_time_width": 1)")},
        {"LampMetAndConnectedTo", bodies(Thin, Ball, "", R"("min_bounces": 3, "transient_time_center": 6.5,
                                             "transient_time_width": 1)")},
        {"LampBeside", bodies(Fog, Beside, "", Gate)},
        {"LargeLamp", bodies(Fog, Large, "", R"("transient_time_center": 7.2, "transient_time_width": 1)")},
        {"LampInside", bodies(Fog, Inside, "", R"("transient_time_center": 6, "transient_time_width": 1)")},
        {"ColouredFog", bodies(Coloured, Beside, "", Gate)},
        {"Floor", bodies(Fog, Beside, Floor, Gate)},
        {"GlossyFloor", bodies(Fog, Beside, Glossy, Gate)},
        {"TwoLamps", bodies(Fog, Beside + ", " + Ball, "", Gate)},
        {"LampAndLaser", bodies(Fog, Beside + R"(, {"type": "collimated", "radius": 0.2, "emission": 20,
                                    "transform": {"position": [0, 2, 0], "look_at": [0, 0, 0], "up": [1, 0, 0]}})",
                                "", R"("transient_time_center": 7.6, "transient_time_width": 2.5)")},
        {"TwoLampsMetAndConnectedTo", bodies(Forward, Beside + ", " + Ball, "", R"("min_bounces": 3,
                                   "transient_time_center": 6.5, "transient_time_width": 1)")},
        {"Roulette", bodies(Fog, Beside, Floor, Gate + R"(, "enable_rr": true)")},
        {"Unwarped", bodies(Fog, Beside, "",
                            R"("camera_unwarped": true, "transient_time_center": 2.6, "transient_time_width": 1.5)")},
        {"Response",
         bodies(Fog, Beside, "", R"("temporal_response": {"type": "gaussian", "center": 7.6, "sigma": 0.15})")}};
}

// ---- Sequences

/// Lamp and camera in fog.
const char* const OpenFog = R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 1, "sigma_a": 0}],
      "primitives": [{"type": "point", "power": 100, "ext_medium": "fog", "transform": {"position": [0, 0, -1]}}],
      "camera": {"resolution": 1, "fov": 40, "medium": "fog", "transform": {"position": [0, 0, 3], "look_at": [0, 0, 0]}},
      "integrator": {"type": "path_tracer", "max_bounces": 64, "start_time": 4, "transient_time_width": 2,
                     "frame_num": 8}, "renderer": {}})";

TEST(TimeWindows, FollowEachOtherAndGrow) {
    const GuidedSetup setup(OpenFog);
    const auto windows = transport::TimeWindows::ofSequence(setup.scene, setup.facts, setup.sensor.arrivals);
    ASSERT_EQ(windows.size(), 4u) << "log(20 / 4) / log(1.5)";
    EXPECT_DOUBLE_EQ(windows[0].begin, 4.0);
    EXPECT_DOUBLE_EQ(windows[3].end, 20.0);
    float probability = 0.0f;
    for (size_t i = 0; i < windows.size(); ++i) {
        probability += windows[i].probability;
        EXPECT_NEAR(windows[i].end / windows[i].begin, std::pow(5.0, 0.25), 1e-9);
        EXPECT_EQ(windows.indexOf(windows[i].begin), i);
        EXPECT_EQ(windows.indexOf(std::nextafter(windows[i].end, 0.0)), i);
        EXPECT_FALSE(windows[i].contains(windows[i].end));
        EXPECT_EQ(windows[i].begin, i > 0 ? windows[i - 1].end : 4.0);
    }
    EXPECT_FLOAT_EQ(probability, 1.0f);
    EXPECT_EQ(windows.choose(0.0f), 0u);
    EXPECT_EQ(windows.choose(1.0f), 3u);
}

/// Every frame has the light that plain paths find there, whatever window it is in. Of thin fog between surfaces, where
/// neither plain nor guided paths find nearly all of it.
TEST(TimeWindows, FramesAreTheSameAtAnyShare) {
    const std::string scene = roomOf(R"({"type": "lambert", "albedo": 0.7})",
                                     R"("start_time": 5, "transient_time_width": 1, "frame_num": 12)");
    const auto render = [&](const std::string& darts, uint32_t samples) {
        return test::renderPaths(scene, {{"integrator.darts=" + darts}, 32, samples, 5});
    };
    const auto plain = render("off", 20000);
    for (const char* share : {"0.6", "0.1"}) {
        const auto both = render(R"({"plain_share": )" + std::string(share) + "}", 12000);
        double error2 = 0.0, all = 0.0, ofPlain = 0.0;
        for (int frame = 0; frame < 12; ++frame) {
            const double error = std::hypot(plain->pixelError(frame), both->pixelError(frame));
            EXPECT_NEAR(both->mean(frame), plain->mean(frame), 4.5 * error) << share << " " << frame;
            error2 += error * error;
            all += both->mean(frame);
            ofPlain += plain->mean(frame);
        }
        EXPECT_NEAR(all, ofPlain, 4.5 * std::sqrt(error2)) << share;
        EXPECT_LT(std::sqrt(error2), 0.02 * ofPlain) << share << ": the test would not see a wrong weight";
    }
}

// ---- Means

class Balanced : public testing::TestWithParam<BalancedCase> {};

TEST_P(Balanced, MeansAreTheSameAtAnyShare) {
    const test::OtherSeeds seeds{{"/Response", 1}};
    const auto render = [&](const std::string& darts, uint32_t samples) {
        return test::renderPaths(GetParam().scene, {{"integrator.darts=" + darts}, 32, samples, 11});
    };
    const auto plain = render("off", 10000);
    ASSERT_GT(plain->mean(), 0.0);
    for (const char* share : {"0.6", "0.15"}) {
        const auto both = render(R"({"plain_share": )" + std::string(share) + "}", 12000);
        EXPECT_GT(both->statistics.counter("plain paths beside guided ones"), 0u);
        EXPECT_GT(both->statistics.counter("counted nanoseconds of camera paths"),
                  100 * both->statistics.counter("camera paths"));
        const double error = std::hypot(plain->pixelError(0), both->pixelError(0));
        EXPECT_NEAR(both->mean(), plain->mean(), 4.5 * error) << share;
        EXPECT_LT(error, 0.05 * plain->mean()) << share << ": the test would not see a wrong weight";
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Balanced, testing::ValuesIn(balancedCases()),
                         [](const auto& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace tungsten::path
