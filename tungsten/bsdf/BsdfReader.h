#pragma once
// How a BSDF reads itself: fields that several models share, and other BSDFs.

#include "tungsten/bsdf/Bsdf.h"
#include "tungsten/texture/ModelReader.h"

namespace tungsten {

/// By name; the first definition wins.
using NamedBsdfs = std::map<std::string, BsdfPtr>;

class BsdfReader : public ModelReader {
  public:
    BsdfReader(const ModelReader& object, NamedBsdfs& named) : ModelReader(object), named_(&named) {}

    [[nodiscard]] float ior() const;
    [[nodiscard]] MicrofacetModel distribution(MicrofacetModel fallback) const;
    [[nodiscard]] Texture roughness(float fallback) const;

    /// A BSDF by name or as an inline object.
    [[nodiscard]] BsdfPtr bsdf(const std::string& field, const Meaning& meaning) const;
    /// One BSDF, or an array indexed by the mesh's materials.
    [[nodiscard]] std::vector<BsdfPtr> bsdfs(const std::string& field, const Meaning& meaning) const;
    /// The object itself; those after it may name it.
    BsdfPtr asBsdf() const;

  private:
    [[nodiscard]] BsdfReader of(const ObjectReader& object) const { return {ModelReader::of(object), *named_}; }
    [[nodiscard]] BsdfPtr byName(const std::string& field, const std::string& name) const;

    NamedBsdfs* named_;
};

void describeBsdf(const std::shared_ptr<Description>& description);

} // namespace tungsten
