#include "tungsten/film/PassScatter.h"

#include <algorithm>
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

void PassScatter::add(double squaredDeviation) {
    sum_ += squaredDeviation;
    if (++inGroup_ < span_) return;
    groups_.push_back(sum_ / double(span_));
    sum_ = 0.0;
    inGroup_ = 0;
    if (groups_.size() < MostGroups) return;
    for (size_t i = 0; i < MostGroups / 2; ++i) groups_[i] = 0.5 * (groups_[2 * i] + groups_[2 * i + 1]);
    groups_.resize(MostGroups / 2);
    span_ *= 2;
}

double PassScatter::boundFactor() const {
    constexpr double QuartileDistance = 1.349; // of a normal distribution, in standard deviations
    if (groups_.size() < 4) return std::numeric_limits<double>::quiet_NaN();
    double mean = 0.0, squares = 0.0;
    for (const double value : groups_) mean += value / double(groups_.size());
    for (const double value : groups_) squares += (value - mean) * (value - mean);
    if (!(mean > 0.0)) return 1.0; // all passes are alike
    const double relative = squares / (double(groups_.size() - 1) * mean * mean);
    std::vector<double> sorted = groups_;
    std::sort(sorted.begin(), sorted.end());
    const double median = quantile(sorted, 0.5);
    const double quartiles = (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / (QuartileDistance * median);
    const double usual = median > 0.0 ? std::min(quartiles * quartiles, relative) : relative;
    return std::sqrt(1.0 + Deviations * std::sqrt(relative / double(groups_.size()) + usual * double(span_)));
}

void PassScatter::write(std::ostream& out) const {
    const uint64_t counts[3] = {groups_.size(), span_, inGroup_};
    out.write(reinterpret_cast<const char*>(counts), sizeof counts);
    out.write(reinterpret_cast<const char*>(&sum_), sizeof sum_);
    out.write(reinterpret_cast<const char*>(groups_.data()), std::streamsize(groups_.size() * sizeof(double)));
}

void PassScatter::read(std::istream& in) {
    uint64_t counts[3] = {};
    in.read(reinterpret_cast<char*>(counts), sizeof counts);
    in.read(reinterpret_cast<char*>(&sum_), sizeof sum_);
    if (!in || counts[0] >= MostGroups) return in.setstate(std::ios::failbit);
    groups_.resize(size_t(counts[0]));
    in.read(reinterpret_cast<char*>(groups_.data()), std::streamsize(groups_.size() * sizeof(double)));
    span_ = size_t(counts[1]);
    inGroup_ = size_t(counts[2]);
}

} // namespace tungsten
