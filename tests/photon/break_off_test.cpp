// Passes that are broken off: the film holds whole passes alone, the integrator goes on as if nothing had been, and
// little is done after the stop.

#include "support/PathsAndPhotons.h"

#include "path/light/LightTracer.h"

#include "app/command.h"
#include "path/PathTracer.h"
#include "photon/PhotonIntegrator.h"
#include "tungsten/film/FilmRows.h"
#include "tungsten/integrator/SceneFacts.h"
#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Memory.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <set>
#include <sstream>

namespace tungsten {
namespace {

using test::foggyBox;
using test::SceneFile;

constexpr size_t Threads = 2;

std::string bitsOf(const Film& film) {
    std::ostringstream out;
    FilmRows::writeState(film, out);
    return out.str();
}

/// An integrator with what a session has.
class Render {
  public:
    explicit Render(const std::string& json)
        : file_(json), loaded_(loadScene(file_.path())), integrator_(make()), film_(filmOf(*loaded_.scene)),
          bias_(filmOf(*loaded_.scene, PassWeight::Repeats)) {
        throwIfProblems(*loaded_.diagnostics);
        SceneFacts facts = analyseScene(*loaded_.scene);
        Features features = featuresOf(*loaded_.scene, facts);
        integrator_->plan(facts, features);
        integrator_->prepare(facts, {}, statistics_);
    }

    /// Renders a pass that stops at the poll of this number; false: it did. Counts polls and notes stages.
    bool pass(uint64_t stopAt = std::numeric_limits<uint64_t>::max()) {
        polls_ = 0;
        std::optional<ProgressMonitor> monitor;
        monitor.emplace([&] {
            const std::scoped_lock lock(mutex_);
            stages_.insert(monitor->progress().stage);
            return ++polls_ >= stopAt;
        });
        const uint32_t index = film_.passes();
        PassInfo info{index, 2 * index, 2, 1, &bias_, 1.0, ProgressToken(*monitor)};
        film_.beginPass();
        bias_.beginPass();
        try {
            integrator_->renderPass(info, film_, statistics_);
        } catch (const PassCancelled&) {
            return false;
        }
        film_.endPass(2.0);
        bias_.endPass(1.0);
        return true;
    }
    [[nodiscard]] std::string bits() const { return bitsOf(film_); }
    [[nodiscard]] uint64_t polls() const { return polls_; }
    [[nodiscard]] const std::set<std::string>& stages() const { return stages_; }

  private:
    std::unique_ptr<Integrator> make() const {
        const std::string& type = loaded_.integratorType;
        if (type == "path_tracer") return std::make_unique<path::PathTracer>(loaded_.scene, loaded_.integratorSettings);
        if (type == "light_tracer")
            return std::make_unique<path::LightTracer>(loaded_.scene, loaded_.integratorSettings);
        return std::make_unique<photon::PhotonIntegrator>(loaded_.scene, loaded_.integratorSettings, true);
    }

    SceneFile file_;
    LoadedScene loaded_;
    std::unique_ptr<Integrator> integrator_;
    Film film_, bias_;
    Statistics statistics_;
    std::mutex mutex_;
    std::set<std::string> stages_;
    uint64_t polls_ = 0;
};

struct BreakOffCase {
    std::string name, integrator;
    std::set<std::string> stages;

    friend std::ostream& operator<<(std::ostream& out, const BreakOffCase& one) { return out << one.name; }
};

const std::string Gate = R"(, "max_bounces": 8, "start_time": 3, "transient_time_width": 0.5, "frame_num": 4)";
const std::string Maps =
    R"("type": "progressive_transient_photon_map", "photon_count": 4000, "volume_photon_count": 4000,
                            "gather_radius": 0.3)" +
    Gate;

const std::vector<BreakOffCase> BreakOffCases{
    {"plain paths", R"("type": "path_tracer")" + Gate, {"camera paths"}},
    {"guided paths", R"("type": "path_tracer", "darts": "best")" + Gate, {"camera paths"}},
    {"light paths", R"("type": "light_tracer")" + Gate, {"light paths"}},
    {"points", Maps, {"camera paths", "photons", "radii", "splat", "gather"}},
    {"beams", Maps + R"(, "volume_photon_type": "beams")", {"photons", "splat", "gather"}},
    {"planes", Maps + R"(, "volume_photon_type": "planes")", {"photons", "splat", "gather"}},
    {"guided points", Maps + R"(, "darts": "best")", {"photons", "splat", "path reuse"}},
};

class BreakOff : public testing::TestWithParam<BreakOffCase> {};

TEST_P(BreakOff, EveryStageIsPolled) {
    Render render(foggyBox(GetParam().integrator));
    ASSERT_TRUE(render.pass());
    for (const std::string& stage : GetParam().stages) EXPECT_TRUE(render.stages().contains(stage)) << stage;
    EXPECT_GT(render.polls(), 40u);
}

TEST_P(BreakOff, TheFilmHoldsWholePassesAndTheRenderGoesOn) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1); // gathers sum in one order
    Render whole(foggyBox(GetParam().integrator)), broken(foggyBox(GetParam().integrator));
    ASSERT_TRUE(whole.pass() && broken.pass());
    const std::string one = whole.bits();
    ASSERT_TRUE(whole.pass());
    const uint64_t polls = whole.polls();
    for (int i = 0; i < 12; ++i) {
        const uint64_t at = 1 + polls * uint64_t(i) / 12;
        ASSERT_FALSE(broken.pass(at)) << at << " of " << polls;
        ASSERT_EQ(broken.bits(), one) << at << " of " << polls;
    }
    ASSERT_TRUE(broken.pass());
    EXPECT_EQ(broken.bits(), whole.bits()) << "nothing is left of what was broken off";
}

/// Every thread may be on its way to one poll; the loop that they share is then at its end.
TEST_P(BreakOff, ThePassEndsSoonAfterTheStop) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, Threads);
    Render render(foggyBox(GetParam().integrator));
    ASSERT_TRUE(render.pass());
    const uint64_t polls = render.polls();
    for (int i = 0; i < 20; ++i) {
        const uint64_t at = 1 + polls * uint64_t(i) / 20;
        if (render.pass(at)) continue; // threads share the polls differently every time
        EXPECT_LE(render.polls(), at + 2 * Threads) << "of " << polls;
    }
}

/// A closed room, a pixel and two samples; `walls` and `light` are a bsdf and a primitive.
std::string closedRoom(const std::string& walls, const std::string& light, const std::string& integrator,
                       const std::string& beside = "") {
    return R"({"bsdfs": [{"name": "walls", )" + walls + R"(}], "media": [{"name": "cloud", "type": "homogeneous",
        "sigma_s": 2, "sigma_a": 0}], "primitives": [{"type": "sphere", "bsdf": "walls", "transform": {"scale": 2}}, )" +
           light + beside +
           R"(], "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 10, "transform": {"position":
        [0, 0, 1], "look_at": [0.3, 0.2, 0]}}, "integrator": {"max_bounces": 20000, "enable_rr": false,
        "photon_count": 4, "volume_photon_count": 200000, "gather_radius": 0.3, )" +
           integrator + R"(}, "renderer": {"spp": 2, "spp_step": 2}})";
}

TEST(BreakOffLongPaths, TheyArePolledOnTheirWay) {
    const std::string white = R"("type": "lambert", "albedo": 1)", mirror = R"("type": "mirror", "albedo": 1)";
    const std::string lamp = R"({"type": "point", "emission": 8, "transform": {"position": [0.3, 0.6, 0.2]}})";
    const std::string inCloud =
        R"({"type": "point", "emission": 8, "ext_medium": "cloud", "transform": {"position": [0.3, 0.6, 0.2]}})";
    const std::string laser = R"({"type": "collimated", "power": 1, "transform": {"position": [-1.5, 0, 0],
        "look_at": [-1.2, 1, 0], "up": [0, 0, 1]}})"; // stays in the plane z = 0
    // All that the camera sees.
    const std::string black = R"(, {"type": "quad", "bsdf": {"type": "lambert", "albedo": 0}, "transform": {"position":
        [0.1, 0.07, 0.7], "rotation": [90, 0, 0], "scale": 0.5}})";
    const std::string ever = R"(, "start_time": 0, "transient_time_width": 1e6, "frame_num": 1)";
    const std::string paths = R"("type": "path_tracer")", light = R"("type": "light_tracer")";
    const std::string maps = R"("type": "progressive_transient_photon_map")" + ever;
    const std::string best = R"(, "darts": "best")";
    const std::vector<std::pair<const char*, std::string>> scenes{
        {"plain", closedRoom(white, lamp, paths)},
        {"plain, in fog", closedRoom(white, inCloud, paths)},
        {"guided", closedRoom(white, lamp, paths + best + ever)},
        {"a laser's way", closedRoom(mirror, laser, paths, black)},
        {"light", closedRoom(white, lamp, light)},
        {"light, in fog", closedRoom(white, inCloud, light)},
        {"photons", closedRoom(white, lamp, maps)},
        {"photons in fog", closedRoom(white, inCloud, maps)},
        {"guided photons", closedRoom(white, lamp, maps + best)},
        {"sensor paths", closedRoom(mirror, lamp, maps)},
    };
    for (const auto& [name, scene] : scenes) {
        Render render(scene);
        ASSERT_TRUE(render.pass()) << name;
        // Two paths or more of 20 000 steps; a poll every 64.
        EXPECT_GT(render.polls(), 600u) << name;
        EXPECT_FALSE(render.pass(render.polls() / 2)) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, BreakOff, testing::ValuesIn(BreakOffCases), [](const auto& test) {
    std::string name = test.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

} // namespace
} // namespace tungsten
