#pragma once
// What `emission` and `power` of the scene format mean for each kind of emitter (docs/scene-format.md, section 7.2).

#include "tungsten/emitter/Emitter.h"

namespace tungsten {

/// Intensity of a point of total power P: P / 4 pi.
Rgb pointIntensityFromPower(const Rgb& power);
/// Axis intensity of a spot of total power P.
Rgb spotIntensityFromPower(const Rgb& power, float cosInner, float cosOuter);
/// A directional_point with emission E carries 4 pi E.
Rgb directionalPointPower(const Rgb& emission);
/// A collimated laser's emission is its irradiance if it has a radius, else its power.
Rgb collimatedPowerFromEmission(const Rgb& emission, float radius);
/// The format divides a collimated laser's power by 4 pi on the way to its emission.
Rgb collimatedPowerFromPower(const Rgb& power, float radius);
/// P / (pi A).
Texture areaRadianceFromPower(const Texture& power, float area);
/// P / 4 pi.
Texture infiniteRadianceFromPower(const Texture& power);

/// Solid angle that, at full intensity, would carry the power of a spot's cone with its smooth edge.
float spotSolidAngle(float cosInner, float cosOuter);

/// An environment with its importance-sampling tables.
InfiniteSphereEmitter makeInfiniteSphere(const Texture& radiance, const Frame& frame, bool samplable);

} // namespace tungsten
