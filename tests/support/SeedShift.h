#pragma once
// Other random numbers for renders of tests: of a whole program without a change of code, or of one test.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace tungsten::test {

/// Other seeds for the renders of a scope: for tests whose guards against noise happen to fail with the first ones.
class OtherSeeds {
  public:
    explicit OtherSeeds(uint64_t which) { inUse_ = which; }
    /// Of a test with parameters, by what its name ends with; those that are not listed keep the first seeds.
    OtherSeeds(std::initializer_list<std::pair<std::string_view, uint64_t>> which) {
        const std::string_view name = testing::UnitTest::GetInstance()->current_test_info()->name();
        for (const auto& [ending, seeds] : which)
            if (name.ends_with(ending)) inUse_ = seeds;
    }
    ~OtherSeeds() { inUse_ = 0; }
    OtherSeeds(const OtherSeeds&) = delete;
    OtherSeeds& operator=(const OtherSeeds&) = delete;

    [[nodiscard]] static uint64_t inUse() { return inUse_; }

  private:
    static inline uint64_t inUse_ = 0;
};

/// What is added to the seeds of renders: by OtherSeeds, and from the environment variable TUNGSTEN_TEST_SEED, 0
/// without it. A test whose bound is right fails under other seeds as rarely as its bound says.
inline uint64_t seedShift() {
    constexpr uint64_t Apart = 1000003; // tests use small seeds, neighbouring ones for passes that must differ
    static const char* const text = std::getenv("TUNGSTEN_TEST_SEED");
    static const uint64_t ofProgram = text ? std::strtoull(text, nullptr, 10) : 0;
    return (ofProgram + OtherSeeds::inUse()) * Apart;
}

} // namespace tungsten::test
