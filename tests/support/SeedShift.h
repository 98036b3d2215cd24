#pragma once
// Other random numbers for all renders of a test program, without a change of code.

#include <cstdint>
#include <cstdlib>

namespace tungsten::test {

/// What is added to the seeds of renders: from the environment variable TUNGSTEN_TEST_SEED, 0 without it. A test whose
/// bound is right fails under other seeds as rarely as its bound says.
inline uint64_t seedShift() {
    constexpr uint64_t Apart = 1000003; // tests use small seeds, neighbouring ones for passes that must differ
    static const char* const text = std::getenv("TUNGSTEN_TEST_SEED");
    static const uint64_t shift = text ? std::strtoull(text, nullptr, 10) * Apart : 0;
    return shift;
}

} // namespace tungsten::test
