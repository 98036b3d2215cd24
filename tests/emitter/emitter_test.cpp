// Light sources: power, intensity, connections.

#include "support/ChiSquare.h"

#include "tungsten/emitter/Emitter.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

Emitter withModel(EmitterVariant model) {
    Emitter emitter;
    emitter.model = std::move(model);
    return emitter;
}

/// A quad of side 2 at height 3 that shines downward with radiance 5.
struct QuadLamp {
    Shape shape;
    Emitter emitter;

    QuadLamp() {
        Transform transform;
        transform.x = Vec3f(2, 0, 0);
        transform.y = Vec3f(0, -1, 0);
        transform.z = Vec3f(0, 0, -2);
        transform.translation = Vec3f(0, 3, 0);
        shape = makeQuad(transform);
        emitter = withModel(AreaEmitter{{}, &shape, 0, Texture(5.0f), std::make_shared<const AreaSampler>(shape)});
    }
};

/// A disk of radius 1 that shines downward with radiance 5, into a cone of half angle 60 degrees.
struct ConeDiskLamp {
    Shape shape = Disk{Vec3f(0, 3, 0), 1.0f, Frame(Vec3f(0, -1, 0)), 0.5f};
    Emitter emitter = withModel(AreaEmitter{{}, &shape, 0, Texture(5.0f), std::make_shared<const AreaSampler>(shape)});
};

SpotEmitter spot() {
    SpotEmitter lamp;
    lamp.position = Vec3f(0, 0, 0);
    lamp.direction = Vec3f(0, 0, 1);
    lamp.intensity = Rgb(2.0f);
    lamp.cosInner = 0.75f;
    lamp.cosOuter = 0.5f;
    return lamp;
}

TEST(Emitter, PhotonsCarryTheEmittersPower) {
    const QuadLamp quad;
    const ConeDiskLamp coneDisk;
    CollimatedEmitter beam;
    beam.position = Vec3f(1, 2, 3);
    beam.radius = 0.5f;
    beam.power = Rgb(7.0f);
    InfiniteSphereEmitter sky = makeInfiniteSphere(Texture(0.5f), Frame(), true);
    sky.sceneRadius = 3.0f;
    const std::vector<std::pair<Emitter, double>> cases{
        {withModel(PointEmitter{{}, Vec3f(0.0f), Rgb(3.0f)}), 12.0 * 3.14159265358979},
        {withModel(spot()), 2.0 * 2.0 * 3.14159265358979 * (1.0 - 0.625)},
        {withModel(beam), 7.0},
        {withModel(sky), 0.5 * 4.0 * 9.0 * 3.14159265358979 * 3.14159265358979},
        {quad.emitter, 5.0 * 4.0 * 3.14159265358979},
        {coneDisk.emitter, 5.0 * 3.14159265358979 * 3.14159265358979 * 0.75}};
    for (const auto& [emitter, power] : cases) {
        EXPECT_NEAR(double(emitterPower(emitter).x), power, 1e-4 * power);
        double sum = 0.0, squared = 0.0;
        constexpr int Count = 100000;
        for (uint64_t i = 0; i < Count; ++i) {
            Sampler s(2, RandomStream::Test, 0, i);
            const Vec2f uPosition = s.next2D();
            const double p = double(sampleEmission(emitter, uPosition, s.next2D()).power.x);
            sum += p;
            squared += p * p;
        }
        const double mean = sum / Count, error = std::sqrt(std::max(squared / Count - mean * mean, 0.0) / Count);
        EXPECT_NEAR(mean, power, 4.5 * error + 1e-4 * power);
    }
}

TEST(Emitter, DirectionsFollowTheirDensities) {
    const QuadLamp quad;
    const auto direction = [](const Emitter& emitter) {
        return [&emitter](Sampler& s) -> std::optional<Vec3f> {
            const Vec2f uPosition = s.next2D();
            return sampleEmission(emitter, uPosition, s.next2D()).ray.direction;
        };
    };
    const Emitter point = withModel(PointEmitter{{}, Vec3f(0.0f), Rgb(1.0f)}), cone = withModel(spot());
    EXPECT_GT(test::chiSquareSphere(direction(point), [](const Vec3f&) { return 0.25 / 3.14159265358979; }),
              test::SmallestPValue);
    EXPECT_GT(test::chiSquareSphere(direction(cone),
                                    [](const Vec3f& w) { return w.z >= 0.5f ? 1.0 / 3.14159265358979 : 0.0; }),
              test::SmallestPValue);
    EXPECT_GT(test::chiSquareSphere(direction(quad.emitter),
                                    [](const Vec3f& w) { return double(std::max(-w.y, 0.0f)) / 3.14159265358979; }),
              test::SmallestPValue);
}

/// What arrives straight below a disk with a cone, by connections and by photons on a small target.
TEST(Emitter, ConnectionsAndPhotonsAgreeOnTheConeOfADisk) {
    const ConeDiskLamp lamp;
    // Two below, a cone of 60 degrees reaches 3.46 beyond the disk's rim at 1.
    for (const float aside : {0.0f, 3.5f, 5.0f}) {
        const Vec3f target(aside, 1.0f, 0.0f);
        constexpr int Count = 400000;
        constexpr float Radius = 0.3f;
        double connected = 0.0, hits = 0.0;
        for (uint64_t i = 0; i < Count; ++i) {
            Sampler s(3, RandomStream::Test, 0, i);
            if (const auto light = sampleDirect(lamp.emitter, target, s.next2D()))
                connected += double(light->weight.x * light->direction.y);
            const Vec2f uPosition = s.next2D();
            const EmissionSample photon = sampleEmission(lamp.emitter, uPosition, s.next2D());
            EXPECT_LE(photon.pdfDirection, 1.01f * InvPi / 0.75f);
            const Vec3f at = photon.ray.at((target.y - photon.ray.origin.y) / photon.ray.direction.y);
            if ((at - target).length2() < Radius * Radius) hits += double(photon.power.x);
        }
        const double flux = hits / Count / double(Pi * Radius * Radius), irradiance = connected / Count;
        const double each = double(emitterPower(lamp.emitter).x) / Count / double(Pi * Radius * Radius);
        EXPECT_NEAR(flux, irradiance, 5.0 * std::sqrt(std::max(flux, irradiance) * each) + 0.01 * irradiance) << aside;
        EXPECT_EQ(irradiance > 0.0, aside < 5.0f) << aside;
    }
}

TEST(Emitter, ConnectionsGiveTheIrradianceOfClosedForms) {
    const auto point = sampleDirect(withModel(PointEmitter{{}, Vec3f(0, 2, 0), Rgb(3.0f)}), Vec3f(0.0f), {0.5f, 0.5f});
    ASSERT_TRUE(point);
    EXPECT_FLOAT_EQ(point->weight.x, 0.75f);
    EXPECT_FLOAT_EQ(point->distance, 2.0f);
    EXPECT_EQ(point->pdf, 0.0f);
    EXPECT_FALSE(sampleDirect(withModel(spot()), Vec3f(0, 0, -1), {0.5f, 0.5f}));

    // Irradiance under a disk of radius R at height h: pi L R^2 / (R^2 + h^2).
    Shape disk = Disk{Vec3f(0, 2, 0), 1.5f, Frame(Vec3f(0, -1, 0)), 0.0f};
    const Emitter lamp = withModel(AreaEmitter{{}, &disk, 0, Texture(4.0f), std::make_shared<const AreaSampler>(disk)});
    double sum = 0.0, squared = 0.0;
    constexpr int Count = 200000;
    for (uint64_t i = 0; i < Count; ++i) {
        Sampler s(3, RandomStream::Test, 0, i);
        const auto light = sampleDirect(lamp, Vec3f(0.0f), s.next2D());
        if (!light) continue;
        EXPECT_NEAR(light->pdf, pdfDirect(lamp, Vec3f(0.0f), light->position, Vec3f(0, -1, 0)), 1e-4f * light->pdf);
        const double e = double(light->weight.x * light->direction.y);
        sum += e;
        squared += e * e;
    }
    const double expected = 3.14159265358979 * 4.0 * 2.25 / (2.25 + 4.0), mean = sum / Count;
    EXPECT_NEAR(mean, expected, 4.5 * std::sqrt((squared / Count - mean * mean) / Count));
}

TEST(Emitter, DirectionsStayInTheConeWithItsDensity) {
    const QuadLamp quad;
    const ConeDiskLamp coneDisk;
    Sampler sampler(8, RandomStream::Test, 0, 0);
    for (const Emitter& emitter : {withModel(PointEmitter{{}, Vec3f(0.0f), Rgb(3.0f)}), withModel(spot()), quad.emitter,
                                   coneDisk.emitter, withModel(makeInfiniteSphere(Texture(2.0f), Frame(), true))})
        for (int i = 0; i < 100; ++i) {
            const Vec2f u = sampler.next2D();
            const EmissionSample sample = sampleEmission(emitter, u, sampler.next2D());
            const SurfaceSample start{sample.ray.origin, sample.normal, {0.0f, 0.0f}};
            const EmissionCone cone = emissionCone(emitter, start);
            const float pdf = pdfEmissionDirection(emitter, start, sample.ray.direction);
            EXPECT_LE(1.0f - sample.ray.direction.dot(cone.axis), cone.widest + 1e-5f) << emitter.model.index();
            EXPECT_NEAR(pdf, sample.pdfDirection, 1e-4f * pdf) << emitter.model.index();
        }
}

TEST(Emitter, PhotonsStartInsideTheBoundingSphere) {
    const QuadLamp quad;
    CollimatedEmitter beam;
    beam.position = Vec3f(1, 2, 3);
    beam.radius = 0.5f;
    Sampler sampler(9, RandomStream::Test, 0, 0);
    for (const Emitter& emitter : {withModel(spot()), withModel(beam), quad.emitter}) {
        const BoundingSphere sphere = boundingSphere(emitter);
        for (int i = 0; i < 100; ++i) {
            const Vec3f start = sampleEmission(emitter, sampler.next2D(), Vec2f(0.5f)).ray.origin;
            EXPECT_LE((start - sphere.centre).length(), sphere.radius * 1.0001f) << emitter.model.index();
        }
    }
}

TEST(Emitter, AreaLightsAreOneSided) {
    const QuadLamp quad;
    EXPECT_EQ(emittedRadiance(quad.emitter, {0, 0}, Vec3f(0, -1, 0), Vec3f(0, -1, 0)), Rgb(5.0f));
    EXPECT_EQ(emittedRadiance(quad.emitter, {0, 0}, Vec3f(0, -1, 0), Vec3f(0, 1, 0)), Rgb(0.0f));
    EXPECT_FALSE(sampleDirect(quad.emitter, Vec3f(0, 5, 0), {0.5f, 0.5f}));
    const SurfaceSample start = sampleEmissionPoint(quad.emitter, {0.2f, 0.7f});
    EXPECT_FLOAT_EQ(start.position.y, 3.0f);
    EXPECT_FLOAT_EQ(emittedIntensity(quad.emitter, start, Vec3f(0, -1, 0)).x, 20.0f);
}

TEST(Emitter, EnvironmentMapsAreImportanceSampled) {
    auto bitmap = std::make_shared<Bitmap>();
    bitmap->width = 8;
    bitmap->height = 4;
    bitmap->channels = 3;
    for (int i = 0; i < 32 * 3; ++i) bitmap->hdr.push_back(i < 12 ? 20.0f : 0.5f);
    const Emitter sky = withModel(makeInfiniteSphere(Texture(std::shared_ptr<const Bitmap>(bitmap)), Frame(), true));
    const auto sample = [&](Sampler& s) -> std::optional<Vec3f> {
        return sampleDirect(sky, Vec3f(0.0f), s.next2D())->direction;
    };
    EXPECT_GT(test::chiSquareSphere(
                  [&](Sampler& s) {
                      // The test's pole is z, the map's is y.
                      const Vec3f w = *sample(s);
                      return std::optional(Vec3f(w.z, w.x, w.y));
                  },
                  [&](const Vec3f& w) { return double(pdfDirectInfinite(sky, Vec3f(w.y, w.z, w.x))); }),
              test::SmallestPValue);
    Sampler s(1, RandomStream::Test, 0, 0);
    const auto light = sampleDirect(sky, Vec3f(0.0f), s.next2D());
    EXPECT_NEAR(light->weight.x * light->pdf, environmentRadiance(sky, light->direction).x,
                1e-3f * light->weight.x * light->pdf);
    for (int i = 0; i < 100; ++i) {
        const auto drawn = sampleDirect(sky, Vec3f(0.0f), s.next2D());
        EXPECT_NEAR(drawn->pdf, pdfDirectInfinite(sky, drawn->direction), 1e-3f * drawn->pdf);
    }
}

TEST(Power, ConversionsOfTheFormat) {
    EXPECT_FLOAT_EQ(pointIntensityFromPower(Rgb(4.0f * Pi)).x, 1.0f);
    EXPECT_FLOAT_EQ(directionalPointPower(Rgb(1.0f)).x, 4.0f * Pi);
    EXPECT_FLOAT_EQ(collimatedPowerFromEmission(Rgb(3.0f), 0.0f).x, 3.0f);
    EXPECT_FLOAT_EQ(collimatedPowerFromEmission(Rgb(3.0f), 2.0f).x, 12.0f * Pi);
    EXPECT_FLOAT_EQ(collimatedPowerFromPower(Rgb(3.0f), 2.0f).x, 3.0f);
    EXPECT_FLOAT_EQ(areaRadianceFromPower(Texture(Pi), 2.0f).rgb({0, 0}).x, 0.5f);
}

} // namespace
} // namespace tungsten
