#include "tungsten/film/ErrorConfidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <istream>
#include <limits>
#include <ostream>

namespace tungsten {

namespace {

/// Between the order statistics; `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double fraction) {
    const double at = fraction * double(sorted.size() - 1);
    const auto below = size_t(at);
    const double share = at - double(below);
    return sorted[below] + share * (sorted[std::min(below + 1, sorted.size() - 1)] - sorted[below]);
}

} // namespace

uint32_t ErrorConfidence::groupEndingWith(uint32_t pass) {
    constexpr uint32_t GroupsPerOctave = 32;
    const uint32_t passes = std::max(std::bit_floor(pass) / GroupsPerOctave, 1u);
    return (pass + 1) % passes == 0 ? passes : 0;
}

void ErrorConfidence::add(uint32_t pass, const PassSpread& deviation) {
    if (const double w = double(groupEndingWith(pass)); w > 0.0) {
        const double q = deviation.product * deviation.product / (w * w), d = deviation.blocks * lastBlocks_ / (w * w);
        const std::array<double, 7> terms{w, w * w, w * q, w * d, w * w * q * q, w * w * q * d, w * w * d * d};
        for (size_t i = 0; d > 0.0 && i < terms.size(); ++i) products_[i] += terms[i];
        lastBlocks_ = deviation.blocks;
    }
    sum_ += deviation.squares;
    if (++inGroup_ < span_) return;
    groups_.push_back(sum_ / double(span_));
    sum_ = 0.0;
    inGroup_ = 0;
    if (groups_.size() < MostGroups) return;
    for (size_t i = 0; i < MostGroups / 2; ++i) groups_[i] = 0.5 * (groups_[2 * i] + groups_[2 * i + 1]);
    groups_.resize(MostGroups / 2);
    span_ *= 2;
}

double ErrorConfidence::boundFactor() const {
    constexpr double QuartileDistance = 1.349; // of a normal distribution, in standard deviations
    if (groups_.size() < 4) return std::numeric_limits<double>::quiet_NaN();
    double mean = 0.0, squares = 0.0;
    for (const double value : groups_) mean += value / double(groups_.size());
    for (const double value : groups_) squares += (value - mean) * (value - mean);
    if (!(mean > 0.0)) return 1.0; // all passes are alike
    const double relative = squares / (double(groups_.size() - 1) * mean * mean);
    const double rare = relative / double(groups_.size()), all = relative * double(span_), shared = sharedVariance();
    if (std::isfinite(shared)) return std::sqrt(1.0 + Deviations * std::sqrt(rare + std::min(all, shared + rare)));
    std::vector<double> sorted = groups_;
    std::sort(sorted.begin(), sorted.end());
    const double median = quantile(sorted, 0.5);
    const double quartiles = (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / (QuartileDistance * median);
    const double usual = median > 0.0 ? std::min(quartiles * quartiles * double(span_), all) : all;
    return std::sqrt(1.0 + Deviations * std::sqrt(rare + usual));
}

double ErrorConfidence::sharedVariance() const {
    constexpr double Fewest = 8.0;
    const auto& [w, w2, wq, wd, w2q2, w2qd, w2d2] = products_;
    if (!(wd > 0.0) || w * w < Fewest * w2) return std::numeric_limits<double>::infinity();
    const double ratio = wq / wd, residual = w2q2 - 2.0 * ratio * w2qd + ratio * ratio * w2d2;
    return 2.0 * (ratio + Deviations * std::sqrt(std::max(residual, 0.0)) / wd);
}

void ErrorConfidence::write(std::ostream& out) const {
    const uint64_t counts[3] = {groups_.size(), span_, inGroup_};
    out.write(reinterpret_cast<const char*>(counts), sizeof counts);
    for (const double* sum : {&sum_, &lastBlocks_}) out.write(reinterpret_cast<const char*>(sum), sizeof *sum);
    out.write(reinterpret_cast<const char*>(products_.data()), sizeof products_);
    out.write(reinterpret_cast<const char*>(groups_.data()), std::streamsize(groups_.size() * sizeof(double)));
}

void ErrorConfidence::read(std::istream& in) {
    uint64_t counts[3] = {};
    in.read(reinterpret_cast<char*>(counts), sizeof counts);
    for (double* sum : {&sum_, &lastBlocks_}) in.read(reinterpret_cast<char*>(sum), sizeof *sum);
    in.read(reinterpret_cast<char*>(products_.data()), sizeof products_);
    if (!in || counts[0] >= MostGroups) return in.setstate(std::ios::failbit);
    groups_.resize(size_t(counts[0]));
    in.read(reinterpret_cast<char*>(groups_.data()), std::streamsize(groups_.size() * sizeof(double)));
    span_ = size_t(counts[1]);
    inGroup_ = size_t(counts[2]);
}

} // namespace tungsten
