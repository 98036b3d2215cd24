#pragma once
// The per-model functions that Bsdf dispatches to. For every model:
//   lobesOf   every lobe the model can have
//   evalModel f |cos wo| of its smooth lobes in `at.query.requested`
//   pdfModel  density of sampleModel per solid angle (smooth lobes)
//   sampleModel one continuation among the requested lobes
//   forwardOf the weight of going straight through, which is what sampleModel brings there on average; of those that
//             do (Bsdf.cpp lists those that do not)
// Reflective models are black from behind (wi.z <= 0): the caller flips the frame for two-sided shading.

#include "tungsten/bsdf/Bsdf.h"

namespace tungsten {

/// Where a model is evaluated.
struct ModelPoint {
    const BsdfQuery& query;
    Rgb albedo;

    [[nodiscard]] bool wants(LobeMask lobes) const { return (query.requested & lobes) != 0; }
};

using MaybeSample = std::optional<BsdfSample>;

template <typename Model>
LobeMask lobesOf(const Model& model);
template <typename Model>
Rgb evalModel(const Model& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo);
template <typename Model>
float pdfModel(const Model& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo);
template <typename Model>
MaybeSample sampleModel(const Model& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u);
Rgb forwardOf(const Forward&, const ModelPoint& at);
Rgb forwardOf(const Transparency& model, const ModelPoint& at);
Rgb forwardOf(const Mixed& model, const ModelPoint& at);

/// Finishes a sample of smooth lobes: weight eval / pdf of the whole model.
template <typename Model>
MaybeSample smoothSample(const Model& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo, LobeMask lobe) {
    const float pdf = pdfModel(model, at, wi, wo);
    if (!(pdf > 0.0f)) return std::nullopt;
    return BsdfSample{wo, evalModel(model, at, wi, wo) / pdf, pdf, lobe};
}

inline Vec3f mirrored(const Vec3f& wi) {
    return {-wi.x, -wi.y, wi.z};
}
inline Vec3f reflectedAbout(const Vec3f& wi, const Vec3f& m) {
    return m * (2.0f * wi.dot(m)) - wi;
}

} // namespace tungsten
