#pragma once
// Points that light has reached, a few of which at once are candidates for arrival at a place within a range of
// lengths.

#include "path/Tuning.h"

#include "transport/GateBounds.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace tungsten::path {

class ArrivalWindow {
  public:
    /// Candidates of a vertex: neighbours in the list from a random place on.
    static constexpr size_t Size = tuning::Candidates;

    struct Choice {
        size_t index = 0;
        float inverseProbability = 0.0f; ///< of its choice among the candidates
    };

    /// `point(i)` is the pair of the i-th of `count` points and light's length so far.
    template <typename Point>
    void fill(size_t count, const Point& point);
    /// A candidate whose light, going on straight to `position`, arrives there after a length in [low, high), in
    /// proportion to `importance(index, unit direction from there, distance)`; none if all of these are 0.
    template <typename Importance>
    [[nodiscard]] std::optional<Choice> choose(const Vec3f& position, float low, float high, const Vec2f& u,
                                               const Importance& importance) const;

  private:
    size_t count_ = 0;
    std::vector<float> x_, y_, z_, length_; ///< the first Size - 1 follow again at the end
};

template <typename Point>
void ArrivalWindow::fill(size_t count, const Point& point) {
    count_ = count;
    for (auto* list : {&x_, &y_, &z_, &length_}) list->clear();
    for (size_t i = 0; count > 0 && i + 1 < count + Size; ++i) {
        const auto [position, length] = point(i % count);
        x_.push_back(position.x);
        y_.push_back(position.y);
        z_.push_back(position.z);
        length_.push_back(length);
    }
}

template <typename Importance>
auto ArrivalWindow::choose(const Vec3f& position, float low, float high, const Vec2f& u,
                           const Importance& importance) const -> std::optional<Choice> {
    if (count_ == 0) return std::nullopt;
    const size_t first = std::min(size_t(u.x * float(count_)), count_ - 1);
    const float *x = &x_[first], *y = &y_[first], *z = &z_[first], *length = &length_[first];
    constexpr auto Slack = float(transport::FlightSlack);
    const float from = low - Slack * std::abs(low), to = high + Slack * std::abs(high);
    std::array<float, Size> squared, importances;
    std::array<uint32_t, Size> inside, candidates;
    for (size_t i = 0; i < Size; ++i) { // in full registers
        squared[i] = sqr(x[i] - position.x) + sqr(y[i] - position.y) + sqr(z[i] - position.z);
        const float total = std::sqrt(squared[i]) + length[i];
        inside[i] = uint32_t(total >= from) & uint32_t(total < to);
    }
    size_t number = 0;
    float sum = 0.0f;
    for (uint32_t i = 0; i < Size; ++i) {
        if (inside[i] == 0) continue;
        const float distance = std::sqrt(squared[i]);
        if (!(distance > 0.0f)) continue; // no direction leads there
        const Vec3f offset(position.x - x[i], position.y - y[i], position.z - z[i]);
        const float value = importance((first + i) % count_, offset / distance, distance);
        if (!(value > 0.0f)) continue;
        candidates[number] = i;
        importances[number++] = value;
        sum += value;
    }
    if (!(sum > 0.0f) || !std::isfinite(sum)) return std::nullopt;
    float rest = u.y * sum;
    size_t chosen = 0;
    for (; chosen + 1 < number; ++chosen) {
        rest -= importances[chosen];
        if (rest < 0.0f) break;
    }
    return Choice{(first + candidates[chosen]) % count_, sum / importances[chosen]};
}

} // namespace tungsten::path
