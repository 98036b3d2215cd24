#pragma once
// Arrays of zeros, and blocks of floats, that take memory only where something is written: the system gives pages of
// zeros on first use.

#include <algorithm>
#include <atomic>
#include <cstdint>
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

/// As many tiles as places at most, each of so many floats. They lie side by side in the order in which they were made,
/// so that memory goes by tiles that are there, not by pages of the system that hold one.
class LazyTiles {
  public:
    LazyTiles() = default;
    LazyTiles(size_t places, size_t floats) : floats_(floats), numbers_(places), values_(places * floats) {}
    LazyTiles(LazyTiles&&) = default;
    LazyTiles& operator=(LazyTiles&&) = default;
    ~LazyTiles() = default;
    /// Copies what is there.
    LazyTiles(const LazyTiles& other) : LazyTiles(other.numbers_.size(), other.floats_) {
        numbers_ = other.numbers_;
        count_ = other.count_;
        std::copy_n(other.values_.begin(), ptrdiff_t(count_ * floats_), values_.begin());
    }
    LazyTiles& operator=(const LazyTiles& other) { return *this = LazyTiles(other); }

    /// Null where there is none.
    [[nodiscard]] const float* find(size_t place) const {
        const uint32_t number = numbers_[place];
        return number == None ? nullptr : values_.data() + size_t(number - First) * floats_;
    }
    [[nodiscard]] float* find(size_t place) { return const_cast<float*>(std::as_const(*this).find(place)); }
    /// Of zeros, where it is new. Threads may ask at once.
    [[nodiscard]] float* make(size_t place) {
        uint32_t number = std::atomic_ref<uint32_t>(numbers_[place]).load(std::memory_order_relaxed);
        if (number < First) number = makeNew(numbers_[place]);
        return values_.data() + size_t(number - First) * floats_;
    }
    [[nodiscard]] size_t count() const { return count_; }
    [[nodiscard]] size_t bytes() const { return count_ * floats_ * sizeof(float) + numbers_.size() * sizeof(uint32_t); }

  private:
    static constexpr uint32_t None = 0, Coming = 1, First = 2;

    [[nodiscard]] uint32_t makeNew(uint32_t& place) {
        const std::atomic_ref<uint32_t> number(place);
        uint32_t found = None;
        if (number.compare_exchange_strong(found, Coming, std::memory_order_relaxed)) {
            found = std::atomic_ref<uint32_t>(count_).fetch_add(1, std::memory_order_relaxed) + First;
            number.store(found, std::memory_order_relaxed);
        }
        while (found == Coming) found = number.load(std::memory_order_relaxed);
        return found;
    }

    size_t floats_ = 0;
    uint32_t count_ = 0;
    std::vector<uint32_t, ZeroedMemory<uint32_t>> numbers_; ///< by place
    LazyArray values_;
};

} // namespace tungsten
