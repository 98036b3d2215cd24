#pragma once
// The cases of the experiment: an infinite homogeneous medium, an isotropic point emitter, a receiver at distance 1.

#include "darts/Settings.h"

#include <string>
#include <vector>

namespace infinite_medium {

/// Lengths in units of the distance C between emitter and receiver; the gate is [gateStart, gateStart + gateWidth).
struct Case {
    std::string name;
    double scattering = 1;      ///< sigmaS C
    double gateStart = 2;       ///< S / C
    double albedo = 1, g = 0;   ///< of the medium
    double gateWidth = 0.02;    ///< relative to C
    double kernelRadius = 0.04; ///< of the photon gather, relative to C
    size_t studyColumn = 0;     ///< place in the study's tables

    [[nodiscard]] darts::Medium medium() const {
        const float sigmaS = float(scattering), sigmaA = float(scattering * (1 - albedo) / albedo);
        return {{sigmaA, sigmaA, sigmaA}, {sigmaS, sigmaS, sigmaS}, float(g)};
    }
    [[nodiscard]] double gateEnd() const { return gateStart + gateWidth; }
};

/// Path mode: the receiver's ray leaves at cos = 0.8 to the emitter's direction.
inline constexpr double ReceiverCosine = 0.8;

/// Numbers the cases in the order of the study's tables.
inline std::vector<Case> inStudyOrder(std::vector<Case> cases) {
    for (size_t i = 0; i < cases.size(); ++i) cases[i].studyColumn = i;
    return cases;
}

inline std::vector<Case> pathCases() {
    const auto relative = [](const char* name, double scattering, double start, double albedo, double g, double width) {
        return Case{name, scattering, start, albedo, g, width * start};
    };
    return inStudyOrder(
        {relative("01", .3, 1.02, 1, 0, .02), relative("02", .3, 2, 1, 0, .02), relative("03", 1, 1.2, 1, 0, .02),
         relative("04", 1, 5, .9, 0, .02), relative("05", 3, 1.02, 1, 0, .0001), relative("06", 3, 1.2, .9, 0, .02),
         relative("07", 3, 2, 1, 0, .0001), relative("08", 3, 2, 1, .85, .02), relative("09", 3, 5, 1, -.5, .02),
         relative("10", 10, 1.02, 1, 0, .02), relative("11", 10, 1.2, 1, .5, .02), relative("12", 10, 2, .9, 0, .0001),
         relative("13", 10, 5, 1, 0, .02), relative("15", 30, 2, 1, 0, .02), relative("16", 30, 5, 1, 0, .02)});
}

inline std::vector<Case> photonCases() {
    const auto relative = [](const char* name, double scattering, double start, double albedo, double g) {
        return Case{name, scattering, start, albedo, g, .01 * start, .04};
    };
    return inStudyOrder({{"GD", 3.6, 1.139, 1, 0, .014, .15 / 3.6}, // as the glossy dragon's fog
                         relative("2", .5, 1.2, 1, 0),
                         relative("3", 1.5, 2, .99, 0),
                         relative("4", 1.5, 1.2, 1, .7),
                         relative("5", 3.2, 2, .99, .7),
                         relative("6", 3.2, 4, 1, 0),
                         relative("7", 10, 1.2, 1, 0),
                         relative("8", 10, 2, .99, .7),
                         relative("9", 1.5, 4, 1, 0)});
}

} // namespace infinite_medium
