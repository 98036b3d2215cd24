#include "tungsten/medium/PhaseFunction.h"

namespace tungsten {

namespace {
constexpr float InvFourPi = 0.25f * InvPi;
} // namespace

float Isotropic::eval(float) const {
    return InvFourPi;
}
float Isotropic::sampleCosine(float u) const {
    return 1.0f - 2.0f * u;
}

float HenyeyGreenstein::eval(float cosTheta) const {
    // 1 + g^2 - 2 g cos written about the peak, so that nothing cancels there: forward for g > 0, backward for g < 0.
    const float magnitude = std::abs(g);
    const float fromPeak = g >= 0.0f ? 1.0f - cosTheta : 1.0f + cosTheta;
    const float denominator = sqr(1.0f - magnitude) + 2.0f * magnitude * fromPeak;
    return InvFourPi * (1.0f - g * g) / (denominator * std::sqrt(denominator));
}

float HenyeyGreenstein::sampleCosine(float u) const {
    // The usual inversion with 1 - cos factored: no division by g, no cancellation at the forward peak (u = 0).
    const float d = 1.0f + g - 2.0f * g * u;
    const float s = (1.0f - g) * (1.0f + g) / d;
    const float oneMinusCos = (1.0f - g) * u * (s + 1.0f - g) / d;
    return 1.0f - std::clamp(oneMinusCos, 0.0f, 2.0f);
}

float Rayleigh::eval(float cosTheta) const {
    return 3.0f / 16.0f * InvPi * (1.0f + cosTheta * cosTheta);
}

float Rayleigh::sampleCosine(float u) const {
    // Root of c^3 + 3 c = 4 (1 - 2u): Cardano.
    const float q = 2.0f * (1.0f - 2.0f * u);
    const float a = std::cbrt(std::abs(q) + std::sqrt(1.0f + q * q));
    return std::clamp(std::copysign(a - 1.0f / a, q), -1.0f, 1.0f);
}

float PhaseFunction::eval(const Vec3f& before, const Vec3f& after) const {
    const float cosTheta = std::clamp(before.dot(after), -1.0f, 1.0f);
    return std::visit([cosTheta](const auto& phase) { return phase.eval(cosTheta); }, model);
}

Vec3f PhaseFunction::sample(const Vec3f& before, const Vec2f& u) const {
    const float cosTheta = std::visit([&](const auto& phase) { return phase.sampleCosine(u.x); }, model);
    const float sinTheta = std::sqrt(std::max((1.0f - cosTheta) * (1.0f + cosTheta), 0.0f));
    const float phi = 2.0f * Pi * u.y;
    return Frame(before).toWorld(Vec3f(sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta)).normalized();
}

float PhaseFunction::g() const {
    const auto* hg = std::get_if<HenyeyGreenstein>(&model);
    return hg ? hg->g : 0.0f;
}

} // namespace tungsten
