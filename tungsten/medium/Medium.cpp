#include "tungsten/medium/Medium.h"

namespace tungsten {

FlightSample sampleFlight(const Medium& medium, float tMax, const ChannelDensities& channels, Sampler& sampler) {
    return std::visit([&](const auto& m) { return m.sampleFlight(tMax, channels, sampler); }, medium.model);
}

FlightSample flightThatExits(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return m.flightThatExits(distance, channels); }, medium.model);
}

FlightSample flightThatCollides(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return m.flightThatCollides(distance, channels); }, medium.model);
}

float pdfFlight(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return m.pdfFlight(distance, channels); }, medium.model);
}

float probabilityFlightExits(const Medium& medium, float distance, const ChannelDensities& channels) {
    return std::visit([&](const auto& m) { return m.probabilityFlightExits(distance, channels); }, medium.model);
}

} // namespace tungsten
