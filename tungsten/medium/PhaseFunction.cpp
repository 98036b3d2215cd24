#include "tungsten/medium/PhaseFunction.h"

#include "tungsten/reader/ObjectReader.h"

namespace tungsten {

namespace {
constexpr float InvFourPi = 0.25f * InvPi;
} // namespace

float Isotropic::eval(float) const {
    return InvFourPi;
}
float Isotropic::sample(float u) const {
    return 2.0f * u;
}

float HenyeyGreenstein::eval(float h) const {
    // 1 + g^2 - 2 g cos about the peak.
    const float strength = std::abs(g), d = sqr(1.0f - strength) + 2.0f * strength * h;
    return InvFourPi * (1.0f - strength) * (1.0f + strength) / (d * std::sqrt(d));
}

float HenyeyGreenstein::sample(float u) const {
    // The inverted distribution from the peak (u = 0) on, with the difference of squares multiplied out: no term is
    // negative.
    const float strength = std::abs(g), b = 1.0f - strength + 2.0f * strength * (1.0f - u);
    return std::min(2.0f * u * sqr(1.0f - strength) * (1.0f + strength * (1.0f - u)) / (b * b), 2.0f);
}

HenyeyGreenstein HenyeyGreenstein::read(const ObjectReader& fields) {
    return {float(fields.number("g", 0.0, {"none", "mean cosine; above 0 light goes on forward"}, {-0.999, 0.999}))};
}

float Rayleigh::eval(float h) const {
    return 3.0f / 16.0f * InvPi * (1.0f + sqr(1.0f - h));
}

float Rayleigh::sample(float u) const {
    // Root of c^3 + 3 c = 4 (1 - 2u): Cardano.
    const float q = 2.0f * (1.0f - 2.0f * u);
    const float a = std::cbrt(std::abs(q) + std::sqrt(1.0f + q * q));
    return 1.0f - std::clamp(std::copysign(a - 1.0f / a, q), -1.0f, 1.0f);
}

float PhaseFunction::eval(const Vec3f& before, const Vec3f& after) const {
    const float h = std::min(0.5f * (after - peak(before)).length2(), 2.0f);
    return std::visit([h](const auto& phase) { return phase.eval(h); }, model);
}

Vec3f PhaseFunction::sample(const Vec3f& before, const Vec2f& u) const {
    const float h = std::visit([&](const auto& phase) { return phase.sample(u.x); }, model);
    const float sinTheta = std::sqrt(std::max(h * (2.0f - h), 0.0f)), phi = 2.0f * Pi * u.y;
    return Frame(peak(before))
        .toWorld(Vec3f(sinTheta * std::cos(phi), sinTheta * std::sin(phi), 1.0f - h))
        .normalized();
}

} // namespace tungsten
