#pragma once
// Moments of heavy-tailed estimates: batch by batch, medians of the batches' variances, errors from the batches' means.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <vector>

namespace infinite_medium {

/// Raw moments of the paths of one batch.
struct Moments {
    double count = 0, first = 0, second = 0, third = 0, fourth = 0;

    void add(double x) {
        const double square = x * x;
        count += 1;
        first += x;
        second += square;
        third += square * x;
        fourth += square * square;
    }
    [[nodiscard]] double mean() const { return first / count; }
    /// Of one path, not of the mean.
    [[nodiscard]] double variance() const { return (second / count - mean() * mean()) * count / (count - 1); }
    [[nodiscard]] Moments operator+(const Moments& o) const {
        return {count + o.count, first + o.first, second + o.second, third + o.third, fourth + o.fourth};
    }
    /// Fourth central moment over the squared second one; 3 for a normal distribution.
    [[nodiscard]] double kurtosis() const {
        const double m = mean(), central = second / count - m * m;
        const double fourthCentral =
            fourth / count - 4 * m * third / count + 6 * m * m * second / count - 3 * m * m * m * m;
        return central > 0 ? fourthCentral / (central * central) : 0;
    }
};

/// A mean and its standard error.
struct Estimate {
    double mean = 0, error = 0;

    /// In standard errors of the difference; 0 for two exact values that are equal.
    [[nodiscard]] double zScore(const Estimate& other) const {
        const double difference = mean - other.mean;
        return difference == 0 ? 0 : difference / std::hypot(error, other.error);
    }
};

/// From independent estimates of equal size.
inline Estimate batchMeans(const std::vector<double>& batches) {
    const double n = double(batches.size());
    double sum = 0, squares = 0;
    for (const double x : batches) sum += x;
    const double mean = sum / n;
    for (const double x : batches) squares += (x - mean) * (x - mean);
    return {mean, std::sqrt(squares / (n * (n - 1)))};
}

inline double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 != 0) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Mean weighted by the inverse squares of the errors; those without an error do not count.
inline Estimate weightedMean(const std::vector<Estimate>& estimates) {
    double weights = 0, sum = 0;
    for (const Estimate& e : estimates) {
        if (!(e.error > 0)) continue;
        weights += 1 / (e.error * e.error);
        sum += e.mean / (e.error * e.error);
    }
    return weights > 0 ? Estimate{sum / weights, std::sqrt(1 / weights)} : Estimate{};
}

/// What a variant did in a case.
struct Measurement {
    Estimate estimate;   ///< path mode: radiance; photon mode: sum over the image's pixels
    double variance = 0; ///< median of the batches', of one path; photon mode: summed over the pixels
    double kurtosis = 0; ///< of all paths' estimates
    double cost = 0;     ///< ns per path, photon mode with the cost of its rays
    double paths = 0;
    std::vector<Estimate> pixels; ///< photon mode

    /// Inverse of the variance that a unit of time leaves.
    [[nodiscard]] double efficiency() const { return 1 / (variance * cost); }
    /// The variance is known to a quarter, as far as the kurtosis tells; otherwise rare paths that carry most of the
    /// mean may have been missed, and neither variance nor error can be trusted.
    [[nodiscard]] bool converged() const { return 16 * kurtosis < paths; }
};

/// Processor time of the calling thread in seconds.
inline double threadSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

} // namespace infinite_medium
