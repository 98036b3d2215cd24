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

/// Variants with an indented name are the preset above them with one part changed.
bool isIndented(const std::string& name) {
    return name.starts_with(' ');
}

std::string withoutIndent(const std::string& name) {
    return name.substr(name.find_first_not_of(' '));
}

/// The study's efficiency of a variant in a case; 0 where it has none.
double studyFigure(const Experiment& e, size_t caseIndex, size_t variantIndex) {
    const std::vector<double>& study = e.variants[variantIndex].study;
    const size_t column = e.cases[caseIndex].studyColumn;
    return column < study.size() ? study[column] : 0;
}

/// A field of comma-separated values.
std::string quoted(const std::string& text) {
    return text.find(',') == std::string::npos ? text : '"' + text + '"';
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
    out << "## " << e.title << "\n\nEfficiency relative to “" << e.baseline << "”, median of " << e.cases.size()
        << " cases, and in how many of them the variance has converged (kurtosis below a sixteenth of the paths).\n\n"
           "| variant | median | converged |\n| --- | ---: | ---: |\n";
    for (size_t v = 0; v < e.variants.size(); ++v) {
        if (isIndented(e.variants[v].name)) continue;
        std::vector<double> ratios;
        size_t converged = 0;
        for (size_t c = 0; c < e.cases.size(); ++c) {
            ratios.push_back(e.ratio(c, v));
            converged += e.measurements[c][v].converged();
        }
        out << "| " << e.variants[v].name << " | " << digits(median(ratios)) << " | " << converged << " |\n";
    }
    out << '\n';
    summarise(out, e);
}

void writeCsv(std::ostream& out, const Experiment& e, bool heading) {
    if (heading)
        out << "experiment,case,variant,relative_efficiency,study_efficiency,converged,z,kurtosis,ns_per_path,mean,"
               "standard_error_percent,pixel_rms_z,paths,variance\n";
    for (size_t c = 0; c < e.cases.size(); ++c)
        for (size_t v = 0; v < e.variants.size(); ++v) {
            const Measurement& m = e.measurements[c][v];
            const double study = studyFigure(e, c, v);
            out << quoted(e.title) << ',' << e.cases[c].name << ',' << quoted(withoutIndent(e.variants[v].name))
                << format(",%.4g,", e.ratio(c, v)) << (study > 0 ? format("%.4g", study) : "")
                << (m.converged() ? ",1" : ",0") << format(",%.2f", e.zScore(c, v)) << format(",%.4g", m.kurtosis)
                << format(",%.1f", m.cost) << format(",%.9g", m.estimate.mean)
                << format(",%.3g,", 100 * m.estimate.error / m.estimate.mean)
                << (m.pixels.empty() ? "" : format("%.2f", e.pixelZ(c, v))) << format(",%.0f", m.paths)
                << format(",%.6g\n", m.variance);
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
