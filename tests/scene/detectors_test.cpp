// Cameras of detectors: what is read, what is refused, and what they hold.

#include "scene/problems_of.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

using test::SceneFile;

std::string scene(const std::string& camera) {
    return R"({"primitives": [{"name": "block", "type": "cube", "transform": {"position": [0, 0, 5], "scale": 2}},
        {"name": "lamp", "type": "point", "emission": 1, "transform": {"position": [0, 3, 0]}}],
        "camera": {"type": "detectors", )" +
           camera + R"(}, "integrator": {"type": "path_tracer"}})";
}
std::string detectorProblems(const std::string& camera) {
    return test::problemsOf(scene(camera));
}
std::string detectorWarnings(const std::string& camera) {
    return test::warningsOf(scene(camera));
}

TEST(Detectors, AreARowOfPixels) {
    const SceneFile file(scene(R"("transform": {"position": [1, 0, 0]}, "detectors": [
        {"name": "fibre", "position": [0, 1, 0], "direction": [0, 0, 2], "radius": 0.1, "numerical_aperture": 0.22},
        {"radius": 0.5}])"));
    const LoadedScene loaded = loadScene(file.path());
    const Camera& camera = loaded.scene->camera;
    EXPECT_EQ(camera.resolution, Vec2i(2, 1));
    const auto& row = std::get<Detectors>(camera.model).row;
    ASSERT_EQ(row.size(), 2u);
    EXPECT_EQ(row[0].name, "fibre");
    EXPECT_EQ(row[0].position, Vec3f(1, 1, 0));
    EXPECT_EQ(row[0].frame.n, Vec3f(0, 0, 1));
    EXPECT_NEAR(row[0].etendue(), M_PI * M_PI * 0.01 * 0.0484, 1e-8);
    EXPECT_FLOAT_EQ(row[1].aperture, 1.0f);
    EXPECT_FALSE(camera.hasSinglePosition());
    EXPECT_EQ(detectorWarnings(R"("detectors": [{"radius": 0.1}])"), "");
}

/// Their own axes, not the world's, are what positions and directions count along.
TEST(Detectors, TurnWithTheirTransform) {
    const SceneFile file(scene(R"("transform": {"position": [1, 0, 0], "look_at": [5, 0, 0], "up": [0, 1, 0]},
        "detectors": [{"position": [0, 0.5, 2], "radius": 0.1}, {"direction": [0, 3, 0], "radius": 0.1},
        {"direction": [0, 0.6, 0.8], "radius": 0.1}])"));
    const LoadedScene loaded = loadScene(file.path());
    const auto& row = std::get<Detectors>(loaded.scene->camera.model).row;
    ASSERT_EQ(row.size(), 3u);
    EXPECT_LT((row[0].position - Vec3f(3, 0.5f, 0)).length(), 1e-6f);
    EXPECT_LT((row[0].frame.n - Vec3f(1, 0, 0)).length(), 1e-6f);
    EXPECT_LT((row[1].frame.n - Vec3f(0, 1, 0)).length(), 1e-6f);
    EXPECT_LT((row[2].frame.n - Vec3f(0.8f, 0.6f, 0)).length(), 1e-6f);
}

TEST(Detectors, RefuseWhatIsNone) {
    const std::vector<std::pair<std::string, std::string>> bad{
        {R"("medium": "")", "camera.detectors: expected an array of 1 to 65536"},
        {R"("detectors": [])", "camera.detectors: expected an array"},
        {R"("detectors": [{"radius": 0}])", "camera.detectors[0].radius: expected a number from 1e-9"},
        {R"("detectors": [{}, {"numerical_aperture": 1.2}])",
         "camera.detectors[1].numerical_aperture: expected a number from 1e-6 to 1"},
        {R"("detectors": [{"direction": [0, 0, 0]}])", "camera.detectors[0].direction: expected a direction"},
        {R"("detectors": [{"position": [0, NaN, 0]}])", "camera.detectors[0].position"},
        {R"("detectors": [{"diameter": 0.1}])",
         "camera.detectors[0].diameter: unknown field, expected direction, name, numerical_aperture, position or "
         "radius: radius is half of it"},
        {R"("detectors": [{"positon": 0.1}])", "did you mean 'position'?"},
        {R"("detectors": [{}], "resolution": 4)", "camera.resolution: the image has a pixel for each detector"}};
    for (const auto& [camera, expected] : bad)
        EXPECT_NE(detectorProblems(camera).find(expected), std::string::npos) << camera << "\n"
                                                                              << detectorProblems(camera);
}

TEST(Detectors, WarnInsideWalls) {
    const auto at = [](const std::string& position) {
        return R"("detectors": [{}, {"radius": 0.01, "position": )" + position + "}]";
    };
    const std::string blind = "camera.detectors[1]: sees nothing but 'block'";
    EXPECT_NE(detectorWarnings(at("[0.2, 0, 5]")).find(blind), std::string::npos) << "in its middle";
    EXPECT_NE(detectorWarnings(at("[0, 0, 3.999]")).find(blind), std::string::npos) << "right before it";
    EXPECT_EQ(detectorWarnings(at("[0, 0, 3.9]")), "");
    EXPECT_EQ(detectorWarnings(at("[0, 0, 6.5]")), "") << "behind it, looking away";
}

TEST(Detectors, WarnInAndAcrossSurfaces) {
    const auto at = [](const std::string& position, const std::string& direction) {
        return detectorWarnings(R"("detectors": [{}, {"name": "tip", "radius": 0.01, "position": )" + position +
                                R"(, "direction": )" + direction + "}]");
    };
    const std::string in = "camera.detectors[1]: 'tip' lies in the surface 'block'",
                      across = "camera.detectors[1]: 'tip' reaches through 'block'";
    EXPECT_NE(at("[0.3, 0.2, 4]", "[0, 0, -1]").find(in), std::string::npos) << "a face looks out";
    EXPECT_NE(at("[1, 0.2, 4.7]", "[0, 0.6, 0.8]").find(in), std::string::npos) << "along the face";
    EXPECT_EQ(at("[0.3, 0.2, 3.9999]", "[0, 0, -1]"), "") << "moved off";
    EXPECT_NE(at("[1.005, 0, 5]", "[0, 0, -1]").find(across), std::string::npos);
    EXPECT_NE(at("[1.005, 0, 5]", "[0, 0, -1]").find("(radius 0.01)"), std::string::npos);
    EXPECT_EQ(at("[1.011, 0, 5]", "[0, 0, -1]"), "") << "clear of it";
    EXPECT_EQ(at("[1.005, 0, 5]", "[1, 0, 0]"), "") << "flat before it";
}

TEST(Detectors, RaysAndConnectionsAreWithinTheirAcceptance) {
    Camera camera;
    camera.resolution = {3, 1};
    Detectors detectors;
    for (int i = 0; i < 3; ++i)
        detectors.row.push_back({"", Vec3f(float(i), 0, 0), Frame(Vec3f(0, 0.6f, 0.8f)), 0.2f, 0.3f + 0.3f * float(i)});
    camera.model = detectors;
    for (int x = 0; x < 3; ++x) {
        const Detector& detector = detectors.row[size_t(x)];
        Vec3d mean(0.0);
        constexpr int Side = 100;
        for (int k = 0; k < Side * Side; ++k) {
            const Vec2f u((float(k % Side) + 0.5f) / Side, (float(k / Side) + 0.5f) / Side);
            const Ray ray = camera.generateRay({x, 0}, u, {u.y, u.x});
            EXPECT_TRUE(detector.accepts(ray.direction));
            EXPECT_LE((ray.origin - detector.position).length(), 0.2001f);
            EXPECT_NEAR((ray.origin - detector.position).dot(detector.frame.n), 0.0f, 1e-6f);
            mean += Vec3d(ray.direction.x, ray.direction.y, ray.direction.z) / double(Side * Side);
        }
        // Of the cosine over projected solid angle: 2 / 3 (1 - cos^3) / sin^2.
        const double sine = double(detector.aperture), cosine = std::sqrt(1.0 - sine * sine);
        const double expected = 2.0 / 3.0 * (1.0 - cosine * cosine * cosine) / (sine * sine);
        EXPECT_NEAR(mean.dot(Vec3d(0.0, 0.6, 0.8)), expected, 2e-4);
        EXPECT_FALSE(detector.accepts(detector.frame.toWorld(Vec3f(0, sine > 0.5 ? 0.95f : 0.5f, 0.3f).normalized())));
        EXPECT_FALSE(detector.accepts(-detector.frame.n));
    }
}

} // namespace
} // namespace tungsten
