#pragma once
// Which photons and beams camera rays gather behind mirrors, refraction and glossy surfaces, when straight rays have
// theirs splatted: a random part, as many as a ray needs. Thousands on each ray took most of the time.

#include "tungsten/core/Types.h"

#include <vector>

namespace tungsten::photon {

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
    [[nodiscard]] double share() const;

  private:
    Vec3f low_{Infinity}, high_{-Infinity};
    double area_ = 0.0;
};

/// Calls keep(i) for elements i of `count`, evenly in their order and each with the probability `share`; u in [0, 1)
/// chooses which.
template <typename Keep>
void chooseSystematically(size_t count, double share, float u, const Keep& keep) {
    double sum = double(u);
    for (size_t i = 0; i < count; ++i) {
        sum += share;
        if (sum < 1.0) continue;
        sum -= 1.0;
        keep(i);
    }
}

/// Copies of the elements so chosen, whose power makes up for the others.
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

} // namespace tungsten::photon
