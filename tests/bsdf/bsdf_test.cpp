// Every surface model: samples follow densities, weights are value over density, energy is kept, Fresnel terms are
// right.

#include "support/ChiSquare.h"

#include "tungsten/bsdf/Bsdf.h"
#include "tungsten/bsdf/Fresnel.h"
#include "tungsten/bsdf/ShadingFrame.h"
#include "tungsten/core/Warp.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

struct Named {
    std::string name;
    Bsdf bsdf;
};

const Rgb GoldEta{0.143f, 0.375f, 1.44f}, GoldK{3.98f, 2.39f, 1.60f};

std::vector<Named> smoothModels() {
    std::vector<Named> models;
    const auto add = [&](const std::string& name, Bsdfs::Variant model) {
        models.push_back({name, Bsdf(name, std::move(model), Texture(0.8f))});
    };
    add("lambert", Lambert{});
    add("oren_nayar", OrenNayar{{}, Texture(0.7f)});
    for (const auto& [name, distribution] : {std::pair{"beckmann", MicrofacetModel::Beckmann},
                                             {"ggx", MicrofacetModel::Ggx},
                                             {"phong", MicrofacetModel::Phong},
                                             {"pbrt-ggx", MicrofacetModel::PbrtGgx}}) {
        for (const float roughness : {0.15f, 0.5f}) {
            const std::string suffix = std::string(" ") + name + " " + std::to_string(roughness);
            add("rough_conductor" + suffix, RoughConductor{{}, GoldEta, GoldK, distribution, Texture(roughness)});
            add("rough_dielectric" + suffix, RoughDielectric{{}, 1.5f, distribution, Texture(roughness), true});
        }
    }
    add("rough_plastic", makeRoughPlastic(1.5f, 1.0f, Rgb(0.2f), MicrofacetModel::Ggx, Texture(0.3f), Rgb(1.0f)));
    add("pbrt_plastic", PbrtPlastic{{}, 1.5f, MicrofacetModel::PbrtGgx, Texture(0.3f), Rgb(0.25f)});
    const auto part = [](Bsdfs::Variant model) {
        return std::make_shared<const Bsdf>("", std::move(model), Texture(0.6f));
    };
    add("mixed", Mixed{{},
                       part(Lambert{}),
                       part(RoughConductor{{}, GoldEta, GoldK, MicrofacetModel::Ggx, Texture(0.4f)}),
                       Texture(0.3f)});
    return models;
}

std::vector<Vec3f> viewDirections(bool below) {
    std::vector<Vec3f> views;
    for (const float z : {0.95f, 0.6f, 0.2f}) {
        views.push_back(Vec3f(std::sqrt(1.0f - z * z), 0.0f, z));
        if (below) views.push_back(Vec3f(0.0f, std::sqrt(1.0f - z * z), -z));
    }
    return views;
}

bool transmits(const Bsdf& bsdf) {
    return (bsdf.lobes() & lobe::Transmissive) != 0;
}

TEST(Bsdf, SamplesFollowDensitiesAndWeightsAreValueOverDensity) {
    for (const Named& model : smoothModels())
        for (const Vec3f& wi : viewDirections(transmits(model.bsdf))) {
            SCOPED_TRACE(model.name + " at z = " + std::to_string(wi.z));
            const BsdfQuery query;
            int failures = 0;
            const auto sample = [&](Sampler& s) -> std::optional<Vec3f> {
                const auto drawn = model.bsdf.sample(query, wi, {s.next2D(), s.next1D()});
                if (!drawn) return std::nullopt;
                const Rgb value = model.bsdf.eval(query, wi, drawn->wo);
                const float pdf = model.bsdf.pdf(query, wi, drawn->wo);
                // Compared loosely where the direction's rounding moves a sharp lobe.
                if (std::abs(pdf - drawn->pdf) > 2e-2f * drawn->pdf ||
                    std::abs(value.x / pdf - drawn->weight.x) > 2e-2f * (drawn->weight.x + 1e-3f))
                    ++failures;
                return drawn->wo;
            };
            const double p = test::chiSquareSphere(
                sample, [&](const Vec3f& wo) { return double(model.bsdf.pdf(query, wi, wo)); }, 7, 60000);
            EXPECT_GT(p, test::SmallestPValue);
            EXPECT_EQ(failures, 0);
        }
}

TEST(Bsdf, NothingGainsEnergy) {
    for (const Named& model : smoothModels())
        for (const Vec3f& wi : viewDirections(transmits(model.bsdf))) {
            const BsdfQuery query{{0, 0}, TransportMode::Photons, lobe::All};
            double sum = 0.0;
            constexpr int Count = 20000;
            for (uint64_t i = 0; i < Count; ++i) {
                Sampler s(5, RandomStream::Test, 0, i);
                if (const auto drawn = model.bsdf.sample(query, wi, {s.next2D(), s.next1D()}))
                    sum += double(maxComponent(drawn->weight));
            }
            // pbrt_plastic takes its Fresnel term from the inside, which reflects more than it should.
            const double limit = model.name == "pbrt_plastic" ? 1.25 : 1.01;
            EXPECT_LT(sum / Count, limit) << model.name << " " << wi.z;
            EXPECT_GT(sum / Count, 0.1) << model.name << " " << wi.z;
        }
}

/// What says that it scatters evenly does, and nothing else does.
TEST(Bsdf, EvenOnesHaveOneValue) {
    const auto shared = [](Bsdfs::Variant model) {
        return std::make_shared<const Bsdf>("", std::move(model), Texture(0.6f));
    };
    const BsdfPtr metal = shared(RoughConductor{{}, GoldEta, GoldK, MicrofacetModel::Ggx, Texture(0.4f)});
    std::vector<Named> models = smoothModels();
    const auto add = [&](const std::string& name, Bsdfs::Variant model) {
        models.push_back({name, Bsdf(name, std::move(model), Texture(0.8f))});
    };
    add("two lamberts", Mixed{{}, shared(Lambert{}), shared(Lambert{}), Texture(0.3f)});
    add("transparency of lambert", Transparency{{}, shared(Lambert{}), Texture(0.4f)});
    add("transparency of metal", Transparency{{}, metal, Texture(0.4f)});
    int even = 0;
    for (const Named& model : models) {
        float least = Infinity, most = 0.0f;
        for (uint64_t i = 0; i < 400; ++i) {
            Sampler s(8, RandomStream::Test, 0, i);
            const Vec3f wi = warp::squareToCosineHemisphere(s.next2D()), wo = warp::squareToSphere(s.next2D());
            const float f = model.bsdf.eval({}, wi, wo).x / std::abs(wo.z);
            if (wo.z > 0.0f) least = std::min(least, f);
            if (wo.z < 0.0f && f > 0.0f) least = 0.0f; // comes out on the other side
            most = std::max(most, f);
        }
        EXPECT_EQ(model.bsdf.isLambertian(), most <= 1.0001f * least) << model.name << ": " << least << ", " << most;
        even += model.bsdf.isLambertian() ? 1 : 0;
    }
    EXPECT_EQ(even, 3);
}

TEST(Bsdf, ReflectionIsReciprocal) {
    for (const Named& model : smoothModels()) {
        if (transmits(model.bsdf)) continue;
        const BsdfQuery query;
        for (uint64_t i = 0; i < 200; ++i) {
            Sampler s(6, RandomStream::Test, 0, i);
            const Vec3f a = warp::squareToCosineHemisphere(s.next2D()), b = warp::squareToCosineHemisphere(s.next2D());
            const float forth = model.bsdf.eval(query, a, b).x / b.z, back = model.bsdf.eval(query, b, a).x / a.z;
            // Written so that both exchanges see the same Fresnel angle, the microfacet models are exactly symmetric.
            EXPECT_NEAR(forth, back, 2e-3f * (forth + back)) << model.name;
        }
    }
}

TEST(Bsdf, RefractionSqueezesRadianceByTheSquaredIndexRatio) {
    const Bsdf glass("", RoughDielectric{{}, 1.5f, MicrofacetModel::Ggx, Texture(0.4f), true});
    const Vec3f wi = Vec3f(0.3f, 0.1f, 0.9f).normalized(), wo = Vec3f(-0.1f, 0.05f, -0.9f).normalized();
    const float radiance = glass.eval({{0, 0}, TransportMode::Radiance, lobe::All}, wi, wo).x;
    const float photons = glass.eval({{0, 0}, TransportMode::Photons, lobe::All}, wi, wo).x;
    EXPECT_GT(photons, 0.0f);
    EXPECT_NEAR(radiance / photons, 1.0f / 2.25f, 1e-5f);
    // f_radiance(i, o) n_i^-2 = f_radiance(o, i) n_o^-2 (per cosine).
    const float back = glass.eval({{0, 0}, TransportMode::Radiance, lobe::All}, wo, wi).x;
    EXPECT_NEAR(radiance / std::abs(wo.z) * 2.25f, back / wi.z, 2e-3f * back / wi.z);
}

TEST(Bsdf, SpecularModelsReflectAndRefract) {
    const BsdfQuery query;
    const Vec3f wi = Vec3f(0.6f, 0.0f, 0.8f);
    const auto mirror = Bsdf("", Mirror{}, Texture(0.9f)).sample(query, wi, {{0.5f, 0.5f}, 0.5f});
    ASSERT_TRUE(mirror);
    EXPECT_EQ(mirror->wo, Vec3f(-0.6f, 0.0f, 0.8f));
    EXPECT_FLOAT_EQ(mirror->weight.x, 0.9f);
    const Bsdf glass("", Dielectric{{}, 1.5f, true});
    const auto refracted = glass.sample(query, wi, {{0.5f, 0.5f}, 0.99f});
    ASSERT_TRUE(refracted);
    EXPECT_NEAR(refracted->wo.x, -0.4f, 1e-6f); // Snell
    EXPECT_NEAR(refracted->weight.x, 1.0f / 2.25f, 1e-5f);
    EXPECT_NEAR(glass.sample({{0, 0}, TransportMode::Photons, lobe::All}, wi, {{0.5f, 0.5f}, 0.99f})->weight.x, 1.0f,
                1e-5f);
    // From inside beyond the critical angle: everything is reflected.
    const auto total = glass.sample(query, Vec3f(0.8f, 0.0f, -0.6f), {{0.5f, 0.5f}, 0.999f});
    ASSERT_TRUE(total);
    EXPECT_EQ(total->lobe, lobe::SpecularReflection);
    EXPECT_FLOAT_EQ(total->weight.x, 1.0f);
}

TEST(Bsdf, LobeMasksSelect) {
    const Bsdf plastic("", makePlastic(1.5f, 1.0f, Rgb(0.0f)), Texture(0.5f));
    const Vec3f wi = Vec3f(0.6f, 0.0f, 0.8f);
    const float fresnel = fresnelDielectric(1.0f / 1.5f, 0.8f);
    const auto specular = plastic.sample({{0, 0}, TransportMode::Radiance, lobe::Specular}, wi, {{0.5f, 0.5f}, 0.999f});
    ASSERT_TRUE(specular);
    EXPECT_NEAR(specular->weight.x, fresnel, 1e-6f);
    EXPECT_FALSE(
        Bsdf("", Lambert{}).sample({{0, 0}, TransportMode::Radiance, lobe::Specular}, wi, {{0.5f, 0.5f}, 0.5f}));
    EXPECT_EQ(plastic.eval({{0, 0}, TransportMode::Radiance, lobe::Specular}, wi, wi), Rgb(0.0f));
    const Bsdf veil("", Transparency{{}, std::make_shared<const Bsdf>("", Bsdfs::Variant(Lambert{})), Texture(0.25f)});
    EXPECT_NEAR(veil.forwardWeight({0, 0}).x, 0.75f, 1e-6f);
    EXPECT_NEAR(veil.eval({}, wi, wi).x, 0.25f * 0.8f / 3.14159265f, 1e-6f);
    const auto straight = veil.sample({{0, 0}, TransportMode::Radiance, lobe::Forward}, wi, {{0.5f, 0.5f}, 0.9f});
    ASSERT_TRUE(straight);
    EXPECT_EQ(straight->wo, -wi);
    EXPECT_NEAR(straight->weight.x, 0.75f, 1e-6f);
}

/// A connection that goes straight through carries what paths that are sampled straight through carry on average.
TEST(Bsdf, StraightConnectionsWeighWhatStraightSamplesDo) {
    const auto part = [](Bsdfs::Variant model, float albedo = 1.0f) {
        return std::make_shared<const Bsdf>("", std::move(model), Texture(albedo));
    };
    const BsdfPtr veil = part(Transparency{{}, part(Lambert{}, 0.6f), Texture(0.25f)});
    const BsdfPtr filter = part(Mixed{{}, part(Forward{}), part(Null{}), Texture(0.4f)}, 0.5f);
    for (const auto& [bsdf, expected] :
         {std::pair{part(Forward{}), 1.0f},
          {veil, 0.75f},
          {filter, 0.5f * 0.4f},
          {part(Mixed{{}, veil, filter, Texture(0.3f)}, 0.9f), 0.9f * (0.225f + 0.14f)}}) {
        constexpr int Count = 10000; // of lobes, stratified
        double sum = 0.0;
        for (int i = 0; i < Count; ++i) {
            const float choice = (float(i) + 0.5f) / Count;
            const auto drawn = bsdf->sample({}, Vec3f(0.6f, 0.0f, 0.8f), {{0.5f, 0.5f}, choice});
            if (drawn && drawn->lobe == lobe::Forward) sum += double(drawn->weight.x);
        }
        EXPECT_NEAR(sum / Count, double(expected), 1e-3);
        EXPECT_NEAR(bsdf->forwardWeight({0.5f, 0.5f}).x, expected, 1e-6f);
    }
}

TEST(Bsdf, BacksOfReflectiveModelsAreBlack) {
    const Vec3f behind = Vec3f(0.0f, 0.6f, -0.8f);
    for (const Named& model : smoothModels()) {
        if (transmits(model.bsdf)) continue;
        EXPECT_FALSE(model.bsdf.sample({}, behind, {{0.3f, 0.4f}, 0.5f})) << model.name;
        EXPECT_EQ(model.bsdf.eval({}, behind, -behind), Rgb(0.0f)) << model.name;
    }
}

TEST(Bsdf, GrazingAndDegenerateDirectionsStayFinite) {
    for (const Named& model : smoothModels())
        for (const float z : {1.0f, 1e-4f, 1e-7f, -1e-7f}) {
            const Vec3f wi = Vec3f(std::sqrt(1.0f - z * z), 0.0f, z);
            for (uint64_t i = 0; i < 500; ++i) {
                Sampler s(8, RandomStream::Test, 0, i);
                const auto drawn = model.bsdf.sample({}, wi, {s.next2D(), s.next1D()});
                if (drawn) {
                    EXPECT_TRUE(isFinite(drawn->weight) && drawn->weight.x >= 0.0f && std::isfinite(drawn->pdf))
                        << model.name << z;
                }
            }
        }
}

TEST(Bsdf, PlasticFollowsItsFormula) {
    const Bsdf plastic("", makePlastic(1.5f, 2.0f, Rgb(0.1f)), Texture(0.5f));
    const Vec3f wi = Vec3f(0.6f, 0.0f, 0.8f), wo = Vec3f(0.0f, 0.8f, 0.6f);
    const double fi = double(fresnelDielectric(1.0f / 1.5f, 0.8f)), fo = double(fresnelDielectric(1.0f / 1.5f, 0.6f));
    const double expected = (1 - fi) * (1 - fo) / 2.25 / 3.14159265358979 * 0.5 / (1 - 0.5 * 0.59635) *
                            std::exp(-2.0 * 0.1 * (1 / 0.8 + 1 / 0.6)) * 0.6;
    EXPECT_NEAR(double(plastic.eval({}, wi, wo).x), expected, 1e-4 * expected);
}

/// Oren and Nayar's full model (1994, equations 32 to 34), towards the light and away from it.
TEST(Bsdf, OrenNayarFollowsItsFormula) {
    const double sigma = 0.5, s = sigma * sigma, albedo = 0.8;
    const Bsdf bsdf("", OrenNayar{{}, Texture(float(sigma * std::sqrt(2.0)))}, Texture(float(albedo)));
    const double alpha = std::acos(0.6), beta = std::acos(0.8), ratio = 2.0 * beta / M_PI;
    const Vec3f wi(0.6f, 0.0f, 0.8f);
    for (const double cosPhi : {1.0, 0.6, 0.0, -0.6, -1.0}) {
        const Vec3f wo(float(0.8 * cosPhi), float(0.8 * std::sqrt(1.0 - cosPhi * cosPhi)), 0.6f);
        const double c1 = 1.0 - 0.5 * s / (s + 0.33);
        const double c2 =
            0.45 * s / (s + 0.09) * (cosPhi >= 0.0 ? std::sin(alpha) : std::sin(alpha) - std::pow(ratio, 3.0));
        const double c3 = 0.125 * s / (s + 0.09) * std::pow(4.0 * alpha * beta / (M_PI * M_PI), 2.0);
        const double direct =
            c1 + cosPhi * c2 * std::tan(beta) + (1.0 - std::abs(cosPhi)) * c3 * std::tan(0.5 * (alpha + beta));
        const double twice = 0.17 * s / (s + 0.13) * (1.0 - cosPhi * ratio * ratio);
        const double expected = 0.6 * (albedo * direct + albedo * albedo * twice) / M_PI;
        EXPECT_NEAR(double(bsdf.eval({}, wi, wo).x), expected, 1e-5 * expected) << cosPhi;
    }
}

/// A height that rises along u and falls along v, on a surface whose tangents are right- or left-handed.
TEST(ShadingFrame, BumpsTiltTheNormalAndKeepItsSide) {
    auto bitmap = std::make_shared<Bitmap>();
    bitmap->width = bitmap->height = 4;
    bitmap->channels = 3;
    for (int i = 0; i < 16 * 3; ++i) bitmap->hdr.push_back(0.2f * float(i / 3 % 4) + 0.1f * float(i / 12));
    Bsdf bsdf("", Lambert{});
    bsdf.bump = Texture(std::shared_ptr<const Bitmap>(bitmap));
    const Vec2f uv(0.5f, 0.5f), slope(0.4f, -0.2f); // across two texels; row 0 is the top
    const Vec3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const auto expectNormal = [&](const Frame& frame, const Vec3f& along) {
        EXPECT_LT((frame.n - along.normalized()).length(), 1e-6f);
        EXPECT_NEAR(frame.s.dot(frame.n), 0.0f, 1e-6f);
    };
    expectNormal(bumpedFrame(bsdf, z, {x, y}, uv), Vec3f(-slope.x, -slope.y, 1));
    expectNormal(bumpedFrame(bsdf, z, {y, x}, uv), Vec3f(-slope.y, -slope.x, 1));
    expectNormal(bumpedFrame(bsdf, -z, {x, y}, uv), Vec3f(-slope.x, -slope.y, -1));
}

} // namespace
} // namespace tungsten
