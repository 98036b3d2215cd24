// sliced_values FILE.md [PATHS [ROWS]]
//
// Every verified value (docs/photon-primitives.md, section 6) by planes, volumes, balls and hypervolumes, from their
// geometry alone (tests/support/SlicedOrders.h), by PATHS walks each. Writes a summary to FILE.md and all deviations to
// FILE.csv; exits with 1 if one exceeds 4 standard errors, except where the estimator has no finite variance.

#include "support/SlicedOrders.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <iostream>

namespace tungsten::test {
namespace {

constexpr double LargestDeviation = 4.0;

struct Result {
    VerifiedValue value;
    Sliced row;
    SlicedMean found;

    [[nodiscard]] double score() const {
        // Values without an error are rounded.
        const double error = std::hypot(found.error, std::max(value.uncertainty, 1e-5 * value.radiance));
        return std::abs(found.mean - value.radiance) / std::max(error, 1e-300);
    }
    [[nodiscard]] bool agrees() const { return score() <= LargestDeviation; }
    /// Without ghosts the estimator is wrong: the figures show by how much.
    [[nodiscard]] bool counts() const { return !infiniteVariance(row) && row != Sliced::ShortWithoutGhosts; }
};

void write(std::ostream& file, const std::filesystem::path& all, const std::vector<Result>& results, uint64_t paths) {
    size_t counted = 0, within = 0;
    double worst = 0.0;
    for (const Result& r : results) {
        if (!r.counts()) continue;
        ++counted;
        within += r.agrees();
        worst = std::max(worst, r.score());
    }
    const std::string csv = all.filename().string();
    char text[128];
    std::snprintf(text, sizeof text, "%zu rows of finite variance, %zu within %g standard errors; the worst: %.1f.\n",
                  counted, within, LargestDeviation, worst);
    file << "# Verified values by sliced primitives\n\n"
            "The [verified values](../../docs/photon-primitives.md#6-verified-values) by planes, volumes, balls "
            "and hypervolumes, from their geometry alone:\n"
         << paths << " walks each, all primitives from one walk. " << text << "\nAll deviations: [" << csv << "]("
         << csv
         << "), in % with the standard error in %; the score is the deviation in standard errors of both together. "
            "Where the "
            "variance is infinite\nthe error is too small. Without padding directions (`no ghosts`) the estimator is "
            "wrong, as it should be.\n";
}

void writeCsv(std::ostream& file, const std::vector<Result>& results) {
    file << "value,radiance,row,deviation_percent,error_percent,score,infinite_variance,agrees\n";
    for (const Result& r : results) {
        char text[192];
        std::snprintf(text, sizeof text, "%s,%.5e,\"%s\",%+.2f,%.2f,%.1f,%d,%d\n", nameOf(r.value).c_str(),
                      r.value.radiance, SlicedNames[size_t(r.row)], 100.0 * (r.found.mean / r.value.radiance - 1.0),
                      100.0 * r.found.error / r.value.radiance, r.score(), infiniteVariance(r.row), r.agrees());
        file << text;
    }
}

bool prove(const std::string& path, uint64_t paths, const std::string& only) {
    std::vector<Result> results;
    for (const VerifiedValue& value : VerifiedValues) {
        if (nameOf(value).find(only) == std::string::npos) continue;
        const SlicedMeans means = SlicedOrder(value).means(paths, 1);
        for (size_t row = 0; row < means.size(); ++row)
            if (exists(Sliced(row), value)) results.push_back({value, Sliced(row), means[row]});
        std::cout << nameOf(value) << std::endl;
    }
    if (results.empty())
        throw std::runtime_error("no value's name holds '" + only + "'; names are such as A3WarpedBox");
    const std::filesystem::path all = std::filesystem::path(path).replace_extension(".csv");
    const std::string unfinished = path + ".part"; // under its own name when it is complete
    std::ofstream file(unfinished), csv(all);
    write(file, all, results, paths);
    writeCsv(csv, results);
    file.close();
    csv.close();
    if (!file || !csv) throw std::runtime_error(unfinished + " or " + all.string() + ": cannot be written");
    std::filesystem::rename(unfinished, path);
    return std::all_of(results.begin(), results.end(), [](const Result& r) { return r.agrees() || !r.counts(); });
}

} // namespace
} // namespace tungsten::test

int main(int argc, char** argv) {
    CLI::App app{"Single orders of scattering against exact and brute-force values, by sliced primitives."};
    std::string file, rows;
    uint64_t paths = 10000000;
    app.add_option("file", file, "the summary, in Markdown; all deviations beside it, as .csv")->required();
    app.add_option("paths", paths, "walks for each value")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("rows", rows, "only values with this in their name");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return tungsten::test::prove(file, paths, rows) ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
