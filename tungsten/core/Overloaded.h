#pragma once
// Visiting a closed set: one function per alternative, and one that is forgotten does not compile.

#include <concepts>

namespace tungsten {

template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// Alternatives that give the same answer, each by its name: `[](const OneOf<Sphere, Disk> auto&) { ... }`. What joins
/// the set later is none of them.
template <typename Model, typename... Models>
concept OneOf = (std::same_as<Model, Models> || ...);

} // namespace tungsten
