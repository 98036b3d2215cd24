// What kernels leave, as a render estimates it, against closed forms.

#include "tungsten/film/FilmErrors.h"

#include "support/PathsAndPhotons.h"
#include "support/SeedShift.h"

#include "support/SingleScattering.h"
#include "support/VerifiedValues.h"

#include <gtest/gtest.h>

namespace tungsten::photon {
namespace {

constexpr int ImageSide = 24;

/// The closed form, pixel by pixel: the midpoint rule over 4 x 4 rays.
std::vector<Vec3d> exactImage(const test::PulsesInFog& c) {
    constexpr int PerPixel = 4, Fine = ImageSide * PerPixel;
    const double distance = 1.0 / std::tan(0.5 * test::FieldOfView * M_PI / 180.0);
    std::vector<Vec3d> pixels(size_t(ImageSide * ImageSide), Vec3d(0.0));
    for (int y = 0; y < Fine; ++y)
        for (int x = 0; x < Fine; ++x) {
            const Vec3d ray(1.0 - 2.0 * (x + 0.5) / Fine, 1.0 - 2.0 * (y + 0.5) / Fine, distance);
            pixels[size_t(y / PerPixel * ImageSide + x / PerPixel)] +=
                test::singleScattering(c, ray / ray.length()) / double(PerPixel * PerPixel);
        }
    return pixels;
}

/// Errors of a render relative to the mean of the truth, rms over the pixels.
struct Errors {
    double bias, noise; ///< made, noise taken off; standard error
    RelativeBias claimed;
    double corrected; ///< bias that is left when the estimate is subtracted; its noise taken off

    Errors(const test::Rendered& rendered, const std::vector<Vec3d>& exact)
        : noise(relativeStandardError(rendered.film)), claimed(RelativeBias::of(rendered.film, rendered.bias)) {
        const Image mean = rendered.film.mean(0), estimate = rendered.bias.mean(0);
        double squared = 0.0, left = 0.0, sum = 0.0;
        for (size_t i = 0; i < exact.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double error = double(mean.pixels[i][c]) - exact[i][c];
                squared += error * error;
                left += std::pow(error - double(estimate.pixels[i][c]), 2.0);
                sum += exact[i][c];
            }
        const double count = 3.0 * double(exact.size()), scale = sum / count;
        bias = std::sqrt(std::max(squared / count - rendered.film.meanSquaredError(), 0.0)) / scale;
        const double noises = rendered.film.meanSquaredError() + rendered.bias.meanSquaredError();
        corrected = std::sqrt(std::max(left / count - noises, 0.0)) / scale;
    }
};

struct BiasCase {
    const char* name;
    size_t pulses; ///< index of singleScatteringCases()
    test::Overrides overrides;
    double radius;
    bool delta = false; ///< at the gate's middle, through a kernel of its width
};

class KernelBiasOf : public testing::TestWithParam<BiasCase> {
  protected:
    [[nodiscard]] static Errors errorsOf(const BiasCase& c, double radius, uint32_t passes) {
        test::PulsesInFog pulses = test::singleScatteringCases()[c.pulses];
        test::Overrides overrides{"camera.resolution=" + std::to_string(ImageSide),
                                  "integrator.type=progressive_transient_photon_map",
                                  "integrator.fixed_volume_radius=true",
                                  "integrator.include_surfaces=false",
                                  test::setting("photon_count", 200000),
                                  test::setting("volume_photon_count", 20000),
                                  test::setting("volume_gather_radius", radius)};
        if (c.delta) overrides.emplace_back("integrator.delta_time_gate=true");
        overrides.insert(overrides.end(), c.overrides.begin(), c.overrides.end());
        const auto rendered =
            test::renderPhotons(test::sceneJson(pulses), {.overrides = overrides, .passes = passes, .bias = true});
        if (c.delta) {
            pulses.gateStart += 0.5 * pulses.gateWidth;
            pulses.gateWidth = 1e-4;
        }
        return {*rendered, exactImage(pulses)};
    }
};

TEST_P(KernelBiasOf, IsWithinAFactorOfTwo) {
    const test::OtherSeeds seeds{{"PointsAtADeltaGate", 4}};
    const BiasCase& c = GetParam();
    const Errors errors = errorsOf(c, c.radius, 24);
    EXPECT_GT(errors.bias, 2.0 * errors.noise) << "nothing is seen below the noise";
    EXPECT_GT(errors.claimed.estimate, 0.5 * errors.bias);
    EXPECT_LT(errors.claimed.estimate, 2.0 * errors.bias);
    EXPECT_LT(errors.corrected, 0.95 * errors.bias) << "the estimate is no picture of the bias";
    RecordProperty("bias", std::to_string(errors.bias));
    RecordProperty("estimate", std::to_string(errors.claimed.estimate));
}

/// Small kernels: nothing to be seen, and nothing is claimed.
class SmallKernelBiasOf : public KernelBiasOf {};
TEST_P(SmallKernelBiasOf, IsNotMoreThanNoise) {
    const BiasCase& c = GetParam();
    const Errors errors = errorsOf(c, 0.15 * c.radius, 16);
    EXPECT_LT(errors.bias, errors.noise);
    EXPECT_LT(errors.claimed.estimate, errors.noise);
    EXPECT_LT(errors.bias, errors.claimed.bound);
}

/// Fog about a lamp, seen straight and in a small mirror beside the camera: as much bias is claimed.
TEST(KernelBiasBehindMirrors, IsThatOfTheSameViewWithoutOne) {
    const auto claimed = [](const std::string& from, const std::string& to, const std::string& mirror) {
        const auto rendered = test::renderPhotons(
            R"({"media": [{"name": "fog", "type": "homogeneous", "sigma_a": 0.02, "sigma_s": 0.1}], "primitives": [)" +
                mirror +
                R"({"type": "point", "emission": 3, "ext_medium": "fog", "transform": {"position": [0, 0, 0]}}],
             "camera": {"type": "pinhole", "resolution": [12, 12], "fov": 20, "medium": "fog", "reconstruction_filter": "box",
                        "transform": {"position": )" +
                from + R"(, "look_at": )" + to + R"(, "up": [0, 1, 0]}},
             "integrator": {"type": "progressive_transient_photon_map", "photon_count": 5000, "max_bounces": 3,
                            "volume_photon_type": "beams", "volume_gather_radius": 0.3, "fixed_volume_radius": true,
                            "alpha": 1, "volume_alpha": 1, "transient_time_center": 6, "transient_time_width": 3}})",
            {.overrides = {}, .passes = 16, .bias = true});
        return RelativeBias::of(rendered->film, rendered->bias).estimate;
    };
    const double straight = claimed("[0, 0, 4]", "[0, 0, 0]", "");
    const double mirrored =
        claimed("[1, 0, 3]", "[0, 0, 3]", R"({"type": "cube", "bsdf": {"type": "mirror"}, "ext_medium": "fog",
            "transform": {"position": [0, 0, 3], "rotation": [0, 45, 0], "scale": [1, 1, 0.01]}},)");
    EXPECT_GT(straight, 0.02);
    EXPECT_GT(mirrored, 0.5 * straight);
    EXPECT_LT(mirrored, 2.0 * straight);
}

const test::Overrides Fixed{"integrator.alpha=1", "integrator.volume_alpha=1"},
    Shrinking{"integrator.alpha=0.5", "integrator.volume_alpha=0.5"};

test::Overrides with(test::Overrides overrides, const std::vector<std::string>& more) {
    overrides.insert(overrides.end(), more.begin(), more.end());
    return overrides;
}

std::string biasName(const testing::TestParamInfo<BiasCase>& tested) {
    return tested.param.name;
}
const BiasCase ShrinkingPoints{"ShrinkingPoints", 1, Shrinking, 0.7},
    PointsAtADeltaGate{"PointsAtADeltaGate", 3, Fixed, 0.3, true},
    BeamsAtADeltaGate{"BeamsAtADeltaGate", 3, with(Fixed, {test::BeamMap}), 0.3, true};

INSTANTIATE_TEST_SUITE_P(
    , KernelBiasOf,
    testing::Values(ShrinkingPoints, BiasCase{"ColouredPoints", 2, Fixed, 0.5},
                    BiasCase{"Beams", 3, with(Fixed, {test::BeamMap}), 0.3},
                    BiasCase{"ShrinkingGuidedBeams", 1,
                             with(Shrinking, {test::BeamMap, test::BestPreset, "integrator.alpha=0.9"}), 0.4},
                    PointsAtADeltaGate, BeamsAtADeltaGate,
                    BiasCase{"GuidedPointsOnADeltaGate", 3, with(Fixed, {test::BestPreset}), 0.3, true}),
    biasName);
INSTANTIATE_TEST_SUITE_P(, SmallKernelBiasOf, testing::Values(ShrinkingPoints, PointsAtADeltaGate, BeamsAtADeltaGate),
                         biasName);

} // namespace
} // namespace tungsten::photon
