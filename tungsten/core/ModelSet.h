#pragma once
// Closed sets: the models of one kind, each of which names itself and reads itself.

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tungsten {

/// Its kind passes every model through an alias that demands the kind's concept (`CheckedBsdf<Lambert>`): a constraint
/// of the pack itself would name neither model nor member where one is missing.
template <typename... Models>
struct ModelSet {
    using Variant = std::variant<Models...>;
    template <typename Another>
    using With = std::variant<Models..., Another>;

    /// What scene files call them, in the order of the set.
    static std::vector<std::string> names() { return {Models::Type...}; }
    /// The same in the order of the alphabet.
    static std::vector<std::string> types() {
        std::vector<std::string> sorted = names();
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }
    static bool has(const std::string& type) { return ((type == Models::Type) || ...); }
    /// Calls `use.operator()<Model>()` for the model of that type, which the set has.
    template <typename Use>
    static void with(const std::string& type, const Use& use) {
        ((type == Models::Type && (use.template operator()<Models>(), true)) || ...);
    }
    /// What the same returns.
    template <typename Read>
    static auto read(const std::string& type, const Read& read) {
        using First = std::variant_alternative_t<0, Variant>;
        std::optional<decltype(read.template operator()<First>())> result;
        with(type, [&]<typename Model> { result.emplace(read.template operator()<Model>()); });
        return std::move(*result);
    }
};

} // namespace tungsten
