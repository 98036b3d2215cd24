// Stores of limited room: what paths bring on average, whatever they leave and however little fits.

#include "photon/store/Store.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

struct RoomCase {
    const char* name;
    uint64_t capacity;
    /// Deposits of a path, drawn by u.
    uint32_t (*deposits)(float u);
};
class StoreFilling : public testing::TestWithParam<RoomCase> {};

/// Every deposit has the power 1 + the size of its path, so that a preference for small or large paths would show.
TEST_P(StoreFilling, LeavesEveryPathsShare) {
    const RoomCase& c = GetParam();
    constexpr int Fillings = 20000, Paths = 30;
    double sum = 0.0, squares = 0.0, expected = 0.0;
    uint64_t largest = 0, full = 0;
    for (int filling = 0; filling < Fillings; ++filling) {
        Sampler sampler(1, RandomStream::Test, uint32_t(filling), 0);
        std::vector<Photon> deposits;
        std::vector<uint32_t> ends;
        for (int path = 0; path < Paths; ++path) {
            const uint32_t count = c.deposits(sampler.next1D());
            for (uint32_t i = 0; i < count; ++i) deposits.push_back({0.0, {}, {}, Rgb(1.0f + float(count)), 1, 0});
            ends.push_back(uint32_t(deposits.size()));
            expected += double(count) * (1.0 + double(count)) / (double(Fillings) * Paths);
        }
        Store<Photon> store;
        Sampler thinning(1, RandomStream::Test, uint32_t(filling), 1);
        appendPaths(store, {deposits, ends}, c.capacity, thinning);
        double power = 0.0;
        for (const Photon& photon : store.records) power += double(photon.power.x) * double(store.scale());
        sum += power / Fillings;
        squares += power * power / Fillings;
        largest = std::max<uint64_t>(largest, store.records.size());
        full += store.full ? 1 : 0;
    }
    EXPECT_LE(largest, c.capacity);
    EXPECT_GT(full, uint64_t(Fillings / 10));
    const double error = std::sqrt((squares - sum * sum) / Fillings);
    EXPECT_NEAR(sum, expected, 5.0 * error);
    EXPECT_LT(error, 0.02 * expected);
}

INSTANTIATE_TEST_SUITE_P(Rooms, StoreFilling,
                         testing::Values(RoomCase{"ForManyPaths", 100, [](float u) { return uint32_t(8.0f * u); }},
                                         RoomCase{"ForAFewPaths", 12, [](float u) { return uint32_t(8.0f * u); }},
                                         RoomCase{"ForMostPaths", 30, [](float u) { return u < 0.1f ? 29u : 1u; }},
                                         RoomCase{"ForLessThanAPath", 5, [](float u) { return u < 0.3f ? 40u : 0u; }},
                                         RoomCase{"ForOne", 1, [](float u) { return uint32_t(3.0f * u); }},
                                         RoomCase{"ForSomePasses", 110, [](float u) { return uint32_t(8.0f * u); }}),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace tungsten::photon
