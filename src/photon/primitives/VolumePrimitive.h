#pragma once
// What volumes store, splat and gather: a closed set, chosen once. Adding a primitive is a folder with a type like
// Points and Beams, its name in the set, and what each walk leaves for it on a flight and at a vertex.

#include "photon/primitives/beams/Beams.h"
#include "photon/primitives/points/Points.h"
#include "photon/primitives/sliced/Slices.h"

#include "tungsten/core/Overloaded.h"

#include <variant>

namespace tungsten::photon {

using VolumePrimitive = std::variant<Points, Beams, Slices>;

namespace detail {

template <template <typename> class Container, typename... Primitives>
std::variant<Container<typename Primitives::Record>...> containerOf(const std::variant<Primitives...>& primitive) {
    return std::visit(
        [](const auto& p) {
            using Record = typename std::decay_t<decltype(p)>::Record;
            return std::variant<Container<typename Primitives::Record>...>(Container<Record>{});
        },
        primitive);
}

} // namespace detail

/// Deposits of consecutive paths, and a pass's store of them.
using VolumeDeposits = decltype(detail::containerOf<DepositList>(VolumePrimitive{}));
using VolumeStore = decltype(detail::containerOf<Store>(VolumePrimitive{}));

inline VolumeDeposits depositsOf(const VolumePrimitive& primitive) {
    return detail::containerOf<DepositList>(primitive);
}
inline VolumeStore storeOf(const VolumePrimitive& primitive) {
    return detail::containerOf<Store>(primitive);
}

/// Calls use(p) for a value of every primitive.
template <typename Use, typename... Primitives>
void forEachPrimitive(const std::variant<Primitives...>&, Use&& use) {
    (use(Primitives{}), ...);
}

/// What volume_photon_type calls a primitive.
struct NamedPrimitive {
    const char* type;
    VolumePrimitive primitive;
};
template <typename Primitive>
std::vector<NamedPrimitive> named(const Primitive& primitive) {
    return {{Primitive::Type, primitive}};
}
inline std::vector<NamedPrimitive> named(const Slices&) {
    std::vector<NamedPrimitive> kinds;
    for (const SliceName& name : SliceNames) kinds.push_back({name.type, Slices{name.kind, {}}});
    return kinds;
}

} // namespace tungsten::photon
