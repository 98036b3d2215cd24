// Radii that scenes leave open.

#include "photon/PhotonSettings.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/PathsAndPhotons.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// A wall 10 in front of a camera that sees 2 tan(45 degrees / 2) of a unit of depth.
std::string wall(const std::string& more, double scale = 1.0) {
    const auto number = [&](double value) { return std::to_string(scale * value); };
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": )" + std::to_string(0.2 / scale) + R"(},
                         {"name": "dense", "type": "homogeneous", "sigma_s": )" +
           std::to_string(1.0 / scale) + R"(}],
        "primitives": [{"type": "quad", "bsdf": {"type": "lambert"}, "transform": {"scale": )" +
           number(100) + R"(}},
                       {"type": "point", "emission": 1, "transform": {"position": [0, )" +
           number(5) + R"(, 0]}}],
        "camera": {"type": "pinhole", "fov": 45, "resolution": [64, 64], )" +
           more + R"("transform": {"position": [0, )" + number(10) + R"(, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}},
        "integrator": {"type": "progressive_transient_photon_map", "volume_photon_type": "beams", "photon_count": 100,
                       "transient_time_center": 12, "transient_time_width": 8}})";
}

DefaultRadius radiusOf(const std::string& json, const std::vector<std::string>& overrides = {}) {
    const test::SceneFile file(json);
    return DefaultRadius::of(*loadScene(file.path(), {{}, overrides}).scene);
}

TEST(DefaultRadius, IsAHundredthOfWhatTheImageSpans) {
    const double span = 2.0 * std::tan(22.5 * 3.14159265 / 180.0);
    EXPECT_NEAR(double(radiusOf(wall("")).radius), 0.1 * span, 0.004 * span) << "at the wall";
    const std::string fog = R"("medium": "fog", )", dense = R"("medium": "dense", )";
    EXPECT_NEAR(double(radiusOf(wall(fog)).radius), 0.1 * span, 0.004 * span) << "15, three free paths, are farther";
    const double chord = 2.0 * std::sin(22.5 * 3.14159265 / 180.0); // between the ends of rays of equal length
    EXPECT_NEAR(double(radiusOf(wall(dense)).radius), 0.03 * chord, 0.0005) << "three free paths";
}

TEST(DefaultRadius, FollowsNarrowFramesDownToATenth) {
    const std::string width = "integrator.transient_time_width=";
    const float wide = radiusOf(wall("")).radius;
    EXPECT_FLOAT_EQ(radiusOf(wall(""), {width + "0.05"}).radius, 0.05f);
    EXPECT_FLOAT_EQ(radiusOf(wall(""), {width + "1e-6"}).radius, 0.1f * wide);
    EXPECT_NE(radiusOf(wall(""), {width + "0.05"}).reason.find("travels in a frame"), std::string::npos);
}

TEST(DefaultRadius, IsALengthWhateverTheSpeedOfLight) {
    const std::string width = "integrator.transient_time_width=", speed = "integrator.vacuum_speed_of_light=";
    EXPECT_FLOAT_EQ(radiusOf(wall(""), {width + "0.1", speed + "0.5"}).radius, 0.05f);
    EXPECT_FLOAT_EQ(radiusOf(wall(""), {width + "0.025", speed + "2"}).radius, 0.05f);
    EXPECT_FLOAT_EQ(radiusOf(wall(R"("medium": "fog", )"), {width + "0.025", "media.fog.speed_of_light=2"}).radius,
                    0.05f);
}

TEST(DefaultRadius, GrowsWithTheScene) {
    const std::string steady = "integrator.transient_time_width=1e9";
    for (const double scale : {1e-3, 1e3})
        EXPECT_NEAR(double(radiusOf(wall("", scale), {steady}).radius) / scale, double(radiusOf(wall("")).radius),
                    1e-3);
}

TEST(DefaultRadius, IsWhatBeamsTakeWithoutOneAndThePlanNamesIt) {
    const std::vector<std::string> fog{"camera.medium=fog", "primitives.1.ext_medium=fog"};
    std::vector<std::string> same = fog;
    same.push_back("integrator.volume_gather_radius=" + std::to_string(radiusOf(wall(""), fog).radius));
    const auto mean = [](const std::vector<std::string>& overrides) {
        return test::renderPhotons(wall(""), {overrides, 2, 1})->mean();
    };
    EXPECT_GT(mean(fog), 0.0);
    EXPECT_NEAR(mean(fog), mean(same), 1e-4 * mean(same)) << "to the digits that are given";
}

} // namespace
} // namespace tungsten::photon
