#include "tungsten/medium/Medium.h"

namespace tungsten {

namespace {

float transmittanceOf(float sigma, float distance) {
    return sigma > 0.0f ? std::exp(-sigma * distance) : 1.0f;
}

/// Apart, so that grey media do not prepare for three exponentials.
[[gnu::noinline]] Rgb transmittanceOf(const Rgb& sigma, float distance) {
    return {transmittanceOf(sigma.x, distance), transmittanceOf(sigma.y, distance), transmittanceOf(sigma.z, distance)};
}

} // namespace

Rgb Homogeneous::transmittance(float distance) const {
    // Nothing comes from infinitely far through a medium, not even in a channel that it leaves alone
    // (docs/scene-format.md, section 9).
    if (std::isinf(distance)) return Rgb(isVacuum() ? 1.0f : 0.0f);
    return grey_ ? Rgb(transmittanceOf(sigmaT().x, distance)) : transmittanceOf(sigmaT(), distance);
}

namespace {

float probabilityFlightExits(const Homogeneous& medium, float distance) {
    return medium.scatters() ? meanComponent(medium.transmittance(distance)) : 1.0f;
}

FlightSample sampleFlight(const Homogeneous& medium, float tMax, Sampler& sampler) {
    if (!medium.scatters()) return {tMax, true, medium.transmittance(tMax), 1.0f};
    const Rgb sigma = medium.sigmaT();
    // One number: where it falls among three parts chooses the channel, and its place there the distance.
    const uint64_t bits = uint64_t(sampler.nextBits()) * (medium.isGrey() ? 1 : 3);
    const float chosen = sigma[int(bits >> 32)];
    // u < 1 always, so the logarithm is finite.
    const float u = float(uint32_t(bits) >> 8) * 0x1p-24f;
    const float t = chosen > 0.0f ? -std::log1p(-u) / chosen : Infinity;
    if (t >= tMax) {
        const float probability = probabilityFlightExits(medium, tMax);
        return {tMax, true, medium.transmittance(tMax) / probability, probability};
    }
    const Rgb transmittance = medium.transmittance(t);
    const float pdf = meanComponent(sigma * transmittance);
    return {t, false, medium.sigmaS() * transmittance / pdf, pdf};
}

float pdfFlight(const Homogeneous& medium, float distance) {
    return medium.scatters() ? meanComponent(medium.sigmaT() * medium.transmittance(distance)) : 0.0f;
}

} // namespace

FlightSample sampleFlight(const Medium& medium, float tMax, Sampler& sampler) {
    return std::visit([&](const auto& m) { return sampleFlight(m, tMax, sampler); }, medium.model);
}

float pdfFlight(const Medium& medium, float distance) {
    return std::visit([&](const auto& m) { return pdfFlight(m, distance); }, medium.model);
}

float probabilityFlightExits(const Medium& medium, float distance) {
    return std::visit([&](const auto& m) { return probabilityFlightExits(m, distance); }, medium.model);
}

} // namespace tungsten
