// What a render would have shown had it been stopped earlier.

#include "app/command.h"
#include "session/fake_integrator.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tungsten {
namespace {

using test::contentOf;
using test::SessionFixture;
using test::tinyScene;

/// The numbers of a list's field, in its order.
std::vector<double> numbers(const std::string& json, const std::string& field) {
    std::vector<double> found;
    const std::string key = "\"" + field + "\": ";
    for (size_t at = json.find(key); at != std::string::npos; at = json.find(key, at + 1)) {
        const std::string value = json.substr(at + key.size(), 24);
        found.push_back(value.starts_with("null") ? NAN : std::stod(value));
    }
    return found;
}

TEST(Trace, HoldsWhatShorterRendersWrite) {
    const std::string rest = std::string(test::ThreeFrames) + R"(, "time_normalization": "integral")";
    SessionFixture traced(tinyScene(rest, R"("spp": 40, "spp_step": 1)"));
    traced.options.trace = traced.folder() / "trace";
    traced.integrator.afterPass = [](const PassInfo&) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
    traced.run();
    const std::string list = contentOf(traced.folder() / "trace/trace.json");
    const std::vector<double> passes = numbers(list, "passes"), seconds = numbers(list, "wall seconds");
    ASSERT_GE(passes.size(), 3u);
    EXPECT_EQ(passes.front(), 1.0);
    EXPECT_EQ(passes.back(), 40.0);
    EXPECT_TRUE(std::isnan(numbers(list, "relative standard error").front()));
    for (size_t i = 1; i + 1 < seconds.size(); ++i) EXPECT_GE(seconds[i], 2.0 * seconds[i - 1]);

    for (const double count : passes) {
        SessionFixture shorter(
            tinyScene(rest, R"("spp_step": 1, "hdr_output_file": "film.npy", "spp": )" + std::to_string(int(count))));
        shorter.run();
        char name[32];
        std::snprintf(name, sizeof name, "mean-%06d.npy", int(count));
        EXPECT_EQ(contentOf(traced.folder() / "trace" / name), contentOf(shorter.folder() / "film.npy")) << name;
        EXPECT_NE(list.find(name), std::string::npos);
    }
    EXPECT_EQ(contentOf(traced.folder() / "trace/stderr-000040.npy").size(),
              contentOf(traced.folder() / "trace/mean-000040.npy").size());
}

/// Studies stop renders within passes: the whole ones before that are not lost, and its time is not theirs.
TEST(Trace, EndsWithTheLastWholePass) {
    constexpr auto Long = std::chrono::milliseconds(50);
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 1)"));
    std::atomic<bool> interrupted{false};
    session.options.interrupted = &interrupted;
    session.options.trace = session.folder() / "trace";
    session.integrator.afterPass = [&](const PassInfo& pass) {
        if (pass.index == 0 || pass.index == 3) std::this_thread::sleep_for(Long);
        interrupted = pass.index == 3;
        pass.watch.advance();
    };
    const SessionResult& result = session.run();
    ASSERT_EQ(result.film.passes(), 3u);
    const std::string list = contentOf(session.folder() / "trace/trace.json");
    EXPECT_EQ(numbers(list, "passes").back(), 3.0);
    EXPECT_LT(numbers(list, "wall seconds").back(), result.renderSeconds - 0.045);
    EXPECT_TRUE(session.has("trace/mean-000003.npy"));
}

TEST(Trace, AFolderThatCannotBeWrittenIsFoundBeforeRendering) {
    SessionFixture session(tinyScene(""));
    std::ofstream(session.folder() / "file") << "in the way";
    session.options.trace = session.folder() / "file";
    EXPECT_THROW(session.run(), InputError);
    EXPECT_TRUE(session.integrator.passes.empty());
}

/// Traces are written beside the render, which is worth more.
TEST(Trace, OneThatCannotBeWrittenCostsNoImage) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 1, "hdr_output_file": "image.pfm")"));
    session.options.trace = session.folder() / "trace";
    session.outputs.statistics = session.folder() / "stats.json";
    session.integrator.afterPass = [&](const PassInfo& pass) {
        if (pass.index == 0) std::filesystem::create_directories(session.folder() / "trace/mean-000008.npy");
    };
    try {
        session.run();
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("mean-000008.npy"), std::string::npos) << error.what();
    }
    EXPECT_EQ(session.results.back().film.passes(), 8u);
    for (const char* name : {"TungstenRender.png", "image.pfm", "stats.json", "trace/trace.json"})
        EXPECT_TRUE(session.has(name)) << name;
}

TEST(Trace, AFolderThatVanishesIsMadeAgain) {
    SessionFixture session(tinyScene("", R"("spp": 8, "spp_step": 1)"));
    session.options.trace = session.folder() / "trace";
    session.integrator.afterPass = [&](const PassInfo& pass) {
        if (pass.index == 7) std::filesystem::remove_all(session.folder() / "trace");
    };
    session.run();
    for (const char* name : {"trace/trace.json", "trace/mean-000008.npy"}) EXPECT_TRUE(session.has(name)) << name;
}

TEST(Trace, TakesOneSceneAtATime) {
    const auto result = test::tungsten({"--trace", "folder", "a.json", "b.json"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.err.find("--trace"), std::string::npos);
}

} // namespace
} // namespace tungsten
