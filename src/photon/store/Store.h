#pragma once
// What light paths leave, how many of them it stands for, and whole light paths into a store of limited room.

#include "tungsten/core/Random.h"
#include "tungsten/core/Types.h"

#include <cstdint>
#include <vector>

namespace tungsten::photon {

/// A photon deposited in a medium (power after the collision, albedo included) or on a surface.
struct Photon {
    double time; ///< since the clock's zero: emission time plus time of flight
    Vec3f position;
    Vec3f direction; ///< of propagation, before the deposit
    Rgb power;       ///< of one path; the store's `scale` still divides it by the number of paths
    uint16_t bounce; ///< interactions from the light up to and including this one
    int16_t medium;  ///< index of the medium (volume photons), -1 on surfaces
};
static_assert(sizeof(Photon) == 48, "millions are stored: no padding");
/// Longest light path that a photon's bounce can tell.
inline constexpr int MostPhotonBounces = 65535;

/// Records of consecutive paths; pathEnds[i] is where path i's end.
template <typename R>
struct DepositList {
    using Record = R;
    std::vector<R> records;
    std::vector<uint32_t> pathEnds;
    void endPath() { pathEnds.push_back(uint32_t(records.size())); }
};

/// Records of one pass in path order, so the content does not depend on the number of threads. A store takes whole
/// paths: it is full when the next path no longer fits (appendPaths).
template <typename R>
struct Store {
    using Record = R;
    std::vector<R> records;
    uint64_t paths = 0; ///< light paths that the content stands for
    bool full = false;

    [[nodiscard]] float scale() const { return paths > 0 ? float(1.0 / double(paths)) : 0.0f; }
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

/// Appends the deposits of consecutive paths until one does not fit, which is neither kept nor counted.
///
/// The path that does not fit is larger than others, but what is kept is not smaller for it: of all orders in which the
/// paths up to it might have come, those that stop with it end with each path without which the rest fits equally
/// often, so that every path brings on average what it does in a store without limits. That needs a path to be kept:
/// one that alone is too much for the room is thinned to it, by `sampler`.
template <typename Record>
void appendPaths(Store<Record>& store, const DepositList<Record>& deposits, uint64_t capacity, Sampler& sampler) {
    std::vector<Record>& records = store.records;
    auto start = deposits.records.begin();
    for (const uint32_t pathEnd : deposits.pathEnds) {
        if (store.full) return;
        const auto end = deposits.records.begin() + ptrdiff_t(pathEnd);
        const auto count = uint64_t(end - start);
        if (records.size() + std::min(count, capacity) > capacity) {
            store.full = true;
        } else {
            if (count > capacity) {
                const double share = double(capacity) / double(count);
                auto thinned = systematicSubset(std::vector<Record>(start, end), share, sampler.next1D());
                thinned.resize(std::min<size_t>(thinned.size(), capacity)); // rounding
                records.insert(records.end(), thinned.begin(), thinned.end());
            } else {
                records.insert(records.end(), start, end);
            }
            ++store.paths;
        }
        start = end;
    }
}

} // namespace tungsten::photon
