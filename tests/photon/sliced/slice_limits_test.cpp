// What must hold for slices whatever the scene: short flights have the means of long ones, volumes and balls together
// are no noisier than either, box gates tend to delta gates, closed boxes keep their light.

#include "support/SeedShift.h"
#include "support/VerifiedValues.h"

#include "photon/primitives/sliced/Hypervolume.h"
#include "photon/primitives/sliced/Plane.h"
#include "photon/primitives/sliced/RecordBudget.h"
#include "photon/primitives/sliced/Slices.h"
#include "photon/primitives/sliced/VolumeBallMis.h"
#include "photon/sliced/box_of_fog.h"

#include "tungsten/emitter/Emitter.h"
#include "tungsten/scene/SceneLoader.h"

#include <functional>
#include <random>

namespace tungsten::photon {
namespace {

constexpr const char *WarpedBox = R"("transient_time_center": 5.6, "transient_time_width": 0.3)",
                     *UnwarpedBox = R"("transient_time_center": 2, "transient_time_width": 0.3)",
                     *WarpedDelta =
                         R"("transient_time_center": 5.6, "transient_time_width": 0.05, "delta_time_gate": true)",
                     *UnwarpedDelta =
                         R"("transient_time_center": 2, "transient_time_width": 0.05, "delta_time_gate": true)";

struct GateCase {
    const char* name;
    bool unwarped;
    const char* gate;
};
const auto Gates =
    testing::Values(GateCase{"WarpedBox", false, WarpedBox}, GateCase{"UnwarpedBox", true, UnwarpedBox},
                    GateCase{"WarpedDelta", false, WarpedDelta}, GateCase{"UnwarpedDelta", true, UnwarpedDelta});
const auto NameOf = [](const auto& test) { return std::string(test.param.name); };

/// Order 4 of configuration A against its verified values, and coloured fog with occluders against long flights.
TEST(ShortFlights, HaveTheVerifiedValues) {
    for (const test::VerifiedValue& value : {test::verified("A4WarpedBox"), test::verified("A4UnwarpedBox"),
                                             test::verified("A4WarpedDelta"), test::verified("A4UnwarpedDelta")})
        for (const char* type : {"volumes", "mis_volumes_balls", "hypervolumes"}) {
            test::Overrides overrides = test::gateOf(value, 0.05);
            overrides.insert(overrides.end(),
                             {std::string("integrator.volume_photon_type=") + type,
                              "integrator.volume_photon_length=short", test::setting("photon_count", 1500)});
            const auto rendered = test::renderPhotons(test::sceneOf(value), {overrides, 40, 1});
            const double error = rendered->pixelError();
            EXPECT_NEAR(rendered->mean(), value.radiance, 4.0 * error) << type << " " << test::nameOf(value);
            EXPECT_LT(error, 0.2 * value.radiance)
                << type << " " << test::nameOf(value) << ": would not see a wrong value";
        }
}

TEST(ShortFlights, HaveTheMeansOfLongOnesInColour) {
    for (const bool unwarped : {false, true})
        for (const char* type : {"planes", "volumes", "balls", "hypervolumes"}) {
            const std::string gate = unwarped ? UnwarpedBox : WarpedBox;
            const Mean longer = meanOf(boxOfFog(unwarped, gate), type, "1500", 16, 0);
            const Mean shorter =
                meanOf(boxOfFog(unwarped, gate + R"(, "volume_photon_length": "short")"), type, "1500", 16, 0);
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(shorter.value[k], longer.value[k], 4.0 * std::hypot(longer.error[k], shorter.error[k]))
                    << type << " channel " << k;
                EXPECT_NE(shorter.value[k], longer.value[k]) << type;
            }
        }
}

class SharedPaths : public testing::TestWithParam<GateCase> {};

/// Of what both make alone, standard errors over the same light paths. 1.2 and 1.5: the errors' own error, about.
TEST_P(SharedPaths, AreNoNoisierThanTheBetterOfVolumesAndBalls) {
    const test::OtherSeeds seeds{{"/WarpedBox", 1}, {"/WarpedDelta", 1}};
    const GateCase& c = GetParam();
    for (const char* g : {"0", "0.7"}) {
        const auto errorOf = [&](const char* type) {
            const std::string gate = std::string(c.gate) + R"(, "exclude_non_mis": true)";
            return meanOf(boxOfFog(c.unwarped, gate, g), type, "1500", 40, 0).error[0];
        };
        const double volumes = errorOf("volumes"), balls = errorOf("balls"), both = errorOf("mis_volumes_balls");
        EXPECT_LT(both, (std::string(g) == "0" ? 1.2 : 1.5) * std::min(volumes, balls)) << "g " << g;
        RecordProperty(std::string("g ") + g + ": errors of volumes, balls, both",
                       std::to_string(volumes) + " " + std::to_string(balls) + " " + std::to_string(both));
    }
}
INSTANTIATE_TEST_SUITE_P(Gates, SharedPaths, Gates, NameOf);

/// A gate as long as many of the flights: weights that leave out where each draws its point bring 1.09 here.
TEST(SharedPaths, WeighWhereEachPlacesItsPointInAGate) {
    const std::string scene = R"({
        "media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.1, "sigma_s": 1.2,
                   "phase_function": {"type": "henyey_greenstein", "g": 0.7}}],
        "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "forward"},
                        "transform": {"scale": [2, 1.8, 1.6], "rotation": [0, 20, 0]}},
                       {"type": "point", "emission": 5, "ext_medium": "fog", "transform": {"position": [0.6, 0.5, -0.2]}}],
        "camera": {"type": "pinhole", "resolution": [16, 16], "fov": 22, "reconstruction_filter": "box",
                   "transform": {"position": [0.3, 0.2, 4], "look_at": [0, 0, 0]}},
        "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 12, "camera_unwarped": true,
                       "transient_time_center": 1.5, "transient_time_width": 0.6, "exclude_non_mis": true,
                       "photon_count": 1500, "volume_gather_radius": 0.06}})";
    const auto errorOf = [&](const char* type) {
        const auto rendered = test::renderPhotons(
            scene, {{std::string("integrator.volume_photon_type=") + type, "integrator.darts=off"}, 40, 1});
        double squares = 0.0;
        const Image errors = rendered->film.standardError(0);
        for (const Rgb& error : errors.pixels) squares += double(error.x) * double(error.x);
        return std::sqrt(squares / double(errors.pixels.size()));
    };
    EXPECT_LT(errorOf("mis_volumes_balls"), 0.85 * errorOf("volumes"));
}

/// Order 3 of configuration A, unwarped, about 2.5: (10) and (7) are different estimators. What a box of width w
/// averages departs from the moment by w^2 / 24 times the second derivative.
TEST(DeltaGate, IsTheLimitOfBoxGates) {
    const auto at = [](const char* type, double width, bool delta) {
        const auto rendered = test::renderPhotons(
            test::configurationA(3, true),
            {{std::string("integrator.volume_photon_type=") + type, test::setting("transient_time_center", 2.5),
              test::setting("transient_time_width", width),
              std::string("integrator.delta_time_gate=") + (delta ? "true" : "false"),
              test::setting("photon_count", 2000)},
             60,
             1,
             delta ? 1u : uint64_t(2 + 100 * width)});
        return std::pair(rendered->mean(), rendered->pixelError());
    };
    for (const char* type : {"volumes", "mis_volumes_balls"}) {
        const auto [moment, momentError] = at(type, 0.1, true);
        const auto [wide, wideError] = at(type, 1.0, false);
        EXPECT_NEAR(wide, 22.1036e-4, 4.0 * wideError) << type;
        for (const double width : {0.5, 0.1, 0.01}) {
            const auto [box, error] = at(type, width, false);
            const double expected = moment + width * width * (wide - moment);
            const double spread = std::hypot(error, (1 - width * width) * momentError, width * width * wideError);
            EXPECT_NEAR(box, expected, 4.0 * spread) << type << " width " << width;
            EXPECT_LT(spread, 0.06 * moment) << type;
            RecordProperty(std::string(type) + " width " + std::to_string(width),
                           std::to_string(box / moment) + " +- " + std::to_string(spread / moment));
        }
    }
}

/// The part of the light that determinants below `least` bring is proportional to it: at most this many times.
/// Directions uniform over the sphere, a ray 1 beside the base, a length 3.
struct Skipped {
    const char* name;
    bool warped;
    double factor;
    std::function<double(const std::array<Vec3d, 4>& w, const CameraRay<double>& sight, double least)> weight;
};
class SkippedLight : public testing::TestWithParam<Skipped> {};

TEST_P(SkippedLight, FallsWithTheLeastDeterminant) {
    const Skipped& c = GetParam();
    const CameraRay<double> sight{{1.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 0.0, 10.0, c.warped};
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> uniform;
    double all = 0.0;
    std::array<double, 2> kept{};
    constexpr std::array Least{0.1, 0.01};
    for (int i = 0; i < 400000; ++i) {
        std::array<Vec3d, 4> w;
        for (Vec3d& direction : w) {
            const float z = 2.0f * uniform(engine) - 1.0f, phi = float(2.0 * M_PI) * uniform(engine);
            const double s = std::sqrt(std::max(1.0 - double(z) * double(z), 0.0));
            direction = {s * std::cos(double(phi)), s * std::sin(double(phi)), double(z)};
        }
        const double value = c.weight(w, sight, 1e-6);
        all += value;
        if (value > 0.0)
            for (size_t k = 0; k < 2; ++k) kept[k] += c.weight(w, sight, Least[k]);
    }
    for (size_t k = 0; k < 2; ++k) {
        const double lost = 1.0 - kept[k] / all;
        EXPECT_GT(lost, 0.0);
        EXPECT_LT(lost, c.factor * Least[k]);
        RecordProperty("lost below " + std::to_string(Least[k]), std::to_string(lost));
    }
}

constexpr Coefficients<double> LimitsFog{0.5, 0.6};
double planeWeight(const std::array<Vec3d, 4>& w, const CameraRay<double>& sight, double least) {
    const auto met = crossPlane<double>(Vec3d(0.0), {w[0], w[1]}, sight, least);
    return met ? met->weight(LimitsFog) : 0.0;
}
double volumeWeight(const std::array<Vec3d, 4>& w, const CameraRay<double>& sight, double least) {
    const auto met = sliceVolume<double>(Vec3d(0.0), {w[0], w[1], w[2]}, sight, 3.0, least);
    return met ? met->weight(LimitsFog) : 0.0;
}
double hypervolumeWeight(const std::array<Vec3d, 4>& w, const CameraRay<double>& sight, double least) {
    const auto chord = sliceHypervolume<double>(Vec3d(0.0), w, sight, 3.0, least);
    return chord ? chordWeight(*chord, LimitsFog) : 0.0;
}

INSTANTIATE_TEST_SUITE_P(Shapes, SkippedLight,
                         testing::Values(Skipped{"Planes", true, 3.0, planeWeight},
                                         Skipped{"VolumesWarped", true, 3.0, volumeWeight},
                                         Skipped{"VolumesUnwarped", false, 3.0, volumeWeight},
                                         Skipped{"HypervolumesWarped", true, 3.0, hypervolumeWeight},
                                         Skipped{"HypervolumesUnwarped", false, 3.0, hypervolumeWeight}),
                         NameOf);

/// A pulse of intensity 1 in a closed white box of volume 1: after two thousand scatterings light is the same
/// everywhere, 4 pi of energy over 4 pi V.
TEST(ClosedBox, KeepsItsLightOverThousandsOfBounces) {
    const test::OtherSeeds seeds(4);
    const std::string json =
        R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0, "sigma_s": 8, "max_bounces": 100000}],
        "camera": {"type": "pinhole", "resolution": [3, 3], "fov": 50, "medium": "fog", "reconstruction_filter": "box",
                   "transform": {"position": [0.1, 0.05, 0.2], "look_at": [-0.2, 0, -0.4], "up": [0, 1, 0]}},
        "primitives": [{"type": "cube", "int_medium": "fog", "bsdf": {"type": "lambert", "albedo": 1}},
                       {"type": "point", "emission": 1, "ext_medium": "fog", "transform": {"position": [0.3, -0.2, 0.1]}}],
        "integrator": {"type": "progressive_transient_photon_map", "max_bounces": 100000, "gather_radius": 0.15,
                       "volume_gather_radius": 0.02, "alpha": 1, "volume_alpha": 1, "gather_photon_count": 10000,
                       "volume_photon_count": 10000000, "transient_time_center": 250, "transient_time_width": 0.5)";
    const Mean mean = meanOf(json + "}}", "volumes", "100", 24, 0);
    EXPECT_NEAR(mean.value[0], 1.0, 4.0 * mean.error[0]);
    EXPECT_LT(mean.error[0], 0.2) << "the test would not see a wrong value";
}

/// A ball on a light brings what a ball does that the light's whole power collides in.
TEST(RecordBudget, CountsTheLightOfLights) {
    const test::SceneFile file(test::configurationA(3, false));
    const auto loaded = loadScene(file.path(), {});
    const Scene& scene = *loaded.scene;
    SliceRecord scattered{}, light{};
    scattered.emitter = -1;
    scattered.power = emitterPower(scene.emitters[0]);
    light.power = Rgb(1.0f);
    RecordBudget counts(scene, scene.transport.gate);
    counts.measure(std::array{scattered, light}, {});
    EXPECT_NEAR(counts.expected(light), counts.expected(scattered), 1e-5);
    EXPECT_NEAR(counts.expected(scattered), 1.0, 1e-5);
}

} // namespace
} // namespace tungsten::photon
