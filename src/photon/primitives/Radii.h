#pragma once
// Kernel radii of a primitive's records, and where surfaces end their kernels.

#include "photon/primitives/KernelEdge.h"
#include "photon/store/RedirectedSelection.h"

namespace tungsten::photon {

/// One radius per record, or one for all; edges per record, or none at all.
class Radii {
  public:
    Radii() = default;
    Radii(float one) : radii_{one} {}
    Radii(std::vector<float> radii, std::vector<KernelEdges> edges = {})
        : radii_(std::move(radii)), edges_(std::move(edges)) {}

    [[nodiscard]] float operator[](size_t record) const { return radii_[single() ? 0 : record]; }
    [[nodiscard]] bool single() const { return radii_.size() == 1; }
    [[nodiscard]] const std::vector<float>& values() const { return radii_; }
    [[nodiscard]] KernelEdges edges(size_t record) const { return edges_.empty() ? KernelEdges{} : edges_[record]; }
    [[nodiscard]] const std::vector<KernelEdges>& edges() const { return edges_; }

    /// All of them times `factor`.
    void scale(float factor) {
        for (float& radius : radii_) radius *= factor;
    }
    /// Radii of the records that chooseSystematically chooses.
    [[nodiscard]] Radii chosen(double share, float u) const {
        Radii part;
        if (single()) part.radii_ = radii_;
        const size_t records = single() ? edges_.size() : radii_.size();
        chooseSystematically(records, share, u, [&](size_t i) { part.append(*this, i); });
        return part;
    }
    /// Radii of the records of each of `count` interleaved parts.
    [[nodiscard]] std::vector<Radii> partitioned(size_t count) const {
        std::vector<Radii> sets(count);
        const auto radii =
            single() ? std::vector<std::vector<float>>(count, radii_) : photon::partitioned(radii_, count);
        const auto edges = photon::partitioned(edges_, count);
        for (size_t k = 0; k < count; ++k) sets[k] = {radii[k], edges[k]};
        return sets;
    }
    /// Adds what `other` has for a record; one radius for all stays one.
    void append(const Radii& other, size_t record) {
        if (!other.single()) radii_.push_back(other.radii_[record]);
        if (!other.edges_.empty()) edges_.push_back(other.edges_[record]);
    }

  private:
    std::vector<float> radii_;
    std::vector<KernelEdges> edges_;
};

/// Some of a store's records.
template <typename Record>
struct Selection {
    std::vector<Record> records;
    Radii radii;
};

} // namespace tungsten::photon
