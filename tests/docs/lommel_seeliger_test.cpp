// The BSDF of docs/extending.md: its sampling belongs to its value, and its albedo is that of the closed form.

#include "lommel_seeliger.cpp"

#include "tungsten/core/Random.h"

#include <gtest/gtest.h>

namespace tungsten {
namespace {

TEST(LommelSeeliger, WeightsAverageToItsAlbedo) {
    const LommelSeeliger model;
    const BsdfQuery query{{0, 0}, TransportMode::Radiance, lobe::All};
    const ModelPoint at{query, Rgb(0.8f)};
    Sampler sampler(1, RandomStream::Camera, 0, 0);
    for (const float mu : {0.1f, 0.5f, 1.0f}) {
        const Vec3f wi{std::sqrt(1.0f - mu * mu), 0.0f, mu};
        double sum = 0.0;
        constexpr int Count = 100000;
        for (int i = 0; i < Count; ++i) {
            const Vec2f u = sampler.next2D();
            const MaybeSample sample = model.sample(at, wi, {u, 0.5f});
            ASSERT_TRUE(sample);
            ASSERT_FLOAT_EQ(sample->pdf, model.pdf(at, wi, sample->wo));
            sum += double(sample->weight.x);
        }
        // Integral of f cos over the hemisphere: albedo / 2 (1 - mu ln(1 + 1 / mu)).
        EXPECT_NEAR(sum / Count, 0.4 * (1.0 - double(mu) * std::log1p(1.0 / double(mu))), 2e-3);
    }
}

} // namespace
} // namespace tungsten
