// Does not compile, and the message is to name both the model and what it lacks: a BSDF without `pdf`.

#include "tungsten/bsdf/BsdfModel.h"

namespace tungsten {

struct Forgetful : BsdfBase {
    static constexpr const char* Type = "forgetful";

    static Forgetful read(const BsdfReader&) { return {}; }
    [[nodiscard]] LobeMask lobes() const { return lobe::None; }
    [[nodiscard]] Rgb eval(const ModelPoint&, const Vec3f&, const Vec3f&) const { return Rgb(0.0f); }
    [[nodiscard]] MaybeSample sample(const ModelPoint&, const Vec3f&, const BsdfRandom&) const { return std::nullopt; }
};

using Bsdfs = BsdfSet<Forgetful>;

} // namespace tungsten
