// Counters and stages.

#include "tungsten/render/Statistics.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace tungsten
