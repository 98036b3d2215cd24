// Two readings of the published method are biased. Put in place of the derived forms they show the bias that was found
// with independent implementations, while the derived forms show none.

#include "Cases.h"
#include "estimates.h"

#include <gtest/gtest.h>

namespace infinite_medium::test {
namespace {

/// The target length is drawn anew at every vertex, evenly, and what is not in time for it gets no weight.
struct FreshTarget : DerivedForm {
    [[nodiscard]] static darts::ConnectionSample connection(const darts::Guide&, const darts::TimeBudget& budget,
                                                            float u) {
        return {budget.low + budget.width * u, budget.width};
    }
    [[nodiscard]] static darts::TimeBudget distanceRange(const darts::TimeBudget& budget,
                                                         const darts::ConnectionSample& connection) {
        darts::TimeBudget aimed = budget;
        aimed.excess = connection.excess;
        return aimed;
    }
};

/// p(t) = p(S) (S - t) / (S - C cos): the ratio upside down.
struct InvertedRatio : DerivedForm {
    [[nodiscard]] static float inversePdf(const darts::ControlVertex& vertex,
                                          const darts::ConnectionSample& connection) {
        return connection.inversePdf * connection.inversePdf / vertex.inversePdf;
    }
};

/// Biases of all orders together in path mode, as parts of the true value.
struct Published {
    Case medium;
    double freshTarget, invertedRatio, tolerance;
    uint64_t paths;
};

const Published Findings[] = {{{"03", 1, 1.2, 1, 0, .02 * 1.2}, -0.021, -0.38, 0.015, 100000},
                              {{"wide gate", 3, 5, 1, 0, .10 * 5}, -0.30, 0.40, 0.03, 20000}};

template <typename Form>
Estimate mean(const Case& c, const darts::Settings& settings, uint64_t paths, uint64_t seed) {
    const Route route{{0, 0, 0}, {0, 0, 1}, {c.gateStart, c.gateEnd()}};
    return radianceByOrder<Form>(settings, c.medium(), route, {0.6f, 0, 0.8f}, paths, seed)[0];
}

/// Relative deviation from the truth.
Estimate bias(const Estimate& found, const Estimate& truth) {
    return {found.mean / truth.mean - 1, std::hypot(found.error, truth.error) / truth.mean};
}

TEST(PublishedForms, HaveTheBiasThatWasFoundAndTheDerivedFormsHaveNone) {
    for (const Published& finding : Findings) {
        SCOPED_TRACE(finding.medium.name);
        darts::Settings independent = darts::best(darts::Mode::Path, 0.0f);
        independent.alpha = 0.5f;
        independent.proposals = darts::Proposals::MixedQuarter;
        independent.greens = darts::Greens::Diffusion;
        const darts::Settings settings = darts::best(darts::Mode::Path, 0.0f);
        const Estimate truth = mean<DerivedForm>(finding.medium, independent, finding.paths, 31);
        const Estimate derived = bias(mean<DerivedForm>(finding.medium, settings, finding.paths, 32), truth);
        const Estimate fresh = bias(mean<FreshTarget>(finding.medium, settings, finding.paths, 33), truth);
        const Estimate inverted = bias(mean<InvertedRatio>(finding.medium, settings, finding.paths, 34), truth);
        EXPECT_NEAR(derived.mean, 0, 4.5 * derived.error);
        EXPECT_NEAR(fresh.mean, finding.freshTarget, finding.tolerance + 4.5 * fresh.error);
        EXPECT_LT(fresh.mean, -4.5 * fresh.error);
        EXPECT_NEAR(inverted.mean, finding.invertedRatio, finding.tolerance + 4.5 * inverted.error);
        EXPECT_GT(std::abs(inverted.mean), 4.5 * inverted.error);
    }
}

} // namespace
} // namespace infinite_medium::test
