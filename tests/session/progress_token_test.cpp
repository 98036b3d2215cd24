// Breaking passes off: what sessions make of it, how passes are cut, and what is seen on the way.

#include "session/fake_integrator.h"

#include "tungsten/session/Passes.h"

#include <gtest/gtest.h>

#include <thread>

namespace tungsten {
namespace {

using test::bitsOf;
using test::SessionFixture;
using test::ThreeFrames;
using test::tinyScene;

/// Polls for ever in the pass with this index, once the image is half there.
void hangIn(SessionFixture& session, uint32_t index) {
    session.integrator.afterPass = [index](const PassInfo& pass) {
        pass.watch.stage("hanging", 1000);
        for (uint64_t i = 0; pass.index == index; ++i) {
            pass.watch.advance();
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
    };
}

TEST(ProgressToken, AnInterruptLeavesTheFilmAsAfterWholePasses) {
    for (const char* const gate : {"", ThreeFrames}) {
        SessionFixture two(tinyScene(gate, R"("spp": 4, "spp_step": 2)"));
        const std::string expected = bitsOf(two.run().film);
        SessionFixture session(tinyScene(gate, R"("spp": 8, "spp_step": 2)"));
        std::atomic<bool> interrupted{false};
        uint64_t polls = 0;
        session.options.interrupted = &interrupted;
        session.integrator.afterPass = [&](const PassInfo& pass) {
            for (; pass.index == 2; ++polls) {
                interrupted = polls == 10;
                pass.watch.advance();
            }
        };
        const SessionResult& result = session.run();
        EXPECT_EQ(result.reason, StopReason::Interrupted);
        EXPECT_EQ(polls, 10u) << "the first poll after the flag";
        EXPECT_EQ(result.samples, 4u);
        EXPECT_EQ(bitsOf(result.film), expected);
        EXPECT_EQ(result.statistics.counter("fake passes"), 2u) << "counters are of whole passes";
        EXPECT_TRUE(session.has("TungstenRender.png"));
    }
}

TEST(ProgressToken, ATimeOutBreaksThePassOff) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 2)"));
    session.options.timeoutSeconds = 0.2;
    hangIn(session, 2);
    const auto start = std::chrono::steady_clock::now();
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::TimedOut);
    EXPECT_EQ(result.film.passes(), 2u);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 2.0);
    EXPECT_EQ(result.statistics.stages().count("passes broken off"), 1u);
    EXPECT_TRUE(session.has("TungstenRender.png"));
}

TEST(ProgressToken, WithoutOnePassNothingIsWritten) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 1)"));
    session.options.timeoutSeconds = 0.1;
    session.options.resumeEnabled = true;
    session.outputs.statistics = session.folder() / "stats.json";
    hangIn(session, 0);
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::TimedOut);
    EXPECT_EQ(result.film.passes(), 0u);
    EXPECT_EQ(session.integrator.passes.size(), 1u) << "what cannot be cut has all the time";
    for (const char* name : {"TungstenRender.png", "stats.json"}) EXPECT_FALSE(session.has(name)) << name;
    EXPECT_FALSE(std::filesystem::exists(session.outputs.state));
}

TEST(ProgressToken, PassesAreCutIfTheFirstIsTooLong) {
    for (const bool lightPaths : {false, true}) {
        SessionFixture session(tinyScene("", R"("spp": 96, "spp_step": 48)"));
        session.options.timeoutSeconds = 1.0;
        session.integrator.cutsPaths = lightPaths;
        session.integrator.afterPass = [](const PassInfo& pass) {
            pass.watch.stage("endless", 4);
            if (pass.samples > 3) pass.watch.advance(1);
            while (pass.samples > 3) pass.watch.advance(0);
        };
        const SessionResult& result = session.run();
        EXPECT_EQ(result.reason, StopReason::Finished);
        EXPECT_EQ(result.samples, 96u);
        const auto& passes = session.integrator.passes;
        ASSERT_EQ(passes.size(), 33u) << "one that was broken off, and 32 of 3 samples";
        EXPECT_EQ(passes[1].index, 0u);
        EXPECT_EQ(passes[2].firstSample, 3u);
        for (size_t i = 1; i < passes.size(); ++i) EXPECT_EQ(passes[i].share, lightPaths ? 1.0 / 16.0 : 1.0);
    }
}

/// So many parts of a sample as make a whole one have as many light paths, and see pixels in different places.
TEST(ProgressToken, SamplesAreCutWhereLightPathsCanBe) {
    SessionFixture session(tinyScene("", R"("spp": 2, "spp_step": 1)"));
    session.options.timeoutSeconds = 1.0;
    session.options.trace = session.folder() / "trace";
    session.integrator.cutsPaths = true;
    session.integrator.afterPass = [](const PassInfo& pass) {
        pass.watch.stage("endless", 8);
        if (pass.share == 1.0) pass.watch.advance(1);
        while (pass.share == 1.0) pass.watch.advance(0);
    };
    const SessionResult& result = session.run();
    EXPECT_EQ(result.samples, 2u);
    EXPECT_DOUBLE_EQ(result.film.totalWeight(), 2.0);
    std::set<uint64_t> samples;
    double light = 0.0;
    for (const PassInfo& pass : session.integrator.passes) {
        if (pass.share == 1.0) continue;
        light += pass.share;
        samples.insert(pass.firstSample);
    }
    EXPECT_DOUBLE_EQ(light, 2.0);
    EXPECT_EQ(samples.size(), 64u);
    ASSERT_FALSE(result.trace.empty());
    for (const TraceEntry& entry : result.trace) EXPECT_DOUBLE_EQ(entry.samples, double(entry.passes) / 32.0);
}

TEST(ProgressToken, WhatIsThrownWithinAPassEndsTheRender) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 2)"));
    int calls = 0;
    session.options.duringPass = [&] {
        if (++calls == 2) throw UsageError("mine");
    };
    hangIn(session, 1);
    EXPECT_THROW(session.run(), UsageError);
    EXPECT_EQ(calls, 2);
    EXPECT_FALSE(session.has("TungstenRender.png"));
}

/// Prepares without end.
void hangInPreparing(SessionFixture& session) {
    session.integrator.preparing = [](const ProgressToken& watch) {
        watch.stage("tables", 1000);
        for (;; watch.advance()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
}

TEST(ProgressToken, PreparingIsBrokenOffAsPassesAre) {
    for (const bool partial : {false, true}) {
        SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 2)"));
        if (partial) session.options.passes = PassRange{0, 2};
        hangInPreparing(session);
        session.options.timeoutSeconds = 0.2;
        const auto start = std::chrono::steady_clock::now();
        EXPECT_EQ(session.run().reason, StopReason::TimedOut);
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
        std::atomic<bool> interrupted{false};
        session.options.timeoutSeconds = 0.0;
        session.options.interrupted = &interrupted;
        session.options.duringPass = [&] { interrupted = true; };
        EXPECT_EQ(session.run().reason, StopReason::Interrupted);
        session.options.duringPass = [] { throw UsageError("mine"); };
        interrupted = false;
        EXPECT_THROW(session.run(), UsageError);
        EXPECT_TRUE(session.integrator.passes.empty());
        EXPECT_FALSE(session.integrator.prepared);
        EXPECT_FALSE(session.has("TungstenRender.png"));
        EXPECT_FALSE(std::filesystem::exists(session.outputs.partialState(0, 2)));
    }
}

TEST(ProgressToken, ARenderThatIsResumedAndNotPreparedInTimeKeepsItsPasses) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 2)"));
    session.options.resumeEnabled = true;
    session.options.spp = 4;
    session.run();
    std::filesystem::remove(session.folder() / "TungstenRender.png");
    hangInPreparing(session);
    session.options.spp = 8;
    session.options.timeoutSeconds = 0.1;
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::TimedOut);
    EXPECT_EQ(result.film.passes(), 2u);
    EXPECT_TRUE(session.has("TungstenRender.png"));
    session.options.timeoutSeconds = 0.0;
    session.integrator.preparing = [](const ProgressToken&) {};
    EXPECT_EQ(session.run().film.passes(), 4u);
}

TEST(ProgressToken, PartialStatesHaveWholePassesOrNone) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 2)"));
    session.options.timeoutSeconds = 0.2;
    session.options.passes = PassRange{1, 3};
    hangIn(session, 1);
    const SessionResult& result = session.run();
    EXPECT_EQ(result.reason, StopReason::TimedOut);
    EXPECT_EQ(session.integrator.passes.size(), 1u);
    EXPECT_TRUE(result.written.empty());
    EXPECT_FALSE(std::filesystem::exists(session.outputs.partialState(1, 3)));
}

TEST(PassSizes, AreCutUntilNothingIsLeftToCut) {
    PassSizes paths(1000, 100, false), photons(1000, 100, true);
    EXPECT_EQ(paths.next(0.0).samples, 100u);
    EXPECT_EQ(paths.next(950.0).samples, 50u);
    paths.cut(0.25);
    photons.cut(0.25);
    EXPECT_EQ(paths.next(0.0).samples, 6u);
    EXPECT_DOUBLE_EQ(paths.next(0.0).weight, 6.0);
    EXPECT_EQ(paths.left(0.0), 167u);
    EXPECT_DOUBLE_EQ(photons.next(0.0).weight, 100.0 / 16.0);
    EXPECT_EQ(photons.left(0.0), 160u);
    paths.cut(0.25);
    EXPECT_EQ(paths.next(0.0).samples, 1u);
    EXPECT_FALSE(paths.canCut());
    while (photons.canCut()) photons.cut(0.0);
    EXPECT_DOUBLE_EQ(photons.share(), 1.0 / 409600.0);
}

TEST(ProgressToken, StagesLieInTheirPartOfThePass) {
    ProgressMonitor monitor([] { return false; });
    const ProgressToken watch(monitor);
    const ProgressToken last = watch.part(0.5, 1.0).part(0.5, 1.0);
    last.stage("gather", 10);
    last.advance(5);
    last.advanceWithin(1, 3);
    EXPECT_EQ(monitor.progress().stage, "gather");
    EXPECT_DOUBLE_EQ(monitor.progress().ofStage, 0.5);
    EXPECT_DOUBLE_EQ(monitor.progress().ofPass, 0.875);
    last.advance(100);
    EXPECT_DOUBLE_EQ(monitor.progress().ofPass, 1.0);
    ProgressToken().advance(); // nobody is asked
}

} // namespace
} // namespace tungsten
