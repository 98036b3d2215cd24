#pragma once
// Visiting a closed set: one function per alternative, and one that is forgotten does not compile.

namespace tungsten {

template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

} // namespace tungsten
