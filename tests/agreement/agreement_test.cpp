// Every method shows the same image on every scene, and the closed form where there is one.

#include "support/AgreementScenes.h"
#include "support/SeedShift.h"
#include "support/SingleScattering.h"

#include <gtest/gtest.h>

namespace tungsten::test {
namespace {

std::string identifier(std::string name) {
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}

/// A comparison that noise or bias could not have hidden a wrong value from.
void expectAgreement(const BlockMeans& method, const BlockMeans& reference) {
    const Agreement agreement = compare(method, reference);
    EXPECT_LE(agreement.score(), 1.0) << agreement;
    EXPECT_LT(agreement.wholeError, 0.04) << "too noisy to be a proof: " << agreement;
    EXPECT_LT(agreement.shrink, 0.08) << "too large a radius to be a proof: " << agreement;
}

class MethodsAgree : public testing::TestWithParam<AgreementScene> {};

/// Published methods have their light of several scatterings compared in Sequence and, by a mirror, in photon's
/// DirectView.
TEST_P(MethodsAgree, WithThePathTracer) {
    std::vector<Method> methods = methodsInTests(GetParam().name);
    std::erase_if(methods, [](const Method& method) { return method.name.starts_with("published"); });
    const BlockMeans reference = renderBlocks(GetParam(), methods.front());
    ASSERT_GT(channelMean(reference.whole(0)), 0.0);
    for (size_t i = 1; i < methods.size(); ++i) {
        SCOPED_TRACE(methods[i].name);
        expectAgreement(renderBlocks(GetParam(), methods[i]), reference);
    }
}

/// Light that scatters backward differs from other light by its phase function alone, which ClosedForms knows.
std::vector<AgreementScene> scenesInTests() {
    std::vector<AgreementScene> scenes = singleGateScenes();
    std::erase_if(scenes, [](const AgreementScene& scene) { return scene.name == "backward-fog"; });
    return scenes;
}
INSTANTIATE_TEST_SUITE_P(Scenes, MethodsAgree, testing::ValuesIn(scenesInTests()),
                         [](const auto& instance) { return identifier(instance.param.name); });

class ClosedForms : public testing::TestWithParam<PulsesInFog> {};

TEST_P(ClosedForms, MatchEveryMethod) {
    const test::OtherSeeds seeds{{"coloured_and_slow", 1}, {"two_pulses", 1}};
    constexpr int Side = 24;
    AgreementScene scene = builtScene(GetParam().name, sceneJson(GetParam()), 0.1, ClosedFormEffort);
    const BlockMeans exact = closedForm(GetParam(), Side);
    // Slow fog is dear to guided points, and published methods meet it in other tests.
    const bool slow = GetParam().speed != 1.0;
    if (!slow) scene.effort.photons /= 2;
    for (Method& method : methodsUnderTest()) {
        if (slow && method.name.starts_with("published")) continue;
        SCOPED_TRACE(method.name);
        // Beams have half the noise of plain points, guided points less but in slow fog, guided paths hardly any.
        const bool plainPoints = method.name == "plain points", beams = method.name.ends_with("beams");
        scene.effort.photonPasses = plainPoints ? ClosedFormEffort.photonPasses : beams ? 24 : 32;
        if (!method.kernel && !method.steadyState) method.share *= 0.25;
        expectAgreement(renderBlocks(scene, method), exact);
    }
}

/// Without the forward case, which the backward one mirrors.
std::vector<PulsesInFog> pulsesInTests() {
    std::vector<PulsesInFog> cases = singleScatteringCases();
    std::erase_if(cases, [](const PulsesInFog& pulses) { return pulses.name == "forward"; });
    return cases;
}
INSTANTIATE_TEST_SUITE_P(SingleScattering, ClosedForms, testing::ValuesIn(pulsesInTests()),
                         [](const auto& instance) { return identifier(instance.param.name); });

/// Block means of the sum over the frames of radiance times width.
BlockMeans summedOverFrames(const BlockMeans& sequence, double width) {
    BlockMeans sum(1, sequence.blocks);
    for (int block = 0; block < sequence.blocks; ++block)
        for (int frame = 0; frame < sequence.frames; ++frame) {
            const size_t from = sequence.index(frame, block), to = size_t(block);
            sum.mean[to] += sequence.mean[from] * width;
            sum.shrink[to] += sequence.shrink[from] * width;
            // Frames share paths: at worst errors add up.
            sum.error[to] += sequence.error[from] * width;
        }
    return sum;
}

/// Frame by frame, and in sum. Beams that are not guided best have their frames compared in photon's CornellFog.
TEST(Sequence, FramesAgreeAndSumToTheSteadyStateOfThePathTracer) {
    std::vector<Method> methods = methodsUnderTest();
    Method independent = methods.front();
    independent.seed = 77;
    const BlockMeans steady = renderBlocks(fogInSteadyState(), independent);
    BlockMeans pathFrames;
    for (Method& method : methods) {
        SCOPED_TRACE(method.name);
        const bool plain = method.name.starts_with("plain"), best = method.name.starts_with("best");
        if (method.name.ends_with("beams") && !best) continue;
        if (best) method.share *= 2.0; // paths arrive anywhere in the twenty frames
        const BlockMeans frames = renderBlocks(fogSequence(), method);
        EXPECT_EQ(frames.frames, 20);
        expectAgreement(summedOverFrames(frames, SequenceFrameWidth), steady);
        if (pathFrames.frames == 0)
            pathFrames = frames;
        else if (plain || best)
            expectAgreement(frames, pathFrames);
        if (method.name == "plain points") expectAgreement(renderBlocks(fogInSteadyState(), method), steady);
    }
}

} // namespace
} // namespace tungsten::test
