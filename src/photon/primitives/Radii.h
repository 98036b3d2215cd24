#pragma once
// Kernel radii of a primitive's records.

#include "photon/store/FoldedSelection.h"

namespace tungsten::photon {

/// One radius per record, or one for all.
class Radii {
  public:
    Radii() = default;
    Radii(float one) : radii_{one} {}
    Radii(std::vector<float> radii) : radii_(std::move(radii)) {}

    [[nodiscard]] float operator[](size_t record) const { return radii_[single() ? 0 : record]; }
    [[nodiscard]] bool single() const { return radii_.size() == 1; }
    [[nodiscard]] const std::vector<float>& values() const { return radii_; }

    /// All of them times `factor`.
    void scale(float factor) {
        for (float& radius : radii_) radius *= factor;
    }
    /// Of the records that chooseEvenly chooses.
    [[nodiscard]] Radii chosen(double share, float u) const {
        if (single()) return radii_.front();
        Radii part;
        chooseEvenly(radii_.size(), share, u, [&](size_t i) { part.radii_.push_back(radii_[i]); });
        return part;
    }
    /// Of the records dealt into `count` hands.
    [[nodiscard]] std::vector<Radii> dealt(size_t count) const {
        if (single()) return std::vector<Radii>(count, *this);
        const auto hands = photon::dealt(radii_, count);
        return {hands.begin(), hands.end()};
    }

  private:
    std::vector<float> radii_;
};

/// Some of a store's records.
template <typename Record>
struct Selection {
    std::vector<Record> records;
    Radii radii;
};

} // namespace tungsten::photon
