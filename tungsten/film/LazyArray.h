#pragma once
// Arrays of zeros that take memory only where something is written: the system gives pages of zeros on first use.

#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace tungsten {

/// Elements made without a value are the zeros that the memory comes with.
template <typename T>
struct ZeroedMemory {
    using value_type = T;

    ZeroedMemory() = default;
    template <typename U>
    ZeroedMemory(const ZeroedMemory<U>&) {}

    [[nodiscard]] T* allocate(size_t n) {
        if (void* memory = std::calloc(n, sizeof(T))) return static_cast<T*>(memory);
        throw std::bad_alloc();
    }
    void deallocate(T* memory, size_t) { std::free(memory); }
    template <typename U, typename... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) > 0)
            ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
    bool operator==(const ZeroedMemory&) const { return true; }
};

using LazyArray = std::vector<float, ZeroedMemory<float>>;

} // namespace tungsten
