// What an error costs: the pilot's laws of known passes, and the command that prints them.

#include "app/command.h"
#include "support/Folders.h"
#include "support/SceneFile.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/Random.h"
#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/CostPilot.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

namespace tungsten {
namespace {

/// Passes whose variance grows and whose bias falls with their index; the mean is 1.
class KnownPasses : public Integrator {
  public:
    PowerLaw variance{0.04, 0.25}, bias{0.02, -0.5};
    double widthExponent = -0.25;
    bool kernels = true, shared = false; ///< shared: noise of the bias is the same for all pixels
    std::vector<uint32_t> indices;

    void plan(SceneFacts&, Features&) const override {}
    void prepare(const SceneFacts&, const ProgressToken&, Statistics&) override {}
    [[nodiscard]] bool leavesBias(const SceneFacts&) const override { return kernels; }
    [[nodiscard]] double kernelWidth(uint32_t pass) const override {
        return std::pow(double(pass) + 1.0, widthExponent);
    }
    void renderPass(const PassInfo& pass, Film& film, Statistics&) override {
        indices.push_back(pass.index);
        const double age = kernels ? double(pass.index) + 1.0 : 1.0;
        const double spread = std::sqrt(3.0 * variance.first * std::pow(age, variance.exponent)); // of a box, half
        const double left = bias.first * std::pow(age, bias.exponent);
        Sampler sampler(pass.seed, RandomStream::Test, pass.index, 0);
        const double common = spread * (2.0 * double(sampler.next1D()) - 1.0);
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x) {
                const double sign = (x + y) % 2 == 0 ? 1.0 : -1.0, wrong = kernels ? sign * left : 0.0;
                const double noise = spread * (2.0 * double(sampler.next1D()) - 1.0);
                film.add(0, x, y, Rgb(float(1.0 + wrong + noise)));
                if (pass.bias) pass.bias->add(0, x, y, Rgb(float(wrong + 0.3 * (shared ? common : noise))));
            }
    }
};

std::optional<PassCosts> costsOf(KnownPasses& integrator, uint32_t rounds = 40, uint64_t seed = 7) {
    const test::SceneFile file(R"({"primitives": [{"type": "point", "emission": 1}],
        "camera": {"type": "pinhole", "resolution": [64, 64]}, "integrator": {"type": "path_tracer"}})");
    const LoadedScene loaded = loadScene(file.path());
    return measurePasses(*loaded.scene, integrator, analyseScene(*loaded.scene),
                         {.seed = seed, .seconds = 0.0, .mostSeconds = 60.0, .rounds = rounds});
}

/// Passes that end only when they are told to.
class EndlessPasses : public KnownPasses {
  public:
    void renderPass(const PassInfo& pass, Film&, Statistics&) override {
        while (true) pass.watch.advance();
    }
};

TEST(CostPilot, PassesThatTakeTooLongAreRefused) {
    const test::SceneFile file(R"({"primitives": [], "integrator": {"type": "path_tracer"}})");
    const LoadedScene loaded = loadScene(file.path());
    EndlessPasses integrator;
    try {
        (void)measurePasses(*loaded.scene, integrator, analyseScene(*loaded.scene),
                            {.seconds = 0.02, .mostSeconds = 0.05});
        FAIL() << "endless passes have no price";
    } catch (const InputError& error) {
        const std::string& message = error.problems().front().message;
        EXPECT_EQ(message.rfind("a pass takes more than ", 0), 0u) << message;
        EXPECT_NE(message.find(" s: not even 6 small ones end within the 0.02 s that --timeout leaves each method"),
                  std::string::npos)
            << message;
    }
}

/// Passes of as much work, and of as much less noise, as they have samples.
class LongPasses : public KnownPasses {
  public:
    uint32_t most = 0; ///< samples of a pass that has ended

    void renderPass(const PassInfo& pass, Film& film, Statistics&) override {
        pass.watch.stage("samples", pass.samples);
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(pass.samples);
        while (std::chrono::steady_clock::now() < end) pass.watch.advance(0);
        pass.watch.advance(pass.samples);
        most = std::max(most, pass.samples);
        Sampler sampler(pass.seed, RandomStream::Test, pass.index, 0);
        const double spread = std::sqrt(3.0 * variance.first / double(pass.samples));
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                film.add(0, x, y, Rgb(float(1.0 + spread * (2.0 * double(sampler.next1D()) - 1.0))));
    }
};

TEST(CostPilot, LongPassesAreCutAndTakenToWholeOnes) {
    const test::SceneFile file(R"({"primitives": [{"type": "point", "emission": 1}],
        "camera": {"type": "pinhole", "resolution": [64, 64]}, "integrator": {"type": "path_tracer"}})");
    const LoadedScene loaded = loadScene(file.path());
    LongPasses integrator;
    integrator.kernels = false;
    // A whole pass takes 65 s.
    const auto costs = measurePasses(*loaded.scene, integrator, analyseScene(*loaded.scene),
                                     {.samplesPerPass = 65536, .seconds = 0.5, .mostSeconds = 60.0});
    ASSERT_TRUE(costs);
    EXPECT_GE(costs->passes, 6u);
    EXPECT_LT(integrator.most, 200u);
    EXPECT_NEAR(costs->variance.first, 0.04 / 65536.0, 0.004 / 65536.0);
    EXPECT_GT(costs->wallSeconds.first, 65.0);
}

TEST(PowerLaw, SumsAreThoseOfTheirTerms) {
    for (const double exponent : {-1.4, -1.0, -0.47, 0.0, 0.3}) {
        const PowerLaw law{2.0, exponent};
        double sum = 0.0;
        for (int i = 1; i <= 5000; ++i) {
            sum += 2.0 * std::pow(i, exponent);
            if (i == 1 || i == 256 || i == 257 || i == 5000) {
                EXPECT_NEAR(law.sum(i), sum, 1e-5 * sum) << i;
            }
        }
    }
}

TEST(PassCosts, PassesForAnErrorAreTheFirstThatReachIt) {
    const PassCosts costs{.variance = {0.09, 0.2}, .bias = {0.05, -0.4}, .cpuSeconds = {0.5, 0.0}};
    for (const double error : {0.2, 0.05, 0.01}) {
        const double passes = costs.passesFor(error).value();
        EXPECT_LE(costs.error(passes), error);
        EXPECT_GT(costs.error(passes - 1.0), error);
        EXPECT_NEAR(costs.cpuSecondsFor(passes), 0.5 * passes, 1e-6 * passes);
    }
    EXPECT_EQ(costs.passesFor(1.0), 1.0);
    const PassCosts stuck{.variance = {0.09, 0.0}, .bias = {0.05, 0.0}};
    EXPECT_TRUE(stuck.passesFor(0.06).has_value());
    EXPECT_FALSE(stuck.passesFor(0.04).has_value()) << "a bias that stays";
}

TEST(CostPilot, FindsTheLawsOfPasses) {
    KnownPasses integrator;
    const PassCosts costs = costsOf(integrator).value();
    EXPECT_EQ(costs.passes, integrator.indices.size());
    // 4096 pixels and several rounds: variances to 3 % at most, laws over 5.5 units of the logarithm.
    EXPECT_NEAR(costs.variance.first, 0.04, 0.004);
    EXPECT_NEAR(costs.variance.exponent, 0.25, 0.03);
    EXPECT_NEAR(costs.bias.first, 0.02, 0.004);
    EXPECT_NEAR(costs.bias.exponent, -0.5, 0.05);
    EXPECT_GT(costs.cpuSeconds.first, 0.0);
    integrator.bias.first = 0.0;
    EXPECT_EQ(costsOf(integrator).value().bias.first, 0.0) << "noise is no bias";
}

TEST(CostPilot, BiasMayFallMoreSlowlyThanTheSquareOfTheWidth) {
    KnownPasses integrator;
    integrator.variance.first = 0.004;
    integrator.bias = {0.05, -0.15};
    const PassCosts costs = costsOf(integrator).value();
    EXPECT_NEAR(costs.bias.exponent, -0.15, 0.05);
    EXPECT_NEAR(costs.bias.sum(1000.0), integrator.bias.sum(1000.0), 0.1 * integrator.bias.sum(1000.0));
}

TEST(CostPilot, NoiseThatPixelsShareIsNoBias) {
    KnownPasses integrator;
    integrator.bias.first = 0.0;
    integrator.shared = true;
    for (const uint32_t rounds : {2u, 4u}) {
        int found = 0; // 2.3 % and 0.1 % of 1000 seeds
        for (uint64_t seed = 0; seed < 100; ++seed)
            if (costsOf(integrator, rounds, 1000 * seed)->bias.first > 0.0) ++found;
        EXPECT_LE(found, 8) << rounds;
    }
}

TEST(CostPilot, NarrowerKernelsTakeNoNoise) {
    KnownPasses integrator;
    for (const double exponent : {-0.5, 1.0}) {
        integrator.variance.exponent = exponent;
        const PassCosts costs = costsOf(integrator).value();
        EXPECT_EQ(costs.variance.exponent, exponent < 0.0 ? 0.0 : 0.75) << "three dimensions, width ~ n^-0.25";
    }
}

TEST(CostPilot, PassesWithoutKernelsAreAlike) {
    KnownPasses integrator;
    integrator.kernels = false;
    const PassCosts costs = costsOf(integrator).value();
    EXPECT_NEAR(costs.variance.first, 0.04, 0.002);
    EXPECT_EQ(costs.variance.exponent, 0.0);
    EXPECT_EQ(costs.bias.first, 0.0);
}

TEST(PlanCost, PrintsATableAndWritesJson) {
    const test::TemporaryFolder folder;
    const std::string json = (folder.path() / "cost.json").string();
    const auto result = test::tungsten({"--plan-cost", "--timeout", "0.2s", "--resolution", "12x12", "--stats", json,
                                        "--set", "renderer.spp_step=1", "--set", "integrator.photon_count=3000",
                                        "--set", "integrator.volume_photon_count=3000", "-d", folder.path().string(),
                                        (test::dataFolder() / "scenes/cornell-fog/scene.json").string()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    for (const char* text : {"points", "beams", "mis_volumes_balls", "paths", "cheapest", "0.3 %"})
        EXPECT_NE(result.out.find(text), std::string::npos) << text << result.out;
    const std::string written = test::contentOf(json);
    EXPECT_NE(written.find("\"CPU seconds\""), std::string::npos) << written;
    EXPECT_NE(written.find("integrator.darts=best"), std::string::npos);
    size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
    EXPECT_EQ(files, 1u) << "it renders nothing";
}

TEST(PlanCost, EndsWhenItIsInterrupted) {
    test::Command command({"--plan-cost", "--timeout", "1h", "--resolution", "12x12", "--set", "renderer.spp_step=1",
                           (test::dataFolder() / "scenes/cornell-fog/scene.json").string()});
    ASSERT_TRUE(command.handles(SIGINT));
    command.send(SIGINT);
    const auto result = command.wait();
    EXPECT_EQ(result.exitCode, 130) << result.all();
    EXPECT_EQ(result.out, "");
}

/// Paths miss a laser's light where it is scattered for the first time: a reason instead of a price.
TEST(PlanCost, SaysWhyAMethodHasNoPrice) {
    const auto result =
        test::tungsten({"--plan-cost", "--timeout", "0.1s", "--resolution", "8x8", "--set", "renderer.spp_step=1",
                        "--set", "integrator.photon_count=2000", "--set", "integrator.volume_photon_count=2000",
                        (test::dataFolder() / "scenes/laser-in-fog/scene.json").string()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const size_t paths = result.out.find("\npaths");
    ASSERT_NE(paths, std::string::npos) << result.out;
    EXPECT_NE(result.out.find("lacks light of a single direction in view", paths), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("paths", result.out.find("\ncheapest")), std::string::npos) << result.out;
}

} // namespace
} // namespace tungsten
