// Environments: radiance from infinitely far away, constant or a bitmap.

#include "tungsten/core/Warp.h"
#include "tungsten/emitter/Power.h"
#include "tungsten/emitter/Sampling.h"

namespace tungsten {

namespace {

/// u = atan2(z, x) / 2pi + 1/2, v = acos(-y) / pi in the local frame: +y is the top row (docs/scene-format.md,
/// section 7.3).
Vec2f uvOf(const InfiniteSphereEmitter& sky, const Vec3f& direction) {
    const Vec3f local = sky.frame.toLocal(direction);
    return {std::atan2(local.z, local.x) * 0.5f * InvPi + 0.5f, std::acos(std::clamp(-local.y, -1.0f, 1.0f)) * InvPi};
}

Vec3f directionOf(const InfiniteSphereEmitter& sky, const Vec2f& uv, float& sinTheta) {
    const float phi = (uv.x - 0.5f) * 2.0f * Pi, theta = uv.y * Pi;
    sinTheta = std::sin(theta);
    return sky.frame.toWorld(Vec3f(std::cos(phi) * sinTheta, -std::cos(theta), std::sin(phi) * sinTheta));
}

/// Direction toward the sky and its density per solid angle.
Vec3f sampleSky(const InfiniteSphereEmitter& sky, const Vec2f& u, float& pdf) {
    if (!sky.distribution) {
        pdf = warp::squareToSpherePdf();
        return warp::squareToSphere(u);
    }
    float density = 0.0f, sinTheta = 0.0f;
    const Vec2f uv = sky.distribution->sample(u, density);
    const Vec3f direction = directionOf(sky, uv, sinTheta);
    pdf = sinTheta > 0.0f ? density / (2.0f * Pi * Pi * sinTheta) : 0.0f;
    return direction.normalized();
}

} // namespace

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

EmissionSample sampleEmission(const InfiniteSphereEmitter& sky, const Vec2f& uPosition, const Vec2f& uDirection) {
    float pdf = 0.0f;
    const Vec3f toSky = sampleSky(sky, uDirection, pdf);
    const Vec2f disk = warp::squareToDisk(uPosition) * sky.sceneRadius;
    const Frame frame(-toSky);
    const Vec3f origin = sky.sceneCentre + toSky * (2.0f * sky.sceneRadius) + frame.s * disk.x + frame.t * disk.y;
    const Rgb radiance = sky.radiance.rgb(uvOf(sky, toSky));
    const Rgb power = pdf > 0.0f ? radiance * (Pi * sqr(sky.sceneRadius) / pdf) : Rgb(0.0f);
    return {{origin, -toSky}, power, pdf, -toSky};
}

std::optional<DirectSample> sampleDirect(const InfiniteSphereEmitter& sky, const Vec3f& receiver, const Vec2f& u) {
    float pdf = 0.0f;
    const Vec3f direction = sampleSky(sky, u, pdf);
    if (pdf <= 0.0f || !sky.samplable) return std::nullopt;
    return DirectSample{direction, Infinity, sky.radiance.rgb(uvOf(sky, direction)) / pdf, pdf, receiver};
}

float pdfSky(const InfiniteSphereEmitter& sky, const Vec3f& direction) {
    if (!sky.distribution) return warp::squareToSpherePdf();
    const Vec2f uv = uvOf(sky, direction);
    const float sinTheta = std::sin(uv.y * Pi);
    return sinTheta > 0.0f ? sky.distribution->pdf(uv) / (2.0f * Pi * Pi * sinTheta) : 0.0f;
}

Rgb skyRadiance(const InfiniteSphereEmitter& sky, const Vec3f& direction) {
    return sky.radiance.rgb(uvOf(sky, direction));
}

} // namespace tungsten
