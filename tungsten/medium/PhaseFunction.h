#pragma once
// Phase functions; g > 0 scatters forward.

#include "tungsten/core/ModelSet.h"
#include "tungsten/core/Types.h"

#include <concepts>

namespace tungsten {

class ObjectReader;

template <typename M>
concept PhaseModel = std::copyable<M> && requires(const M& m, float number, const ObjectReader& fields) {
    { M::Type } -> std::convertible_to<std::string>; // of the scene file
    { M::read(fields) } -> std::same_as<M>;
    { m.eval(number) } -> std::same_as<float>;   // at h, per solid angle
    { m.sample(number) } -> std::same_as<float>; // h of a number from 0 to 1
    { m.meanCosine() } -> std::same_as<float>;
    { m.evenly() } -> std::same_as<bool>;                   // no direction is preferred
    { M::OfHenyeyGreenstein } -> std::convertible_to<bool>; // eval() is that of Henyey and Greenstein's at meanCosine()
};
template <PhaseModel M>
using CheckedPhase = M;
template <typename... M>
using PhaseSet = ModelSet<CheckedPhase<M>...>;

// Models are functions of h = 1 - cos of the angle between the direction after and the peak: the direction of
// propagation before, or its opposite where more is scattered back than forward. About a peak that is narrow nothing
// cancels in h, as it does in the cosine.

struct Isotropic {
    static constexpr const char* Type = "isotropic";
    static constexpr bool OfHenyeyGreenstein = true;

    static Isotropic read(const ObjectReader&) { return {}; }
    [[nodiscard]] float eval(float h) const;
    [[nodiscard]] float sample(float u) const;
    [[nodiscard]] float meanCosine() const { return 0.0f; }
    [[nodiscard]] bool evenly() const { return true; }
};
struct HenyeyGreenstein {
    static constexpr const char* Type = "henyey_greenstein";
    static constexpr bool OfHenyeyGreenstein = true;
    float g = 0.0f;

    static HenyeyGreenstein read(const ObjectReader& fields);
    [[nodiscard]] float eval(float h) const;
    [[nodiscard]] float sample(float u) const;
    [[nodiscard]] float meanCosine() const { return g; }
    [[nodiscard]] bool evenly() const { return g == 0.0f; }
};
struct Rayleigh {
    static constexpr const char* Type = "rayleigh";
    static constexpr bool OfHenyeyGreenstein = false;

    static Rayleigh read(const ObjectReader&) { return {}; }
    [[nodiscard]] float eval(float h) const;
    [[nodiscard]] float sample(float u) const;
    [[nodiscard]] float meanCosine() const { return 0.0f; }
    [[nodiscard]] bool evenly() const { return false; }
};

using PhaseFunctions = PhaseSet<Isotropic, HenyeyGreenstein, Rayleigh>;

/// Normalised over the sphere: eval is also the density per solid angle of sample.
class PhaseFunction {
  public:
    PhaseFunctions::Variant model;

    [[nodiscard]] float eval(const Vec3f& before, const Vec3f& after) const;
    [[nodiscard]] float pdf(const Vec3f& before, const Vec3f& after) const { return eval(before, after); }
    [[nodiscard]] Vec3f sample(const Vec3f& before, const Vec2f& u) const;
    /// Mean cosine.
    [[nodiscard]] float g() const {
        return std::visit([](const auto& phase) { return phase.meanCosine(); }, model);
    }
    [[nodiscard]] bool isIsotropic() const {
        return std::visit([](const auto& phase) { return phase.evenly(); }, model);
    }
    /// Its values are those of Henyey and Greenstein's at g().
    [[nodiscard]] bool isHenyeyGreenstein() const {
        return std::visit([](const auto& phase) { return phase.OfHenyeyGreenstein; }, model);
    }

  private:
    [[nodiscard]] Vec3f peak(const Vec3f& before) const { return g() < 0.0f ? -before : before; }
};

} // namespace tungsten
