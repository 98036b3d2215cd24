// Kernels that end at surfaces: what a record brings to all rays of a direction together, in bodies of many shapes.

#include "photon/Tuning.h"
#include "photon/primitives/beams/BeamGather.h"
#include "photon/primitives/beams/Beams.h"
#include "photon/primitives/points/PointGather.h"
#include "photon/primitives/points/Points.h"
#include "photon/view/CameraSubpath.h"

#include "support/PathsAndPhotons.h"

#include "tungsten/core/Warp.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace tungsten::photon {
namespace {

/// Clear enough that transmittance is 1.
constexpr double SigmaS = 1e-3;

struct Body {
    const char* name;
    std::string primitives;
    std::function<bool(const Vec3f&)> holds; ///< within the cube of half-width 1
    bool two = false;                        ///< media: the second one where x is above 0
};

std::string sceneOf(const Body& body) {
    const std::string medium = R"(", "type": "homogeneous", "sigma_a": 0, "sigma_s": )" + std::to_string(SigmaS) + "}";
    return R"({"media": [{"name": "fog)" + medium + R"(, {"name": "haze)" + medium + R"(], "primitives": [)" +
           body.primitives + R"(], "camera": {"type": "pinhole", "resolution": 1,
           "transform": {"position": [0, 0, 50], "look_at": [0, 0, 0]}},
           "integrator": {"type": "photon_map", "max_bounces": 64}, "renderer": {}})";
}

/// Rays of one direction, evenly over all that bodies can cover.
class Rays {
  public:
    Rays(const Scene& scene, const Vec3f& direction) : scene_(scene), frame_(direction), direction_(direction) {}

    /// Mean over the rays of what they gather, times their area and `weight` of their place.
    template <typename Gather, typename Weight>
    double energy(const Gather& gather, const Weight& weight) const {
        constexpr float HalfWidth = 1.9f;
        constexpr int Count = 20000;
        double sum = 0.0;
        for (int i = 0; i < Count; ++i) {
            const double u = (i + 0.5) / Count, v = std::fmod(i * 0.6180339887498949, 1.0); // Fibonacci's lattice
            const Vec3f place =
                frame_.s * (HalfWidth * float(2.0 * u - 1.0)) + frame_.t * (HalfWidth * float(2.0 * v - 1.0));
            Shown<Gather> shown{scene_, gather, FrameSums(1, Vec3d(0.0))};
            const Sampler unused(1, RandomStream::Test, 0, 0);
            followCameraSubpath(scene_, Ray{place - direction_ * 20.0f, direction_}, {}, unused, shown);
            sum += shown.sums[0].x * weight(place);
        }
        return sum * double(sqr(2.0f * HalfWidth)) / Count;
    }
    double energy(const auto& gather) const {
        return energy(gather, [](const Vec3f&) { return 1.0; });
    }

  private:
    template <typename Gather>
    struct Shown {
        const Scene& scene;
        const Gather& gather;
        FrameSums sums;
        void segment(const CameraSubpath& state, const std::optional<SurfaceHit>& hit) {
            if (scene.medium(state.region))
                gather.gather({state.ray.origin, state.ray.direction, hit ? hit->t : Infinity, state.time, 1.0,
                               state.interactions, state.region.medium},
                              sums);
        }
        void surface(const CameraSubpath&, const SurfaceInteraction&) const {}
        void escaped(const CameraSubpath&) const {}
    };

    const Scene& scene_;
    Frame frame_;
    Vec3f direction_;
};

struct BoundaryCase {
    Body body;
    float radius;
    double each = 0.01; ///< of the light that rays of a direction meet
};

class BoundaryKernels : public testing::TestWithParam<BoundaryCase> {
  protected:
    [[nodiscard]] std::vector<Vec3f> points(size_t count) const {
        Sampler sampler(1, RandomStream::Test, 0, 0);
        std::vector<Vec3f> found;
        while (found.size() < count) {
            const float x = sampler.next1D(), y = sampler.next1D(), z = sampler.next1D();
            const Vec3f point(2.0f * x - 1.0f, 2.0f * y - 1.0f, 2.0f * z - 1.0f);
            if (GetParam().body.holds(point)) found.push_back(point);
        }
        return found;
    }
    [[nodiscard]] int16_t mediumAt(const Vec3f& point) const {
        return int16_t(GetParam().body.two && point.x > 0.0f ? 1 : 0);
    }
    [[nodiscard]] std::vector<Photon> photons() const {
        std::vector<Photon> all;
        for (const Vec3f& x : points(20000)) all.push_back({0.0, x, Vec3f(0, 0, 1), Rgb(1.0f), 1, mediumAt(x)});
        return all;
    }
    /// From anywhere to the next surface.
    [[nodiscard]] std::vector<PhotonBeam> beams() const {
        std::vector<PhotonBeam> all;
        Sampler sampler(3, RandomStream::Test, 0, 0);
        for (const Vec3f& x : points(5000)) {
            const Vec3f direction = warp::squareToSphere(sampler.next2D());
            all.push_back(
                {0.0, x, direction, Rgb(1.0f), 0.0f, scene().geometry->intersect({x, direction})->t, 0, mediumAt(x)});
        }
        return all;
    }
    /// What rays of several directions meet is `all`, and more than without ended kernels.
    void expectNoLoss(const auto& ended, const auto& plain, double all) const {
        constexpr int Directions = 6;
        double mean = 0.0;
        for (int k = 0; k < Directions; ++k) {
            Sampler sampler(5, RandomStream::Test, 0, uint64_t(k));
            const Rays rays(scene(), warp::squareToSphere(sampler.next2D()));
            const double met = rays.energy(ended) / all;
            mean += met / Directions;
            EXPECT_NEAR(met, 1.0, GetParam().each);
            EXPECT_LT(rays.energy(plain) / all, 0.98);
        }
        EXPECT_NEAR(mean, 1.0, 0.7 * GetParam().each);
    }
    [[nodiscard]] const Scene& scene() const { return *loaded_.scene; }
    [[nodiscard]] transport::TimeSensor sensor() const {
        return transport::TimeSensor::of(scene(), scene().transport.gate);
    }
    [[nodiscard]] KernelEnds ends() const { return {scene(), surfaces_, Sampler(1, RandomStream::Test, 1, 0)}; }

  private:
    test::SceneFile file_{sceneOf(GetParam().body)};
    LoadedScene loaded_ = loadScene(file_.path(), {});
    NearSurfaces surfaces_{*loaded_.scene, GetParam().radius, 1.0f + 0.5f * tuning::NearPartInRadii};
};

constexpr double Sphere = 4.0 * double(Pi);

TEST_P(BoundaryKernels, PointsLoseNoLight) {
    const auto plain = photons();
    auto ended = plain;
    Radii radii = GetParam().radius;
    Points::endAtSurfaces(ends(), ended, radii);
    expectNoLoss(PointGather(scene(), sensor(), ended, radii), PointGather(scene(), sensor(), plain, GetParam().radius),
                 double(plain.size()) / Sphere);
}

TEST_P(BoundaryKernels, BeamsLoseNoLight) {
    const auto plain = beams();
    double length = 0.0;
    for (const PhotonBeam& beam : plain) length += double(beam.tEnd);
    auto ended = plain;
    Radii radii = GetParam().radius;
    Beams::endAtSurfaces(ends(), ended, radii);
    expectNoLoss(BeamGather(scene(), sensor(), ended, radii), BeamGather(scene(), sensor(), plain, GetParam().radius),
                 SigmaS * length / Sphere);
}

const auto within = [](float x, float y, float z) {
    return [=](const Vec3f& p) { return std::abs(p.x) < x && std::abs(p.y) < y && std::abs(p.z) < z; };
};
const auto inBall = [](float radius) { return [radius](const Vec3f& p) { return p.length() < radius; }; };

std::string shape(const std::string& type, const std::string& transform, const std::string& medium = "fog") {
    return R"({"type": ")" + type + R"(", "int_medium": ")" + medium +
           R"(", "bsdf": {"type": "forward"}, "transform": {)" + transform + "}}";
}
std::string twoCubes(const std::string& second) {
    return shape("cube", R"("position": [-0.5, 0, 0])") + ", " + shape("cube", R"("position": [0.5, 0, 0])", second);
}

// Few of a sheet's kernels meet a ray: 20 000 rays tell what they bring to 2 %, that of the others to 0.2 %.
INSTANTIATE_TEST_SUITE_P(
    , BoundaryKernels,
    testing::Values(
        BoundaryCase{{"Cube", shape("cube", R"("scale": 1)"), within(0.5f, 0.5f, 0.5f)}, 0.06f},
        BoundaryCase{{"Slab", shape("cube", R"("scale": [2, 0.3, 2])"), within(1.0f, 0.15f, 1.0f)}, 0.1f},
        BoundaryCase{{"Sheet", shape("cube", R"("scale": [1.6, 0.01, 1.6])"), within(0.8f, 0.005f, 0.8f)}, 0.06f, 0.06},
        BoundaryCase{{"TurnedBox", shape("cube", R"("scale": [1, 0.6, 1], "rotation": [0, 0, 45])"),
                      [](const Vec3f& p) {
                          return std::abs(p.x + p.y) < std::sqrt(0.5f) &&
                                 std::abs(p.x - p.y) < 0.6f * std::sqrt(0.5f) && std::abs(p.z) < 0.5f;
                      }},
                     0.06f},
        BoundaryCase{{"Ball", shape("sphere", R"("scale": 0.7)"), inBall(0.7f)}, 0.06f},
        BoundaryCase{{"SmallBall", shape("sphere", R"("scale": 0.12)"), inBall(0.12f)}, 0.06f, 0.02},
        BoundaryCase{{"TouchingCubes", twoCubes("haze"), within(1.0f, 0.5f, 0.5f), true}, 0.06f},
        BoundaryCase{{"CubesOfOneMedium", twoCubes("fog"), within(1.0f, 0.5f, 0.5f)}, 0.06f}),
    [](const auto& tested) { return tested.param.body.name; });

class KernelsInACube : public BoundaryKernels {};
INSTANTIATE_TEST_SUITE_P(, KernelsInACube,
                         testing::Values(BoundaryCase{{"", shape("cube", R"("scale": 1)"), within(0.5f, 0.5f, 0.5f)},
                                                      0.1f}));

/// Light and what rays make of it both fall away from a face, as exp(-4 d): kernels that reach beyond it lose as the
/// radius, ended ones are off as its square, -r^2 / 16 * 4 * 4 of it.
TEST_P(KernelsInACube, ErrorsFallAsTheSquareOfTheRadius) {
    constexpr double Fall = 4.0;
    const auto depth = [](const Vec3f& p) { return double(p.x) + 0.5; };
    const auto error = [&](float radius, bool ends) {
        auto photons = this->photons();
        double exact = 0.0;
        for (size_t i = 0; i < photons.size(); ++i) {
            photons[i].position.x = float((double(i) + 0.5) / double(photons.size()) - 0.5);
            photons[i].power = Rgb(float(std::exp(-Fall * depth(photons[i].position))));
            exact += std::exp(-2.0 * Fall * depth(photons[i].position)) / Sphere;
        }
        Radii radii = radius;
        if (ends) Points::endAtSurfaces(this->ends(), photons, radii);
        const PointGather gather(scene(), sensor(), photons, radii);
        return Rays(scene(), Vec3f(0, 1, 0))
                       .energy(gather, [&](const Vec3f& p) { return std::exp(-Fall * depth(p)); }) /
                   exact -
               1.0;
    };
    EXPECT_NEAR(error(0.2f, true), -0.03, 0.01);
    EXPECT_NEAR(error(0.1f, true), -0.01, 0.004);
    EXPECT_LT(std::abs(error(0.1f, true)), 0.5 * std::abs(error(0.2f, true)));
    EXPECT_LT(error(0.2f, false), -0.2);
    EXPECT_LT(error(0.1f, false), -0.1);
}

TEST_P(KernelsInACube, StayAsTheyAreWhereNoSurfaceIsNear) {
    auto photons = this->photons();
    auto beams = this->beams();
    for (Photon& photon : photons) photon.position = photon.position * 0.7f;
    for (PhotonBeam& beam : beams) {
        beam.base = beam.base * 0.5f;
        beam.tEnd = 0.1f;
    }
    const auto samePhotons = photons;
    const auto sameBeams = beams;
    Radii ofPhotons = GetParam().radius, ofBeams = GetParam().radius;
    Points::endAtSurfaces(ends(), photons, ofPhotons);
    Beams::endAtSurfaces(ends(), beams, ofBeams);
    for (const Radii* radii : {&ofPhotons, &ofBeams}) {
        EXPECT_TRUE(radii->single());
        EXPECT_TRUE(radii->edges().empty());
    }
    ASSERT_EQ(photons.size(), samePhotons.size());
    ASSERT_EQ(beams.size(), sameBeams.size());
    EXPECT_EQ(std::memcmp(photons.data(), samePhotons.data(), photons.size() * sizeof(Photon)), 0);
    EXPECT_EQ(std::memcmp(beams.data(), sameBeams.data(), beams.size() * sizeof(PhotonBeam)), 0);
}

/// Many faces, few, flat and curved ones.
const std::string Crowd =
    shape("sphere", R"("scale": 0.5, "position": [0.3, 0.2, 0.1])") + ", " +
    shape("cube", R"("scale": [1.9, 0.05, 1.9], "position": [0, -0.6, 0], "rotation": [0, 20, 5])") + ", " +
    shape("cube", R"("scale": 0.3, "position": [-0.5, 0.4, 0.2], "rotation": [30, 20, 0])");

struct SurfaceCellsTest : testing::Test {
    [[nodiscard]] const SceneGeometry& geometry() const { return *loaded.scene->geometry; }
    /// Calls check(position, radius) for points all over the scene and beyond, some of them about small cells.
    void everywhere(const std::function<void(const Vec3f&, float)>& check) const {
        Sampler sampler(1, RandomStream::Test, 2, 0);
        for (int i = 0; i < 20000; ++i) {
            const float x = sampler.next1D(), y = sampler.next1D(), z = sampler.next1D();
            check(Vec3f(3.0f * x - 1.5f, 3.0f * y - 1.5f, 3.0f * z - 1.5f), 0.1f * sampler.next1D());
        }
    }
    test::SceneFile file{sceneOf({"", Crowd, {}})};
    LoadedScene loaded = loadScene(file.path(), {});
    NearSurfaces surfaces{*loaded.scene, 0.1f, 1.0f};
};

TEST_F(SurfaceCellsTest, AnswerAsTheWholeSceneDoesToTheLastBit) {
    size_t near = 0, alone = 0;
    everywhere([&](const Vec3f& position, float radius) {
        const auto [edge, isAlone, faced] = surfaces.nearest(position, radius);
        const auto direct = geometry().toNearest(position, radius);
        ASSERT_EQ(edge.exists(), direct.has_value());
        if (!direct) return;
        ++near;
        alone += isAlone ? 1 : 0;
        ASSERT_EQ(edge.reach, float(direct->length()));
        ASSERT_EQ(edge.normal, Vec3f(*direct / direct->length()));
        if (isAlone) {
            ASSERT_TRUE(surfaces.sees(position, edge.normal * (0.999f * edge.reach), radius));
        }
        if (!faced) {
            ASSERT_FALSE(surfaces.opposite(position, edge, radius).exists());
        }
    });
    EXPECT_GT(near, 500u);
    EXPECT_GT(alone, 200u);
    EXPECT_LT(alone, near);
}

TEST_F(SurfaceCellsTest, NoSurfaceIsNearerThanTheClearance) {
    everywhere([&](const Vec3f& position, float) {
        const auto direct = geometry().toNearest(position, Infinity);
        ASSERT_TRUE(direct);
        ASSERT_LE(double(surfaces.clearance(position)), direct->length());
    });
}

TEST_F(SurfaceCellsTest, ImagesAreTheSameByAnyNumberOfThreads) {
    const std::string scene =
        R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 2, "sigma_a": 0.5}], "primitives": [)" + Crowd +
        R"(, {"type": "point", "emission": 10, "transform": {"position": [0.8, 0.4, 0.4]}}],
        "camera": {"type": "pinhole", "resolution": 16, "fov": 20, "reconstruction_filter": "box",
                   "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
        "integrator": {"type": "transient_photon_map", "max_bounces": 64, "photon_count": 4000,
                       "volume_photon_count": 4000, "fixed_volume_radius": true, "volume_gather_radius": 0.06,
                       "transient_time_center": 8, "transient_time_width": 16}, "renderer": {}})";
    for (const std::string type : {"points", "beams"}) {
        const auto render = [&](size_t threads) {
            test::RenderOptions options{{"integrator.darts=off", "integrator.volume_photon_type=" + type}, 2, 2, 1};
            options.threads = threads;
            return test::renderPhotons(scene, options);
        };
        const auto one = render(1), two = render(2);
        EXPECT_GT(one->mean(), 0.0);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) ASSERT_EQ(one->film.mean(0).at(x, y), two->film.mean(0).at(x, y)) << type;
    }
}

/// Of a render's image, over several seeds.
struct SeedMean {
    double mean = 0.0, error = 0.0;

    template <typename Render>
    explicit SeedMean(const Render& render) {
        constexpr int Seeds = 8;
        double squares = 0.0;
        for (int seed = 1; seed <= Seeds; ++seed) {
            const double one = render(uint64_t(seed))->mean();
            mean += one / Seeds;
            squares += one * one / Seeds;
        }
        error = std::sqrt(std::max(squares - mean * mean, 0.0) / (Seeds - 1));
    }
};

/// A ball of fog lit from beside it, its whole image over all time: kernels of a tenth of its radius lost 5 %.
TEST(BoundaryKernelsOfABall, ShowTheLightThatPathsShow) {
    const std::string scene =
        R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_s": 4, "sigma_a": 0.5}],
        "primitives": [{"type": "sphere", "int_medium": "fog", "bsdf": {"type": "forward"}, "transform": {"scale": 0.6}},
                       {"type": "point", "emission": 10, "transform": {"position": [0.8, 0.4, 0.4]}}],
        "camera": {"type": "pinhole", "resolution": 16, "fov": 20, "reconstruction_filter": "box",
                   "transform": {"position": [0, 0, 5], "look_at": [0, 0, 0]}},
        "integrator": {"type": "transient_photon_map", "max_bounces": 64, "photon_count": 40000,
                       "fixed_volume_radius": true, "volume_gather_radius": 0.06, "transient_time_center": 8,
                       "transient_time_width": 16}, "renderer": {}})";
    const SeedMean paths([&](uint64_t seed) {
        return test::renderPaths(scene, {{"integrator.darts=off"}, 8, 16, seed});
    });
    for (const std::string type : {"points", "beams"})
        for (const std::string ends : {"true", "false"}) {
            const SeedMean photons([&](uint64_t seed) {
                return test::renderPhotons(scene, {{"integrator.darts=off", "integrator.volume_photon_type=" + type,
                                                    "integrator.boundary_kernels=" + ends},
                                                   8,
                                                   4,
                                                   seed});
            });
            const double error = std::hypot(photons.error, paths.error);
            EXPECT_LT(error, 0.006 * paths.mean);
            if (ends == "true")
                EXPECT_NEAR(photons.mean, paths.mean, 5.0 * error + 0.005 * paths.mean) << type;
            else
                EXPECT_LT(photons.mean, 0.97 * paths.mean) << type;
        }
}

} // namespace
} // namespace tungsten::photon
