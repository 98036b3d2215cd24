#pragma once
// Ends of light paths of one emitter, a few of which at once are candidates for arrival at a place within a range of
// lengths.

#include "path/Tuning.h"

#include "transport/GateBounds.h"

#include "tungsten/integrator/Integrator.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace tungsten::path {

/// An `End` has a position() and light's length() so far.
template <typename End>
class ArrivalCandidates {
  public:
    /// Candidates of a vertex: neighbours in the list from a random place on.
    static constexpr size_t Size = tuning::Candidates;

    struct CandidateSample {
        const End* vertex = nullptr;
        float weight = 0.0f; ///< 1 / (probability x number of light paths)
    };

    /// What `trace(index of the path, ends)` appends for each of so many light paths, in their order.
    template <typename Trace>
    void fill(size_t paths, const char* stage, const ProgressToken& watch, const Trace& trace);
    /// A candidate whose light, going on straight to `position`, arrives there after a length in [low, high), in
    /// proportion to `importance(end, unit direction from there, distance)`; none if all of these are 0. Of more than
    /// `most` that arrive so many, evenly spaced, stand for all.
    template <typename Importance>
    [[nodiscard]] CandidateSample choose(const Vec3f& position, float low, float high, const Vec2f& u,
                                         const Importance& importance, size_t most = Size) const;
    [[nodiscard]] const std::vector<End>& ends() const { return ends_; }

  private:
    /// Keeps at most `most` of the candidates inside, every one with the same probability; `u` is uniform.
    struct Thinned {
        float each = 1.0f; ///< that one stands for
        Thinned(std::array<uint32_t, Size>& inside, size_t most, float u) {
            if (most >= Size) return;
            const uint32_t all = std::accumulate(inside.begin(), inside.end(), 0u);
            if (all <= most) return;
            each = float(all) / float(most);
            float next = u * each; // the place among those inside of the next to keep
            for (uint32_t i = 0, place = 0; i < Size; ++i) {
                if (inside[i] == 0) continue;
                inside[i] = uint32_t(float(place++) + 1.0f > next);
                if (inside[i] != 0) next += each;
            }
        }
    };

    size_t paths_ = 0;
    std::vector<End> ends_;
    std::vector<float> x_, y_, z_, length_; ///< the first Size - 1 follow again at the end
};

template <typename End>
template <typename Trace>
void ArrivalCandidates<End>::fill(size_t paths, const char* stage, const ProgressToken& watch, const Trace& trace) {
    constexpr size_t Block = 1024;
    std::vector<std::vector<End>> found((paths + Block - 1) / Block);
    watch.stage(stage, found.size());
    tbb::parallel_for(size_t(0), found.size(), [&](size_t block) {
        watch.advance();
        for (size_t i = block * Block; i < std::min(paths, (block + 1) * Block); ++i) trace(i, found[block]);
    });
    paths_ = paths;
    ends_.clear();
    for (const auto& block : found) ends_.insert(ends_.end(), block.begin(), block.end());
    for (auto* list : {&x_, &y_, &z_, &length_}) list->clear();
    for (size_t i = 0; !ends_.empty() && i + 1 < ends_.size() + Size; ++i) {
        const End& end = ends_[i % ends_.size()];
        const Vec3f position = end.position();
        x_.push_back(position.x);
        y_.push_back(position.y);
        z_.push_back(position.z);
        length_.push_back(end.length());
    }
}

template <typename End>
template <typename Importance>
auto ArrivalCandidates<End>::choose(const Vec3f& position, float low, float high, const Vec2f& u,
                                    const Importance& importance, size_t most) const -> CandidateSample {
    const size_t count = ends_.size();
    if (count == 0) return {};
    const size_t first = std::min(size_t(u.x * float(count)), count - 1);
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
    const Thinned thinned(inside, most, u.x * float(count) - float(first));
    size_t number = 0;
    float sum = 0.0f;
    for (uint32_t i = 0; i < Size; ++i) {
        if (inside[i] == 0) continue;
        const float distance = std::sqrt(squared[i]);
        if (!(distance > 0.0f)) continue; // no direction leads there
        const Vec3f offset(position.x - x[i], position.y - y[i], position.z - z[i]);
        const float value = importance(ends_[(first + i) % count], offset / distance, distance);
        if (!(value > 0.0f)) continue;
        candidates[number] = i;
        importances[number++] = value;
        sum += value;
    }
    if (!(sum > 0.0f) || !std::isfinite(sum)) return {};
    float rest = u.y * sum;
    size_t chosen = 0;
    for (; chosen + 1 < number; ++chosen) {
        rest -= importances[chosen];
        if (rest < 0.0f) break;
    }
    const float each = float(count) * thinned.each / (float(paths_) * float(Size));
    return {&ends_[(first + candidates[chosen]) % count], each * (sum / importances[chosen])};
}

} // namespace tungsten::path
