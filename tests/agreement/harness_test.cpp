// The harness itself: it finds deliberate errors, and a method that is not there is an error.

#include "tungsten/core/Errors.h"

#include "support/AgreementScenes.h"
#include "support/SeedShift.h"
#include "support/SingleScattering.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

struct Fault {
    std::string name, scene;
    std::vector<std::string> overrides; ///< of the faulty render
};

AgreementScene sceneCalled(const std::string& name) {
    for (AgreementScene& scene : singleGateScenes())
        if (scene.name == name) return scene;
    throw std::logic_error("no scene " + name);
}

class Faults : public testing::TestWithParam<Fault> {};

TEST_P(Faults, AreDetected) {
    const test::OtherSeeds seeds{{"SecondPulseLate", 1}};
    const AgreementScene right = sceneCalled(GetParam().scene);
    AgreementScene wrong = right;
    wrong.overrides.insert(wrong.overrides.end(), GetParam().overrides.begin(), GetParam().overrides.end());
    const std::vector<Method> methods = plainMethods();
    const BlockMeans reference = renderBlocks(right, methods.front());
    for (size_t i = 1; i < methods.size(); ++i) {
        const Agreement agreement = compare(renderBlocks(wrong, methods[i]), reference);
        EXPECT_GT(agreement.score(), 1.3) << methods[i].name << ": " << agreement;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Harness, Faults,
    testing::Values(Fault{"SingleScatteringDropped", "backward-fog", {"integrator.min_bounces=3"}},
                    Fault{"OrdersAboveTheSecondDropped", "coloured-fog", {"integrator.max_bounces=4"}},
                    Fault{"SpeedInVacuumOffByThreePercent", "slow-cloud", {"integrator.vaccum_speed_of_light=1.03"}},
                    Fault{"AnisotropyOff", "forward-fog", {"media.fog.phase_function.g=0.6"}},
                    Fault{"SecondPulseLate", "two-pulses", {"primitives.blue pulse.emission_time=1.65"}}),
    [](const auto& instance) { return instance.param.name; });

TEST(Harness, ClosedFormsDetectASpeedOffByOnePercent) {
    PulsesInFog fog = singleScatteringCases().front();
    const BlockMeans exact = closedForm(fog, 24);
    fog.speed *= 1.01;
    AgreementScene wrong = builtScene("wrong speed", sceneJson(fog), 0.1, ClosedFormEffort);
    wrong.overrides = {"integrator.vaccum_speed_of_light=1.01"};
    for (const Method& method : plainMethods()) {
        const Agreement agreement = compare(renderBlocks(wrong, method), exact);
        EXPECT_GT(agreement.score(), 1.3) << method.name << ": " << agreement;
    }
}

TEST(Harness, MethodsThatTheBuildDoesNotKnowFail) {
    const AgreementScene scene = sceneCalled("slow-cloud");
    for (const std::string field : {"type=imagined", "volume_photon_type=beans", "darts=imagined", "imagined=1"})
        EXPECT_THROW(renderBlocks(scene, photonMethod("imagined", {field}, 3)), InputError) << field;
    EXPECT_THROW(renderBlocks(scene, pathMethod("imagined", {"darts=imagined"}, 3)), InputError);
}

/// The kernel's bias falls as the square of the radius. Wide kernels must be seen to be biased, and extrapolation must
/// remove most of it.
TEST(Harness, KernelBiasFallsWithTheRadius) {
    AgreementScene scene = sceneCalled("backward-fog");
    scene.effort.photonPasses = 16;
    // Kernels that end at surfaces are off by less than this harness can tell.
    scene.overrides.emplace_back("integrator.boundary_kernels=false");
    const std::vector<Method> methods = plainMethods();
    const BlockMeans reference = renderBlocks(scene, methods.front());
    for (const Method& method : methods) {
        if (!method.kernel) continue;
        SCOPED_TRACE(method.name);
        scene.radius = 0.9;
        const Agreement wide = compare(renderBlocks(scene, method), reference);
        scene.radius = 0.45;
        const Agreement narrow = compare(renderBlocks(scene, method), reference);
        EXPECT_GT(wide.shrink, 0.04);
        EXPECT_LT(narrow.shrink, 0.5 * wide.shrink);
        EXPECT_LT(narrow.deviation, 0.5 * wide.shrink + wide.blockError);
        EXPECT_LE(narrow.score(), 1.0) << narrow;
    }
}

TEST(Harness, ComparesWhatItSays) {
    const auto allowance = [](double standardErrors, double shrink) { return 0.01 + standardErrors + shrink; };
    BlockMeans a(1, 2), b(1, 2);
    for (size_t i = 0; i < 2; ++i) a.mean[i] = b.mean[i] = Vec3d(1.0);
    EXPECT_EQ(compare(a, b).worst, 0.0);
    a.mean[0].y = 1.1;
    EXPECT_NEAR(compare(a, b).worst, 0.1 / allowance(0.0, 0.0), 1e-9);
    a.error[0].y = 0.03;
    b.error[0].y = 0.04;
    EXPECT_NEAR(compare(a, b).worst, 0.1 / allowance(5.0 * 0.05, 0.0), 1e-9);
    a.shrink[0].y = -0.3;
    EXPECT_NEAR(compare(a, b).worst, 0.1 / allowance(5.0 * 0.05, 2.0 / 3.0 * 0.3), 1e-9);
    EXPECT_EQ(compare(a, b).channel, 1);
    // Small deviations of every block add up.
    a = BlockMeans(1, 101);
    b = a;
    for (size_t i = 0; i < 101; ++i) {
        b.mean[i] = Vec3d(1.0);
        b.error[i] = Vec3d(0.1);
        a.mean[i] = Vec3d(1.0 + 0.01 + (i % 2 == 0 ? 0.3 : -0.32));
    }
    EXPECT_NEAR(compare(a, b).rmsSigmas, 3.0, 1e-9);
    EXPECT_LT(compare(a, b).worst, 1.0);
    EXPECT_NEAR(compare(a, b).score(), 3.0 / 2.2, 1e-9);
    EXPECT_THROW(compare(a, BlockMeans(1, 3)), std::logic_error);
}

} // namespace
} // namespace tungsten::test
