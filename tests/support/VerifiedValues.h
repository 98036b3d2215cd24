#pragma once
// The verified values of docs/photon-primitives.md, section 6, with the scenes and gates that they belong to: single
// orders of scattering seen by one camera ray.

#include "support/GroundTruthScenes.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tungsten::test {

using Overrides = std::vector<std::string>;

inline std::string setting(const std::string& name, double value) {
    return "integrator." + name + "=" + std::to_string(value);
}

struct VerifiedValue {
    char configuration; ///< A; B: forward scattering; C: a laser; W: as A, with an absorbing plane
    int order;
    bool unwarped, delta;
    double radiance;          ///< per unit path length, averaged over the gate
    double uncertainty = 0.0; ///< standard error of values that were simulated; 0: exact to the digits printed
    double gateWidth = 1.0;   ///< of box gates
};

/// Exact where a closed form exists, otherwise the estimate with the smallest standard error that is trusted.
inline constexpr std::array VerifiedValues{
    VerifiedValue{'A', 1, false, true, 2.1055e-4},
    VerifiedValue{'A', 1, false, false, 2.22436e-4},
    VerifiedValue{'A', 1, true, true, 26.6081e-4},
    VerifiedValue{'A', 1, true, false, 11.1009e-4},
    VerifiedValue{'A', 2, false, true, 5.79199e-4},
    VerifiedValue{'A', 2, false, false, 5.97962e-4},
    VerifiedValue{'A', 2, true, true, 40.7037e-4},
    VerifiedValue{'A', 2, true, false, 29.4416e-4},
    VerifiedValue{'A', 3, false, true, 7.70375e-4},
    VerifiedValue{'A', 3, false, false, 7.81135e-4},
    VerifiedValue{'A', 3, false, false, 7.70e-4, 0.003e-4, 0.1}, // rounded
    VerifiedValue{'A', 3, true, true, 24.0969e-4},
    VerifiedValue{'A', 3, true, false, 22.1036e-4},
    VerifiedValue{'A', 4, false, true, 6.67469e-4},
    VerifiedValue{'A', 4, false, false, 6.68089e-4},
    VerifiedValue{'A', 4, true, true, 8.49732e-4},
    VerifiedValue{'A', 4, true, false, 9.71149e-4},
    VerifiedValue{'B', 2, false, true, 1.22185e-4, 0.00067e-4},
    VerifiedValue{'B', 2, false, false, 1.28207e-4, 0.00072e-4},
    VerifiedValue{'B', 2, true, true, 67.886e-4, 0.027e-4},
    VerifiedValue{'B', 2, true, false, 36.250e-4, 0.017e-4},
    VerifiedValue{'B', 3, false, true, 1.8411e-4, 0.0029e-4},
    VerifiedValue{'B', 3, false, false, 1.9006e-4, 0.0019e-4},
    VerifiedValue{'B', 3, true, true, 36.248e-4, 0.042e-4},
    VerifiedValue{'B', 3, true, false, 24.867e-4, 0.015e-4},
    VerifiedValue{'B', 4, false, true, 1.8208e-4, 0.0013e-4},
    VerifiedValue{'B', 4, false, false, 1.8492e-4, 0.0014e-4},
    VerifiedValue{'B', 4, true, true, 12.8920e-4, 0.0083e-4},
    VerifiedValue{'B', 4, true, false, 11.0711e-4, 0.0071e-4},
    VerifiedValue{'C', 2, false, true, 8.55486e-5},
    VerifiedValue{'C', 2, false, false, 9.56707e-5},
    VerifiedValue{'C', 2, true, true, 7.63581e-5},
    VerifiedValue{'C', 2, true, false, 8.34604e-5},
    VerifiedValue{'C', 3, false, true, 10.1183e-5, 0.0038e-5},
    VerifiedValue{'C', 3, false, false, 10.6334e-5, 0.0042e-5},
    VerifiedValue{'C', 3, true, true, 12.0245e-5, 0.0036e-5},
    VerifiedValue{'C', 3, true, false, 12.5775e-5, 0.0040e-5},
    VerifiedValue{'W', 3, false, true, 3.9406e-4, 0.0018e-4},
    VerifiedValue{'W', 3, true, true, 19.914e-4, 0.018e-4},
    VerifiedValue{'W', 4, false, true, 4.3186e-4, 0.0057e-4},
    VerifiedValue{'W', 4, true, true, 7.102e-4, 0.016e-4},
};

constexpr std::string_view gateName(const VerifiedValue& v) {
    if (v.unwarped) return v.delta ? "UnwarpedDelta" : "UnwarpedBox";
    if (v.delta) return "WarpedDelta";
    return v.gateWidth < 1.0 ? "WarpedNarrow" : "WarpedBox";
}

/// Test names such as A2UnwarpedDelta.
inline std::string nameOf(const VerifiedValue& v) {
    return v.configuration + std::to_string(v.order) + std::string(gateName(v));
}

/// The value of that name; does not compile without one.
consteval VerifiedValue verified(std::string_view name) {
    for (const VerifiedValue& v : VerifiedValues)
        if (name[0] == v.configuration && name[1] == '0' + v.order && name.substr(2) == gateName(v)) return v;
    throw "no such verified value";
}

/// Half-width of a delta gate's temporal kernel.
inline constexpr double VerifiedTau = 0.1;

/// The configuration's scene: A's with forward scattering in B, a laser instead of the point in C, and a black plane at
/// z = 2.6 in W.
inline std::string sceneOf(const VerifiedValue& v) {
    const double g = v.configuration == 'C' ? 0.3 : v.configuration == 'B' ? 0.6 : 0.0;
    std::string json = configurationA(v.order, v.unwarped, g);
    if (v.configuration == 'W') {
        const std::string first = R"("primitives": [)";
        json.insert(json.find(first) + first.size(), R"({"type": "quad", "bsdf": {"type": "lambert", "albedo": 0},
            "int_medium": "fog", "ext_medium": "fog",
            "transform": {"position": [0, 0, 2.6], "rotation": [90, 0, 0], "scale": 100}}, )");
    }
    return v.configuration == 'C' ? withLaser(json) : json;
}

inline Overrides gateOf(const VerifiedValue& v, double tau = VerifiedTau) {
    const double unwarpedCentre = v.configuration == 'C' ? 3.5 : v.delta ? 2.2 : 2.5;
    Overrides overrides{setting("transient_time_center", v.unwarped ? unwarpedCentre : 5.5),
                        setting("transient_time_width", v.delta ? 2.0 * tau : v.gateWidth)};
    if (v.delta) overrides.emplace_back("integrator.delta_time_gate=true");
    return overrides;
}

} // namespace tungsten::test
