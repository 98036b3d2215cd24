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

float probabilityFlightExits(const Homogeneous& medium, float distance, const ChannelDensities& channels) {
    if (!medium.scatters()) return 1.0f;
    const Rgb transmittance = medium.transmittance(distance);
    return medium.isGrey() ? transmittance.x : meanComponent(channels * transmittance);
}

float pdfFlight(const Homogeneous& medium, float distance, const ChannelDensities& channels) {
    if (!medium.scatters()) return 0.0f;
    const Rgb density = medium.sigmaT() * medium.transmittance(distance);
    return medium.isGrey() ? density.x : meanComponent(channels * density);
}

FlightSample flightThatExits(const Homogeneous& medium, float distance, const ChannelDensities& channels) {
    const Rgb transmittance = medium.transmittance(distance);
    if (!medium.scatters()) return {distance, true, transmittance, 1.0f, channels};
    if (medium.isGrey()) return {distance, true, Rgb(1.0f), transmittance.x, channels};
    const float probability = meanComponent(channels * transmittance);
    return {distance, true, transmittance / probability, probability, channels * transmittance / probability};
}

FlightSample flightThatCollides(const Homogeneous& medium, float distance, const ChannelDensities& channels) {
    const Rgb sigma = medium.sigmaT(), transmittance = medium.transmittance(distance), density = sigma * transmittance;
    if (medium.isGrey()) return {distance, false, medium.sigmaS() / sigma, density.x, channels};
    const float pdf = meanComponent(channels * density);
    return {distance, false, medium.sigmaS() * transmittance / pdf, pdf, channels * density / pdf};
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

FlightSample sampleFlight(const Homogeneous& medium, float tMax, const ChannelDensities& channels, Sampler& sampler) {
    if (!medium.scatters()) return {tMax, true, medium.transmittance(tMax), 1.0f, channels};
    // u < 1 always, so the logarithm is finite.
    const uint32_t bits = sampler.nextBits();
    const auto [chosen, u] =
        medium.isGrey() ? ChosenChannel{0, float(bits >> 8) * 0x1p-24f} : chooseChannel(channels, bits);
    const Rgb sigma = medium.sigmaT();
    const float t = sigma[chosen] > 0.0f ? -std::log1p(-u) / sigma[chosen] : Infinity;
    return t >= tMax ? flightThatExits(medium, tMax, channels) : flightThatCollides(medium, t, channels);
}

} // namespace

FlightSample sampleFlight(const Medium& medium, float tMax, const ChannelDensities& channels, Sampler& sampler) {
    return std::visit([&](const auto& m) { return sampleFlight(m, tMax, channels, sampler); }, medium.model);
}

FlightSample flightThatExits(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return flightThatExits(m, distance, channels); }, medium.model);
}

FlightSample flightThatCollides(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return flightThatCollides(m, distance, channels); }, medium.model);
}

float pdfFlight(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return pdfFlight(m, distance, channels); }, medium.model);
}

float probabilityFlightExits(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return probabilityFlightExits(m, distance, channels); }, medium.model);
}

} // namespace tungsten
