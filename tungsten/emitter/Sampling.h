#pragma once
// Per-model sampling, dispatched by Emitter.cpp: point-like sources in Point.cpp, surfaces in Area.cpp, environments in
// Infinite.cpp.

#include "tungsten/emitter/Emitter.h"

namespace tungsten {

EmissionSample sampleEmission(const PointEmitter& point, const Vec2f& uPosition, const Vec2f& uDirection);
EmissionSample sampleEmission(const SpotEmitter& spot, const Vec2f& uPosition, const Vec2f& uDirection);
EmissionSample sampleEmission(const DirectionalPointEmitter& laser, const Vec2f& uPosition, const Vec2f& uDirection);
EmissionSample sampleEmission(const CollimatedEmitter& laser, const Vec2f& uPosition, const Vec2f& uDirection);
EmissionSample sampleEmission(const AreaEmitter& area, const Vec2f& uPosition, const Vec2f& uDirection);
EmissionSample sampleEmission(const InfiniteSphereEmitter& sky, const Vec2f& uPosition, const Vec2f& uDirection);

std::optional<DirectSample> sampleDirect(const PointEmitter& point, const Vec3f& receiver, const Vec2f& u);
std::optional<DirectSample> sampleDirect(const SpotEmitter& spot, const Vec3f& receiver, const Vec2f& u);
std::optional<DirectSample> sampleDirect(const AreaEmitter& area, const Vec3f& receiver, const Vec2f& u);
std::optional<DirectSample> sampleDirect(const InfiniteSphereEmitter& sky, const Vec3f& receiver, const Vec2f& u);

/// Density per solid angle of the directions towards an environment that both draw.
float pdfSky(const InfiniteSphereEmitter& sky, const Vec3f& direction);
Rgb skyRadiance(const InfiniteSphereEmitter& sky, const Vec3f& direction);

} // namespace tungsten
