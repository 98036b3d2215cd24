#include "tungsten/emitter/Infinite.h"

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/EmitterReader.h"

namespace tungsten {

/// u = atan2(z, x) / 2pi + 1/2, v = acos(-y) / pi in the local frame: +y is the top row (docs/scene-format.md,
/// section 7.3).
Vec2f InfiniteSphereEmitter::uvOf(const Vec3f& direction) const {
    const Vec3f local = frame.toLocal(direction);
    return {std::atan2(local.z, local.x) * 0.5f * InvPi + 0.5f, std::acos(std::clamp(-local.y, -1.0f, 1.0f)) * InvPi};
}

Vec3f InfiniteSphereEmitter::directionOf(const Vec2f& uv, float& sinTheta) const {
    const float phi = (uv.x - 0.5f) * 2.0f * Pi, theta = uv.y * Pi;
    sinTheta = std::sin(theta);
    return frame.toWorld(Vec3f(std::cos(phi) * sinTheta, -std::cos(theta), std::sin(phi) * sinTheta));
}

Vec3f InfiniteSphereEmitter::sample(const Vec2f& u, float& density) const {
    if (!distribution) {
        density = warp::squareToSpherePdf();
        return warp::squareToSphere(u);
    }
    float uvDensity = 0.0f, sinTheta = 0.0f;
    const Vec2f uv = distribution->sample(u, uvDensity);
    const Vec3f direction = directionOf(uv, sinTheta);
    density = sinTheta > 0.0f ? uvDensity / (2.0f * Pi * Pi * sinTheta) : 0.0f;
    return direction.normalized();
}

EmissionSample InfiniteSphereEmitter::sampleEmission(const Vec2f& uPosition, const Vec2f& uDirection) const {
    float density = 0.0f;
    const Vec3f toSky = sample(uDirection, density);
    const Vec2f disk = warp::squareToDisk(uPosition) * sceneRadius;
    const Frame around(-toSky);
    const Vec3f origin = sceneCentre + toSky * (2.0f * sceneRadius) + around.s * disk.x + around.t * disk.y;
    const Rgb emitted = radiance.rgb(uvOf(toSky));
    const Rgb power = density > 0.0f ? emitted * (Pi * sqr(sceneRadius) / density) : Rgb(0.0f);
    return {{origin, -toSky}, power, density, -toSky};
}

MaybeDirect InfiniteSphereEmitter::sampleDirect(const Vec3f& receiver, const Vec2f& u) const {
    float density = 0.0f;
    const Vec3f direction = sample(u, density);
    if (density <= 0.0f || !samplable) return std::nullopt;
    return DirectSample{direction, Infinity, radiance.rgb(uvOf(direction)) / density, density, receiver};
}

float InfiniteSphereEmitter::pdf(const Vec3f& direction) const {
    if (!distribution) return warp::squareToSpherePdf();
    const Vec2f uv = uvOf(direction);
    const float sinTheta = std::sin(uv.y * Pi);
    return sinTheta > 0.0f ? distribution->pdf(uv) / (2.0f * Pi * Pi * sinTheta) : 0.0f;
}

float InfiniteSphereEmitter::pdfEmissionDirection(const SurfaceSample&, const Vec3f& direction) const {
    return pdf(-direction);
}

Rgb InfiniteSphereEmitter::environmentRadiance(const Vec3f& direction) const {
    return radiance.rgb(uvOf(direction));
}

InfiniteSphereEmitter makeInfiniteSphere(const Texture& radiance, const Frame& frame, bool samplable) {
    InfiniteSphereEmitter sky;
    sky.radiance = radiance;
    sky.frame = frame;
    sky.samplable = samplable;
    if (radiance.isConstant()) return sky;
    constexpr int Columns = 512, Rows = 256, Strata = 2;
    std::vector<float> weights;
    weights.reserve(size_t(Columns) * Rows);
    const auto vOf = [](int row, int down) { return (float(row) + (float(down) + 0.5f) / Strata) / Rows; };
    for (int row = 0; row < Rows; ++row) {
        float sines[Strata];
        for (int down = 0; down < Strata; ++down) sines[down] = std::sin(vOf(row, down) * Pi);
        for (int column = 0; column < Columns; ++column) {
            float sum = 0.0f;
            for (int i = 0; i < Strata * Strata; ++i) {
                const int across = i % Strata, down = i / Strata;
                const Vec2f uv((float(column) + (float(across) + 0.5f) / Strata) / Columns, vOf(row, down));
                sum += meanComponent(radiance.rgb(uv)) * sines[down];
            }
            weights.push_back(sum);
        }
    }
    // A floor keeps cells that the strata missed within reach.
    const float mean = std::max(float(Distribution1D(weights).total()) / float(weights.size()), 1e-30f);
    for (float& weight : weights) weight += 0.01f * mean;
    sky.distribution = std::make_shared<const Distribution2D>(weights, Columns, Rows);
    return sky;
}

std::optional<InfiniteSphereEmitter> InfiniteSphereEmitter::read(const EmitterReader& fields) {
    Texture radiance = fields.texture("emission", Texture(0.0f), {"radiance", "by direction, from infinitely far away"},
                                      Range::nonNegative());
    const Texture power = fields.texture("power", Texture(0.0f), EmitterReader::PowerMeaning, Range::nonNegative());
    if (fields.has("power")) radiance = power.scaled(Rgb(0.25f * InvPi));
    const bool samplable = fields.flag("sample", true, {"none", "vertices may connect to it"});
    if (!fields.shines(radiance.maximum())) return std::nullopt;
    return makeInfiniteSphere(radiance, fields.placement.rotation(), samplable);
}

} // namespace tungsten
