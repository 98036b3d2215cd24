// Counters and stages, memory, and what ranks tell of their films.

#include "tungsten/film/Film.h"
#include "tungsten/integrator/Statistics.h"
#include "tungsten/session/DistributedFilm.h"
#include "tungsten/session/Memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

namespace tungsten {
namespace {

TEST(Statistics, ThreadsMayAddAtOnce) {
    Statistics statistics;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int k = 0; k < 1000; ++k) statistics.add("events", 3);
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(statistics.counter("events"), 12000u);
    EXPECT_EQ(statistics.counter("none"), 0u);
}

TEST(Statistics, StagesAddUp) {
    Statistics statistics;
    for (int i = 0; i < 2; ++i) {
        const StageTimer timer(statistics, "sleep");
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    const Statistics::Stage stage = statistics.stages().at("sleep");
    EXPECT_EQ(stage.runs, 2u);
    EXPECT_GE(stage.wallSeconds, 0.02);
    EXPECT_LT(stage.cpuSeconds, stage.wallSeconds);
    EXPECT_GT(peakMemoryBytes(), 1u << 20);
}

TEST(Statistics, ThoseOfAPassAddToTheRenders) {
    Statistics render, pass;
    render.addStage("gather", 1.0, 2.0);
    pass.addStage("gather", 0.25, 0.5);
    pass.addStage("trace", 4.0, 8.0);
    pass.add("rays", 3);
    for (int i = 0; i < 2; ++i) render.add(pass);
    const auto stages = render.stages();
    EXPECT_DOUBLE_EQ(stages.at("gather").wallSeconds, 1.5);
    EXPECT_DOUBLE_EQ(stages.at("gather").cpuSeconds, 3.0);
    EXPECT_EQ(stages.at("gather").runs, 3u);
    EXPECT_DOUBLE_EQ(stages.at("trace").cpuSeconds, 16.0);
    EXPECT_EQ(render.counter("rays"), 6u);
}

/// The number that a file begins with, or what comes after a name in it; -1: none.
double numberIn(const char* file, const std::string& name = "") {
    std::ifstream in(file);
    for (std::string word; !name.empty() && word != name && in >> word;) continue;
    double number = -1.0;
    return in >> number ? number : -1.0;
}

/// Others take and free memory meanwhile, but hardly three quarters of it.
TEST(Memory, AvailableIsWhatTheSystemSaysInBytes) {
    double expected = 1024.0 * numberIn("/proc/meminfo", "MemAvailable:");
    if (expected < 0.0) GTEST_SKIP() << "the system does not say";
    const double most = numberIn("/sys/fs/cgroup/memory.max"), used = numberIn("/sys/fs/cgroup/memory.current");
    if (most >= 0.0 && used >= 0.0) expected = std::min(expected, std::max(most - used, 0.0));
    EXPECT_GT(availableMemoryBytes(), expected / 4.0);
    EXPECT_LT(availableMemoryBytes(), expected * 4.0);
}

/// The second of two ranks, whose messages are looked at and answered by nothing.
class SecondRank : public ProcessGroup {
  public:
    std::vector<Bytes> toFirst;

    [[nodiscard]] int rank() const override { return 1; }
    [[nodiscard]] int size() const override { return 2; }
    [[nodiscard]] int onThisMachine() const override { return 2; }
    [[nodiscard]] std::string machine() const override { return "here"; }
    [[nodiscard]] std::vector<double> allReduceMax(std::vector<double> values) override { return values; }
    [[nodiscard]] std::vector<Bytes> allToAll(const std::vector<Bytes>& parts) override {
        toFirst.push_back(parts.at(0));
        return std::vector<Bytes>(2);
    }
    [[noreturn]] void abort(int exitCode) override { std::_Exit(exitCode); }
};

TEST(DistributedFilm, NonFiniteSamplesAreToldOnce) {
    SecondRank group;
    Film film(4, 4, 1);
    DistributedFilm shared(&group, film);
    const auto told = [&] {
        shared.gather();
        uint64_t count = 99;
        if (group.toFirst.back().size() >= sizeof count) std::memcpy(&count, group.toFirst.back().data(), sizeof count);
        return count;
    };
    film.countNonFinite(5);
    EXPECT_EQ(told(), 5u);
    EXPECT_EQ(told(), 0u);
    film.countNonFinite(2);
    EXPECT_EQ(told(), 2u);
}

} // namespace
} // namespace tungsten
