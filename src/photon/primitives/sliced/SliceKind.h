#pragma once
// Which primitive makes which paths, by the chain index m: medium scatterings since the last surface or light, the one
// on the camera ray included (docs/photon-primitives.md, section 3).

#include "photon/primitives/sliced/SliceRecord.h"

namespace tungsten::photon {

enum class SliceKind { Planes, Volumes, Balls, VolumesBalls, MisVolumesBalls, Hypervolumes };

struct SliceName {
    const char* type; ///< of volume_photon_type
    SliceKind kind;
    bool steadyState; ///< also without a time gate
};
inline constexpr std::array SliceNames{SliceName{"planes", SliceKind::Planes, true},
                                       SliceName{"volumes", SliceKind::Volumes, true},
                                       SliceName{"balls", SliceKind::Balls, false},
                                       SliceName{"volumes_balls", SliceKind::VolumesBalls, false},
                                       SliceName{"mis_volumes_balls", SliceKind::MisVolumesBalls, false},
                                       SliceName{"hypervolumes", SliceKind::Hypervolumes, false}};

constexpr const SliceName& sliceName(SliceKind kind) {
    return SliceNames[size_t(kind)];
}

/// Every class m has one shape, but for those that balls and volumes share.
struct SliceClasses {
    enum class Bases : uint8_t { None, First, All };

    bool lights = false; ///< m = 1: balls on lights that shine in more than one direction
    bool beams = false;  ///< m = 1 after a surface or a laser: photon beams
    /// Which chain indices the records of k = 2 to 4 flights make: None, First: m = k, All: m >= k.
    std::array<Bases, 5> flights{};
    int firstBall = 0, lastBall = -1; ///< medium vertices of the chain with a ball: m = vertex + 1
    float share = 1.0f;        ///< of what is not a beam that is left, at random; its power makes up for the rest
    float sharedShare = 1.0f;  ///< likewise, of paths that balls and volumes both make
    bool shared = false;       ///< m >= 3: balls and volumes together
    bool shortFlights = false; ///< flights end at random lengths
    /// Last flights of what single balls make at a delta gate: beams up to this length, balls beyond it; after surfaces
    /// that scatter evenly too. 0: balls alone, and beams alone after surfaces.
    float shortBeams = 0.0f;

    [[nodiscard]] float shareOf(const SliceRecord& record) const { return record.shared ? sharedShare : share; }
    /// A vertex of a chain has a ball that volumes do not share.
    [[nodiscard]] bool hasSingleBall(int vertex) const {
        return vertex >= firstBall && vertex <= lastBall && !(shared && vertex >= 2);
    }
    /// `lowOrders`: with m = 1. `onlyShared`: m >= 3 alone, which balls and volumes both make.
    static SliceClasses of(SliceKind kind, bool steadyState, bool lowOrders, bool onlyShared);
};

} // namespace tungsten::photon
