// Every inverted distribution undoes its distribution and never falls, over random configurations of every size.

#include "darts/ConnectionLobe.h"
#include "darts/ControlVertex.h"
#include "darts/EdaTable.h"
#include "darts/Ellipse.h"
#include "darts/PhaseFunction.h"

#include "support/LogUniform.h"

#include "tungsten/core/Random.h"

#include <gtest/gtest.h>

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::logUniform;

constexpr uint64_t Configurations = 100000;

/// Two numbers in [0, 1), the first not above the second; now and then the ends.
std::pair<float, float> ordered(Sampler& s) {
    const float a = s.next1D(), b = s.next1D();
    if (a < 0.02f) return {0.0f, b};
    if (b > 0.98f) return {a, 0x1.fffffep-1f};
    return {std::min(a, b), std::max(a, b)};
}

TEST(Inverse, EllipseFirstLegsAndLengths) {
    for (uint64_t i = 0; i < Configurations; ++i) {
        Sampler s(1, RandomStream::Test, 0, i);
        const double C = logUniform(s, 1e-4, 1e5), delta = C * logUniform(s, 1e-7, 1e3), h = 2 * s.nextDouble();
        const Ellipse<double> e{C, delta, h};
        const double t = e.firstLeg();
        ASSERT_NEAR(e.lengthThrough(t), e.length(), 1e-14 * e.length());
        ASSERT_GT(e.lengthThrough(1.001 * t), e.length());
        const Ellipse<float> f{float(C), float(delta), float(h)};
        ASSERT_NEAR(f.lengthThrough(f.firstLeg()) / f.length(), 1.0f, 1e-6f);
        const float longer = 1.0001f * f.delta;
        ASSERT_LT(f.firstLeg(), (Ellipse<float>{f.C, longer, f.h}.firstLeg())) << C << " " << delta << " " << h;
    }
}

TEST(Inverse, ConnectionLengths) {
    for (uint64_t i = 0; i < Configurations; ++i) {
        Sampler s(2, RandomStream::Test, 0, i);
        const auto width = float(logUniform(s, 1e-11, 1e5)), depth = float(logUniform(s, 1e-8, 1e4));
        const ConnectionLength<float> length{1.0f, width, depth / width};
        const auto [u, larger] = ordered(s);
        const float offset = length.sample(u).offset;
        const double sigma = double(length.sigmaT), full = sigma * double(width);
        ASSERT_NEAR(std::expm1(-sigma * double(offset)) / std::expm1(-full), double(u), 1e-6) << depth << " " << u;
        ASSERT_LE(offset, length.sample(larger).offset) << depth << " " << u << " " << larger;
        ASSERT_TRUE(offset >= 0.0f && length.sample(larger).offset <= width);
    }
}

TEST(Inverse, ConnectionLobes) {
    for (uint64_t i = 0; i < Configurations; ++i) {
        Sampler s(3, RandomStream::Test, 0, i);
        const double C = logUniform(s, 1e-4, 1e5), delta = C * logUniform(s, 1e-7, 1e3);
        const bool path = s.next1D() < 0.5f;
        const auto lobe = path ? ConnectionLobe<float>::path(float(C), float(delta))
                               : ConnectionLobe<float>::photon(float(C), float(delta));
        const double kappa = path ? delta * delta / (2 * C * (C + delta)) : delta / C;
        const auto [u, larger] = ordered(s);
        const float h = lobe.sample(u);
        ASSERT_NEAR(std::log1p(double(h) / kappa) / std::log1p(2 / kappa), double(u), 3e-6) << kappa << " " << u;
        ASSERT_LE(h, lobe.sample(larger)) << kappa << " " << u << " " << larger;
        ASSERT_TRUE(h >= 0.0f && h <= 2.0f);
        ASSERT_NEAR(lobe.part(h), u, 3e-6f) << kappa << " " << u;
        ASSERT_LE(lobe.part(h), lobe.part(std::min(1.0001f * h, 2.0f)) + 1e-7f);
    }
}

TEST(Inverse, HenyeyGreenstein) {
    for (uint64_t i = 0; i < Configurations; ++i) {
        Sampler s(4, RandomStream::Test, 0, i);
        const float g = 1.98f * s.next1D() - 0.99f, sign = g < 0 ? -1.0f : 1.0f;
        const HenyeyGreenstein phase{{0, 0, 1}, g};
        const auto [u, larger] = ordered(s);
        const Vec3 direction = phase.sample(u, 0.3f);
        const double G = std::abs(double(g)), h = double(oneMinusCosine(direction, {0, 0, sign}));
        if (!(G > 1e-3)) continue; // the distribution's form needs g
        const double root = std::sqrt((1 - G) * (1 - G) + 2 * G * h);
        const double above = (1 - G * G) / (2 * G) * (1 / root - 1 / (1 + G));
        ASSERT_NEAR(above, double(u), 2e-6 + 2e-7 / G) << g << " " << u;
        ASSERT_GE(sign * phase.sample(larger, 0.3f).z, sign * direction.z) << g << " " << u << " " << larger;
        const float quantile = phase.quantile(u);
        ASSERT_TRUE(quantile >= 0.0f && quantile <= 2.0f && quantile <= phase.quantile(larger)) << g << " " << u;
        ASSERT_NEAR(phase.part(quantile), u, 2e-6f) << g << " " << u;
        ASSERT_NEAR(phase.pdfAt(quantile) / phase.pdf(directionAbout(phase.peak(), quantile, 0.3f)), 1.0f, 3e-5f);
    }
}

TEST(Inverse, EdaTableRows) {
    const EdaTable table = EdaTable::build(0.9f, 0.3f);
    for (uint64_t i = 0; i < Configurations; ++i) {
        Sampler s(5, RandomStream::Test, 0, i);
        const double S = logUniform(s, 1e-4, 1e5), delta = S * logUniform(s, 1e-7, 1.0);
        const auto row = table.row(float(S - delta), float(delta), float(logUniform(s, 1e-6, 1e4) / S));
        const auto [u, larger] = ordered(s);
        const float h = row.sample(u);
        double below = 0.0;
        int bin = 0;
        for (; bin + 1 < row.bins() && row.edge(bin + 1) <= h; ++bin) below += double(row.mass(bin));
        below += 2 * double(Pi) * double(row.pdf(h)) * double(h - row.edge(bin));
        ASSERT_NEAR(below, double(u), 1e-5) << S << " " << delta;
        ASSERT_LE(h, row.sample(larger)) << u << " " << larger;
    }
}

} // namespace
} // namespace darts
