// Passes, stopping, checkpoints and resuming, with an integrator whose image is known.

#include "session/fake_integrator.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/image/ReadImage.h"
#include "tungsten/session/Checkpoint.h"
#include "tungsten/session/Report.h"

#include <gtest/gtest.h>

#include <thread>

namespace tungsten {
namespace {

using test::bitsOf;
using test::SessionFixture;
using test::ThreeFrames;
using test::tinyScene;

const char* const TenByFour = R"("spp": 10, "spp_step": 4)";

std::string errorOf(SessionFixture& session) {
    try {
        session.run();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Session, TheLastPassTakesWhatIsLeft) {
    SessionFixture session(tinyScene("", TenByFour));
    const SessionResult& result = session.run();
    const auto& passes = session.integrator.passes;
    ASSERT_EQ(passes.size(), 3u);
    EXPECT_EQ(passes[0].samples, 4u);
    EXPECT_EQ(passes[1].firstSample, 4u);
    EXPECT_EQ(passes[2].samples, 2u);
    EXPECT_EQ(passes[2].firstSample, 8u);
    EXPECT_EQ(passes[2].index, 2u);
    EXPECT_EQ(passes[2].seed, session.options.seed);
    EXPECT_TRUE(session.integrator.prepared);
    EXPECT_EQ(result.samples, 10u);
    EXPECT_EQ(result.reason, StopReason::Finished);
    EXPECT_DOUBLE_EQ(result.film.totalWeight(), 10.0);
}

TEST(Session, ATimeOutStopsAfterAPassThatNeverPollsAndWrites) {
    SessionFixture session(tinyScene("", TenByFour));
    session.options.timeoutSeconds = 0.01;
    session.integrator.afterPass = [](const PassInfo&) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::TimedOut);
    EXPECT_EQ(result.film.passes(), 1u);
    EXPECT_TRUE(session.has("TungstenRender.png"));
}

TEST(Session, AnInterruptFinishesThePassAndWrites) {
    std::atomic<bool> interrupted{false};
    SessionFixture session(tinyScene("", TenByFour));
    session.options.interrupted = &interrupted;
    session.integrator.afterPass = [&](const PassInfo& pass) { interrupted = pass.index == 1; };
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::Interrupted);
    EXPECT_EQ(result.film.passes(), 2u);
    EXPECT_TRUE(session.has("TungstenRender.png"));
}

TEST(Session, AnInterruptBeforeTheFirstPassWritesNothing) {
    const std::atomic<bool> interrupted{true};
    SessionFixture session(tinyScene("", TenByFour));
    session.options.interrupted = &interrupted;
    EXPECT_EQ(session.run().reason, StopReason::Interrupted);
    EXPECT_TRUE(session.integrator.passes.empty());
    EXPECT_FALSE(session.has("TungstenRender.png"));
}

TEST(Session, ATargetErrorIsLookedAtWheneverThePassesHaveDoubled) {
    SessionFixture session(tinyScene("", R"("spp": 100000, "spp_step": 1)"));
    session.options.targetError = 0.045;
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::TargetReached);
    EXPECT_LE(relativeErrorBound(result.film), 0.045);
    EXPECT_LT(relativeStandardError(result.film), relativeErrorBound(result.film));
    // Uniform on (0, 1]: relative standard error sqrt(1/12) / (0.5 sqrt(n)), below the target from n = 165 on.
    EXPECT_EQ(result.film.passes(), 256u);
}

TEST(Session, ATargetErrorThatTheSamplesDoNotReachIsSaid) {
    SessionFixture session(tinyScene("", R"("spp": 32, "spp_step": 1)"));
    session.options.targetError = 0.001;
    testing::internal::CaptureStderr();
    const SessionResult& result = session.run();
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("target error of 0.1 % was not reached: 32 samples"), std::string::npos) << said;
    EXPECT_NE(statisticsJson(session.loaded, session.options, result).find("\"target error reached\": false"),
              std::string::npos);
}

/// Two passes that happen to be alike say nothing about the error.
TEST(Session, ATargetErrorNeedsSomePasses) {
    SessionFixture session(tinyScene("", R"("spp": 100000, "spp_step": 1)"));
    session.options.targetError = 0.12;
    session.integrator.noise = 0.0f;
    session.integrator.afterPass = [&](const PassInfo& pass) {
        session.integrator.noise = pass.index >= 2 ? 1.0f : 0.0f;
    };
    EXPECT_EQ(session.run().film.passes(), 64u);
    session.integrator.noise = 0.0f;
    session.integrator.afterPass = [](const PassInfo&) {};
    EXPECT_EQ(session.run().film.passes(), LeastPassesForTargetError);
}

TEST(Session, OnePassDoesNotKnowItsError) {
    SessionFixture session(tinyScene("", R"("spp": 1, "hdr_output_file": "image.exr")"));
    const SessionResult& result = session.run();
    const std::string json = statisticsJson(session.loaded, session.options, result);
    EXPECT_NE(json.find("\"relative standard error\": null"), std::string::npos) << json;
    EXPECT_TRUE(std::isnan(readExr(session.outputs.hdr, 0, "stderr.").at(0, 0).x));
}

TEST(Session, OutputsAreCheckedBeforeTheFirstPass) {
    SessionFixture session(tinyScene(""));
    session.outputs.ldr = session.folder() / "scene.json" / "image.png";
    EXPECT_NE(errorOf(session).find("-d DIRECTORY"), std::string::npos);
    EXPECT_TRUE(session.integrator.passes.empty());
}

TEST(Session, CheckpointsAreWrittenOnTheWay) {
    SessionFixture session(tinyScene("", R"("spp": 3, "spp_step": 1, "hdr_output_file": "image.pfm")"));
    session.options.checkpointSeconds = 1e-9;
    bool seen = false;
    session.integrator.afterPass = [&](const PassInfo& pass) {
        if (pass.index == 1) seen = session.has("TungstenRender_checkpoint.png") && session.has("image_checkpoint.pfm");
    };
    session.run();
    EXPECT_TRUE(seen);
    EXPECT_FALSE(session.has("TungstenRenderState.dat")) << "resuming is not enabled";
}

TEST(Session, AFailingCheckpointDoesNotLoseTheRender) {
    SessionFixture session(tinyScene("", R"("spp": 3, "spp_step": 1)"));
    session.options.checkpointSeconds = 1e-9;
    // A folder where the checkpoint's image should go, made meanwhile.
    session.integrator.afterPass = [&](const PassInfo& pass) {
        if (pass.index == 0)
            std::filesystem::create_directories(session.folder() / "TungstenRender_checkpoint.png" / "x");
    };
    EXPECT_EQ(session.run().film.passes(), 3u);
    EXPECT_TRUE(session.has("TungstenRender.png"));
}

/// Interrupts after every pass and resumes until the render is done: exact equality with one that ran through.
TEST(Session, AResumedRenderEqualsAnUninterruptedOneBitForBit) {
    for (const char* const gate : {"", ThreeFrames}) {
        SessionFixture whole(tinyScene(gate, TenByFour));
        const std::string expected = bitsOf(whole.run().film);

        SessionFixture pieces(tinyScene(gate, TenByFour));
        pieces.options.resumeEnabled = true;
        pieces.options.timeoutSeconds = 1e-9;
        uint64_t resumed = 0;
        for (const uint64_t expectedSamples : {4u, 8u, 10u}) {
            const SessionResult& result = pieces.run();
            EXPECT_EQ(result.samples, expectedSamples);
            EXPECT_EQ(result.resumedSamples, resumed);
            resumed = result.samples;
        }
        EXPECT_EQ(pieces.integrator.passes.size(), 3u);
        EXPECT_EQ(bitsOf(pieces.run().film), expected);
        EXPECT_EQ(pieces.integrator.passes.size(), 3u) << "nothing is left to do";
    }
}

TEST(Session, RestartIgnoresTheState) {
    SessionFixture session(tinyScene("", TenByFour));
    session.options.resumeEnabled = true;
    session.run();
    session.options.restart = true;
    EXPECT_EQ(session.run().resumedSamples, 0u);
    EXPECT_EQ(session.integrator.passes.size(), 6u);
}

TEST(Session, AStateOfAnotherRenderIsRefusedAndKept) {
    SessionFixture session(tinyScene("", TenByFour));
    session.options.resumeEnabled = true;
    session.run();
    const auto stamp = std::filesystem::last_write_time(session.outputs.state);
    const auto refuses = [&](const std::string& what) {
        const std::string text = errorOf(session);
        EXPECT_NE(text.find(what), std::string::npos) << text;
        EXPECT_NE(text.find("-r"), std::string::npos) << text;
        EXPECT_EQ(std::filesystem::last_write_time(session.outputs.state), stamp);
    };
    ++session.options.seed;
    refuses("another seed");
    --session.options.seed;
    session.options.sppStep = 5;
    refuses("another spp_step");
    session.options.sppStep = 4;
    session.loaded.hash ^= 1;
    refuses("another scene");
}

TEST(Session, ADamagedStateIsAnErrorNotACrash) {
    SessionFixture session(tinyScene(ThreeFrames, TenByFour));
    session.options.resumeEnabled = true;
    session.run();
    const auto size = std::filesystem::file_size(session.outputs.state);
    for (std::uintmax_t length = size; length-- > 0; length -= std::min<std::uintmax_t>(length, 37)) {
        std::filesystem::resize_file(session.outputs.state, length);
        EXPECT_NE(errorOf(session), "") << length;
    }
}

/// Every single bit, and random pairs of bits beside every eighth.
TEST(Session, AFlippedBitIsNoticed) {
    SessionFixture session(tinyScene(ThreeFrames, TenByFour));
    session.options.resumeEnabled = true;
    session.run();
    const std::filesystem::path file = session.outputs.state;
    std::stringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    const std::string whole = content.str();
    const RenderIdentity identity{session.loaded.hash, session.options.seed, session.options.sppStep};
    Film film(6, 4, 3), bias;
    const auto accepted = [&](const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
        try {
            return readCheckpoint(file, identity, film, bias).has_value();
        } catch (const InputError&) {
            return false;
        }
    };
    ASSERT_TRUE(accepted(whole));
    int flipped = 0;
    Sampler sampler(1, RandomStream::Test, 0, 0);
    for (size_t bit = 0; bit < 8 * whole.size(); bit += 5) {
        std::string bytes = whole;
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
        flipped += accepted(bytes) ? 1 : 0;
        if (bit % 4 != 0) continue;
        const size_t other = (bit + 1 + sampler.nextBits() % (8 * whole.size() - 1)) % (8 * whole.size());
        bytes[other / 8] = char(bytes[other / 8] ^ (1 << other % 8));
        flipped += accepted(bytes) ? 1 : 0;
    }
    EXPECT_EQ(flipped, 0) << "of every fifth bit";
    EXPECT_FALSE(accepted(whole + "x"));
    std::string older = whole;
    older[7] = '1';
    std::ofstream(file, std::ios::binary) << older;
    EXPECT_NE(errorOf(session).find("another version"), std::string::npos);
}

/// Removing it would not help, and might lose it.
TEST(Session, AStateThatCannotBeReadIsNotCalledDamaged) {
    SessionFixture session(tinyScene("", TenByFour));
    session.options.resumeEnabled = true;
    session.run();
    std::filesystem::permissions(session.outputs.state, std::filesystem::perms::none);
    if (std::ifstream(session.outputs.state)) GTEST_SKIP() << "this user may read everything";
    const std::string text = errorOf(session);
    EXPECT_NE(text.find("cannot be read: Permission denied"), std::string::npos) << text;
    EXPECT_EQ(text.find("-r"), std::string::npos) << text;
}

TEST(Session, StatisticsSayWhatHappened) {
    SessionFixture session(tinyScene("", TenByFour));
    session.outputs.statistics = session.folder() / "stats" / "run.json";
    const SessionResult& result = session.run();
    ASSERT_TRUE(session.has("stats/run.json"));
    EXPECT_EQ(result.statistics.counter("fake passes"), 3u);
    const std::string json = statisticsJson(session.loaded, session.options, result);
    for (const char* expected :
         {"\"passes\": 3", "\"samples per pixel\": 10", "\"fake passes\": 3",
          "\"stopped because\": \"all samples taken\"", "\"width\": 6", "\"height\": 4", "\"frames\": 1",
          "\"peak memory bytes\": ", "\"relative standard error\": 0.", "\"non-finite samples\": 0", "\"prepare\": {",
          "\"passes\": {", "\"write\": {", "\"CPU seconds\": "})
        EXPECT_NE(json.find(expected), std::string::npos) << expected << " in\n" << json;
}

} // namespace
} // namespace tungsten
