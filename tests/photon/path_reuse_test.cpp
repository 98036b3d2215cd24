// Connections' light shared among neighbouring visible points.

#include "photon/light/RecordImportance.h"
#include "photon/surface/PathReuse.h"
#include "tungsten/scene/SceneLoader.h"

#include "support/Render.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

/// A grey floor seen from above, with a box on its right half whose lid is parallel to it.
const std::string Table = R"({
     "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.5}],
     "primitives": [{"type": "quad", "bsdf": "grey", "transform": {"scale": [20, 1, 20]}},
                    {"type": "cube", "bsdf": "grey", "transform": {"position": [5, 1, 0], "scale": [10, 2, 20]}},
                    {"type": "point", "emission": 1, "transform": {"position": [0, 5, 0]}}],
     "camera": {"type": "pinhole", "fov": 30, "resolution": [24, 20], "reconstruction_filter": "box",
                "transform": {"position": [0, 20, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}},
     "integrator": {"type": "progressive_transient_photon_map", "transient_time_center": 10, "transient_time_width": 2}})";

class PathReuse : public testing::Test {
  protected:
    test::SceneFile file_{Table};
    LoadedScene loaded_ = loadScene(file_.path(), {});
    Statistics statistics_;
    CameraRecord record_ = recordCameraSubpaths(*loaded_.scene, {true, false}, 1, 0, {.points = true}, statistics_);

    [[nodiscard]] Image share(const std::vector<ConnectionRecord>& received, float radius, float distance = 100.0f) {
        Film film(24, 20, 1);
        reuseAcrossPixels(*loaded_.scene, transport::TimeSensor(loaded_.scene->transport.gate), record_, received,
                          {radius, distance}, 3.0, film, statistics_);
        Image image(24, 20);
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x) image.at(x, y) = film.passPixel(0, x, y);
        return image;
    }
    [[nodiscard]] ConnectionRecord straightDown(uint32_t point) const {
        return {point, 0, 0.0f, Vec3f(0.0f, 1.0f, 0.0f), Rgb(0.0f, 2.0f, 0.0f)};
    }
    /// Scale 3, light 2, albedo 0.5, gate of width 2.
    static constexpr float Reflected = 3.0f * 2.0f * 0.5f * InvPi / 2.0f;
};

TEST_F(PathReuse, BelowOnePixelEachPointKeepsItsOwn) {
    ASSERT_EQ(record_.points.size(), 480u);
    const Image image = share({straightDown(30), straightDown(30), straightDown(200)}, 0.9f);
    for (size_t i = 0; i < 480; ++i)
        EXPECT_NEAR(image.pixels[i].y, i == 30 ? 2.0f * Reflected : i == 200 ? Reflected : 0.0f, 1e-5f) << i;
}

/// The pilot knows what a connection brings: the root of its squares' sum over the image, BSDF and disc included.
TEST_F(PathReuse, IsWhatThePilotCounts) {
    PhotonSettings settings;
    settings.progressive = false;
    settings.gatherRadius = 100.0f;
    const ConnectionRecord light = straightDown(10 * 24 + 5);
    double squares = 0.0;
    for (const Rgb& pixel : share({light}, tuning::SharedPixels).pixels) squares += double(sqr(meanComponent(pixel)));
    const RecordImportance importance(*loaded_.scene, settings, loaded_.scene->transport.gate);
    const double counted = double(importance.ofConnection(light, record_.points[light.point]).value);
    EXPECT_NEAR(counted * 3.0 / 2.0, std::sqrt(squares), 0.05 * std::sqrt(squares)) << "scale 3, gate of width 2";
}

/// A constant stays what it is, also at edges, where fewer neighbours share.
TEST_F(PathReuse, KeepWhatIsTheSameEverywhere) {
    std::vector<ConnectionRecord> received;
    for (uint32_t point = 0; point < 480; ++point) received.push_back(straightDown(point));
    for (const float radius : {1.0f, 2.5f, 4.0f})
        for (const Rgb& pixel : share(received, radius).pixels) EXPECT_NEAR(pixel.y, Reflected, 1e-5f);
}

/// Light received at one point spreads over the disc, keeps its sum, and does not pass from the floor to the parallel
/// lid.
TEST_F(PathReuse, StayOnTheirSurface) {
    const auto height = [&](size_t pixel) { return record_.points[pixel].hit.position.y; };
    size_t atEdge = 10 * 24;
    while (std::abs(height(atEdge) - height(atEdge + 1)) < 1.0f) ++atEdge;
    for (const size_t pixel : {atEdge, atEdge + 1, size_t(10 * 24 + 5)}) {
        const Image image = share({straightDown(uint32_t(pixel))}, 2.5f);
        float sum = 0.0f;
        size_t lit = 0;
        for (size_t i = 0; i < 480; ++i) {
            sum += image.pixels[i].y;
            if (image.pixels[i].y == 0.0f) continue;
            ++lit;
            EXPECT_NEAR(height(i), height(pixel), 0.5f);
            EXPECT_EQ(image.pixels[i].x, 0.0f);
        }
        EXPECT_GE(lit, 12u);
        EXPECT_NEAR(sum, Reflected, 0.25f * Reflected) << "at an edge neighbours have fewer neighbours";
        if (pixel == size_t(10 * 24 + 5)) {
            EXPECT_EQ(lit, 21u) << "away from edges the whole disc";
            EXPECT_NEAR(sum, Reflected, 1e-5f);
        } else {
            EXPECT_LT(lit, 21u) << "nothing across the edge";
        }
    }
}

TEST_F(PathReuse, GoNoFartherThanTheDistance) {
    const uint32_t point = 10 * 24 + 5;
    const Image image = share({straightDown(point)}, 4.0f, 1.0f);
    size_t lit = 0;
    for (size_t i = 0; i < 480; ++i) {
        if (image.pixels[i].y == 0.0f) continue;
        ++lit;
        EXPECT_LE((record_.points[i].hit.position - record_.points[point].hit.position).length(), 1.0f);
    }
    EXPECT_GT(lit, 1u);
}

TEST(ReuseKernel, Shrinks) {
    const auto first = ReuseKernel::of(0.3f, 1.0f), later = ReuseKernel::of(0.3f, 0.5f);
    EXPECT_GT(first.pixels, 1.0f);
    EXPECT_EQ(first.distance, 0.3f);
    EXPECT_FLOAT_EQ(later.pixels, 0.5f * first.pixels);
    EXPECT_FLOAT_EQ(later.distance, 0.5f * first.distance);
}

} // namespace
} // namespace tungsten::photon
