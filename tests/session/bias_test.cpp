// The bias of kernels on its way through a session: measured passes, outputs, target, resume state.

#include "app/command.h"
#include "session/fake_integrator.h"
#include "support/Folders.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/image/ReadImage.h"
#include "tungsten/io/Result.h"
#include "tungsten/session/Report.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::contentOf;
using test::SessionFixture;
using test::tinyScene;

const char* const FortyPasses = R"("spp": 40, "spp_step": 1, "hdr_output_file": "image.exr")";

TEST(Bias, IsInTheExrTheStatisticsAndTheTrace) {
    SessionFixture session(
        tinyScene(std::string(test::ThreeFrames) + R"(, "time_normalization": "integral")", FortyPasses));
    session.integrator.bias = 0.2f;
    session.options.bias = true;
    session.options.trace = session.folder() / "trace";
    const SessionResult& result = session.run();
    uint32_t measured = 0;
    for (const PassInfo& pass : session.integrator.passes) {
        EXPECT_EQ(pass.bias != nullptr, passesOfItsBias(pass.index) > 0) << pass.index;
        measured += pass.bias ? 1 : 0;
    }
    EXPECT_EQ(result.bias.passes(), measured);
    EXPECT_NEAR(result.relativeBias().estimate, 0.2 / meanValue(result.film), 0.01);
    for (int frame = 0; frame < 3; ++frame) {
        constexpr float Width = 0.5f; // integrals over frames
        const Image bias = readExr(session.outputs.hdr, frame, "bias."),
                    error = readExr(session.outputs.hdr, frame, "biasStderr.");
        for (size_t i = 0; i < bias.pixels.size(); ++i) {
            EXPECT_EQ(bias.pixels[i], result.bias.mean(frame).pixels[i] * Width);
            EXPECT_EQ(error.pixels[i], result.bias.standardError(frame).pixels[i] * Width);
            EXPECT_GT(error.pixels[i].x, 0.0f);
        }
    }
    const std::string json = statisticsJson(session.loaded, session.options, result);
    EXPECT_NE(json.find("\"relative bias\": 0."), std::string::npos) << json;
    EXPECT_NE(json.find("\"relative bias bound\": 0."), std::string::npos);
    const std::string list = contentOf(session.folder() / "trace/trace.json");
    EXPECT_NE(list.find("\"bias\": \"bias-000040.npy\""), std::string::npos) << list;
    EXPECT_EQ(contentOf(session.folder() / "trace/bias-000040.npy").size(),
              contentOf(session.folder() / "trace/mean-000040.npy").size());
}

TEST(Bias, IsInResultFiles) {
    SessionFixture session(tinyScene("", FortyPasses));
    session.integrator.bias = 0.2f;
    session.options.bias = true;
    const SessionResult& result = session.run();
    const ResultContent content = resultContent(result.film, result.bias, *session.loaded.scene, "");
    ASSERT_EQ(content.images.size(), 4u);
    EXPECT_EQ(content.images[2].name, "bias");
    EXPECT_EQ(content.images[2].frame(0).pixels, result.bias.mean(0).pixels);
    EXPECT_EQ(content.images[3].name, "bias_standard_error");
    EXPECT_EQ(content.images[3].frame(0).pixels, result.bias.standardError(0).pixels);
    EXPECT_EQ(resultContent(result.film, Film(), *session.loaded.scene, "").images.size(), 2u);
}

TEST(Bias, CostsNothingWhereNoneIsLeftOrAskedFor) {
    for (const bool leaves : {false, true}) {
        SessionFixture session(tinyScene("", FortyPasses));
        session.integrator.bias = leaves ? 0.2f : 0.0f;
        session.options.bias = !leaves;
        const SessionResult& result = session.run();
        for (const PassInfo& pass : session.integrator.passes) EXPECT_EQ(pass.bias, nullptr);
        EXPECT_EQ(result.relativeBias().bound, 0.0);
        EXPECT_EQ(result.bias.memoryBytes(), 0u);
        EXPECT_THROW(readExr(session.outputs.hdr, 0, "bias."), InputError);
        EXPECT_EQ(statisticsJson(session.loaded, session.options, result).find("bias"), std::string::npos);
    }
}

TEST(Bias, CountsForATargetError) {
    const auto passesFor = [](float bias) {
        SessionFixture session(tinyScene("", R"("spp": 1024, "spp_step": 1)"));
        session.integrator.bias = bias;
        session.options.targetError = 0.09;
        return session.run().film.passes();
    };
    // The mean is 0.5; the noise falls below 9 % with 64 passes. The bound of a bias is 1.71 times what is seen.
    EXPECT_EQ(passesFor(0.0f), 64u);
    EXPECT_EQ(passesFor(0.01f), 128u);
    EXPECT_EQ(passesFor(0.02f), 256u);
    EXPECT_EQ(passesFor(0.05f), 1024u) << "beyond the target for ever";
}

TEST(Bias, AResumedRenderKnowsWhatOneThatRanThroughDoes) {
    const std::string renderer = R"("spp_step": 1, "spp": )";
    SessionFixture through(tinyScene(test::ThreeFrames, renderer + "40"));
    through.integrator.bias = 0.1f;
    through.options.bias = true;
    const SessionResult& whole = through.run();

    SessionFixture parts(tinyScene(test::ThreeFrames, renderer + "40"));
    parts.integrator.bias = 0.1f;
    parts.options.bias = parts.options.resumeEnabled = true;
    parts.options.spp = 18; // in the midst of a group
    parts.run();
    parts.options.spp = 40;
    const SessionResult& resumed = parts.run();
    EXPECT_EQ(resumed.resumedSamples, 18u);
    EXPECT_EQ(test::bitsOf(resumed.bias), test::bitsOf(whole.bias));
    EXPECT_EQ(resumed.relativeBias().bound, whole.relativeBias().bound);

    parts.options.bias = false;
    EXPECT_THROW(parts.run(), InputError) << "the estimate would be lost";
    parts.options.bias = true;
    parts.options.restart = true;
    EXPECT_NO_THROW(parts.run());
}

/// Photon maps leave some, paths none.
TEST(Bias, TheCommandEstimatesItForPhotonMaps) {
    const test::TemporaryFolder folder;
    for (const std::string type : {"transient_photon_map", "transient_path_tracer"}) {
        const auto result = test::tungsten(
            {"--bias", "--spp", "6", "--resolution", "12x12", "--set", "renderer.spp_step=1", "--set",
             "integrator.type=" + type, "--set", "integrator.photon_count=3000", "-d", folder.path().string(), "-e",
             type + ".exr", (test::dataFolder() / "scenes/cornell-fog/scene.json").string()});
        ASSERT_EQ(result.exitCode, 0) << result.err;
        const bool photons = type == "transient_photon_map";
        EXPECT_EQ(result.out.find(", bias ") != std::string::npos, photons) << result.out;
        const std::filesystem::path file = folder.path() / (type + ".exr");
        if (photons)
            EXPECT_EQ(readExr(file, 0, "bias.").width, 12);
        else
            EXPECT_THROW(readExr(file, 0, "bias."), InputError);
    }
}

} // namespace
} // namespace tungsten
