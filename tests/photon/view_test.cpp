// What the camera sees, and directions that leave emitters.

#include "photon/light/PhotonGuidance.h"
#include "photon/light/StepsToCamera.h"

#include "tungsten/core/Warp.h"

#include "support/ChiSquare.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr Rgb White{1.0f, 1.0f, 1.0f};

/// At (1, 2, 3), looking along a slanted axis.
Camera slantedCamera(const decltype(Camera::model)& model, FilterType filter = FilterType::Tent) {
    Camera camera;
    camera.model = model;
    camera.resolution = {30, 20};
    camera.filter = ReconstructionFilter(filter);
    const Frame frame(Vec3f(0.4f, -0.3f, 0.8f).normalized());
    camera.toWorld = {frame.s, frame.t, frame.n, Vec3f(1.0f, 2.0f, 3.0f)};
    return camera;
}

template <typename Directions>
double pValue(const Directions& directions) {
    return test::chiSquareSphere(
        [&](Sampler& sampler) {
            const Vec2f u = sampler.next2D();
            const darts::Vec3 d = directions.sample(u.x, u.y);
            return std::optional<Vec3f>(Vec3f(d.x, d.y, d.z));
        },
        [&](const Vec3f& d) { return double(directions.pdf(darts::vec3(d))); });
}

struct ViewCase {
    const char* name;
    decltype(Camera::model) model;
    FilterType filter;
};
class Sight : public testing::TestWithParam<ViewCase> {};

/// A photon culled although some ray passes near it would be missing from the image.
TEST_P(Sight, MissesNoPointNearACameraRay) {
    const Camera camera = slantedCamera(GetParam().model, GetParam().filter);
    const CameraView view(camera);
    Sampler sampler(3, RandomStream::Test, 0, 0);
    int hidden = 0;
    for (int i = 0; i < 50000; ++i) {
        // Rays at the image's edge and beyond by the filter matter most: every other one leaves a border pixel.
        Vec2i pixel(int(sampler.next1D() * 30.0f), int(sampler.next1D() * 20.0f));
        if (i % 4 == 0) pixel.x = i % 8 == 0 ? 0 : 29;
        if (i % 4 == 2) pixel.y = i % 8 == 2 ? 0 : 19;
        const Ray ray = camera.generateRay(pixel, sampler.next2D(), sampler.next2D());
        const float radius = i % 3 == 0 ? 1.0f : 0.05f, t = 5.0f * sampler.next1D();
        const Vec3f offset = warp::squareToSphere(sampler.next2D()) * (0.9999f * radius);
        EXPECT_TRUE(view.sees(ray.at(t) + offset, radius)) << i;
        const Vec3f anywhere = camera.position() + warp::squareToSphere(sampler.next2D()) * 5.0f;
        if (!view.sees(anywhere, 0.05f)) ++hidden;
    }
    EXPECT_GT(hidden, 25000) << "the test must also say no";
}

TEST_P(Sight, HoldsAnIntervalOfARay) {
    const Camera camera = slantedCamera(GetParam().model, GetParam().filter);
    const bool pinhole = std::holds_alternative<Pinhole>(camera.model);
    const CameraView view(camera);
    Sampler sampler(5, RandomStream::Test, 0, 0);
    int inside = 0, outside = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3f origin = camera.position() + warp::squareToSphere(sampler.next2D()) * (5.0f * sampler.next1D());
        const Vec3f direction = warp::squareToSphere(sampler.next2D());
        const float radius = i % 3 == 0 ? 1.0f : 0.05f;
        const FlightPart part = view.seenPart(origin, direction, radius);
        for (int k = 0; k < 20; ++k) {
            const float s = 8.0f * sampler.next1D();
            const bool sees = view.sees(origin + direction * s, radius),
                       held = double(s) >= part.start && double(s) <= part.end;
            EXPECT_TRUE(held || !sees) << "lost: " << i << ' ' << s << " of " << part.start << " .. " << part.end;
            const bool wellInside = double(s) > part.start + 0.01 && double(s) < part.end - 0.01;
            if (pinhole && wellInside) {
                EXPECT_TRUE(view.sees(origin + direction * s, radius + 0.001f)) << i << ' ' << s;
            }
            ++(held ? inside : outside);
        }
    }
    EXPECT_GT(inside, 1000);
    if (pinhole) {
        EXPECT_GT(outside, 5000);
    }
}

INSTANTIATE_TEST_SUITE_P(Cameras, Sight,
                         testing::Values(ViewCase{"Pinhole", Pinhole{60.0f}, FilterType::Box},
                                         ViewCase{"Tele", Pinhole{5.0f}, FilterType::Lanczos},
                                         ViewCase{"Wide", Pinhole{110.0f}, FilterType::Gaussian},
                                         ViewCase{"Lens", ThinLens{50.0f, 3.0f, 0.2f}, FilterType::Tent},
                                         ViewCase{"NearFocus", ThinLens{40.0f, 0.5f, 0.1f}, FilterType::Box}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(EmissionDirections, FollowTheirDensity) {
    SurfaceSample start{};
    start.normal = Vec3f(0.48f, -0.6f, 0.64f);
    Emitter emitter;
    emitter.model = PointEmitter{{}, Vec3f(0.0f), White};
    EXPECT_GT(pValue(EmissionDirections(emitter, start)), test::SmallestPValue);
    for (const float coneAngle : {90.0f, 60.0f, 30.0f}) {
        const Shape disk = makeDisk(Transform{}, coneAngle);
        emitter.model = AreaEmitter{{}, &disk, 0, Texture(1.0f), nullptr};
        EXPECT_GT(pValue(EmissionDirections(emitter, start)), test::SmallestPValue) << coneAngle;
    }
    for (const float cosOuter : {-0.3f, 0.5f, 0.9f}) {
        emitter.model = SpotEmitter{{}, Vec3f(0.0f), start.normal, White, 0.95f, cosOuter};
        EXPECT_GT(pValue(EmissionDirections(emitter, start)), test::SmallestPValue) << cosOuter;
    }
}

TEST(EmissionDirections, FollowTheirDensityTowardsABody) {
    SurfaceSample start{};
    start.position = Vec3f(0.0f);
    start.normal = Vec3f(0.48f, -0.6f, 0.64f);
    const transport::MediumSphere body{Vec3f(-3.0f, 3.0f, -3.0f), 1.0f}, around{Vec3f(0.1f, 0.0f, 0.0f), 1.0f};
    const std::vector<transport::MediumSphere> bodies = {body, around};
    Emitter emitter;
    emitter.model = PointEmitter{{}, Vec3f(0.0f), White};
    const EmissionDirections point(emitter, start, bodies);
    const darts::Vec3 axis = darts::vec3(body.centre.normalized());
    const double widest = 1.0 - std::sqrt(1.0 - 1.0 / 27.0);
    std::vector<double> edges{0.0, 0.3 * widest, 0.6 * widest, widest + 1e-6, 2.0 * widest};
    for (int i = 1; i <= 20; ++i) edges.push_back(0.1 * i + 1e-7);
    const double p = test::chiSquareInterval(
        [&](Sampler& sampler) {
            const Vec2f u = sampler.next2D();
            return double(darts::oneMinusCosine(point.sample(u.x, u.y), axis));
        },
        [&](double h) { return 2.0 * double(Pi) * double(point.pdf(darts::directionAbout(axis, float(h), 0.3f))); },
        edges);
    EXPECT_GT(p, test::SmallestPValue);
    // A fifth goes there, and what does not is hardly brighter for it.
    EXPECT_NEAR(point.pdf(axis), 0.8 * 0.25 * double(InvPi) + 0.2 / (2.0 * double(Pi) * widest), 1e-3);
    // Behind a surface's back there is nothing to light.
    const Shape disk = makeDisk(Transform{}, 90.0f);
    emitter.model = AreaEmitter{{}, &disk, 0, Texture(1.0f), nullptr};
    EXPECT_NEAR(EmissionDirections(emitter, start, bodies).pdf(darts::vec3(start.normal)), InvPi, 1e-5f);
}

/// Also at the edge of a narrow cone, where rounding is a large part of the angle.
TEST(EmissionDirections, HaveADensityWhereverTheyAreDrawn) {
    Sampler sampler(1, RandomStream::Test, 0, 0);
    for (const float degrees : {0.1f, 0.15f, 1.0f, 30.0f, 120.0f}) {
        int without = 0;
        for (int i = 0; i < 200000; ++i) {
            SpotEmitter spot{};
            spot.position = Vec3f(0.0f);
            spot.direction = warp::squareToSphere(sampler.next2D());
            spot.cosOuter = std::cos(degrees * Pi / 180.0f);
            const EmissionDirections directions(Emitter{"", spot}, {});
            const float u = i % 2 == 0 ? 0x1.fffffep-1f : sampler.next1D(); // often the edge itself
            without += directions.pdf(directions.sample(u, sampler.next1D())) > 0.0f ? 0 : 1;
        }
        EXPECT_EQ(without, 0) << degrees;
    }
}

/// The integral of the density over what the emitter lights: the emission weighted by it is the emitter's power.
TEST(EmissionDirections, CarryThePowerOfTheEmitter) {
    std::vector<Emitter> emitters(3);
    const Shape disk = makeDisk(Transform{}, 40.0f);
    emitters[2].model = AreaEmitter{{}, &disk, 0, Texture(1.0f), std::make_shared<const AreaSampler>(disk)};
    emitters[0].model = PointEmitter{{}, Vec3f(0.0f), White};
    emitters[1].model = SpotEmitter{{}, Vec3f(0.0f), Vec3f(0.48f, -0.6f, 0.64f), White, 0.9f, 0.6f};
    // The cosine tells the edge of a narrow cone in ten steps.
    for (const Vec3f& axis : {Vec3f(2.0f, 4.0f, 2.0f), Vec3f(-1.0f, 2.0f, 5.0f), Vec3f(3.0f, -1.0f, 0.2f)})
        emitters.push_back(Emitter{"", SpotEmitter{{},
                                                   Vec3f(0.0f),
                                                   axis.normalized(),
                                                   White,
                                                   std::cos(0.135f * Pi / 180.0f),
                                                   std::cos(0.15f * Pi / 180.0f)}});
    const std::vector<transport::MediumSphere> bodies = {{Vec3f(1.0f, -4.0f, 3.0f), 0.6f},
                                                         {Vec3f(1.0f, 3.0f, 0.5f), 0.8f}};
    for (const bool towards : {false, true})
        for (const Emitter& emitter : emitters) {
            const SurfaceSample start = sampleEmissionPoint(emitter, Vec2f(0.5f, 0.5f));
            const EmissionDirections directions(emitter, start,
                                                towards ? bodies : std::vector<transport::MediumSphere>());
            double sum = 0.0;
            constexpr int Side = 500;
            for (int i = 0; i < Side * Side; ++i) {
                const darts::Vec3 d =
                    directions.sample((float(i % Side) + 0.5f) / float(Side), (float(i / Side) + 0.5f) / float(Side));
                sum += double(emittedIntensity(emitter, start, Vec3f(d.x, d.y, d.z)).x) / double(directions.pdf(d));
            }
            const double power = double(emitterPower(emitter).x);
            EXPECT_NEAR(sum / (Side * Side), power, 4e-3 * power);
        }
}

} // namespace
} // namespace tungsten::photon
