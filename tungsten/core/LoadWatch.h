#pragma once
// Scenes that take long to load: whoever waits for one is asked, on the way, whether to go on, and told what is read.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <thread>

namespace tungsten {

/// Copies share what they call. One thread loads: the one that made this.
class LoadWatch {
  public:
    /// Nobody waits.
    LoadWatch() = default;
    /// `look` is called once every `between`, as long as work goes on; what it throws ends the loading.
    explicit LoadWatch(std::function<void()> look, std::chrono::milliseconds between = std::chrono::milliseconds(50));

    /// Costs a look at a clock.
    void poll() const;
    /// In a loop over what takes about a microsecond each.
    void pollEvery(size_t index) const {
        constexpr size_t Span = 1024;
        if (state_ && index % Span == 0) poll();
    }
    /// The same where nothing may be thrown, from any thread: false once the loading is to end, which the next poll()
    /// then does.
    [[nodiscard]] bool goesOn() const noexcept;

    using Reading = std::function<void(const std::filesystem::path& file, std::string_view bytes)>;
    /// The same, which also tells of every file that is read for the scene.
    [[nodiscard]] LoadWatch telling(Reading reading) const;
    /// By whoever reads one.
    void read(const std::filesystem::path& file, std::string_view bytes) const {
        if (reading_) (*reading_)(file, bytes);
    }

  private:
    struct State;
    std::shared_ptr<State> state_;
    std::shared_ptr<const Reading> reading_;
};

} // namespace tungsten
