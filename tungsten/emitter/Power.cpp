#include "tungsten/emitter/Power.h"

namespace tungsten {

Rgb pointIntensityFromPower(const Rgb& power) {
    return power / (4.0f * Pi);
}

float spotSolidAngle(float cosInner, float cosOuter) {
    // The smoothstep is antisymmetric about the middle of the edge, so it averages to 1/2 over equal steps of the
    // cosine.
    return 2.0f * Pi * (1.0f - 0.5f * (cosInner + cosOuter));
}

Rgb spotIntensityFromPower(const Rgb& power, float cosInner, float cosOuter) {
    return power / spotSolidAngle(cosInner, cosOuter);
}

Rgb directionalPointPower(const Rgb& emission) {
    return emission * (4.0f * Pi);
}

Rgb collimatedPowerFromEmission(const Rgb& emission, float radius) {
    return radius > 0.0f ? emission * (Pi * radius * radius) : emission;
}

Rgb collimatedPowerFromPower(const Rgb& power, float radius) {
    return collimatedPowerFromEmission(power / (4.0f * Pi), radius);
}

Texture areaRadianceFromPower(const Texture& power, float area) {
    return power.scaled(Rgb(area > 0.0f ? 1.0f / (Pi * area) : 0.0f));
}

Texture infiniteRadianceFromPower(const Texture& power) {
    return power.scaled(Rgb(0.25f * InvPi));
}

} // namespace tungsten
