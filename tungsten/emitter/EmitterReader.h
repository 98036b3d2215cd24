#pragma once
// How a light source reads itself: where it stands, and how much it emits.

#include "tungsten/core/Transform.h"
#include "tungsten/emitter/EmitterModel.h"
#include "tungsten/texture/ModelReader.h"

namespace tungsten {

class EmitterReader : public ModelReader {
  public:
    static constexpr Meaning PowerMeaning{"power", "all that is emitted, instead of `emission`", "none"};

    EmitterReader(const ModelReader& object, const Transform& transform) : ModelReader(object), placement(transform) {}

    const Transform placement;

    /// `power` wins over `emission`; the flag says which was given.
    struct Strength {
        Rgb value{0.0f};
        bool isPower = false;
    };
    /// `emission` means what the emitter's own function says.
    [[nodiscard]] Strength strength(const Meaning& emissionMeaning, const Meaning& powerMeaning = PowerMeaning) const;
    /// Dark emitters are left out.
    [[nodiscard]] bool shines(const Rgb& strength) const { return maxComponent(strength) > 0.0f || describes(); }
};

} // namespace tungsten
