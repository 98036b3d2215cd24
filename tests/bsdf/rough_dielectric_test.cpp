// Rough interfaces: what leaves them in all against an integral over facets; reciprocity across.

#include "tungsten/bsdf/Bsdf.h"
#include "tungsten/core/Random.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

/// What leaves a rough Beckmann interface in all, by facets instead of by directions (Walter et al. 2007): every facet
/// that is seen reflects and refracts its light whole, but for what other facets shadow. In double precision.
class BeckmannInterface {
  public:
    BeckmannInterface(double ior, double alpha) : ior_(ior), alpha_(alpha) {}

    [[nodiscard]] double albedo(const Vec3f& wiBothSides) const {
        const Vec3d wi(double(wiBothSides.x), double(wiBothSides.y), std::abs(double(wiBothSides.z)));
        const double eta = wiBothSides.z > 0.0f ? 1.0 / ior_ : ior_;
        constexpr int Heights = 2000, Azimuths = 500;
        double sum = 0.0;
        for (int i = 0; i < Heights; ++i)
            for (int k = 0; k < Azimuths; ++k) {
                const double tan2 = -alpha_ * alpha_ * std::log1p(-(i + 0.5) / Heights);
                const double phi = 2.0 * M_PI * (k + 0.5) / Azimuths, z = 1.0 / std::sqrt(1.0 + tan2);
                const double r = std::sqrt(tan2) * z;
                sum += ofFacet(wi, Vec3d(r * std::cos(phi), r * std::sin(phi), z), eta) / z;
            }
        return sum / (double(Heights) * Azimuths) / wi.z;
    }

  private:
    [[nodiscard]] double ofFacet(const Vec3d& wi, const Vec3d& m, double eta) const {
        const double c = wi.dot(m);
        if (c <= 0.0) return 0.0;
        const double t2 = 1.0 - eta * eta * (1.0 - c * c), t = std::sqrt(std::max(t2, 0.0));
        const double rs = (eta * c - t) / (eta * c + t), rp = (eta * t - c) / (eta * t + c);
        const double fresnel = t2 > 0.0 ? 0.5 * (rs * rs + rp * rp) : 1.0;
        const Vec3d reflected = m * (2.0 * c) - wi, refracted = m * (eta * c - t) - wi * eta;
        double out = 0.0;
        if (reflected.z > 0.0) out += fresnel * unshadowed(wi) * unshadowed(reflected);
        if (refracted.z < 0.0) out += (1.0 - fresnel) * unshadowed(wi) * unshadowed(refracted);
        return c * out;
    }
    [[nodiscard]] double unshadowed(const Vec3d& v) const {
        const double a = std::abs(v.z) / (alpha_ * std::hypot(v.x, v.y));
        return a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) : 1.0;
    }

    double ior_, alpha_;
};

TEST(Bsdf, ARoughInterfaceLetsOutWhatItsFacetsDo) {
    const BeckmannInterface facets(double(1.33f), double(0.3f));
    const Bsdf glass("", RoughDielectric{{}, 1.33f, MicrofacetModel::Beckmann, Texture(0.3f), true});
    const BsdfQuery query{{0, 0}, TransportMode::Photons, lobe::All};
    for (const float z : {0.95f, 0.6f, 0.2f, -0.95f, -0.6f, -0.2f}) {
        const Vec3f wi(std::sqrt(1.0f - z * z), 0.0f, z);
        double sum = 0.0, squared = 0.0;
        constexpr int Count = 200000;
        for (uint64_t i = 0; i < Count; ++i) {
            Sampler s(5, RandomStream::Test, 0, i);
            const auto drawn = glass.sample(query, wi, {s.next2D(), s.next1D()});
            const double weight = drawn ? double(drawn->weight.x) : 0.0;
            sum += weight;
            squared += weight * weight;
        }
        const double mean = sum / Count, error = std::sqrt((squared / Count - mean * mean) / Count);
        EXPECT_NEAR(mean, facets.albedo(wi), 4.5 * error + 1e-4) << wi.z;
        EXPECT_LT(error, 2e-3);
    }
}

/// f(i, o) / n_o^2 = f(o, i) / n_i^2 of what photons carry across, per cosine.
TEST(Bsdf, RefractionIsReciprocal) {
    for (const auto model : {MicrofacetModel::Beckmann, MicrofacetModel::Ggx, MicrofacetModel::Phong}) {
        const Bsdf glass("", RoughDielectric{{}, 1.33f, model, Texture(0.3f), true});
        const BsdfQuery query{{0, 0}, TransportMode::Photons, lobe::All};
        for (uint64_t i = 0; i < 2000; ++i) {
            Sampler s(6, RandomStream::Test, 0, i);
            const Vec3f a = warp::squareToCosineHemisphere(s.next2D()), b = -warp::squareToCosineHemisphere(s.next2D());
            const float in = glass.eval(query, a, b).x / std::abs(b.z) / sqr(1.33f),
                        out = glass.eval(query, b, a).x / a.z;
            // Beyond the smallest values facets are so steep that rounding shows.
            EXPECT_NEAR(in, out, 5e-3f * (in + out) + 1e-5f) << a << b;
        }
    }
}

} // namespace
} // namespace tungsten
