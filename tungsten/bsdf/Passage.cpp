// Models that let light through or combine others: null, forward, transparency, mixed.

#include "tungsten/bsdf/Models.h"

namespace tungsten {

namespace {

MaybeSample passStraight(const Vec3f& wi, const Rgb& weight, float probability) {
    return BsdfSample{-wi, weight, probability, lobe::Forward};
}

/// Chance of going straight through a transparency.
float straightProbability(const Transparency& model, const ModelPoint& at, float alpha) {
    const bool base = (model.base->lobes() & at.query.requested) != 0;
    if (!at.wants(lobe::Forward)) return 0.0f;
    return base ? 1.0f - alpha : 1.0f;
}

/// Chance of sampling the first part of a mixture: its ratio, or all or nothing when only one part has the requested
/// lobes.
float firstProbability(const Mixed& model, const ModelPoint& at, float ratio) {
    const bool first = (model.bsdf0->lobes() & at.query.requested) != 0;
    const bool second = (model.bsdf1->lobes() & at.query.requested) != 0;
    return first && second ? ratio : (first ? 1.0f : 0.0f);
}

} // namespace

template <>
LobeMask lobesOf(const Null&) {
    return lobe::None;
}
template <>
Rgb evalModel(const Null&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return Rgb(0.0f);
}
template <>
float pdfModel(const Null&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return 0.0f;
}
template <>
MaybeSample sampleModel(const Null&, const ModelPoint&, const Vec3f&, const BsdfRandom&) {
    return std::nullopt;
}

template <>
LobeMask lobesOf(const Forward&) {
    return lobe::Forward;
}
template <>
Rgb evalModel(const Forward&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return Rgb(0.0f);
}
template <>
float pdfModel(const Forward&, const ModelPoint&, const Vec3f&, const Vec3f&) {
    return 0.0f;
}
template <>
MaybeSample sampleModel(const Forward&, const ModelPoint& at, const Vec3f& wi, const BsdfRandom&) {
    if (!at.wants(lobe::Forward)) return std::nullopt;
    return passStraight(wi, Rgb(1.0f), 1.0f);
}
Rgb forwardOf(const Forward&, const ModelPoint&) {
    return Rgb(1.0f);
}

template <>
LobeMask lobesOf(const Transparency& model) {
    return lobe::Forward | model.base->lobes();
}
template <>
Rgb evalModel(const Transparency& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    return model.base->eval(at.query, wi, wo) * model.alpha.alpha(at.query.uv);
}
template <>
float pdfModel(const Transparency& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    const float alpha = model.alpha.alpha(at.query.uv);
    return (1.0f - straightProbability(model, at, alpha)) * model.base->pdf(at.query, wi, wo);
}
template <>
MaybeSample sampleModel(const Transparency& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    const float alpha = model.alpha.alpha(at.query.uv);
    const float probability = straightProbability(model, at, alpha);
    if (u.lobe < probability) return passStraight(wi, Rgb((1.0f - alpha) / probability), probability);
    if (probability >= 1.0f) return std::nullopt;
    auto sample = model.base->sample(at.query, wi, {u.direction, (u.lobe - probability) / (1.0f - probability)});
    if (!sample) return sample;
    sample->weight *= alpha / (1.0f - probability);
    sample->pdf *= 1.0f - probability;
    return sample;
}
Rgb forwardOf(const Transparency& model, const ModelPoint& at) {
    return Rgb(1.0f - model.alpha.alpha(at.query.uv));
}

template <>
LobeMask lobesOf(const Mixed& model) {
    return model.bsdf0->lobes() | model.bsdf1->lobes();
}
template <>
Rgb evalModel(const Mixed& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    const float ratio = model.ratio.scalar(at.query.uv);
    return at.albedo *
           (model.bsdf0->eval(at.query, wi, wo) * ratio + model.bsdf1->eval(at.query, wi, wo) * (1.0f - ratio));
}
template <>
float pdfModel(const Mixed& model, const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) {
    const float p = firstProbability(model, at, model.ratio.scalar(at.query.uv));
    return p * model.bsdf0->pdf(at.query, wi, wo) + (1.0f - p) * model.bsdf1->pdf(at.query, wi, wo);
}
template <>
MaybeSample sampleModel(const Mixed& model, const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) {
    const float ratio = model.ratio.scalar(at.query.uv);
    const float p = firstProbability(model, at, ratio);
    const bool first = u.lobe < p;
    const Bsdf& part = first ? *model.bsdf0 : *model.bsdf1;
    const float chosen = first ? p : 1.0f - p, share = first ? ratio : 1.0f - ratio;
    auto sample = part.sample(at.query, wi, {u.direction, first ? u.lobe / p : (u.lobe - p) / (1.0f - p)});
    if (!sample) return sample;
    if ((sample->lobe & lobe::Smooth) != 0) return smoothSample(model, at, wi, sample->wo, sample->lobe);
    sample->weight = sample->weight * at.albedo * (share / chosen);
    sample->pdf *= chosen;
    return sample;
}
Rgb forwardOf(const Mixed& model, const ModelPoint& at) {
    const float ratio = model.ratio.scalar(at.query.uv);
    return at.albedo *
           (model.bsdf0->forwardWeight(at.query.uv) * ratio + model.bsdf1->forwardWeight(at.query.uv) * (1.0f - ratio));
}

} // namespace tungsten
