#pragma once
// Which light paths are rendered, by what happens on them.

#include "tungsten/scene/Scene.h"

namespace tungsten::transport {

/// An interaction is a scattering in a medium or a surface met, index-matched ones included.
struct BounceLimits {
    int minBounces = 0, maxBounces = 64;
    bool includeSurfaces = true;    ///< false: nothing of paths without a scattering in a medium
    bool lowOrderScattering = true; ///< false: nothing of paths with a single one, see orderCounts()

    BounceLimits() = default;
    explicit BounceLimits(const TransportSettings& transport)
        : minBounces(transport.minBounces), maxBounces(transport.maxBounces) {}

    /// Whether whole paths, from light to sensor, with so many interactions are rendered.
    [[nodiscard]] bool renders(int interactions) const {
        return interactions >= minBounces && interactions < maxBounces;
    }
    /// How many more interactions make a whole path out of one that has so many.
    struct Remaining {
        int least, most;
    };
    [[nodiscard]] Remaining remaining(int interactions) const {
        return {minBounces - interactions, maxBounces - 1 - interactions};
    }
    /// Walks go on if what they may find next has so many interactions, with them, that it may count.
    [[nodiscard]] bool mayGoOn(int interactions) const { return interactions < maxBounces; }
    /// Counts a flight in a scattering medium: false if it is one too many since the last surface.
    [[nodiscard]] static bool fly(int& flights, const Medium& medium) { return ++flights <= medium.maxBounces; }
    /// Whether a path with so many scatterings in media counts, of which the last `inARow`, seen from the light, have
    /// no surface between them. Without low orders one that is alone there does not count, whatever comes before it:
    /// the format ends camera paths that meet a surface after their first scattering in a medium.
    [[nodiscard]] bool orderCounts(int mediumScatters, int inARow) const {
        if (mediumScatters == 0) return includeSurfaces;
        return lowOrderScattering || inARow > 1;
    }
    /// Whether a camera path with so many scatterings counts: endsAtSurface() has ended those with a surface between
    /// them.
    [[nodiscard]] bool orderCounts(int mediumScatters) const { return orderCounts(mediumScatters, mediumScatters); }
    /// A camera path ends at a surface, index-matched ones included, after so many scatterings in media.
    [[nodiscard]] bool endsAtSurface(int mediumScatters) const { return mediumScatters == 1 && !lowOrderScattering; }
};

} // namespace tungsten::transport
