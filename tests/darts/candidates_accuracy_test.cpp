// Candidates of distances and directions against 50 digits: where they come from, with what density, and what they are
// weighed by, one at a time and in registers; excess lengths of 1e-6, depths from 1e-4 to 1e3, needles.

#include "darts/CandidateKernel.h"
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
using tungsten::test::LargestError;
using tungsten::test::logUniform;
using Register = RegisterOf<8>;

float firstLane(const Register& batch) {
    alignas(64) std::array<float, 8> values{};
    lanes::put(values.data(), batch);
    return values[0];
}

/// A draw in a grey medium.
struct Drawn {
    Medium medium;
    CandidateDraw draw;

    explicit Drawn(uint64_t i, Proposals proposals = Proposals::Exponential) {
        Sampler s(51, RandomStream::Test, 0, i);
        const double scale = logUniform(s, 1e-4, 1e5);
        const float C = s.next1D() < 0.1f ? 0.0f : float(scale);
        draw.latest = {C, float(scale * logUniform(s, 1e-6, 10.0)),
                       s.next1D() < 0.1f ? 2.0f : float(logUniform(s, 1e-9, 2.0))};
        draw.firstLeg = draw.latest.firstLeg();
        draw.bound = draw.firstLeg * (s.next1D() < 0.5f ? 1.0f : s.next1D());
        draw.gateWidth = float(double(draw.latest.length()) * logUniform(s, 1e-6, 1.0));
        draw.overlap = s.next1D() < 0.5f;
        draw.proposals = proposals;
        const double depth = logUniform(s, 1e-4, 1e3) / double(draw.bound), albedo = s.nextDouble();
        const auto sigmaS = float(albedo * depth), sigmaA = float((1.0 - albedo) * depth);
        medium = {{sigmaA, sigmaA, sigmaA}, {sigmaS, sigmaS, sigmaS}, 1.8f * s.next1D() - 0.9f};
        draw.medium = &medium;
    }
    Drawn(const Drawn&) = delete;
    Drawn& operator=(const Drawn&) = delete;
};

/// e^{-rate d} on [0, bound), normalised.
Exact exponential(const Exact& rate, const Exact& bound, const Exact& d) {
    return rate * exp(-rate * d) / -expm1(-rate * bound);
}

/// The mixture's density at the distance that was drawn.
Exact mixture(const CandidateDraw& draw, const Exact& d, bool pairs) {
    const Exact rate(draw.medium->sigmaT().x), bound(draw.bound);
    if (draw.proposals == Proposals::Equiangular) {
        const Exact C(draw.latest.C), h(draw.latest.h), centre = C * (1 - h);
        const Exact least = Exact(1e-3f) * draw.latest.length(), height = C * sqrt(h * (2 - h));
        const Exact spread = height > least ? height : least;
        const Exact angles = atan((bound - centre) / spread) + atan(centre / spread);
        return spread / angles / (spread * spread + (d - centre) * (d - centre));
    }
    if (rate * bound < 0.05f) return 1 / bound;
    const Exact own = exponential(rate, bound, d);
    if (draw.proposals == Proposals::Exponential || !pairs) return own;
    const Exact second = draw.proposals == Proposals::MixedQuarter ? exponential(rate / 4, bound, d) : Exact(1 / bound);
    return (own + second) / 2;
}

TEST(CandidatesAccuracy, DensitiesOfProposals) {
    for (const auto& [kind, name, bound] : {std::tuple(Proposals::Exponential, "exponential", 1.6e-6),
                                            {Proposals::MixedUniform, "mixed_uniform", 1.6e-6},
                                            {Proposals::MixedQuarter, "mixed_quarter", 1.6e-6},
                                            {Proposals::Equiangular, "equiangular", 1.2e-4}}) {
        LargestError density(name), transmittance(std::string("transmittance_") + name);
        for (uint64_t i = 0; i < 500; ++i) {
            const Drawn drawn(i, kind);
            Sampler s(52, RandomStream::Test, 0, i);
            const Proposal<Register, 8, 1> registers(drawn.draw);
            const Proposal<float, 1, 1> single(drawn.draw);
            for (const float u : {s.next1D(), 0.999f}) {
                Register pdfs(0.0f), throughs(0.0f);
                float pdf = 0.0f, through = 0.0f;
                const float d = firstLane(registers.sample(Register(u), 0, pdfs, throughs));
                const float alone = single.sample(u, 0, pdf, through);
                const Exact sigma(drawn.medium.sigmaT().x);
                if (sigma * d > 80) continue;
                density.add(double(firstLane(pdfs)), mixture(drawn.draw, d, true));
                density.add(double(pdf), mixture(drawn.draw, alone, false));
                transmittance.add(double(firstLane(throughs)), exp(-sigma * d));
                transmittance.add(double(through), exp(-sigma * alone));
            }
        }
        EXPECT_TRUE(density.within(bound));
        EXPECT_TRUE(transmittance.within(7e-6));
    }
}

/// log(e^{-sigmaT d} Phi(rho, S - d)), of the Green's functions' definitions; but for what all candidates share.
Exact logContribution(const Drawn& drawn, Shape shape, const Exact& d, Exact& terms) {
    const Ellipse<float>& e = drawn.draw.latest;
    const Exact C(e.C), S = C + e.delta, s = S - d, rho2 = d * d - 2 * d * C * (1 - Exact(e.h)) + C * C;
    const Exact sigmaA(drawn.medium.sigmaA.x), sigmaS(drawn.medium.sigmaS.x),
        reduced = sigmaS * (1 - Exact(drawn.medium.g));
    terms = 1 + (sigmaA + sigmaS) * d;
    if (shape == Shape::TimeBound) return -(sigmaA + sigmaS) * d;
    if (shape == Shape::Diffusion) {
        const Exact spread = rho2 * 3 * (sigmaA + reduced) / (4 * s);
        terms += spread;
        return 1.5 * log(S / s) - spread - sigmaS * d;
    }
    const Exact u = 1 - rho2 / (s * s), x = reduced * s * pow(u, Exact(0.75));
    terms += x + reduced * d;
    return log(u) / 8 + 1.5 * log(S / s) + x + log(1 + Exact(2.026) / x) / 2 - (sigmaS - reduced) * d +
           log(reduced * S) / 2;
}

template <Shape G>
void expectUseful(const char* name, double bound) {
    LargestError useful(name), reachable(std::string("reachable_") + name);
    for (uint64_t i = 0; i < 700; ++i) {
        const Drawn drawn(i);
        Sampler s(53, RandomStream::Test, 0, i);
        const float d = s.next1D() * drawn.draw.firstLeg * (1.0f - 1e-6f);
        const CandidatePlace<Register> at(drawn.draw, Register(d));
        const CandidatePlace<float> alone(drawn.draw, d);
        Register factors(0.0f);
        float factor = 0.0f;
        const CandidateImportance<G> importance(drawn.draw, 0, true);
        const double found =
            double(firstLane(importance.exponent(Register(d), at, factors))) + std::log(double(firstLane(factors)));
        const double single = double(importance.exponent(d, alone, factor)) + std::log(double(factor));
        Exact terms;
        const Exact exact = logContribution(drawn, G, d, terms);
        useful.add(found, exact, terms);
        useful.add(single, exact, terms);
        const Ellipse<float>& e = drawn.draw.latest;
        const Exact C(e.C), left = C + e.delta - d - sqrt(Exact(d) * d - 2 * d * C * (1 - Exact(e.h)) + C * C);
        const Exact part = !drawn.draw.overlap ? Exact(1) : std::min(left, Exact(drawn.draw.gateWidth));
        reachable.add(double(firstLane(at.reachable)), part, part + Exact(e.delta) * (drawn.draw.overlap ? 1 : 0));
    }
    EXPECT_TRUE(useful.within(bound));
    EXPECT_TRUE(reachable.within(1.5e-6));
}

TEST(CandidatesAccuracy, CandidateImportance) {
    expectUseful<Shape::TimeBound>("time_bound", 2e-7);
    expectUseful<Shape::Diffusion>("diffusion", 2.5e-6);
    expectUseful<Shape::Causal>("causal", 5e-6);
}

/// Proportional to 1 / (rate - pull cos).
TEST(CandidatesAccuracy, LobesOfDrift) {
    LargestError pdf("drift_pdf"), sampled("drift_sample");
    for (uint64_t i = 0; i < 2000; ++i) {
        Sampler s(54, RandomStream::Test, 0, i);
        const auto rate = float(logUniform(s, 1e-4, 1e5)), pull = rate * float(1.0 / (1.0 + logUniform(s, 1e-3, 1e5)));
        const auto lobe = ConnectionLobe<float>::drift(rate, pull);
        const auto h = float(logUniform(s, 1e-9, 2.0));
        const Exact far = Exact(rate) + pull, near = Exact(rate) - pull, range = log(far / near);
        pdf.add(double(lobe.pdf(h)), pull / (2 * ExactPi * range * (near + pull * Exact(h))));
        const float u = s.next1D();
        if (u > 0.0f) sampled.add(double(lobe.sample(u)), near / pull * expm1(u * range));
    }
    EXPECT_TRUE(pdf.within(6e-7));
    EXPECT_TRUE(sampled.within(9e-7));
}

/// Shares of the lobe and the phase function, as the mixture's definition has them.
TEST(CandidatesAccuracy, MixturesOfDirections) {
    LargestError mixed("mixtures");
    const auto dotOf = [](const Vec3& a, const Vec3& b) {
        return Exact(Exact(a.x) * b.x + Exact(a.y) * b.y + Exact(a.z) * b.z);
    };
    const auto henyeyGreenstein = [](const Exact& g, const Exact& h) {
        const Exact d = (1 - g) * (1 - g) + 2 * g * h;
        return Exact((1 - g * g) / (4 * ExactPi * d * sqrt(d)));
    };
    for (uint64_t i = 0; i < 1500; ++i) {
        Sampler s(55, RandomStream::Test, 0, i);
        const float sigma = float(logUniform(s, 1e-3, 1e2));
        const Medium medium{{0, 0, 0}, {sigma, sigma, sigma}, 0.0f};
        const Guide guide(best(Mode::Photon, 0.0f), medium);
        const double C = logUniform(s, 1e-2, 1e2), high = C * (1.0 + logUniform(s, 1e-4, 10.0));
        const TimeBudget budget =
            TimeBudget::of(directionAbout({0, 0, 1}, s.next1D(), s.next1D()) * float(C), {C, high});
        // Directions suit the median length, whatever was drawn.
        const ConnectionSample connection = guide.sampleConnection(budget, 0.5f);
        const ConnectionSample drawn = guide.sampleConnection(budget, s.next1D());
        const Vec3 direction = directionAbout(budget.axis, float(logUniform(s, 1e-2, 2.0)), s.next1D());
        const HenyeyGreenstein phase{{0, 0, 1}, 0.3f};
        const Exact distance(budget.C), delta(connection.excess), S = distance + delta;
        // Of unit vectors as they were rounded.
        const auto apart = [&](const Vec3& a, const Vec3& b) {
            const Vec3 difference = a - b;
            return Exact(dotOf(difference, difference) / 2);
        };
        const Exact h = apart(direction, budget.axis);
        const Exact lobe = 1 / (2 * ExactPi * (delta / distance + h) * log1p(2 * distance / delta));
        const Settings& settings = guide.settings();
        const Exact ratio = distance / S, share = ratio / (ratio + Exact(settings.alpha));
        const Exact exact =
            share * lobe + (1 - share) * henyeyGreenstein(Exact(phase.g), apart(direction, phase.before));
        mixed.add(double(guide.pdfDirection(budget, drawn, direction, phase)), exact);
    }
    EXPECT_TRUE(mixed.within(1.3e-6));
}

} // namespace
} // namespace darts
