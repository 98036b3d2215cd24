// What the library returns in float against 50 decimal digits, from the definitions with all their subtractions, at the
// hard cases: targets at the vertex, excess lengths of 1e-7, needles, depths from 1e-6 to 1e4, g to 0.99, sizes from
// 1e-4 to 1e5.

#include "darts/ConnectionLobe.h"
#include "darts/ControlVertex.h"
#include "darts/GreensFunction.h"
#include "darts/Guide.h"

#include "support/Exact.h"
#include "support/LogUniform.h"

#include "tungsten/core/Random.h"

namespace darts {
namespace {

using tungsten::RandomStream;
using tungsten::Sampler;
using tungsten::test::Exact;
using tungsten::test::ExactPi;
using tungsten::test::logUniform;

/// Relative to the exact value.
constexpr double Bound = 1e-5;

testing::AssertionResult near(float value, const Exact& exact, double bound = Bound) {
    if (!std::isfinite(value) || value < 0.0f) return testing::AssertionFailure() << value;
    // The smallest normal float stands for what underflows.
    const Exact scale = exact > 1.2e-38 ? exact : Exact(1.2e-38);
    const auto error = double(abs(Exact(value) - exact) / scale);
    if (error <= bound) return testing::AssertionSuccess();
    return testing::AssertionFailure() << value << ", exactly " << exact << ", relative error " << error;
}

/// The polar form of the ellipse, as in a textbook.
struct Definition {
    Exact C, S, cosine;
    Definition(float c, const Exact& delta, float h) : C(c), S(C + delta), cosine(1 - Exact(h)) {}
    [[nodiscard]] Exact t() const { return (S * S - C * C) / (2 * (S - C * cosine)); }
    [[nodiscard]] Exact r() const { return S - t(); }
    [[nodiscard]] Exact tPerLength() const {
        const Exact d = S - C * cosine;
        return (S * S - 2 * S * C * cosine + C * C) / (2 * d * d);
    }
    [[nodiscard]] Exact toTarget(const Exact& d) const { return sqrt(d * d - 2 * d * C * cosine + C * C); }
};

template <typename Use>
void forHardEllipses(Use&& use) {
    for (const float scale : {1e-4f, 1.0f, 1e5f})
        for (const float C : {0.0f, 1.0f})
            for (const float excess : {1e-7f, 1e-6f, 1e-3f, 0.5f, 100.0f})
                for (const float h : {0.0f, 1e-12f, 1e-6f, 0.1f, 1.0f, 2.0f}) {
                    SCOPED_TRACE(testing::Message() << "C " << C * scale << " delta " << excess * scale << " h " << h);
                    use(Ellipse<float>{C * scale, excess * scale, h});
                }
}

TEST(Accuracy, Ellipse) {
    forHardEllipses([](const Ellipse<float>& e) {
        const Definition exact(e.C, e.delta, e.h);
        EXPECT_TRUE(near(e.firstLeg(), exact.t()));
        EXPECT_TRUE(near(e.secondLeg(), exact.r()));
        EXPECT_TRUE(near(e.firstLegPerLength(), exact.tPerLength()));
        EXPECT_TRUE(near(controlVertexPdf(e, 3.0f), 3 / exact.tPerLength()));
        EXPECT_TRUE(near(e.legs().first, exact.t()));
        EXPECT_TRUE(near(e.legs().second, exact.r()));
        EXPECT_TRUE(near(e.legs().firstPerLength, exact.tPerLength()));
        for (const float part : {1e-6f, 0.3f, 0.9f}) {
            const float d = part * e.firstLeg();
            const Exact left = exact.S - d - exact.toTarget(d);
            EXPECT_TRUE(near(e.distanceToTarget(d), exact.toTarget(d)));
            EXPECT_TRUE(near(e.lengthThrough(d), d + exact.toTarget(d)));
            EXPECT_TRUE(near(e.advance(d).delta, left)) << part;
        }
    });
}

TEST(Accuracy, ConnectionLength) {
    for (const float width : {1e-11f, 1.0f, 1e5f})
        for (const float depth : {0.0f, 1e-12f, 9e-7f, 1.1e-6f, 1e-3f, 1.0f, 30.0f, 1e4f})
            for (const float u : {0.0f, 1e-7f, 0.1f, 0.5f, 0.9f, 0x1.fffffep-1f}) {
                const ConnectionLength<float> length{1.0f, width, depth / width};
                const Exact sigma(length.sigmaT), d = sigma * Exact(width);
                const Exact drop = -expm1(-d), offset = depth > 0 ? Exact(-log1p(-u * drop) / sigma) : Exact(u) * width;
                SCOPED_TRACE(testing::Message() << "width " << width << " depth " << depth << " u " << u);
                const float sampled = length.sample(u).offset;
                EXPECT_TRUE(near(sampled, offset));
                EXPECT_TRUE(near(length.pdf(sampled),
                                 depth > 0 ? Exact(sigma * exp(-sigma * sampled) / drop) : 1 / Exact(width)));
            }
}

TEST(Accuracy, ConnectionLobes) {
    forHardEllipses([](const Ellipse<float>& e) {
        const Exact C(e.C), delta(e.delta);
        const auto check = [&](const ConnectionLobe<float>& lobe, const Exact& kappa) {
            const Exact range = C > 0 ? Exact(log1p(2 / kappa)) : Exact(0);
            for (const float u : {0.0f, 1e-7f, 0.1f, 0.5f, 0.9f, 0x1.fffffep-1f}) {
                const Exact h = C > 0 ? Exact(kappa * expm1(u * range)) : Exact(2 * u);
                EXPECT_TRUE(near(lobe.sample(u), h)) << u;
            }
            EXPECT_TRUE(
                near(lobe.pdf(e.h), C > 0 ? Exact(1 / (2 * ExactPi * (kappa + e.h) * range)) : 1 / (4 * ExactPi)));
        };
        check(ConnectionLobe<float>::path(e.C, e.delta),
              C > 0 ? Exact(delta * delta / (2 * C * (C + delta))) : Exact(0));
        check(ConnectionLobe<float>::photon(e.C, e.delta), C > 0 ? Exact(delta / C) : Exact(0));
    });
}

TEST(Accuracy, LobesOfAllLengths) {
    for (const float C : {1e-4f, 1.0f, 1e5f})
        for (const float relativeWidth : {1e-6f, 1e-3f, 0.5f, 100.0f})
            for (const float relativeLow : {0.0f, 1e-3f, 30.0f}) {
                const float width = relativeWidth * C, low = relativeLow * width;
                const UniformLengthLobe<float> all(C, low, width);
                const GateLobe<float> gate(C, low, width);
                const Exact S = Exact(C) + low + Exact(width) / 2, scale = 1 / sqrt(2 * S * C);
                const Exact k = 2 / ExactPi * width * scale, start = Exact(low) * scale;
                const Exact range = log((k + sqrt(2 + start * start)) / (k + start));
                const Exact delta = Exact(low) + Exact(width) / 2, kappa = delta * delta / (2 * C * S);
                SCOPED_TRACE(testing::Message() << "C " << C << " low " << low << " width " << width);
                for (const float u : {1e-7f, 0.1f, 0.5f, 0.9f}) {
                    const Exact y = (k + start) * expm1(u * range) + start;
                    EXPECT_TRUE(near(all.sample(u), y * y - start * start)) << u;
                }
                for (const float h : {1e-12f, 1e-6f, 0.1f, 1.0f, 2.0f}) {
                    const Exact y = sqrt(h + start * start), ofAll = 1 / (4 * ExactPi * y * (k + y) * range);
                    const Exact middle = 1 / (2 * ExactPi * (kappa + h) * log1p(2 / kappa));
                    EXPECT_TRUE(near(all.pdf(h), ofAll)) << h;
                    EXPECT_TRUE(near(gate.pdf(h), (ofAll + middle) / 2)) << h;
                }
            }
}

TEST(Accuracy, LengthAlong) {
    for (const float width : {1e-4f, 1.0f, 1e5f})
        for (const float relativeLow : {0.0f, 1e-3f, 30.0f})
            for (const float relativeA : {1e-4f, 0.1f, 3.0f, 1e3f}) {
                const float low = relativeLow * width, a = relativeA * width;
                const LengthAlong<float> length{{low, width, 0.0f}, a};
                const Exact first = Exact(low) + a, last = first + width;
                SCOPED_TRACE(testing::Message() << "width " << width << " low " << low << " a " << a);
                for (const float u : {1e-6f, 0.1f, 0.5f, 0.9f}) {
                    const float number = 0.5f + 0.5f * u;
                    const Exact part = Exact(2 * number - 1);
                    EXPECT_TRUE(near(length.sample(number).offset, 1 / ((1 - part) / first + part / last) - first))
                        << u;
                }
                for (const float part : {0.0f, 1e-6f, 0.3f, 1.0f}) {
                    const float offset = part * width;
                    const Exact excess = first + offset;
                    EXPECT_TRUE(
                        near(length.pdf(offset), (1 / Exact(width) + first * last / (width * excess * excess)) / 2))
                        << part;
                }
            }
}

Exact exactDot(const Vec3& a, const Vec3& b) {
    return Exact(a.x) * b.x + Exact(a.y) * b.y + Exact(a.z) * b.z;
}
/// 1 - cos of the angle between vectors of nearly unit length.
Exact exactOneMinusCosine(const Vec3& a, const Vec3& b) {
    return 1 - exactDot(a, b) / sqrt(exactDot(a, a) * exactDot(b, b));
}

TEST(Accuracy, DirectionsAboutAnAxis) {
    for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0.48f, 0.64f, -0.6f}, Vec3{1, 0, 0}})
        for (const float h : {0.0f, 1e-12f, 1e-6f, 1e-3f, 0.5f, 1.0f, 1.999f, 2.0f})
            for (const float u : {0.0f, 0.3f, 0.8f}) {
                const Vec3 direction = directionAbout(axis, h, u);
                const Exact rounded = exactOneMinusCosine(axis, direction);
                SCOPED_TRACE(testing::Message() << "h " << h << " u " << u);
                EXPECT_NEAR(double(exactDot(direction, direction)), 1.0, 1e-6);
                // Floats of unit vectors lie 1e-7 apart, which moves h by 1e-7 sqrt(2 h).
                EXPECT_NEAR(double(rounded), double(h), 4e-7 * std::sqrt(double(h)) + 1e-13);
                EXPECT_NEAR(double(oneMinusCosine(axis, direction)), double(rounded), Bound * double(rounded) + 1e-13);
            }
}

TEST(Accuracy, HenyeyGreenstein) {
    const Vec3 before{0.48f, 0.64f, -0.6f};
    for (const float g : {0.0f, 1e-6f, 0.5f, 0.99f, 0.9999f})
        for (const float sign : {1.0f, -1.0f})
            for (const float h : {0.0f, 1e-6f, 1e-3f, 0.3f, 1.0f, 1.999f, 2.0f}) {
                const Vec3 after = directionAbout(before * sign, h, 0.3f);
                const Exact G(g), d = 1 + G * G - 2 * G * (1 - exactOneMinusCosine(before * sign, after));
                EXPECT_TRUE(
                    near(HenyeyGreenstein{before, sign * g}.pdf(after), (1 - G * G) / (4 * ExactPi * d * sqrt(d))))
                    << g * sign << " " << h;
            }
}

TEST(Accuracy, GreensFunctions) {
    // Logarithms, so relative errors of Phi; those beyond a hundred mean free paths are compared with the logarithm.
    const auto nearLog = [](float value, const Exact& phi) {
        const auto exact = double(log(phi));
        return std::isfinite(value) && std::abs(double(value) - exact) <= Bound * std::max(std::abs(exact), 1.0);
    };
    for (const float scale : {1e-4f, 1.0f, 1e5f})
        for (const float albedo : {0.0f, 0.5f, 1.0f})
            for (const float depth : {1e-6f, 1.0f, 79.0f, 1e4f}) {
                const float s = scale, sigmaA = (1.0f - albedo) * depth / s, sigmaS = albedo * depth / s;
                SCOPED_TRACE(testing::Message() << "s " << s << " albedo " << albedo << " depth " << depth);
                for (const float g : {0.0f, 0.99f, -0.99f})
                    for (const float part : {0.0f, 1e-6f, 0.5f, 0.9f, 0.9999999f}) {
                        const float rho = part * s;
                        const Exact fourDs = 4 * Exact(s) / (3 * (Exact(sigmaA) + Exact(sigmaS) * (1 - Exact(g))));
                        const Exact phi =
                            exp(-Exact(rho) * rho / fourDs - Exact(sigmaA) * s) / pow(ExactPi * fourDs, Exact(1.5));
                        EXPECT_TRUE(nearLog(DiffusionGreensFunction<float>{sigmaA, sigmaS, g}.log(rho, s), phi))
                            << g << " " << part;
                    }
                if (!(sigmaS > 0)) continue;
                for (const float u : {1e-7f, 1e-4f, 0.3f, 0.9f, 1.0f}) {
                    const Exact l = 1 / Exact(sigmaS), x = s / l * pow(Exact(u), Exact(0.75));
                    const Exact phi = pow(Exact(u), Exact(0.125)) * pow(4 * ExactPi * l * s / 3, Exact(-1.5)) *
                                      exp(-s / l) * exp(x) * sqrt(1 + Exact(2.026) / x) * exp(-Exact(sigmaA) * s);
                    EXPECT_TRUE(nearLog(CausalGreensFunction<float>{sigmaA, sigmaS}.log(u, s), phi)) << u;
                }
            }
    EXPECT_EQ(std::exp(DiffusionGreensFunction<float>{}.log(2.0f, 2.0f)), 0.0f);
    EXPECT_EQ(std::exp(CausalGreensFunction<float>{}.log(0.0f, 2.0f)), 0.0f);
}

TEST(Accuracy, Residuals) {
    for (uint64_t i = 0; i < 20000; ++i) {
        Sampler s(11, RandomStream::Test, 0, i);
        const double scale = logUniform(s, 1e-4, 1e5);
        const Vec3 toTarget{float(scale * s.nextDouble()), float(-scale * s.nextDouble()), float(scale)};
        const Exact C = sqrt(exactDot(toTarget, toTarget));
        const double gap = logUniform(s, 1e-7, 10.0) * double(C), width = logUniform(s, 1e-7, 1.0) * (double(C) + gap);
        const double high = double(C) + gap, low = high - width;
        const TimeBudget r = TimeBudget::of(toTarget, {low, high});
        const Exact first = C > low ? C : Exact(low);
        ASSERT_TRUE(near(r.C, C));
        ASSERT_TRUE(near(r.excess, high - C));
        ASSERT_TRUE(near(r.width, high - first));
        if (first > C) {
            ASSERT_TRUE(near(r.low, first - C));
        }
        ASSERT_NEAR(r.shortest, double(first), 1e-15 * double(first));
    }
}

/// Random configurations of every size: connections and control vertices, and the density of the latter as seen from
/// the ray.
TEST(Accuracy, ControlVertices) {
    uint64_t tested = 0, within = 0;
    for (uint64_t i = 0; i < 30000; ++i) {
        Sampler s(6, RandomStream::Test, 0, i);
        const double scale = logUniform(s, 1e-4, 1e5), C = s.next1D() < 0.1f ? 0.0 : scale;
        const double high = C + scale * logUniform(s, 1e-6, 1e2), width = high * logUniform(s, 1e-7, 1.0);
        const double depth = logUniform(s, 1e-6, 100.0);
        const auto sigma = float(depth / high);
        const Guide guide(best(Mode::Photon, 0.0f), Medium{{0, 0, 0}, {sigma, sigma, sigma}, 0.0f});
        const TimeBudget budget = TimeBudget::of({0, float(C), 0}, {high - width, high});
        if (!budget.alive()) continue;
        const ConnectionSample connection = guide.sampleConnection(budget, s.next1D());
        const float choice = s.next1D(), h = choice < 0.1f   ? 0.0f
                                             : choice < 0.2f ? 2.0f
                                                             : float(logUniform(s, 1e-12, 2.0));
        const auto vertex = guide.controlVertex(budget, connection, h, INFINITY);
        if (!vertex) continue;
        ++tested;
        SCOPED_TRACE(testing::Message() << "C " << C << " delta " << connection.excess << " h " << h << " width "
                                        << width);
        const Definition exact(budget.C, connection.excess, h);
        const Exact drop = -expm1(-Exact(sigma) * budget.width);
        // Of the length as it was rounded: its offset is known to an ulp of the excess, so e^{-sigma offset} is.
        const Exact offset = Exact(connection.excess) - budget.low;
        const Exact pdf = sigma * exp(-sigma * offset) / drop;
        ASSERT_TRUE(near(vertex->distance, exact.t()));
        ASSERT_TRUE(near(vertex->toTarget, exact.r()));
        ASSERT_TRUE(near(vertex->inversePdf, exact.tPerLength() / pdf, 3 * Bound));
        // Seen from the ray: of the connection through the vertex as it was rounded, which may have left the range.
        const Exact d(vertex->distance), delta = d + exact.toTarget(d) - budget.C, seenOffset = delta - budget.low;
        if (seenOffset < 0 || seenOffset > budget.width) continue;
        ++within;
        const Exact expected = sigma * exp(-sigma * seenOffset) / drop / Definition(budget.C, delta, h).tPerLength();
        ASSERT_TRUE(near(guide.pdfControlVertex(budget, h, vertex->distance), expected, 3 * Bound));
        // The range seen from the ray ends where it ends.
        if (budget.width > 1e-3f * budget.excess) {
            ASSERT_EQ(guide.pdfControlVertex(budget, h, 1.001f * budget.latest(h).firstLeg()), 0.0f);
        }
    }
    EXPECT_GT(within, 15000u);
    EXPECT_GT(tested, 20000u);
}

} // namespace
} // namespace darts
