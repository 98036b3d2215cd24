#include "darts/TemporalResponse.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace darts {

TemporalResponse TemporalResponse::box(double begin, double end) {
    return {{begin, end}, {1.0, 1.0}};
}

TemporalResponse TemporalResponse::gaussian(double center, double sigma) {
    constexpr int Ends = 65;
    constexpr double CandidatePlace = 4.0;
    std::vector<double> times(Ends), values(Ends);
    for (int i = 0; i < Ends; ++i) {
        const double x = CandidatePlace * (2.0 * i / (Ends - 1) - 1.0);
        times[size_t(i)] = center + x * sigma;
        values[size_t(i)] = std::exp(-0.5 * x * x);
    }
    return {std::move(times), std::move(values)};
}

TemporalResponse TemporalResponse::tabulated(std::vector<double> times, std::vector<double> values) {
    return {std::move(times), std::move(values)};
}

namespace {

/// Where the convolution of two piecewise linear densities may bend: sums of their ends. Few of them, evenly spread,
/// where there are many.
std::vector<double> bendsOfConvolution(const std::vector<double>& a, const std::vector<double>& b) {
    constexpr size_t Most = 4096, MostPairs = size_t(1) << 20;
    const double first = a.front() + b.front(), last = a.back() + b.back();
    std::vector<double> sums, bends;
    if (a.size() * b.size() > MostPairs) {
        for (size_t i = 0; i <= Most; ++i) sums.push_back(first + (last - first) * double(i) / double(Most));
    } else {
        for (const double s : a)
            for (const double t : b) sums.push_back(s + t);
        std::sort(sums.begin(), sums.end());
    }
    const double least = (last - first) / double(Most);
    for (const double sum : sums)
        if (bends.empty() || sum >= bends.back() + least) bends.push_back(sum);
    bends.back() = last;
    return bends;
}

} // namespace

double TemporalResponse::convolvedPdf(const TemporalResponse& other, double time) const {
    std::vector<double> ends;
    for (const double s : times_) ends.push_back(s);
    for (const double s : other.times_) ends.push_back(time - s);
    std::sort(ends.begin(), ends.end());
    double sum = 0.0;
    for (size_t k = 0; k + 1 < ends.size(); ++k) {
        const double low = std::max(ends[k], begin()), width = std::min(ends[k + 1], end()) - low;
        if (!(width > 0.0)) continue;
        // Between ends a parabola, which Gauss's two points integrate exactly; they lie inside, where densities that
        // begin with a step are continuous.
        constexpr double Point = 0.21132486540518713;
        for (const double share : {Point, 1.0 - Point}) {
            const double s = low + share * width;
            sum += 0.5 * width * pdf(s) * other.pdf(time - s);
        }
    }
    return sum;
}

TemporalResponse TemporalResponse::convolved(const TemporalResponse& a, const TemporalResponse& b) {
    std::vector<double> times = bendsOfConvolution(a.times_, b.times_), values;
    for (const double time : times) values.push_back(a.convolvedPdf(b, time));
    return {std::move(times), std::move(values)};
}

TemporalResponse::TemporalResponse(std::vector<double> times, std::vector<double> values)
    : times_(std::move(times)), densities_(std::move(values)), distribution_(times_.size(), 0.0) {
    if (times_.size() < 2 || times_.size() != densities_.size())
        throw std::invalid_argument("a temporal response needs as many values as times, at least two");
    for (size_t i = 0; i < times_.size(); ++i) {
        if (!std::isfinite(times_[i]) || !std::isfinite(densities_[i]) || densities_[i] < 0.0)
            throw std::invalid_argument("a temporal response needs finite times and values that are not negative");
        if (i == 0) continue;
        if (!(times_[i] > times_[i - 1])) throw std::invalid_argument("the times of a temporal response must increase");
        distribution_[i] =
            distribution_[i - 1] + 0.5 * (densities_[i] + densities_[i - 1]) * (times_[i] - times_[i - 1]);
    }
    const double total = distribution_.back();
    if (!(total > 0.0)) throw std::invalid_argument("a temporal response is zero everywhere");
    for (double& density : densities_) density /= total;
    for (double& value : distribution_) value /= total;
    distribution_.back() = 1.0;
}

size_t TemporalResponse::piece(const std::vector<double>& grid, double value) const {
    const auto above = std::upper_bound(grid.begin() + 1, grid.end() - 1, value);
    return size_t(above - grid.begin()) - 1;
}

double TemporalResponse::pdf(double time) const {
    if (!(time >= begin()) || time >= end()) return 0.0;
    const size_t i = piece(times_, time);
    const double x = (time - times_[i]) / (times_[i + 1] - times_[i]);
    return densities_[i] + x * (densities_[i + 1] - densities_[i]);
}

double TemporalResponse::distribution(double time) const {
    if (!(time > begin())) return 0.0;
    if (time >= end()) return 1.0;
    const size_t i = piece(times_, time);
    return std::min(distribution_[i] + 0.5 * (densities_[i] + pdf(time)) * (time - times_[i]), 1.0);
}

double TemporalResponse::quantile(double u) const {
    const size_t i = piece(distribution_, u);
    const double low = densities_[i], width = times_[i + 1] - times_[i], slope = (densities_[i + 1] - low) / width;
    const double area = std::max(u - distribution_[i], 0.0);
    // Root of low t + slope t^2 / 2 = area in the form without cancellation.
    const double root = std::sqrt(std::max(low * low + 2.0 * slope * area, 0.0)) + low;
    const double t = root > 0.0 ? 2.0 * area / root : 0.0;
    return std::min(times_[i] + std::min(t, width), std::nextafter(end(), begin()));
}

} // namespace darts
