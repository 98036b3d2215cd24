// verified_values FILE.md [SECONDS [ROWS]]
//
// Renders every verified value (docs/photon-primitives.md, section 6) by points, beams and paths, plain, published and
// best, for about SECONDS (5) each: a pilot finds how many passes that is. With ROWS only what has it in its name, such
// as "A2" or "best beams". Writes a summary to FILE.md and all deviations to FILE.csv; exits with 1 if one exceeds what
// is allowed, except where the estimator is known to have no finite variance.

#include "support/PathsAndPhotons.h"
#include "support/VerifiedValues.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace tungsten::test {
namespace {

constexpr double PointRadius = 0.15, BeamRadius = 0.1, Tau = 0.05;
constexpr double KernelBias = 0.01;         ///< allowed to points and beams
constexpr double Rounding = 2e-4;           ///< allowed to paths: of the printed values, and the pixel's width
constexpr double LargestDeviation = 4.0;    ///< in standard errors, beyond what is allowed
constexpr double LargestProvingError = 0.1; ///< relative standard errors above it prove little

enum class Primitive { Points, Beams, Paths };
enum class Preset { Plain, Published, Best };

struct Method {
    const char* name;
    Primitive primitive;
    Preset preset;
};
constexpr std::array Methods{Method{"plain points", Primitive::Points, Preset::Plain},
                             Method{"published points", Primitive::Points, Preset::Published},
                             Method{"best points", Primitive::Points, Preset::Best},
                             Method{"plain beams", Primitive::Beams, Preset::Plain},
                             Method{"published beams", Primitive::Beams, Preset::Published},
                             Method{"best beams", Primitive::Beams, Preset::Best},
                             Method{"plain paths", Primitive::Paths, Preset::Plain},
                             Method{"published paths", Primitive::Paths, Preset::Published},
                             Method{"best paths", Primitive::Paths, Preset::Best}};

/// Plain paths meet a delta gate with probability zero, and paths render none in scenes with surfaces that scatter.
bool applies(const Method& method, const VerifiedValue& value) {
    if (method.primitive != Primitive::Paths || !value.delta) return true;
    return method.preset != Preset::Plain && value.configuration != 'W';
}

/// Plain paths connect to the light (with a laser: to a vertex on it) from wherever they are, weight 1 / distance^2,
/// and published directions ignore the weight 2 / |S w - r|^2 of the control vertex that they lead to: both have tails
/// x^(-3/2) once a vertex is free to come near, hence means that are usually low and errors that shrink like N^(-1/3)
/// (docs/photon-primitives.md, sections 2.5 and 6.5). Published photons have the like where forward scattering has to
/// turn back.
bool infiniteVariance(const Method& method, const VerifiedValue& value) {
    if (method.primitive == Primitive::Paths)
        return method.preset != Preset::Best && value.order > (value.configuration == 'C' ? 2 : 1);
    return method.preset == Preset::Published && value.configuration == 'B' && !value.unwarped;
}

struct Row {
    VerifiedValue value;
    Method method;
    double deviation = 0.0, error = 0.0; ///< relative to the value; `error` is the render's
    uint32_t passes = 0;
    bool repeated = false; ///< the second render of a value that the first one missed
    bool finite = true;

    [[nodiscard]] double allowance() const { return method.primitive == Primitive::Paths ? Rounding : KernelBias; }
    [[nodiscard]] double combinedError() const { return std::hypot(error, value.uncertainty / value.radiance); }
    /// Deviation in standard errors, beyond what is allowed.
    [[nodiscard]] double score() const {
        return std::max(0.0, std::abs(deviation) - allowance()) / std::max(combinedError(), 1e-12);
    }
    [[nodiscard]] bool agrees() const { return finite && score() <= LargestDeviation; }
    [[nodiscard]] bool noisy() const { return error > LargestProvingError; }
    [[nodiscard]] bool exempt() const { return infiniteVariance(method, value); }
    [[nodiscard]] std::string marks() const {
        return std::string(exempt() ? " ∞" : "") + (noisy() ? " noisy" : "") + (repeated ? " repeated" : "") +
               (agrees() ? "" : " **disagrees**");
    }
};

std::unique_ptr<Rendered> renderRow(const VerifiedValue& value, const Method& method, uint32_t passes, uint64_t seed) {
    Overrides overrides = gateOf(value, Tau);
    if (method.preset == Preset::Published) overrides.emplace_back("integrator.darts=published");
    if (method.preset == Preset::Best) overrides.emplace_back("integrator.darts=best");
    RenderOptions options{overrides, passes, 1, seed};
    const auto photons = [&](double radius, double count) {
        options.overrides.push_back(setting("volume_gather_radius", radius));
        options.overrides.push_back(setting("photon_count", count));
    };
    switch (method.primitive) {
    case Primitive::Points:
        photons(PointRadius, 15000);
        return renderPhotons(sceneOf(value), options);
    case Primitive::Beams:
        photons(BeamRadius, 6000);
        return renderBeams(sceneOf(value), options);
    case Primitive::Paths:
        options.samplesPerPass = 5000;
        return renderPaths(sceneOf(value), options);
    }
    return nullptr;
}

/// So many that they take about `seconds`.
uint32_t passesFor(const VerifiedValue& value, const Method& method, double seconds) {
    for (uint32_t passes = 8;; passes *= 4) {
        const auto start = std::chrono::steady_clock::now();
        renderRow(value, method, passes, 77);
        const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (taken > 0.1 * seconds || passes > 1000000) return std::max(8u, uint32_t(passes * seconds / taken));
    }
}

Row measure(const VerifiedValue& value, const Method& method, uint32_t passes, uint64_t seed) {
    const auto rendered = renderRow(value, method, passes, seed);
    Row row{value, method};
    row.deviation = rendered->mean() / value.radiance - 1.0;
    row.error = rendered->pixelError() / value.radiance;
    row.passes = passes;
    row.finite = rendered->statistics.counter("non-finite samples") == 0;
    return row;
}

/// A value that is missed gets a second chance, with another seed and four times the passes: errors of heavy tails are
/// themselves uncertain.
Row prove(const VerifiedValue& value, const Method& method, double seconds) {
    const uint32_t passes = passesFor(value, method, seconds);
    Row row = measure(value, method, passes, 1);
    const auto print = [&row] {
        std::printf("%s, %s: %+.2f %% +- %.2f (%.1f), %u passes%s\n", nameOf(row.value).c_str(), row.method.name,
                    100.0 * row.deviation, 100.0 * row.error, row.score(), row.passes, row.marks().c_str());
        std::fflush(stdout);
    };
    print();
    if (row.agrees() || row.exempt()) return row;
    row = measure(value, method, 4 * passes, 2);
    row.repeated = true;
    print();
    return row;
}

void writeHeader(std::ostream& file, const std::filesystem::path& all, double seconds) {
    const std::string csv = all.filename().string();
    file
        << "# Verified values\n\n"
           "Single orders of scattering by every method against the "
           "[verified values](../../docs/photon-primitives.md#6-verified-values).\n"
        << "About " << seconds
        << " s per render on 2 threads; 15000 photons, 6000 beams or 5000 paths a pass; constant radii. Points: "
           "biweight "
           "kernel of radius "
        << PointRadius << "; beams: uniform\nkernel of radius " << BeamRadius
        << "; delta gates: uniform kernel of half-width " << Tau << ". Allowed: " << 100.0 * KernelBias
        << " % for the kernels' bias, " << 100.0 * Rounding << " % for paths (rounding).\n\n"
        << "All deviations: [" << csv << "](" << csv
        << "), in % of the value with the standard error of the render in %; the score is the deviation beyond what is "
           "allowed, in standard\nerrors of render and value together. A value's name: configuration, order of "
           "scattering, "
           "time (with or without the camera's segment), gate (a delta; a box of\nwidth 1, or of 0.1: narrow).\n\n"
           "- Infinite variance (∞): means are usually too low and standard errors too small. These rows stand apart "
           "in the "
           "summary, with those within "
        << LargestDeviation << " in brackets.\n- Noisy: the standard error is above " << 100.0 * LargestProvingError
        << " %, so that the row proves little.\n- Repeated: the first render deviated by more than " << LargestDeviation
        << "; the figures are those of a second one, with another seed and four times the passes.\n"
           "- Plain paths cannot meet a delta gate, and guided ones render none where surfaces could scatter: these "
           "rows do "
           "not exist.\n\n";
}

void writeCsv(std::ostream& file, const std::vector<Row>& rows) {
    file << "value,radiance,method,deviation_percent,error_percent,score,infinite_variance,noisy,repeated,agrees\n";
    for (const Row& row : rows) {
        char text[192];
        std::snprintf(text, sizeof text, "%s,%.5e,%s,%+.2f,%.2f,%.1f,%d,%d,%d,%d\n", nameOf(row.value).c_str(),
                      row.value.radiance, row.method.name, 100.0 * row.deviation, 100.0 * row.error, row.score(),
                      row.exempt(), row.noisy(), row.repeated, row.agrees());
        file << text;
    }
}

/// Of one method's rows (all: name empty): how many agree, and how wide deviations spread in units of their errors.
std::string summary(const std::vector<Row>& rows, const std::string& name) {
    int counted = 0, within = 0, noisy = 0, repeated = 0, exempt = 0, exemptWithin = 0;
    double worst = 0.0, squares = 0.0;
    std::vector<double> errors;
    for (const Row& row : rows) {
        if (!name.empty() && name != row.method.name) continue;
        if (row.exempt()) {
            ++exempt;
            exemptWithin += row.agrees();
            continue;
        }
        ++counted;
        within += row.agrees();
        noisy += row.noisy();
        repeated += row.repeated;
        worst = std::max(worst, row.score());
        squares += std::pow(row.deviation / std::hypot(row.combinedError(), Rounding), 2);
        errors.push_back(row.error);
    }
    std::sort(errors.begin(), errors.end());
    char text[256];
    std::snprintf(text, sizeof text, "| %s | %d | %d | %.1f | %.2f | %.2f | %d | %d | %d (%d) |\n",
                  name.empty() ? "all" : name.c_str(), counted, within, worst,
                  counted > 0 ? std::sqrt(squares / counted) : 0.0,
                  counted > 0 ? 100.0 * errors[errors.size() / 2] : 0.0, noisy, repeated, exempt, exemptWithin);
    return text;
}

bool proveAll(const std::string& path, double seconds, const std::string& only) {
    const std::filesystem::path all = std::filesystem::path(path).replace_extension(".csv");
    const std::string unfinished = path + ".part"; // under its own name when it is complete
    std::ofstream file(unfinished);
    if (!file) throw std::runtime_error(unfinished + ": cannot be written");
    std::vector<Row> rows;
    for (const VerifiedValue& value : VerifiedValues)
        for (const Method& method : Methods)
            if (applies(method, value) && (nameOf(value) + ", " + method.name).find(only) != std::string::npos)
                rows.push_back(prove(value, method, seconds));
    if (rows.empty()) {
        file.close();
        std::filesystem::remove(unfinished);
        throw std::runtime_error("no row's name holds '" + only + "'; names are such as 'A2WarpedBox, best beams'");
    }
    writeHeader(file, all, seconds);
    std::string table = "| method | values | within 4 | worst | rms of deviation / error | median error, % | "
                        "noisy | repeated | ∞ |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Method& method : Methods)
        if (std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return row.method.name == method.name; }))
            table += summary(rows, method.name);
    table += summary(rows, "");
    std::cout << table;
    file << table;
    file.close();
    std::ofstream csv(all);
    writeCsv(csv, rows);
    csv.close();
    if (!file || !csv) throw std::runtime_error(unfinished + " or " + all.string() + ": cannot be written");
    std::filesystem::rename(unfinished, path);
    return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.agrees() || row.exempt(); });
}

} // namespace
} // namespace tungsten::test

int main(int argc, char** argv) {
    CLI::App app{"Single orders of scattering against exact and brute-force values, by every method."};
    std::string file, rows;
    double seconds = 5.0;
    app.add_option("file", file, "the summary, in Markdown; all deviations beside it, as .csv")->required();
    app.add_option("seconds", seconds, "of each render, about")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("rows", rows, "only those with this in their name");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return tungsten::test::proveAll(file, seconds, rows) ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
