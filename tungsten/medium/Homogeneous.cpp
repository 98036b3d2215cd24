#include "tungsten/medium/Homogeneous.h"

#include "tungsten/reader/ObjectReader.h"

namespace tungsten {

namespace {

float transmittanceOf(float sigma, float distance) {
    return sigma > 0.0f ? std::exp(-sigma * distance) : 1.0f;
}

/// Apart, so that grey media do not prepare for three exponentials.
[[gnu::noinline]] Rgb transmittanceOf(const Rgb& sigma, float distance) {
    return {transmittanceOf(sigma.x, distance), transmittanceOf(sigma.y, distance), transmittanceOf(sigma.z, distance)};
}

/// A channel in proportion to the densities, and a number in [0, 1) of what is left of the random one.
struct ChosenChannel {
    int index;
    float u;
};
ChosenChannel chooseChannel(const ChannelDensities& channels, uint32_t bits) {
    double rest = double(bits) * 0x1p-32 * (double(channels.x) + double(channels.y) + double(channels.z));
    int index = 0;
    while (index < 2 && !(rest < double(channels[index]))) rest -= double(channels[index++]);
    while (index > 0 && !(channels[index] > 0.0f)) rest = double(channels[--index]); // rounding at the end
    return {index, std::min(float(rest / double(channels[index])), 0x1.fffffep-1f)};
}

} // namespace

Rgb Homogeneous::transmittance(float distance) const {
    // Nothing comes from infinitely far through a medium, not even in a channel that it leaves alone
    // (docs/scene-format.md, section 9).
    if (std::isinf(distance)) return Rgb(isVacuum() ? 1.0f : 0.0f);
    return grey_ ? Rgb(transmittanceOf(sigmaT().x, distance)) : transmittanceOf(sigmaT(), distance);
}

float Homogeneous::probabilityFlightExits(float distance, const ChannelDensities& channels) const {
    if (!scatters()) return 1.0f;
    const Rgb transmittance = this->transmittance(distance);
    return isGrey() ? transmittance.x : meanComponent(channels * transmittance);
}

float Homogeneous::pdfFlight(float distance, const ChannelDensities& channels) const {
    if (!scatters()) return 0.0f;
    const Rgb density = sigmaT() * transmittance(distance);
    return isGrey() ? density.x : meanComponent(channels * density);
}

FlightSample Homogeneous::flightThatExits(float distance, const ChannelDensities& channels) const {
    const Rgb transmittance = this->transmittance(distance);
    if (!scatters()) return {distance, true, transmittance, 1.0f, channels};
    if (isGrey()) return {distance, true, Rgb(1.0f), transmittance.x, channels};
    const float probability = meanComponent(channels * transmittance);
    return {distance, true, transmittance / probability, probability, channels * transmittance / probability};
}

FlightSample Homogeneous::flightThatCollides(float distance, const ChannelDensities& channels) const {
    const Rgb sigma = sigmaT(), transmittance = this->transmittance(distance), density = sigma * transmittance;
    if (isGrey()) return {distance, false, sigmaS_ / sigma, density.x, channels};
    const float pdf = meanComponent(channels * density);
    return {distance, false, sigmaS_ * transmittance / pdf, pdf, channels * density / pdf};
}

FlightSample Homogeneous::sampleFlight(float tMax, const ChannelDensities& channels, Sampler& sampler) const {
    if (!scatters()) return {tMax, true, transmittance(tMax), 1.0f, channels};
    // u < 1 always, so the logarithm is finite.
    const uint32_t bits = sampler.nextBits();
    const auto [chosen, u] = isGrey() ? ChosenChannel{0, float(bits >> 8) * 0x1p-24f} : chooseChannel(channels, bits);
    const Rgb sigma = sigmaT();
    const float t = sigma[chosen] > 0.0f ? -std::log1p(-u) / sigma[chosen] : Infinity;
    return t >= tMax ? flightThatExits(tMax, channels) : flightThatCollides(t, channels);
}

Homogeneous Homogeneous::read(const ObjectReader& fields) {
    const float density =
        float(fields.number("density", 1.0, {"none", "factor on both coefficients"}, Range::nonNegative()));
    const Rgb sigmaA =
        fields.rgb("sigma_a", Rgb(0.0f), {"1/length", "absorption coefficient"}, Range::nonNegative()) * density;
    const Rgb sigmaS =
        fields.rgb("sigma_s", Rgb(0.0f), {"1/length", "scattering coefficient"}, Range::nonNegative()) * density;
    return Homogeneous(sigmaA, sigmaS);
}

} // namespace tungsten
