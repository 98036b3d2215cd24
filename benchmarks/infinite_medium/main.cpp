// infinite_medium: which sampling works, without a scene. Every variant on every case, in both modes; a summary and
// all figures as comma-separated values.

#include "Measure.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <set>
#include <thread>

namespace {

using namespace infinite_medium;

/// Those whose name (indentation aside) is asked for; all if none is.
template <typename Named>
std::vector<Named> chosen(std::vector<Named> all, const std::vector<std::string>& names) {
    if (names.empty()) return all;
    std::erase_if(all, [&](const Named& candidate) {
        const std::string name = candidate.name.substr(candidate.name.find_first_not_of(' '));
        return std::find(names.begin(), names.end(), name) == names.end();
    });
    return all;
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    char text[16];
    std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
    return text;
}

void list(const char* mode, const std::vector<Case>& cases, const std::vector<Variant>& variants) {
    std::cout << mode << " cases:";
    for (const Case& c : cases) std::cout << ' ' << c.name;
    std::cout << '\n' << mode << " variants:\n";
    for (const Variant& v : variants) std::cout << "  " << v.name.substr(v.name.find_first_not_of(' ')) << '\n';
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Compares the library's samplers in an infinite homogeneous medium."};
    std::string mode = "both", markdown, csv;
    std::vector<std::string> cases, variants;
    Budget budget;
    budget.threads = std::max(1u, std::thread::hardware_concurrency());
    bool listOnly = false;
    app.add_option("--mode", mode, "path, photon or both")->check(CLI::IsMember({"path", "photon", "both"}));
    app.add_option("--seconds", budget.seconds, "processor time per variant and case")->check(CLI::PositiveNumber);
    app.add_option("--threads", budget.threads, "pairs of variant and case at a time")->check(CLI::PositiveNumber);
    app.add_option("--cases", cases, "names, separated by commas (default all)")->delimiter(',');
    app.add_option("--variants", variants, "names, separated by commas (default all)")->delimiter(',');
    app.add_option("--seed", budget.seed, "of the random numbers");
    app.add_option("--markdown", markdown, "file for the summary (default standard output)");
    app.add_option("--csv", csv, "file for all figures");
    app.add_flag("--list", listOnly, "print the names of cases and variants");
    CLI11_PARSE(app, argc, argv);
    if (listOnly) {
        list("path", pathCases(), pathVariants());
        list("photon", photonCases(), photonVariants());
        return 0;
    }
    std::vector<Experiment> experiments;
    const auto start = std::chrono::steady_clock::now();
    if (mode != "photon")
        experiments.push_back(measurePaths(chosen(pathCases(), cases), chosen(pathVariants(), variants), budget));
    if (mode != "path")
        for (Experiment& e : measurePhotons(chosen(photonCases(), cases), chosen(photonVariants(), variants), budget))
            experiments.push_back(std::move(e));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::ofstream markdownFile, csvFile;
    if (!markdown.empty()) markdownFile.open(markdown);
    if (!csv.empty()) csvFile.open(csv);
    std::ostream& tables = markdown.empty() ? std::cout : markdownFile;
    tables << "# Sampling in an infinite medium\n\nWithout a scene: every variant of the library's samplers, on cases "
              "of path "
              "tracing and of the photon pass, whose image is seen in a cone of\ndirections or all around (sphere). "
              "Efficiency is "
              "1 / (variance × time). The baselines leave directions to the phase function; their variance is "
              "infinite,\nso that "
              "ratios in cases that have not converged say little.\n\n`infinite_medium";
    for (int i = 1; i < argc; ++i) tables << ' ' << argv[i];
    tables << "`, " << today() << ", " << machineKind() << ", " << std::lround(seconds / 60) << " min. ";
    if (!csv.empty()) tables << "All figures: [" << csv << "](" << csv << "). ";
    tables << "What they say:\n[notebook](../../docs/notebook.md#infinite-medium).\n\n";
    int disagreements = 0;
    for (const Experiment& e : experiments) {
        if (e.cases.empty() || e.variants.empty()) continue;
        writeMarkdown(tables, e);
        if (csvFile.is_open()) writeCsv(csvFile, e, &e == &experiments.front());
        disagreements += reportDisagreements(std::cerr, e);
    }
    if (disagreements > 0) std::cerr << disagreements << " means differ by more than 5 standard errors.\n";
    if (!tables.good() || (csvFile.is_open() && !csvFile.good())) {
        std::cerr << "could not write the results\n";
        return 1;
    }
    return 0;
}
