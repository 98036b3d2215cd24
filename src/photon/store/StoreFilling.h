#pragma once
// Whole light paths into a store of limited room.

#include "photon/store/RedirectedSelection.h"
#include "photon/store/Store.h"

#include "tungsten/core/Random.h"

namespace tungsten::photon {

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
