// All unbiased variants have one mean: plain sampling, the published sampler with bounded candidates, the presets.

#include "Measure.h"

#include <gtest/gtest.h>

namespace infinite_medium {
namespace {

constexpr double MostSigmas = 5;

template <typename Named>
std::vector<Named> named(std::vector<Named> all, const std::vector<std::string>& names) {
    std::erase_if(all, [&](const Named& x) { return std::find(names.begin(), names.end(), x.name) == names.end(); });
    EXPECT_EQ(all.size(), names.size());
    return all;
}

/// With wide gates, in which plain sampling finds the light as well.
std::vector<Case> widened(std::vector<Case> cases) {
    for (Case& c : cases) c.gateWidth = 0.2 * c.gateStart;
    return cases;
}

void expectAgreement(const Experiment& e) {
    double squares = 0;
    for (size_t c = 0; c < e.cases.size(); ++c)
        for (size_t v = 0; v < e.variants.size(); ++v) {
            const Estimate found = e.measurements[c][v].estimate, others = e.reference(c, v);
            const double z = found.zScore(others);
            EXPECT_LT(std::abs(z), MostSigmas)
                << e.title << ", case " << e.cases[c].name << ", " << e.variants[v].name << ": " << found.mean << " +- "
                << found.error << ", others " << others.mean << " +- " << others.error;
            EXPECT_LT(found.error, (e.variants[v].reference ? 0.1 : 0.4) * found.mean) << "the comparison says nothing";
            squares += z * z;
        }
    EXPECT_LT(std::sqrt(squares / double(e.cases.size() * e.variants.size())), 1.8) << e.title;
}

TEST(Agreement, PathMode) {
    Budget budget;
    budget.paths = 40000;
    expectAgreement(
        measurePaths(widened(named(pathCases(), {"01", "02", "03", "04", "05", "06", "07"})),
                     named(pathVariants(), {"A plain", "B elliptical only", "bounded phase",
                                            "bounded table diffusion a.5", "bounded lobe a.5", "R2", "best"}),
                     budget));
}

TEST(Agreement, PhotonMode) {
    Budget budget;
    budget.paths = 20000;
    for (const Experiment& e : measurePhotons(widened(named(photonCases(), {"GD", "3", "6"})),
                                              named(photonVariants(), {"P0 plain", "P0 elliptical only", "P2 bounded",
                                                                       "P2 table a.5", "RIS M=4", "best"}),
                                              budget))
        expectAgreement(e);
}

} // namespace
} // namespace infinite_medium
