// Vertices seen from both ends of a path: the value is the same, and so is the density of going back.

#include "transport/Vertex.h"

#include "support/ChiSquare.h"

#include <gtest/gtest.h>

namespace tungsten::transport {
namespace {

const Vec3f Geometric(0.0f, 0.0f, 1.0f);
/// Away from the vertex, both on the outer side of both normals.
const Vec3f ToLight = Vec3f(0.5f, -0.2f, 0.7f).normalized(), ToCamera = Vec3f(-0.1f, 0.6f, 0.5f).normalized();

struct Material {
    const char* name;
    Bsdfs::Variant model;
};

class Reversed : public testing::TestWithParam<Material> {
  protected:
    /// Met from where `back` leads; the shading normal leans.
    [[nodiscard]] Vertex met(const Vec3f& back, TransportMode mode) const {
        SurfaceInteraction surface;
        surface.hit.ng = Geometric;
        surface.bsdf = &bsdf_;
        surface.frame = Frame(Vec3f(0.3f, 0.2f, 0.9f).normalized());
        surface.wi = surface.frame.toLocal(back);
        return {scene_, surface, -back, mode, Region{-1, 1.0f}};
    }

    Scene scene_;
    Bsdf bsdf_{"", GetParam().model, Texture(Rgb(0.2f, 0.5f, 0.8f))};
};

TEST_P(Reversed, LightAndCameraPathsFindTheSameValue) {
    // f |cos| of shading normals belongs to the camera's path; areas are those of geometric normals.
    const Rgb light = met(ToLight, TransportMode::Photons).scattering(ToCamera) * ToLight.dot(Geometric);
    const Rgb camera = met(ToCamera, TransportMode::Radiance).scattering(ToLight) * ToCamera.dot(Geometric);
    for (int k = 0; k < 3; ++k) {
        EXPECT_GT(camera[k], 0.0f);
        EXPECT_NEAR(light[k], camera[k], 1e-5f * camera[k]);
    }
}

TEST_P(Reversed, ItsDensityIsThatOfThePathThatGoesBack) {
    for (const TransportMode mode : {TransportMode::Photons, TransportMode::Radiance}) {
        const TransportMode other = mode == TransportMode::Photons ? TransportMode::Radiance : TransportMode::Photons;
        const float density = met(ToCamera, other).pdf(ToLight);
        EXPECT_GT(density, 0.0f);
        EXPECT_NEAR(met(ToLight, mode).pdfReverse(ToCamera), density, 1e-5f * density);
    }
    // Of what a camera's path draws, by where light's would have come from.
    const Vertex camera = met(ToCamera, TransportMode::Radiance);
    const SurfaceInteraction& surface = *camera.surface();
    const auto sample = [&](Sampler& sampler) -> std::optional<Vec3f> {
        const BsdfRandom u{sampler.next2D(), sampler.next1D()};
        const auto drawn = bsdf_.sample(surface.query(TransportMode::Radiance), surface.wi, u);
        return drawn ? std::optional(surface.frame.toWorld(drawn->wo).normalized()) : std::nullopt;
    };
    const auto density = [&](const Vec3f& toLight) {
        return double(met(toLight, TransportMode::Photons).pdfReverse(ToCamera));
    };
    EXPECT_GT(test::chiSquareSphere(sample, density), test::SmallestPValue);
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, Reversed,
    testing::Values(Material{"Lambert", Lambert{}}, Material{"OrenNayar", OrenNayar{}},
                    Material{"RoughConductor",
                             RoughConductor{{}, Rgb(0.2f), Rgb(3.0f), MicrofacetModel::Ggx, Texture(0.4f)}},
                    Material{"RoughPlastic", makeRoughPlastic(1.5f, 0.0f, Rgb(0.0f), MicrofacetModel::Beckmann,
                                                              Texture(0.4f), Rgb(1.0f))}),
    [](const auto& instance) { return instance.param.name; });

TEST(ReversedInMedia, ItsDensityIsThatOfThePathThatGoesBack) {
    Medium fog;
    fog.phase.model = HenyeyGreenstein{0.6f};
    const Vertex light(fog, Vec3f(0.0f), -ToLight, Region{0, 1.0f}),
        camera(fog, Vec3f(0.0f), -ToCamera, Region{0, 1.0f});
    EXPECT_FLOAT_EQ(light.pdfReverse(ToCamera), camera.pdf(ToLight));
    EXPECT_FLOAT_EQ(camera.pdfReverse(ToLight), light.pdf(ToCamera));
    const double p = test::chiSquareSphere(
        [&](Sampler& sampler) { return std::optional(fog.phase.sample(-ToCamera, sampler.next2D())); },
        [&](const Vec3f& toLight) {
            return double(Vertex(fog, Vec3f(0.0f), -toLight, Region{0, 1.0f}).pdfReverse(ToCamera));
        });
    EXPECT_GT(p, test::SmallestPValue);
}

} // namespace
} // namespace tungsten::transport
