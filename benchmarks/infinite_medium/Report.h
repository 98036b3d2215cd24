#pragma once
// A summary and all figures of the measurements, and the check that all variants estimate one value.

#include "Statistics.h"
#include "Variants.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace infinite_medium {

/// Of one image or mode: measurements[case][variant].
struct Experiment {
    std::string title, baseline; ///< of the efficiencies
    std::vector<Case> cases;
    std::vector<Variant> variants;
    std::vector<std::vector<Measurement>> measurements;

    /// Mean of the trusted variants, the one asked for left out.
    [[nodiscard]] Estimate reference(size_t caseIndex, size_t variantIndex) const;
    [[nodiscard]] double zScore(size_t caseIndex, size_t variantIndex) const;
    /// Root mean square of the pixels' z-scores against the trusted variants; 0 without pixels.
    [[nodiscard]] double pixelZ(size_t caseIndex, size_t variantIndex) const;
    /// Efficiency relative to the baseline's; 0 if there is none.
    [[nodiscard]] double ratio(size_t caseIndex, size_t variantIndex) const;
};

/// Medians of the named variants' efficiencies, and how well the means of all agree.
void writeMarkdown(std::ostream& out, const Experiment& experiment);
/// All figures, a line for each case and variant; `heading` once per file. The study's efficiencies and the pixels'
/// z-scores are empty where there are none.
void writeCsv(std::ostream& out, const Experiment& experiment, bool heading);
/// Prints every |z| > 5 to `out`; returns how many there were.
int reportDisagreements(std::ostream& out, const Experiment& experiment);

/// "2 cores, AuthenticAMD family 25", without names of hosts.
std::string machineKind();

} // namespace infinite_medium
