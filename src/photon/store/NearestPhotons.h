#pragma once
// The nearest photons about a point, by Embree point queries over the photons' own structure.

#include "photon/store/EmbreeScene.h"
#include "photon/store/Store.h"

#include <optional>

namespace tungsten::photon {

class NearestPhotons {
  public:
    /// `photons` must stay alive.
    explicit NearestPhotons(const std::vector<Photon>& photons);

    struct Neighbour {
        float squaredDistance;
        uint32_t index;
        /// Neighbours are ordered by distance, ties by index: the choice of the k nearest is unique.
        friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
    };
    /// The at most `count` nearest photons within `radius` (inclusive), sorted by index so that sums have one order.
    /// `found` is reused. Returns the squared distance of the farthest when `count` were found, else radius squared.
    float find(const Vec3f& position, float radius, uint32_t count, std::vector<Neighbour>& found) const;

  private:
    const std::vector<Photon>& photons_;
    std::optional<EmbreeScene> points_; ///< none without photons
};

} // namespace tungsten::photon
