#include "Report.h"

#include <cstdio>
#include <fstream>
#include <ostream>
#include <thread>

namespace infinite_medium {

namespace {

/// Two significant digits, as far as that is short.
std::string digits(double value) {
    char text[32];
    if (!std::isfinite(value) || value == 0) return "–";
    if (value >= 9.95)
        std::snprintf(text, sizeof text, value < 1e5 ? "%.0f" : "%.1e", value);
    else
        std::snprintf(text, sizeof text, value >= 0.095 ? "%.2g" : "%.1g", value);
    return text;
}

std::string format(const char* pattern, double value) {
    char text[32];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

template <typename Cell>
void writeTable(std::ostream& out, const Experiment& e, const char* corner, Cell&& cell) {
    out << "| " << corner << " |";
    for (const Case& c : e.cases) out << ' ' << c.name << " |";
    out << "\n| --- |";
    for (size_t i = 0; i < e.cases.size(); ++i) out << " --- |";
    out << '\n';
    for (size_t v = 0; v < e.variants.size(); ++v) {
        out << "| " << e.variants[v].name << " |";
        for (size_t c = 0; c < e.cases.size(); ++c) out << ' ' << cell(c, v) << " |";
        out << '\n';
    }
    out << '\n';
}

/// Count, root mean square, mean and extreme of all z-scores.
void summarise(std::ostream& out, const Experiment& e) {
    double count = 0, sum = 0, squares = 0, extreme = 0;
    for (size_t c = 0; c < e.cases.size(); ++c)
        for (size_t v = 0; v < e.variants.size(); ++v) {
            if (!e.measurements[c][v].converged()) continue;
            const double z = e.zScore(c, v);
            count += 1;
            sum += z;
            squares += z * z;
            if (std::abs(z) > std::abs(extreme)) extreme = z;
        }
    out << "Agreement of the means, where converged: " << count
        << " comparisons, rms z = " << format("%.2f", std::sqrt(squares / count))
        << ", mean z = " << format("%.2f", sum / count) << ", extreme z = " << format("%.1f", extreme) << ".\n\n";
}

} // namespace

Estimate Experiment::reference(size_t caseIndex, size_t variantIndex) const {
    std::vector<Estimate> trusted;
    for (size_t v = 0; v < variants.size(); ++v)
        if (v != variantIndex && variants[v].reference) trusted.push_back(measurements[caseIndex][v].estimate);
    return weightedMean(trusted);
}

double Experiment::zScore(size_t caseIndex, size_t variantIndex) const {
    const Estimate others = reference(caseIndex, variantIndex);
    return others.error > 0 ? measurements[caseIndex][variantIndex].estimate.zScore(others) : 0;
}

double Experiment::pixelZ(size_t caseIndex, size_t variantIndex) const {
    const std::vector<Estimate>& pixels = measurements[caseIndex][variantIndex].pixels;
    double count = 0, squares = 0;
    for (size_t pixel = 0; pixel < pixels.size(); ++pixel) {
        std::vector<Estimate> trusted;
        for (size_t v = 0; v < variants.size(); ++v)
            if (v != variantIndex && variants[v].reference) trusted.push_back(measurements[caseIndex][v].pixels[pixel]);
        const Estimate others = weightedMean(trusted);
        if (!(others.error > 0) || !(pixels[pixel].error > 0)) continue;
        const double z = pixels[pixel].zScore(others);
        count += 1;
        squares += z * z;
    }
    return count > 0 ? std::sqrt(squares / count) : 0;
}

double Experiment::ratio(size_t caseIndex, size_t variantIndex) const {
    for (size_t v = 0; v < variants.size(); ++v)
        if (variants[v].name == baseline)
            return measurements[caseIndex][variantIndex].efficiency() / measurements[caseIndex][v].efficiency();
    return 0;
}

void writeMarkdown(std::ostream& out, const Experiment& e) {
    out << "## " << e.title << "\n\nEfficiency relative to “" << e.baseline
        << "”; the study's figures in brackets. * variance not converged "
           "(kurtosis above a sixteenth of the paths).\n\n";
    writeTable(out, e, "variant", [&](size_t c, size_t v) {
        const std::vector<double>& study = e.variants[v].study;
        std::string cell = digits(e.ratio(c, v)) + (e.measurements[c][v].converged() ? "" : "*");
        for (size_t k = 0; k < study.size(); ++k)
            if (e.cases[c].studyColumn == k && study[k] > 0) cell += " (" + digits(study[k]) + ")";
        return cell;
    });
    summarise(out, e);
    writeTable(out, e, "z", [&](size_t c, size_t v) { return format("%.1f", e.zScore(c, v)); });
    writeTable(out, e, "kurtosis", [&](size_t c, size_t v) { return digits(e.measurements[c][v].kurtosis); });
    writeTable(out, e, "ns per path", [&](size_t c, size_t v) { return format("%.0f", e.measurements[c][v].cost); });
    writeTable(out, e, "mean ± error in %", [&](size_t c, size_t v) {
        const Estimate& m = e.measurements[c][v].estimate;
        return format("%.4g", m.mean) + " ± " + format("%.2g", 100 * m.error / m.mean);
    });
    if (e.measurements.empty() || e.measurements[0][0].pixels.empty()) return;
    writeTable(out, e, "rms z of the pixels", [&](size_t c, size_t v) { return format("%.2f", e.pixelZ(c, v)); });
}

void writeCsv(std::ostream& out, const Experiment& e, bool heading) {
    if (heading)
        out << "experiment,case,variant,paths,mean,standard_error,variance,kurtosis,ns_per_path,relative_efficiency,"
               "z\n";
    for (size_t c = 0; c < e.cases.size(); ++c)
        for (size_t v = 0; v < e.variants.size(); ++v) {
            const Measurement& m = e.measurements[c][v];
            const std::string& name = e.variants[v].name;
            char line[256];
            std::snprintf(line, sizeof line, ",%.0f,%.9g,%.4g,%.6g,%.6g,%.6g,%.6g,%.3f\n", m.paths, m.estimate.mean,
                          m.estimate.error, m.variance, m.kurtosis, m.cost, e.ratio(c, v), e.zScore(c, v));
            out << e.title << ',' << e.cases[c].name << ',' << name.substr(name.find_first_not_of(' ')) << line;
        }
}

int reportDisagreements(std::ostream& out, const Experiment& e) {
    int count = 0;
    for (size_t c = 0; c < e.cases.size(); ++c)
        for (size_t v = 0; v < e.variants.size(); ++v) {
            const double z = e.zScore(c, v);
            if (!(std::abs(z) > 5) || !e.measurements[c][v].converged()) continue;
            ++count;
            const Estimate expected = e.reference(c, v), found = e.measurements[c][v].estimate;
            out << "DISAGREES: " << e.title << ", case " << e.cases[c].name << ", " << e.variants[v].name << ": "
                << found.mean << " +- " << found.error << ", others " << expected.mean << " +- " << expected.error
                << ", z = " << z << '\n';
        }
    return count;
}

std::string machineKind() {
    std::ifstream info("/proc/cpuinfo");
    std::string vendor, family, line;
    while (std::getline(info, line)) {
        const size_t colon = line.find(": ");
        if (colon == std::string::npos) continue;
        if (line.starts_with("vendor_id")) vendor = line.substr(colon + 2);
        if (line.starts_with("cpu family")) family = line.substr(colon + 2);
    }
    return std::to_string(std::thread::hardware_concurrency()) + " cores, " + vendor + " family " + family;
}

} // namespace infinite_medium
