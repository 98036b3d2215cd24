// Models that let light through or combine others: null, forward, transparency, mixed.

#include "tungsten/bsdf/BsdfReader.h"

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

MaybeSample Forward::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom&) const {
    if (!at.wants(lobe::Forward)) return std::nullopt;
    return passStraight(wi, Rgb(1.0f), 1.0f);
}

LobeMask Transparency::lobes() const {
    return lobe::Forward | base->lobes();
}
Rgb Transparency::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    return base->eval(at.query, wi, wo) * alpha.alpha(at.query.uv);
}
float Transparency::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    const float opacity = alpha.alpha(at.query.uv);
    return (1.0f - straightProbability(*this, at, opacity)) * base->pdf(at.query, wi, wo);
}
MaybeSample Transparency::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    const float opacity = alpha.alpha(at.query.uv);
    const float probability = straightProbability(*this, at, opacity);
    if (u.lobe < probability) return passStraight(wi, Rgb((1.0f - opacity) / probability), probability);
    if (probability >= 1.0f) return std::nullopt;
    auto sample = base->sample(at.query, wi, {u.direction, (u.lobe - probability) / (1.0f - probability)});
    if (!sample) return sample;
    sample->weight *= opacity / (1.0f - probability);
    sample->pdf *= 1.0f - probability;
    return sample;
}
Rgb Transparency::forwardWeight(const ModelPoint& at) const {
    return Rgb(1.0f - alpha.alpha(at.query.uv));
}

LobeMask Mixed::lobes() const {
    return bsdf0->lobes() | bsdf1->lobes();
}
Rgb Mixed::eval(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    const float share0 = ratio.scalar(at.query.uv);
    return at.albedo * (bsdf0->eval(at.query, wi, wo) * share0 + bsdf1->eval(at.query, wi, wo) * (1.0f - share0));
}
float Mixed::pdf(const ModelPoint& at, const Vec3f& wi, const Vec3f& wo) const {
    const float p = firstProbability(*this, at, ratio.scalar(at.query.uv));
    return p * bsdf0->pdf(at.query, wi, wo) + (1.0f - p) * bsdf1->pdf(at.query, wi, wo);
}
MaybeSample Mixed::sample(const ModelPoint& at, const Vec3f& wi, const BsdfRandom& u) const {
    const float share0 = ratio.scalar(at.query.uv);
    const float p = firstProbability(*this, at, share0);
    const bool first = u.lobe < p;
    const Bsdf& part = first ? *bsdf0 : *bsdf1;
    const float chosen = first ? p : 1.0f - p, share = first ? share0 : 1.0f - share0;
    auto sample = part.sample(at.query, wi, {u.direction, first ? u.lobe / p : (u.lobe - p) / (1.0f - p)});
    if (!sample) return sample;
    if ((sample->lobe & lobe::Smooth) != 0) return smoothSample(*this, at, wi, sample->wo, sample->lobe);
    sample->weight = sample->weight * at.albedo * (share / chosen);
    sample->pdf *= chosen;
    return sample;
}
Rgb Mixed::forwardWeight(const ModelPoint& at) const {
    const float share0 = ratio.scalar(at.query.uv);
    return at.albedo *
           (bsdf0->forwardWeight(at.query.uv) * share0 + bsdf1->forwardWeight(at.query.uv) * (1.0f - share0));
}

bool Transparency::isLambertian() const {
    return base->isLambertian();
}
bool Mixed::isLambertian() const {
    return bsdf0->isLambertian() && bsdf1->isLambertian();
}

Transparency Transparency::read(const BsdfReader& fields) {
    return {
        {},
        fields.bsdf("base", {"none", "what is seen where alpha is 1", "white Lambert"}),
        fields.texture("alpha", Texture(1.0f), {"none", "opacity: 0 lets everything straight through"}, Range::unit())};
}

Mixed Mixed::read(const BsdfReader& fields) {
    for (const char* field : {"bsdf0", "bsdf1"})
        if (!fields.has(field)) fields.problem(field, "a mixed BSDF needs bsdf0 and bsdf1");
    return {{},
            fields.bsdf("bsdf0", {"none", "mixed with the share `ratio`", "required"}),
            fields.bsdf("bsdf1", {"none", "the rest of the mixture", "required"}),
            fields.texture("ratio", Texture(0.5f), {"none", "share of bsdf0"}, Range::unit())};
}

} // namespace tungsten
