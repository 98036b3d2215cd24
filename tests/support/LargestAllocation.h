#pragma once
// Replaces operator new to remember the largest block asked for. Include in one file of a test executable only.
// Sanitizer builds keep their own operators; there the record stays 0.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace tungsten::test {

inline std::atomic<size_t> largestAllocation{0};

} // namespace tungsten::test

#ifndef __SANITIZE_ADDRESS__
[[gnu::noinline]] void* operator new(std::size_t size) {
    size_t seen = tungsten::test::largestAllocation;
    while (size > seen && !tungsten::test::largestAllocation.compare_exchange_weak(seen, size)) {
    }
    if (void* block = std::malloc(std::max<size_t>(size, 1))) return block;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* block) noexcept {
    std::free(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
    std::free(block);
}
#endif
