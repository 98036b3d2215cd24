#pragma once
// A medium that is the same everywhere.

#include "tungsten/medium/MediumModel.h"

namespace tungsten {

/// Coefficients per scene unit of length (density already multiplied in), per RGB channel.
class Homogeneous {
  public:
    static constexpr const char* Type = "homogeneous";
    static constexpr bool IsHomogeneous = true;

    Homogeneous() : Homogeneous(Rgb(0.0f), Rgb(0.0f)) {}
    Homogeneous(const Rgb& sigmaA, const Rgb& sigmaS)
        : sigmaA_(sigmaA), sigmaS_(sigmaS), grey_(hasEqualChannels(sigmaA) && hasEqualChannels(sigmaS)) {}

    static Homogeneous read(const ObjectReader& fields);
    [[nodiscard]] const Rgb& sigmaA() const { return sigmaA_; }
    [[nodiscard]] const Rgb& sigmaS() const { return sigmaS_; }
    [[nodiscard]] Rgb sigmaT() const { return sigmaA_ + sigmaS_; }
    [[nodiscard]] bool scatters() const { return !isBlack(sigmaS_); }
    [[nodiscard]] bool isVacuum() const { return isBlack(sigmaT()); }
    [[nodiscard]] bool isGrey() const { return grey_; }
    /// e^{-sigmaT d}; zero at infinity unless the medium is empty.
    [[nodiscard]] Rgb transmittance(float distance) const;
    [[nodiscard]] FlightSample sampleFlight(float tMax, const ChannelDensities& channels, Sampler& sampler) const;
    [[nodiscard]] FlightSample flightThatExits(float distance, const ChannelDensities& channels) const;
    [[nodiscard]] FlightSample flightThatCollides(float distance, const ChannelDensities& channels) const;
    [[nodiscard]] float pdfFlight(float distance, const ChannelDensities& channels) const;
    [[nodiscard]] float probabilityFlightExits(float distance, const ChannelDensities& channels) const;

  private:
    [[nodiscard]] static bool hasEqualChannels(const Rgb& sigma) { return sigma.x == sigma.y && sigma.y == sigma.z; }

    Rgb sigmaA_, sigmaS_;
    bool grey_; ///< asked in every flight
};

} // namespace tungsten
