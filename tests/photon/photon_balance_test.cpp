// Plain light paths beside guided ones: what one of them leaves, whoever it is, is weighed by how densely both leave
// it.

#include "photon/PhotonPlan.h"
#include "photon/light/DepositVisitor.h"

#include "support/PathsAndPhotons.h"
#include "support/PlainState.h"
#include "support/SceneFile.h"
#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

using transport::Ahead;
using transport::Flight;
using transport::PathState;
using transport::WalkVertex;
using transport::Way;

const std::string EvenFog = R"("sigma_s": 4, "sigma_a": 0.1)",
                  PeakedFog =
                      R"("sigma_s": 8, "sigma_a": 0, "phase_function": {"type": "henyey_greenstein", "g": 0.6})",
                  ColouredFog = R"("sigma_s": [2, 4, 8], "sigma_a": 0.1)",
                  LampBeside = R"({"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                      "transform": {"position": [1.2, 0.9, 0.8], "scale": 0.3}})",
                  LampInside = R"({"type": "sphere", "emission": 9, "bsdf": {"type": "null"}, "ext_medium": "fog",
                      "transform": {"scale": 0.1}})",
                  WhiteFloor = R"(, {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.6},
                      "transform": {"position": [0, -0.9, 0], "scale": 6}})",
                  MirrorFloor = R"(, {"type": "quad", "bsdf": {"type": "mirror"},
                      "transform": {"position": [0, -0.9, 0], "scale": 6}})",
                  WideGate = R"("transient_time_center": 7.6, "transient_time_width": 2.5)";

/// A cube of fog seen from outside.
std::string sceneOf(const std::string& medium, const std::string& lamp, const std::string& more,
                    const std::string& integrator) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", )" + medium + R"(}],
      "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
                      "transform": {"rotation": [10, 20, 0]}}, )" +
           lamp + more + R"(],
      "camera": {"resolution": 4, "fov": 20, "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
      "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 64, "photon_count": 4000,
                     "volume_photon_count": 100000, "fixed_volume_radius": true, "volume_gather_radius": 0.1,
                     "gather_radius": 0.05, "alpha": 1, "volume_alpha": 1, "darts": "best", )" +
           integrator + R"(}, "renderer": {}})";
}

/// Follows a guided light path as if it were a plain one, and compares what is said afterwards with what was summed
/// while it was drawn.
class Replay : public transport::VisitorBase {
  public:
    Replay(const StepsToCamera& steps, PhotonCounters& counters) { trail_.start(steps, counters.densities); }

    void emit(const PathState& start, const Emitter& emitter, const SurfaceSample& from, const Vec3f& direction) {
        trail_.emit(start, emitter, from, direction);
    }
    [[nodiscard]] bool mayGoOn(const PathState& path) const { return path.interactions < 40; }
    bool ahead(PathState& path, StepsToCamera&, const Ahead& ahead) {
        before_ = path.channels;
        trail_.fly(test::plainly(path), ahead);
        expectSame(trail_.onFlight(), path.logRatio, path);
        return true;
    }
    bool arrive(PathState& path, StepsToCamera& steps, const Ahead& ahead, const Flight& flight) {
        const bool collided = flight.event == Flight::Event::Collision;
        Flight plain = flight;
        plain.pdf = transport::PlainFlight{ahead.medium, ahead.reach(), before_}.like(flight).pdf;
        trail_.arrive(test::plainly(path), ahead, plain);
        if (collided) expectSame(trail_.inMedium(), steps.inMedium(flight.distance).logRatio, path);
        expectSame(trail_.there(), path.logRatio, path);
        largest = std::max(largest, std::abs(path.logRatio));
        return true;
    }
    bool vertex(PathState& path, StepsToCamera&, const WalkVertex&) {
        expectSame(trail_.atVertex(), path.logRatio, path);
        return true;
    }
    void leave(PathState&, StepsToCamera&, const WalkVertex&, const Way& way) { trail_.leave(way); }

    static inline int compared = 0;
    static inline float largest = 0.0f;

  private:
    static void expectSame(float asked, float summed, const PathState& path) {
        EXPECT_NEAR(asked, summed, 1e-4f * float(1 + path.interactions) * (1.0f + std::abs(summed)))
            << path.interactions;
        ++compared;
    }

    PhotonTrail trail_; ///< a value: copies of a path that is split have one each
    ChannelDensities before_{1.0f};
};

void replay(const std::string& json) {
    const test::SceneFile file(json);
    const LoadedScene loaded = loadScene(file.path());
    const Scene& scene = *loaded.scene;
    const PhotonSettings settings = readPhotonSettings(loaded.integratorSettings, scene, true);
    const PhotonPlan plan = PhotonPlan::of(scene, settings, analyseScene(scene));
    ASSERT_TRUE(plan.sideBySide.on) << plan.sideBySide.reason;
    const ProgressToken watch;
    const PhotonGuidance guidance(scene, settings.policy, plan, watch);
    Replay::compared = 0;
    Replay::largest = 0.0f;
    for (uint64_t i = 0; i < 600; ++i) {
        PhotonCounters counters;
        const StepsToCamera steps({scene, counters, watch}, guidance, {.storesVertices = true, .balance = {0.5f, 0.5f}},
                                  guidance.gate());
        transport::Walk walk{PathState{.random = Sampler(1, RandomStream::Test, 0, i)}, steps, Replay(steps, counters)};
        const Emitter& emitter = scene.emitters[0];
        walk.path.region = scene.regionOf(emitter);
        walk.path.random.at(0, Draw::Emission);
        const SurfaceSample from = sampleEmissionPoint(emitter, walk.path.random.next2D());
        const PathState start = walk.path;
        const auto way = walk.steps.emit(walk.path, emitter, from);
        if (!way) continue;
        walk.visitor.emit(start, emitter, from, way->ray.direction);
        walk.path.ray = way->ray;
        walk.path.throughput = way->weight;
        if (!isBlack(walk.path.throughput)) walk.run();
    }
    EXPECT_GT(Replay::compared, 1000);
    EXPECT_GT(Replay::largest, 1.0f) << "guided paths go as plain ones do: nothing is tested";
}

TEST(PhotonTrail, SaysWhatGuidedPathsSummed) {
    replay(sceneOf(EvenFog, LampBeside, "", WideGate));
    replay(sceneOf(EvenFog, LampInside, "", R"("transient_time_center": 6, "transient_time_width": 0.5)"));
}
TEST(PhotonTrail, SaysItOfPeakedPhaseFunctions) {
    replay(sceneOf(PeakedFog, LampBeside, "", WideGate));
}
TEST(PhotonTrail, SaysItOfColours) {
    replay(sceneOf(ColouredFog, LampBeside, "", WideGate));
}
TEST(PhotonTrail, SaysItBesideSurfaces) {
    replay(sceneOf(EvenFog, LampBeside, WhiteFloor, WideGate));
    replay(sceneOf(EvenFog, LampBeside, MirrorFloor, WideGate));
}

struct BalancedCase {
    std::string name, scene, primitive;
};

class BalancedPhotons : public testing::TestWithParam<BalancedCase> {};

/// Plain paths alone and guided paths alone need no weights; both together have the same mean, whoever has how many of
/// the paths.
TEST_P(BalancedPhotons, MeansAreTheSameAtAnyShare) {
    const test::OtherSeeds seeds{{"/SlicesColouredFog", 1}};
    constexpr int Seeds = 8;
    struct Mean {
        double value, error;
    };
    const auto render = [&](const std::string& darts, int paths) {
        double sum = 0.0, squares = 0.0;
        for (uint64_t seed = 1; seed <= Seeds; ++seed) {
            const auto rendered = test::renderPhotons(
                GetParam().scene,
                {{"integrator.darts=" + darts, "integrator.volume_photon_type=" + GetParam().primitive,
                  test::setting("photon_count", paths), "integrator.volume_photon_count=1000000"},
                 6,
                 1,
                 seed});
            sum += rendered->mean() / Seeds;
            squares += rendered->mean() * rendered->mean() / Seeds;
        }
        return Mean{sum, std::sqrt((squares - sum * sum) / (Seeds - 1))};
    };
    const Mean plain = render("\"off\"", 5000), guided = render(R"({"plain_share": 0})", 5000);
    ASSERT_GT(guided.value, 0.0);
    EXPECT_NEAR(plain.value, guided.value, 5.0 * std::hypot(plain.error, guided.error));
    for (const char* share : {"0.9", "0.5", "0.1"}) {
        const Mean both = render(R"({"plain_share": )" + std::string(share) + "}", 5000);
        const double error = std::hypot(both.error, guided.error);
        EXPECT_NEAR(both.value, guided.value, 5.0 * error) << share;
        EXPECT_LT(error, 0.1 * guided.value) << share << ": the test would not see a wrong weight";
    }
}

std::vector<BalancedCase> balancedCases() {
    std::vector<BalancedCase> cases;
    const auto add = [&](const char* what, const std::string& scene, bool peaked = false) {
        cases.push_back({std::string("Points") + what, scene, "points"});
        cases.push_back({std::string("Beams") + what, scene, "beams"});
        if (!peaked) cases.push_back({std::string("Slices") + what, scene, "mis_volumes_balls"}); // they vary too much
    };
    add("LampBeside", sceneOf(EvenFog, LampBeside, "", WideGate));
    add("Peak", sceneOf(PeakedFog, LampBeside, "", WideGate), true);
    add("ColouredFog", sceneOf(ColouredFog, LampBeside, "", WideGate));
    add("Floor", sceneOf(EvenFog, LampBeside, WhiteFloor, WideGate));
    add("Mirror", sceneOf(EvenFog, LampBeside, MirrorFloor, WideGate));
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Scenes, BalancedPhotons, testing::ValuesIn(balancedCases()),
                         [](const auto& instance) { return instance.param.name; });

/// In thousandths.
uint64_t chosenShare(const std::string& scene, const std::string& primitive) {
    return test::renderPhotons(scene, {{"integrator.volume_photon_type=" + primitive}, 1, 1})
        ->statistics.counter("plain light paths, in thousandths");
}

TEST(SharePilotOfPhotons, GivesPlainPathsWhatGuidesCannotDoBetter) {
    // A gate in which nearly all light is, and one of a hundredth of it.
    const std::string open = sceneOf(EvenFog, LampInside, "",
                                     R"("transient_time_center": 24, "transient_time_width": 40)"),
                      narrow = sceneOf(EvenFog, LampInside, "",
                                       R"("transient_time_center": 6.05, "transient_time_width": 0.1)");
    EXPECT_GT(chosenShare(open, "points"), 600u);
    // Beams of guided paths cost less in the open gate: 0.29 of plain alone for 0.37, fixed shares, variance x CPU.
    for (const char* primitive : {"points", "beams"}) EXPECT_LT(chosenShare(narrow, primitive), 600u) << primitive;
}

/// Where lamps in view are the noise, cheap light paths are the best: a panel that shines at the camera alone.
TEST(SharePilotOfPhotons, KnowsTheNoiseOfLampsInView) {
    const std::string narrow = R"("transient_time_center": 6.05, "transient_time_width": 0.1)",
                      panel = R"(, {"type": "quad", "emission": 20, "emission_time": 2.03, "bsdf": {"type": "null"},
                          "transform": {"position": [0.4, 0.4, 1], "rotation": [90, 0, 0], "scale": 0.3}})";
    EXPECT_LT(chosenShare(sceneOf(EvenFog, LampInside, "", narrow), "points"), 600u);
    EXPECT_EQ(chosenShare(sceneOf(EvenFog, LampInside, panel, narrow), "points"), 1000u);
}

/// A lamp whose pulse takes time, beside the fog: when its light starts and where it goes are independent.
TEST(GuidedEmission, DirectionsDoNotDependOnDelays) {
    const std::string pulse = R"({"type": "sphere", "emission": 40, "bsdf": {"type": "null"},
                      "pulse": {"type": "gaussian", "center": 1.5, "sigma": 0.5},
                      "transform": {"position": [1.2, 0.9, 0.8], "scale": 0.3}})";
    const std::string json =
        sceneOf(EvenFog, pulse, "", R"("start_time": 7.6, "transient_time_width": 1.2, "frame_num": 2)");
    const auto beams = [&](const std::string& darts) {
        return test::renderPhotons(json, {{"integrator.volume_photon_type=beams", "integrator.darts=" + darts,
                                           "camera.resolution=1", "integrator.volume_gather_radius=0.04"},
                                          400,
                                          1});
    };
    const auto paths = test::renderPaths(json, {{"integrator.darts=off", "camera.resolution=1"}, 64, 4000});
    for (const char* share : {"0", "1"}) {
        const auto other = beams(R"({"plain_share": )" + std::string(share) + "}");
        for (int frame = 0; frame < 2; ++frame) {
            const double error = std::hypot(paths->pixelError(frame), other->pixelError(frame));
            EXPECT_NEAR(other->mean(frame), paths->mean(frame),
                        5.0 * error + 0.06 * paths->mean(frame)) // and the kernel
                << share << ", frame " << frame;
            EXPECT_LT(error, 0.15 * paths->mean(frame));
        }
    }
}

} // namespace
} // namespace tungsten::photon
