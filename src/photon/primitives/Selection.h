#pragma once
// Records of a store, the radii of their kernels, and where surfaces end these. Behind mirrors, refraction and glossy
// surfaces camera rays gather a random part of the photons or beams, as many as a ray needs, when straight rays have
// theirs splatted: thousands on each ray took most of the time.

#include "photon/Tuning.h"
#include "photon/store/Store.h"

#include "tungsten/core/Types.h"

#include <cmath>
#include <vector>

namespace tungsten::photon {

/// The side of a plane that a kernel keeps to: points x with normal . (x - y) < reach, y the record's position.
struct KernelEdge {
    Vec3f normal{0.0f};     ///< unit, away from the side that is kept
    float reach = Infinity; ///< of the plane along the normal, below 0 where the record lies beyond it

    /// False where no surface is near.
    [[nodiscard]] bool exists() const { return reach < Infinity; }
    /// Whether it holds y + offset.
    [[nodiscard]] bool holds(const Vec3f& offset) const { return normal.dot(offset) < reach; }
};

/// Edges at the nearest surface, and at one that is as near on the other side.
struct KernelEdges {
    KernelEdge nearest, opposite;
};

/// Estimates how many records a random line through their bounding box meets: mean projected area over a quarter of the
/// box's surface (Cauchy).
class ExpectedHits {
  public:
    /// A record reaches so far about this point.
    void include(const Vec3f& point, float radius) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = std::min(low_[axis], point[axis] - radius);
            high_[axis] = std::max(high_[axis], point[axis] + radius);
        }
    }
    /// Adds the projected area of a disc or ribbon, averaged over directions.
    void addArea(double area) { area_ += area; }
    /// The part of the records of which such a line meets tuning::RedirectedHits, at most 1.
    [[nodiscard]] double share() const {
        // Area of the box about everything seen from far away, averaged over directions: a quarter of its surface.
        const Vec3f size = high_ - low_;
        const double shadow =
            0.5 * (double(size.x) * double(size.y) + double(size.y) * double(size.z) + double(size.z) * double(size.x));
        const double met = area_ / shadow;
        return met > tuning::RedirectedHits && std::isfinite(met) ? tuning::RedirectedHits / met : 1.0;
    }

  private:
    Vec3f low_{Infinity}, high_{-Infinity};
    double area_ = 0.0;
};

/// Copies of the elements that chooseSystematically chooses, whose power makes up for the others.
template <typename Element>
std::vector<Element> systematicSubset(const std::vector<Element>& elements, double share, float u) {
    std::vector<Element> chosen;
    chosen.reserve(size_t(double(elements.size()) * share) + 1);
    chooseSystematically(elements.size(), share, u, [&](size_t i) {
        chosen.push_back(elements[i]);
        chosen.back().power = elements[i].power * float(1.0 / share);
    });
    return chosen;
}

/// Distributes elements into `count` parts, one after the other.
template <typename Element>
std::vector<std::vector<Element>> partitioned(const std::vector<Element>& elements, size_t count) {
    std::vector<std::vector<Element>> parts(count);
    for (size_t k = 0; k < count; ++k) {
        parts[k].reserve(elements.size() / count + 1);
        for (size_t i = k; i < elements.size(); i += count) parts[k].push_back(elements[i]);
    }
    return parts;
}

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
