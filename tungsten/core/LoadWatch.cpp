#include "tungsten/core/LoadWatch.h"

#include <atomic>
#include <exception>
#include <utility>

namespace tungsten {

using Clock = std::chrono::steady_clock;

struct LoadWatch::State {
    State(std::function<void()> calls, std::chrono::milliseconds every) : look(std::move(calls)), between(every) {}

    std::function<void()> look;
    std::chrono::milliseconds between;
    std::thread::id thread = std::this_thread::get_id();
    Clock::time_point last = Clock::now();
    std::atomic<bool> failed{false};
    std::exception_ptr failure{}; ///< if failed
};

LoadWatch::LoadWatch(std::function<void()> look, std::chrono::milliseconds between)
    : state_(std::make_shared<State>(std::move(look), between)) {}

LoadWatch LoadWatch::telling(Reading reading) const {
    LoadWatch other = *this;
    other.reading_ = std::make_shared<const Reading>(std::move(reading));
    return other;
}

bool LoadWatch::goesOn() const noexcept {
    if (!state_ || state_->failed) return !state_;
    if (std::this_thread::get_id() != state_->thread) return true;
    const auto now = Clock::now();
    if (now - state_->last < state_->between) return true;
    state_->last = now;
    try {
        state_->look();
    } catch (...) {
        state_->failure = std::current_exception();
        state_->failed = true;
    }
    return !state_->failed;
}

void LoadWatch::poll() const {
    if (!goesOn()) std::rethrow_exception(state_->failure);
}

} // namespace tungsten
