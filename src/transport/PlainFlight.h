#pragma once
// Flights of plain walks, asked of those that guided steps take (docs/method.md, section 11).

#include "transport/Walk.h"

namespace tungsten::transport {

/// Through `medium`, null in vacuum, up to a surface at `reach`.
struct PlainFlight {
    const Medium* medium = nullptr;
    float reach = Infinity;
    ChannelDensities channels{1.0f}; ///< where it starts

    /// Probability of getting to the surface.
    [[nodiscard]] float surface() const { return medium ? probabilityFlightExits(*medium, reach, channels) : 1.0f; }
    /// Per length, of a collision.
    [[nodiscard]] float pdf(float distance) const { return pdfFlight(*medium, distance, channels); }
    /// That ends as this one does.
    [[nodiscard]] FlightSample like(const Flight& flight) const {
        if (!medium) return {flight.distance, true, Rgb(1.0f), 1.0f, channels};
        return flight.event == Flight::Event::Collision ? flightThatCollides(*medium, flight.distance, channels)
                                                        : flightThatExits(*medium, flight.distance, channels);
    }
};

} // namespace tungsten::transport
