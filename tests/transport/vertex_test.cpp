// Vertices and their connections, and the tests that paths pass on their way: numbers known by hand.

#include "transport/BounceLimits.h"
#include "transport/GateBounds.h"
#include "transport/Vertex.h"

#include "support/SceneFile.h"

#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

namespace tungsten::transport {
namespace {

/// A lamp over a floor; between them a slab of slow fog, 1 high, with index-matched faces.
class Lamp : public testing::Test {
  protected:
    static std::shared_ptr<const Scene> load() {
        const test::SceneFile file(R"({
          "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.2, "sigma_s": 0.3, "speed_of_light": 0.5,
                     "phase_function": {"type": "henyey_greenstein", "g": 0.6}}],
          "primitives": [{"type": "quad", "bsdf": {"type": "lambert", "albedo": 0.5}, "transform": {"scale": 8}},
                         {"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
                          "transform": {"position": [0, 2, 0], "scale": [4, 1, 4]}},
                         {"type": "quad", "bsdf": {"type": "null"}, "emission": 3,
                          "transform": {"position": [0, 4, 0], "scale": 2, "rotation": [180, 0, 0]}},
                         {"type": "directional_point", "power": 1, "transform": {"position": [3, 4, 0]}}],
          "camera": {"resolution": 1, "transform": {"position": [0, 1, 5], "look_at": [0, 0, 0]}},
          "integrator": {"type": "path_tracer"}, "renderer": {}})");
        return loadScene(file.path()).scene;
    }
    /// The point of the floor under (x, z), met by light or from the camera along `direction`.
    [[nodiscard]] Vertex floorAt(float x, float z, const Vec3f& direction, TransportMode mode) const {
        const Vec3f from = Vec3f(x, 0.0f, z) - direction;
        const auto hit = scene_->geometry->intersect({from, direction});
        return {*scene_, makeInteraction(*scene_, *hit, direction), direction, mode, Region{-1, 1.0f}};
    }
    [[nodiscard]] const Emitter& lamp() const { return scene_->emitters[0]; }
    [[nodiscard]] Vertex lampPoint() const { return {*scene_, lamp(), sampleEmissionPoint(lamp(), {0.5f, 0.5f})}; }

    std::shared_ptr<const Scene> scene_ = load();
    Connector connector_{*scene_, true};
    uint64_t rays_ = 0;
};

TEST_F(Lamp, ScatteringHasTheCosineOfTheWayOn) {
    const Vec3f down = Vec3f(0.0f, -1.0f, 0.0f), oblique = Vec3f(0.6f, 0.8f, 0.0f);
    EXPECT_NEAR(floorAt(0, 0, -oblique, TransportMode::Radiance).scattering(-down).x, 0.5f * InvPi, 1e-6f);
    EXPECT_NEAR(floorAt(0, 0, down, TransportMode::Photons).scattering(oblique).x, 0.5f * InvPi * 0.8f, 1e-6f);
    EXPECT_NEAR(floorAt(0, 0, down, TransportMode::Photons).pdf(oblique), InvPi * 0.8f, 1e-6f);
    // Radiance times area (4) and cosine.
    EXPECT_NEAR(lampPoint().scattering(-oblique).x, 3.0f * 4.0f * 0.8f, 1e-5f);
    EXPECT_EQ(lampPoint().scattering(oblique).x, 0.0f);
    const Vertex inFog(scene_->media[0], Vec3f(0, 2, 0), down, Region{0, 0.5f});
    EXPECT_NEAR(inFog.scattering(oblique).x, 0.25f * InvPi * 0.64f / std::pow(1.36f + 1.2f * 0.8f, 1.5f), 1e-6f);
    EXPECT_EQ(inFog.pdf(oblique), inFog.scattering(oblique).x);
}

TEST_F(Lamp, DensitiesPerAreaAreThoseOfThePoint) {
    const Vec3f receiver(1.0f, 0.0f, 0.5f);
    const Vertex light = lampPoint();
    const Vec3f offset = light.position() - receiver, direction = offset / offset.length();
    const float pdf = pdfDirect(lamp(), receiver, light.position(), light.margin().normal);
    EXPECT_NEAR(light.areaDensity(pdf, direction, offset.length()), 0.25f, 1e-6f); // 1 / area
    const Vertex floor = floorAt(0, 0, Vec3f(0, -1, 0), TransportMode::Photons);
    EXPECT_NEAR(floor.areaDensity(2.0f, Vec3f(0.6f, 0.8f, 0.0f), 4.0f), 0.1f, 1e-6f);
    const Vertex inFog(scene_->media[0], Vec3f(0, 2, 0), direction, Region{0, 0.5f});
    EXPECT_NEAR(inFog.areaDensity(2.0f, direction, 4.0f), 0.125f, 1e-6f);
}

TEST_F(Lamp, LightsStartPathsAsTheyEmit) {
    const Vertex light = lampPoint();
    const Vec3f oblique(0.6f, -0.8f, 0.0f);
    EXPECT_NEAR(light.pdf(oblique), 0.8f * InvPi, 1e-6f);
    EXPECT_EQ(light.pdf(-oblique), 0.0f);
    EXPECT_EQ(light.pdfReverse(oblique), 0.0f);
}

TEST_F(Lamp, RegionsAreThoseOfThePathThatComes) {
    const Vertex floor = floorAt(0, 0, Vec3f(0, -1, 0), TransportMode::Photons);
    const Region fog{0, 0.5f};
    EXPECT_EQ(floor.regionTowards({0.0f, 1.0f, 0.0f}).medium, -1);
    EXPECT_EQ(floor.regionTowards({0.0f, 1.0f, 0.0f}, fog).medium, 0);
    EXPECT_EQ(lampPoint().regionTowards({0.0f, -1.0f, 0.0f}, fog).speed, 0.5f);
    EXPECT_TRUE(floor.reflects({0.6f, 0.8f, 0.0f}));
    EXPECT_FALSE(floor.reflects({0.6f, -0.8f, 0.0f}));
}

TEST_F(Lamp, ConnectionsCrossTheFogFromBothEnds) {
    const Vertex light = lampPoint();
    const Vec3f above = light.position();
    const Vertex floor = floorAt(above.x, above.z, Vec3f(-0.6f, -0.8f, 0.0f), TransportMode::Radiance);
    for (const bool fromLight : {false, true}) {
        const Vertex &from = fromLight ? light : floor, &to = fromLight ? floor : light;
        const auto way = connectionSegment(from.position(), to.position());
        ASSERT_TRUE(way);
        const auto connection = connector_.connect(from, Rgb(0.5f), connectionEndpoint(*way, {to, Rgb(4.0f)}), rays_);
        ASSERT_TRUE(connection);
        EXPECT_NEAR(connection->throughput.x, 2.0f * 0.5f * InvPi * 12.0f / 16.0f * std::exp(-0.5f), 1e-5f);
        EXPECT_NEAR(connection->time, 5.0, 1e-5); // 3 at speed 1, 1 at 0.5
        EXPECT_EQ(connection->crossings, 2);
        EXPECT_FALSE(connection->oneSpeed);
    }
    // Behind the lamp there is nothing.
    const Vertex behind(scene_->media[0], Vec3f(0, 5, 0), Vec3f(0, 1, 0), Region{-1, 1.0f});
    const auto down = connectionSegment(behind.position(), floor.position());
    ASSERT_TRUE(down);
    EXPECT_FALSE(connector_.connect(behind, Rgb(1.0f), connectionEndpoint(*down, {floor, Rgb(1.0f)}), rays_));
    EXPECT_FALSE(connectionSegment(above, above));
}

TEST(Connections, ThroughASurfaceGoThroughTheMediumBeyondIt) {
    const test::SceneFile file(R"({
      "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.2, "sigma_s": 0.3, "speed_of_light": 0.5}],
      "primitives": [{"type": "cube", "int_medium": "fog",
                      "bsdf": {"type": "rough_dielectric", "ior": 1.5, "roughness": 0.5}, "transform": {"scale": 2}}],
      "camera": {"resolution": 1}, "integrator": {"type": "path_tracer"}, "renderer": {}})");
    const auto scene = loadScene(file.path()).scene;
    const Vec3f down(0.0f, -1.0f, 0.0f);
    const auto hit = scene->geometry->intersect({Vec3f(0.1f, 2.0f, 0.2f), down});
    ASSERT_TRUE(hit);
    const Vertex top(*scene, makeInteraction(*scene, *hit, down), down, TransportMode::Radiance, Region{-1, 1.0f});
    const ConnectionEndpoint inside{down, 0.8f, Rgb(2.0f), {}};
    uint64_t rays = 0;
    const auto connection = Connector(*scene, false).connect(top, Rgb(0.5f), inside, rays);
    ASSERT_TRUE(connection);
    EXPECT_NEAR(connection->throughput.x, top.scattering(down).x * std::exp(-0.5f * 0.8f), 1e-5f);
    EXPECT_NEAR(connection->time, 0.8 / 0.5, 1e-5);
}

TEST_F(Lamp, OnlySingleDirectionsCannotBeConnected) {
    EXPECT_TRUE(lampPoint().isConnectible());
    EXPECT_TRUE(floorAt(0, 0, Vec3f(0, -1, 0), TransportMode::Radiance).isConnectible());
    const Emitter& laser = scene_->emitters[1];
    EXPECT_FALSE(Vertex(*scene_, laser, sampleEmissionPoint(laser, {0.5f, 0.5f})).isConnectible());
}

TEST(GateBounds, RejectOnlyWhatCannotArrive) {
    SceneFacts facts;
    facts.highestSpeed = 2.0f;
    const TimeGate gate{false, false, 4.0, 1.0, 2}; // [4, 6)
    const GateBounds bounds(gate, facts);
    EXPECT_FALSE(bounds.mayArrive(3.0, 1.9)); // at 3.95
    EXPECT_TRUE(bounds.mayArrive(3.0, 2.0));
    EXPECT_TRUE(bounds.mayArrive(3.0, 2.0 - 1e-6)); // rounding
    EXPECT_TRUE(bounds.mayArrive(3.0, 5.9));
    EXPECT_FALSE(bounds.mayArrive(3.0, 6.1));
    EXPECT_TRUE(bounds.beforeEnd(3.0, 0.0));
    EXPECT_FALSE(bounds.beforeEnd(3.0, 6.1));
    facts.speedsDiffer = true;
    EXPECT_TRUE(GateBounds(gate, facts).mayArrive(3.0, 1.0)); // may be slower
    EXPECT_TRUE(GateBounds(TimeGate{}, facts).mayArrive(0.0, double(Infinity)));
    EXPECT_FALSE(bounds.mayArrive(0.0, double(Infinity)));
    EXPECT_TRUE(bounds.during(TimeGate{false, false, 0.0, 1.0, 1}).mayArrive(0.0, 1.0));
}

TEST(BounceLimits, CountInteractionsAndOrders) {
    TransportSettings settings;
    settings.minBounces = 2;
    settings.maxBounces = 5;
    BounceLimits limits(settings);
    for (int n = 0; n < 8; ++n) {
        EXPECT_EQ(limits.renders(n), n >= 2 && n < 5);
        const auto [least, most] = limits.remaining(n);
        for (int more = 0; more < 8; ++more)
            EXPECT_EQ(more >= least && more <= most, limits.renders(n + more)) << n << " " << more;
    }
    EXPECT_TRUE(limits.orderCounts(0) && limits.orderCounts(1) && !limits.endsAtSurface(1));
    limits.includeSurfaces = limits.lowOrderScattering = false;
    EXPECT_FALSE(limits.orderCounts(0) || limits.orderCounts(1));
    EXPECT_TRUE(limits.orderCounts(2) && limits.endsAtSurface(1) && !limits.endsAtSurface(2));
    EXPECT_FALSE(limits.orderCounts(2, 1)); // the camera's first one met a surface next
    EXPECT_TRUE(limits.mayGoOn(4));         // a path of four more vertices than its ends counts, and none of five
    EXPECT_FALSE(limits.mayGoOn(5));
    Medium fog;
    fog.maxBounces = 2;
    int flights = 0;
    EXPECT_TRUE(BounceLimits::fly(flights, fog));
    EXPECT_EQ(flights, 1);
    EXPECT_TRUE(BounceLimits::fly(flights, fog));
    EXPECT_FALSE(BounceLimits::fly(flights, fog));
}

/// What a ray crosses on its way moves it on by some of the margin; it must still end short of the lamp.
TEST(Visibility, OfALampFromInsideBoxesIsNeverHiddenByTheLampItself) {
    const test::SceneFile file(R"({
      "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0, "sigma_s": 0.1}],
      "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
                      "transform": {"rotation": [10, 15, 5], "scale": 1.4}},
                     {"type": "cube", "bsdf": {"type": "forward"}, "transform": {"rotation": [0, 25, 0], "scale": 1.7}},
                     {"type": "cube", "bsdf": {"type": "forward"}, "transform": {"rotation": [0, 65, 0], "scale": 1.71}},
                     {"type": "sphere", "emission": 1, "bsdf": {"type": "null"},
                      "transform": {"position": [1.2, 1.6, 1.4], "scale": 0.3}}],
      "camera": {"resolution": 1}, "integrator": {"type": "path_tracer"}, "renderer": {}})");
    const auto scene = loadScene(file.path()).scene;
    const Primitive& box = scene->primitives[0];
    uint64_t rays = 0;
    int connected = 0;
    for (uint64_t i = 0; i < 100000; ++i) {
        Sampler sampler(1, RandomStream::Test, 0, i);
        const Vec3f from = (Vec3f(sampler.next1D(), sampler.next1D(), sampler.next1D()) - Vec3f(0.5f)) * 0.9f;
        const auto direct = sampleDirect(scene->emitters[0], from, sampler.next2D());
        if (!direct) continue;
        const ConnectionEndpoint end = connectionEndpoint(*direct);
        const Ray ray{from, end.direction, 0.0f, end.margin.before(end.direction, end.distance)};
        const Visibility seen = traceVisibility(*scene, ray, end.distance, box.inside, rays);
        ASSERT_EQ(seen.crossings, 3) << i;
        ASSERT_FALSE(isBlack(seen.transmittance)) << i;
        ++connected;
    }
    EXPECT_GT(connected, 30000);
}

} // namespace
} // namespace tungsten::transport
