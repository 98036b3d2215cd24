#include "darts/EdaDensity.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace darts {
namespace {

/// Positive half of the 16-point Gauss-Legendre rule.
constexpr std::array<double, 8> GaussNodes{0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                           0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                           0.9445750230732326, 0.9894009349916499};
constexpr std::array<double, 8> GaussWeights{0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                             0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                             0.0622535239386479, 0.0271524594117541};

/// Parts of the integrand below e^-Cutoff of its maximum are left out.
constexpr double Cutoff = 20.0;

/// The integrand over v = log s, s = S - tau the length of what follows the first flight. With s^2 - rho^2 =
/// 2 (delta + C h) s - delta^2 - 2 S C h, its logarithm is -kappa s - log(s) / 2 - b / s + constant.
struct LogIntegrand {
    double kappa, fourDInverse, C, delta, h;

    [[nodiscard]] double length() const { return C + delta; }
    /// 0 at s = S but for what depends on neither h nor s. The exponent's h-dependence is written so that it vanishes
    /// there without cancellation.
    [[nodiscard]] double at(double v) const {
        const double s = std::exp(v), tau = length() - s;
        return kappa * tau - 0.5 * v - fourDInverse * (delta * delta + 2.0 * C * h * tau) / s;
    }
    /// Where the logarithm is largest and smallest, if anywhere: roots of kappa s^2 + s / 2 - b.
    [[nodiscard]] std::array<double, 2> turningLengths() const {
        const double b = fourDInverse * (delta * delta + 2.0 * length() * C * h);
        const double discriminant = 0.25 + 4.0 * kappa * b;
        if (!(discriminant >= 0.0)) return {0.0, 0.0};
        const double sum = 0.5 + std::sqrt(discriminant);
        return {2.0 * b / sum, kappa < 0.0 ? -0.5 * sum / kappa : 0.0};
    }
};

/// Moves the lower end of a monotone piece up to where the integrand is at least e^-Cutoff of the maximum.
double clipToCutoff(const LogIntegrand& f, double low, double high, double maximum) {
    if (f.at(low) > maximum - Cutoff) return low;
    for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (low + high);
        (f.at(middle) > maximum - Cutoff ? high : low) = middle;
    }
    return low;
}

double gaussLegendre(const LogIntegrand& f, double from, double to, double maximum) {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0.0;
    for (size_t i = 0; i < GaussNodes.size(); ++i)
        sum += GaussWeights[i] * (std::exp(f.at(middle - half * GaussNodes[i]) - maximum) +
                                  std::exp(f.at(middle + half * GaussNodes[i]) - maximum));
    return std::abs(half) * sum;
}

} // namespace

double edaLogDensity(double albedo, double g, double C, double delta, double h) {
    const double fourDInverse = 0.75 * (1.0 - albedo * g), S = C + delta;
    const LogIntegrand f{fourDInverse - albedo, fourDInverse, C, delta, h};
    const double shortest = (delta * delta + 2.0 * S * C * h) / (2.0 * (delta + C * h));

    // Monotone pieces, each integrated from its larger end as far as it matters.
    std::array<double, 4> ends{std::log(shortest), std::log(S), std::log(S), std::log(S)};
    size_t pieces = 1;
    for (const double s : f.turningLengths())
        if (s > shortest && s < S) ends[pieces++] = std::log(s);
    ends[pieces] = std::log(S);
    double maximum = f.at(ends[0]);
    for (size_t i = 1; i <= pieces; ++i) maximum = std::max(maximum, f.at(ends[i]));

    double sum = 0.0;
    for (size_t i = 0; i < pieces; ++i) {
        double low = ends[i], high = ends[i + 1];
        if (f.at(low) > f.at(high)) std::swap(low, high);
        if (f.at(high) < maximum - Cutoff) continue;
        low = clipToCutoff(f, low, high, maximum);
        sum += gaussLegendre(f, low, high, maximum);
    }
    return maximum + std::log(sum);
}

} // namespace darts
