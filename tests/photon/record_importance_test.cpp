// What the pilot of light paths takes records for, against the images that they make.

#include "photon/light/RecordImportance.h"
#include "photon/primitives/points/Points.h"

#include "tungsten/scene/SceneLoader.h"

#include "support/Render.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// Fog everywhere, and what `primitives` adds.
std::string fogWith(const std::string& primitives) {
    return R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.2, "sigma_a": 0,
      "speed_of_light": 1}],
     "bsdfs": [{"name": "mirror", "type": "mirror"}],
     "primitives": [{"type": "point", "emission": 1, "transform": {"position": [0, 9, 0]}})" +
           primitives + R"(],
     "camera": {"type": "pinhole", "fov": 30, "resolution": [24, 20], "reconstruction_filter": "box", "medium": "fog",
                "transform": {"position": [0, 0, 10], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
     "integrator": {"type": "progressive_transient_photon_map", "transient_time_center": 16,
                    "transient_time_width": 32}})";
}

class Importance {
  public:
    explicit Importance(const std::string& scene) : file_(scene) {}
    [[nodiscard]] Contribution of(const Vec3f& position) const { return importance_.of(photon(position))[0]; }
    /// The root of the squares' sum over the pixels that such a photon covers.
    [[nodiscard]] double inImage(const Vec3f& position) {
        Film film(24, 20, 1);
        Points::splat(*loaded_.scene, sensor_, {&record_}, {{photon(position)}, Radius}, 1.0, film, {});
        double squares = 0.0;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x) squares += double(sqr(meanComponent(film.passPixel(0, x, y))));
        return std::sqrt(squares);
    }

  private:
    static constexpr float Radius = 1.5f;
    static PhotonSettings settings() {
        PhotonSettings settings;
        settings.volumeRadius = Radius;
        return settings;
    }
    static Photon photon(const Vec3f& position) { return {2.0, position, Vec3f(1.0f, 0.0f, 0.0f), Rgb(1.0f), 1, 0}; }

    test::SceneFile file_;
    LoadedScene loaded_ = loadScene(file_.path(), {});
    transport::TimeSensor sensor_{loaded_.scene->transport.gate};
    Statistics statistics_;
    CameraRecord record_ = recordCameraSubpaths(*loaded_.scene, {true, false}, 1, 0, {}, statistics_);
    RecordImportance importance_{*loaded_.scene, settings(), sensor_};
};

TEST(RecordImportance, IsTheRootOfSquaresInTheImage) {
    Importance fog(fogWith(""));
    const double before = double(fog.of({0.0f, 0.0f, 0.0f}).value) / fog.inImage({0.0f, 0.0f, 0.0f});
    for (const Vec3f& position : {Vec3f(0.5f, 0.2f, -8.0f), Vec3f(-0.3f, 0.4f, 3.0f), Vec3f(1.0f, -0.6f, 1.0f)})
        EXPECT_NEAR(double(fog.of(position).value) / fog.inImage(position), before, 0.15 * before) << position.z;
}

/// Unless a mirror may show it.
TEST(RecordImportance, IsNothingBesideTheView) {
    Importance fog(fogWith("")), mirrored(fogWith(R"(, {"type": "quad", "bsdf": "mirror",
        "transform": {"position": [0, -9, 0], "scale": 0.1}})"));
    for (const Vec3f& position : {Vec3f(7.0f, 0.0f, 0.0f), Vec3f(0.0f, -6.0f, 0.0f), Vec3f(0.0f, 0.0f, 12.0f)}) {
        EXPECT_EQ(fog.inImage(position), 0.0);
        EXPECT_EQ(fog.of(position).value, 0.0f);
        EXPECT_GT(mirrored.of(position).value, 0.0f);
    }
}

/// Those that do not meet are not taken to meet, also to either side of the image's centre.
TEST(RecordImportance, CellsAreAsWideAsRecords) {
    const Importance fog(fogWith(""));
    for (const float x : {-4.0f, -0.1f, 2.5f}) {
        EXPECT_NE(fog.of({x, 0.5f, -5.0f}).cell, fog.of({x + 3.5f, 0.5f, -5.0f}).cell) << x;
        EXPECT_NE(fog.of({0.5f, x, -5.0f}).cell, fog.of({0.5f, x + 3.5f, -5.0f}).cell) << x;
    }
    EXPECT_EQ(fog.of({0.4f, 0.5f, -5.0f}).cell, fog.of({0.6f, 0.7f, -5.0f}).cell);
}

} // namespace
} // namespace tungsten::photon
